//! Feasible drives over waypoints: every leg that a search returns meets its waypoint by another integrator, and keeps
//! its limits.

use std::time::Instant;

use hairpin::campaign::drive::Site;
use hairpin::feasibility::reach::drive::{
    DriveSettings, DriveSite, GroundSampling, GroundScore, LegRefusal, Manoeuvres, sample_ground,
};
use hairpin::feasibility::reach::{DriveNode, DriveRoadmap, PlanarVehicle, Reach};
use hairpin::feasibility::steering::shooting::rough::Steps;
use hairpin::math::random::hashed_unit;
use hairpin::robot::rover::{Rover, RoverDescription, Weight, Wheels};
use hairpin::search::{
    Aggregate, BeamSettings, ExactSettings, Found, LegGraph, OpenEnd, OpenNode, Score, Task, UniformSettings, beam,
    exact, uniform,
};
use hairpin::trajectory::Drive;
use hairpin::trajectory::drive::{Gear, Motion, Planar, Segment};
use hairpin::world::Sampling;
use hairpin::world::terrain::generate::{Recipe, generate};
use hairpin::world::terrain::{ElevationMap, KeepOut, KeepOutShape, KeepOuts};
use nalgebra::Point3;

fn shipped(name: &str) -> Rover {
    let path = format!("{}/../../data/robots/rover/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(path).expect("a shipped rover");
    toml::from_str::<RoverDescription>(&text).expect("its keys").build().expect("its numbers")
}

/// Craters and hills of 30 m.
fn cratered() -> ElevationMap {
    let recipe =
        Recipe { size_m: 30.0, relief_m: 0.5, rock_cover: 0.0, crater_area_m2: 40.0, seed: 3, ..Recipe::default() };
    generate(&recipe).expect("a yard")
}

fn level() -> ElevationMap {
    let recipe =
        Recipe { size_m: 30.0, relief_m: 0.0, rock_cover: 0.0, least_crater_m: f64::INFINITY, ..Recipe::default() };
    generate(&recipe).expect("a plain")
}

const START: Planar = Planar { x: 15.0, y: 15.0, yaw: 0.3, curvature: 0.2 };

/// The start and `count` places around it.
fn graph(site: &DriveSite, settings: &DriveSettings, count: usize, seed: u64) -> Vec<Point3<f64>> {
    let asked = GroundSampling {
        count,
        margin: 1.0,
        around: Some(([START.x, START.y], 10.0)),
        sampling: Sampling::Uniform,
        seed,
    };
    let mut points = vec![Point3::new(START.x, START.y, 0.0)];
    points.extend(sample_ground(site, settings, &asked, &|| false).expect("places"));
    points
}

fn careful(rover: &Rover) -> DriveSettings {
    let mut settings = DriveSettings::of(rover);
    settings.leg_m = [2.0, 6.0];
    settings.limits.tilt = settings.limits.tilt.min(25.0_f64.to_radians());
    settings
}

fn by_beam(
    map: &DriveRoadmap,
    points: &[Point3<f64>],
    length: usize,
    aggregate: Aggregate,
) -> Option<Found<DriveNode>> {
    let open = OpenEnd::new(map, points);
    let settings = BeamSettings { length: length + 1, aggregate, lookahead: 0, ..BeamSettings::default() };
    let score = open.score(&Score::Ground, aggregate);
    let outcome = beam(&open.task(map.start()), &score, OpenEnd::<&DriveRoadmap>::may_arrive, &settings);
    outcome.found.into_iter().next().map(|found| open.closed(found))
}

/// Replays every leg with another integrator and holds it against what was claimed.
fn hold(site: &DriveSite, settings: &DriveSettings, drive: &Drive, told: &str) {
    for (number, leg) in drive.legs.iter().enumerate() {
        let ground = Site { rover: site.rover, map: site.map, speed: drive.speed.into(), direction: leg.direction };
        let replay = ground.replay(&leg.from, &leg.to, &leg.segments).expect("a way");
        let [x, y, yaw] = replay.error;
        let met = x.hypot(y) <= 0.01 && yaw.abs() <= 0.01 && replay.error_curvature.abs() <= 0.01;
        assert!(met, "{told}, leg {number}: {replay:?}");
        assert!(replay.max_tilt <= settings.limits.tilt, "{told}, leg {number}: {replay:?}");
        assert!(replay.max_torque <= site.rover.wheels.torque, "{told}, leg {number}: {replay:?}");
        for segment in &leg.segments {
            let step = segment.length_m() / 200.0;
            let most = (0..=200).map(|i| segment.curvature_at(step * f64::from(i)).abs()).fold(0.0, f64::max);
            assert!(most <= settings.bounds.most * (1.0 + 1e-6), "{told}, leg {number}: {most}");
        }
        if let Some(next) = drive.legs.get(number + 1) {
            assert_eq!((leg.to, leg.direction.end), (next.from, next.direction.start), "{told}");
        }
    }
}

#[test]
fn eight_waypoints_over_craters_are_found_and_replayed() {
    let (yard, rover) = (cratered(), shipped("rocky8"));
    let free = KeepOuts::default();
    let site = DriveSite::new(&rover, &yard, &free);
    let mut found = 0;
    for seed in 0..4 {
        let settings = DriveSettings { seed, ..careful(&rover) };
        let begun = Instant::now();
        let points = graph(&site, &settings, 60, seed);
        let map = DriveRoadmap::new(site, &points, &START, None, &settings);
        let best = by_beam(&map, &points, 8, Aggregate::Sum);
        println!(
            "graph {seed}: {} solves, {:.2} s; {}",
            map.tally().solves,
            begun.elapsed().as_secs_f64(),
            map.tally()
        );
        let Some(best) = best else { continue };
        found += 1;
        assert_eq!((best.waypoints.len(), best.leg_times.len()), (8, 7));
        let drive = map.drive(&best.nodes).expect("legs that were found");
        assert_eq!(drive.legs[0].from, START);
        for (k, leg) in drive.legs.iter().enumerate() {
            let [a, b] = [best.waypoints[k], best.waypoints[k + 1]].map(|w| points[w as usize]);
            assert!((leg.from.x, leg.from.y, leg.to.x, leg.to.y) == (a.x, a.y, b.x, b.y));
            assert!((2.0..=6.0).contains(&(b - a).xy().norm()), "seed {seed}");
            assert!((drive.leg_time(k) - best.leg_times[k]).abs() < 1e-9);
        }
        hold(&site, &settings, &drive, &format!("seed {seed}"));
    }
    assert!(found >= 3, "{found} of 4 graphs");
}

#[test]
fn places_in_clusters_lie_closer_and_are_stood_on_all_the_same() {
    let (yard, rover) = (cratered(), shipped("rocky8"));
    let free = KeepOuts::default();
    let site = DriveSite::new(&rover, &yard, &free);
    let settings = careful(&rover);
    let places = |sampling: Sampling| {
        let around = Some(([START.x, START.y], 10.0));
        let asked = GroundSampling { count: 60, margin: 1.0, around, sampling, seed: 2 };
        sample_ground(&site, &settings, &asked, &|| false).expect("places")
    };
    let apart = |points: &[Point3<f64>]| {
        let nearest = |at: usize| {
            let others = points.iter().enumerate().filter(|(other, _)| *other != at);
            others.map(|(_, other)| (other.xy() - points[at].xy()).norm()).fold(f64::INFINITY, f64::min)
        };
        let mut nearest: Vec<f64> = (0..points.len()).map(nearest).collect();
        nearest.sort_by(f64::total_cmp);
        nearest[points.len() / 2]
    };
    let (uniform, clustered) = (places(Sampling::Uniform), places(Sampling::Clustered));
    assert!(apart(&clustered) < 0.75 * apart(&uniform), "{} and {} m", apart(&clustered), apart(&uniform));
    assert!(clustered.iter().all(|p| (p.x - START.x).hypot(p.y - START.y) <= 10.0));
    assert_eq!(clustered, places(Sampling::Clustered));
}

#[test]
fn the_same_seed_gives_the_same_drive_and_another_another() {
    let (yard, rover) = (cratered(), shipped("rocky8"));
    let free = KeepOuts::default();
    let site = DriveSite::new(&rover, &yard, &free);
    let drive = |seed: u64| {
        let settings = DriveSettings { seed, ..careful(&rover) };
        let points = graph(&site, &settings, 40, seed);
        let map = DriveRoadmap::new(site, &points, &START, None, &settings);
        by_beam(&map, &points, 5, Aggregate::Max).and_then(|found| map.drive(&found.nodes)).expect("a drive")
    };
    assert_eq!(drive(1), drive(1));
    assert_ne!(drive(1), drive(2));
}

#[test]
fn no_beam_is_better_than_the_exact_search_and_draws_are_feasible() {
    let (yard, rover) = (cratered(), shipped("rocky8"));
    let free = KeepOuts::default();
    let site = DriveSite::new(&rover, &yard, &free);
    let score = GroundScore::named("roll+curvature-change+random").expect("terms");
    for seed in 0..2 {
        let settings = DriveSettings { seed, headings: 2, score: score.clone(), ..careful(&rover) };
        let points = graph(&site, &settings, 30, seed);
        let map = DriveRoadmap::new(site, &points, &START, None, &settings);
        let open = OpenEnd::new(&map, &points);
        let legs = LegGraph::explore(OpenNode::At(map.start()), open.candidates(), &open, 6);
        for aggregate in [Aggregate::Sum, Aggregate::Max] {
            let score = open.score(&Score::Ground, aggregate);
            let beam = by_beam(&map, &points, 5, aggregate).expect("a drive");
            let best = exact(&legs, &score, &ExactSettings { length: 6, aggregate, ..ExactSettings::default() });
            assert!(best.proven == 1 && best.found[0].score >= beam.score - 1e-12, "seed {seed}: {best:?}");
            let drawn = UniformSettings { length: 6, wanted: 5, aggregate, ..UniformSettings::default() };
            for found in uniform(&legs, &score, seed, &drawn).found {
                let found = open.closed(found);
                assert!(found.score <= best.found[0].score + 1e-12);
                hold(&site, &settings, &map.drive(&found.nodes).expect("legs"), &format!("seed {seed}"));
            }
        }
    }
}

#[test]
fn behind_a_wall_of_keep_outs_there_is_nothing_and_it_is_said_why() {
    let (yard, rover) = (cratered(), shipped("rocky8"));
    // Stones around the start, closer together than the rover is wide; it stands clear of all of them.
    let stone = |i: u32| {
        let (sin, cos) = (f64::from(i) * 0.314).sin_cos();
        let center_m = [START.x + 1.5 * cos, START.y + 1.5 * sin];
        KeepOut { name: format!("stone {i}"), shape: KeepOutShape::Circle { center_m, radius_m: 0.1 } }
    };
    let wall = KeepOuts::new((0..20).map(stone).collect()).expect("a wall");
    let site = DriveSite::new(&rover, &yard, &wall);
    assert!(wall.distance(START.x, START.y) > site.radius);
    let settings = careful(&rover);
    let points = graph(&site, &settings, 40, 0);
    let map = DriveRoadmap::new(site, &points, &START, None, &settings);
    assert_eq!(by_beam(&map, &points, 3, Aggregate::Sum), None);
    let tally = map.tally();
    assert!(tally.asked > 10 && tally.feasible == 0, "{tally}");
    assert!(tally.refused(LegRefusal::KeepOut) > 0, "{tally}");
    let told: u64 = LegRefusal::ALL.iter().map(|reason| tally.refused(*reason)).sum();
    assert_eq!(told, tally.asked);
    assert!(tally.to_string().contains("enter a keep-out"), "{tally}");
}

#[test]
fn on_level_ground_a_body_without_wheels_drives_to_an_end_of_its_own() {
    let (plain, rover) = (level(), shipped("generic"));
    let free = KeepOuts::default();
    let site = DriveSite::new(&rover, &plain, &free);
    let settings = DriveSettings { score: GroundScore::named("speed").expect("a term"), ..careful(&rover) };
    let mut points = graph(&site, &settings, 40, 5);
    points.push(Point3::new(19.0, 18.0, 0.0));
    let end = Planar { x: 19.0, y: 18.0, yaw: 1.0, curvature: -0.1 };
    let map = DriveRoadmap::new(site, &points, &START, Some(&end), &settings);
    let task = Task { start: map.start(), candidates: &points, reach: &map };
    let asked = BeamSettings { length: 4, lookahead: 0, ..BeamSettings::default() };
    let outcome = beam(&task, &Score::Ground, |node, steps| map.may_arrive(node, steps), &asked);
    let found = outcome.found.first().expect("a drive");
    let drive = map.drive(&found.nodes).expect("legs");
    assert_eq!(drive.legs[2].to, end);
    hold(&site, &settings, &drive, "level");
    assert!(found.score > 1.5 && found.score <= 3.0, "{}", found.score);
}

/// Every leg from the start over `points`.
fn from_start(map: &DriveRoadmap, points: &[Point3<f64>]) -> Vec<(f64, Drive)> {
    let mut legs = Vec::new();
    map.legs(&map.start(), points, &mut legs);
    assert!(legs.windows(2).all(|w| w[0].waypoint <= w[1].waypoint));
    legs.iter().map(|leg| (leg.features.ground, map.drive(&[map.start(), leg.to]).expect("a leg"))).collect()
}

#[test]
fn each_manoeuvre_is_used_where_it_is_allowed_and_only_there() {
    let (plain, rover) = (level(), shipped("generic"));
    let free = KeepOuts::default();
    let site = DriveSite::new(&rover, &plain, &free);
    let with = |forward, reverse, turn_in_place| {
        let settings = DriveSettings {
            manoeuvres: Manoeuvres { forward, reverse, turn_in_place },
            score: GroundScore::named("reversals").expect("a term"),
            ..careful(&rover)
        };
        let points = graph(&site, &settings, 60, 9);
        let map = DriveRoadmap::new(site, &points, &START, None, &settings);
        let legs = from_start(&map, &points);
        legs.iter().for_each(|(_, drive)| hold(&site, &settings, drive, "manoeuvres"));
        legs
    };
    let any = |legs: &[(f64, Drive)], is: fn(&Segment) -> bool| {
        legs.iter().filter(|(_, drive)| drive.legs[0].segments.iter().any(is)).count()
    };
    let reversed = |segment: &Segment| segment.gear == Gear::Reverse;
    let turned = |segment: &Segment| matches!(segment.motion, Motion::Turn { .. });
    let (ahead, back, both, all) =
        (with(true, false, false), with(false, true, false), with(true, true, false), with(true, true, true));
    assert!(!ahead.is_empty() && any(&ahead, reversed) + any(&ahead, turned) == 0);
    assert!(!back.is_empty() && any(&back, reversed) == back.len() && any(&back, turned) == 0);
    assert!(both.len() > ahead.len().max(back.len()), "{} {} {}", ahead.len(), back.len(), both.len());
    assert!(both.iter().any(|(reversals, _)| *reversals > 0.0), "legs with a change of gear");
    assert!(all.len() >= both.len() && any(&all, turned) > 0);
    assert!(any(&both, turned) == 0 && with(false, false, false).is_empty());
}

#[test]
fn slip_and_delay_that_the_rover_is_known_to_have_are_met() {
    let yard = cratered();
    let mut rover = shipped("rocky8");
    rover.slip.at_20_deg = 0.3;
    rover.slip.side_at_20_deg = 0.15;
    rover.response.latency = 0.3;
    let free = KeepOuts::default();
    let site = DriveSite::new(&rover, &yard, &free);
    let settings = careful(&rover);
    let points = graph(&site, &settings, 60, 2);
    let map = DriveRoadmap::new(site, &points, &START, None, &settings);
    let legs = from_start(&map, &points);
    assert!(legs.len() > 5, "{}", map.tally());
    legs.iter().for_each(|(_, drive)| hold(&site, &settings, drive, "slip"));
}

#[test]
fn the_underside_keeps_its_distance_and_the_vehicle_the_keep_outs() {
    let (yard, rover) = (cratered(), shipped("rocky8"));
    let circle = |i: u32| {
        let (sin, cos) = (f64::from(i) * 0.7).sin_cos();
        let center_m = [START.x + 5.0 * cos, START.y + 5.0 * sin];
        KeepOut { name: format!("rock {i}"), shape: KeepOutShape::Circle { center_m, radius_m: 0.3 } }
    };
    let rocks = KeepOuts::new((0..9).map(circle).collect()).expect("places");
    let site = DriveSite::new(&rover, &yard, &rocks);
    let mut settings = DriveSettings { seed: 1, headings: 12, ..careful(&rover) };
    let points = graph(&site, &settings, 60, 1);
    let legs_with = |settings: &DriveSettings| {
        let map = DriveRoadmap::new(site, &points, &START, None, settings);
        let drives = from_start(&map, &points);
        (drives, map.tally())
    };
    let (loose, tally) = legs_with(&settings);
    assert!(tally.refused(LegRefusal::Belly) == 0 && tally.refused(LegRefusal::KeepOut) > 0, "{tally}");
    let clearance_at = |place: [f64; 3]| {
        let pose = rover.suspension.settle_cold(&yard, place).expect("rest").0;
        rover.belly_clearance(&yard, place, &pose).expect("ground")
    };
    let least = 0.03;
    settings.limits.clearance = least;
    let (strict, tally) = legs_with(&settings);
    assert!(tally.refused(LegRefusal::Belly) > 0 && !strict.is_empty() && strict.len() < loose.len(), "{tally}");
    let course = Site { rover: &rover, map: &yard, speed: settings.speed.into(), direction: 0.0.into() };
    for (_, drive) in &strict {
        let leg = &drive.legs[0];
        let mut at = leg.from;
        for segment in &leg.segments {
            // Cut into pieces of a centimetre, whose ends are looked at.
            let pieces = (segment.length_m() / 0.01).ceil();
            for k in 0..pieces as usize {
                let step = segment.length_m() / pieces;
                let s = k as f64 * step;
                let piece =
                    Segment::clothoid(step, segment.curvature_at(s), segment.curvature_at(s + step), segment.gear);
                at = course.predict(&at, &[piece], Steps { least: 1, ..Steps::default() }).expect("a way").end;
                let clearance = clearance_at([at.x, at.y, at.yaw]);
                assert!(clearance > least - 0.01 && rocks.distance(at.x, at.y) > site.radius - 1e-3, "{clearance}");
            }
        }
    }
}

#[test]
fn legs_that_the_wheels_are_too_weak_for_are_refused_and_the_others_proven() {
    let (yard, mut rover) = (cratered(), shipped("rocky8"));
    rover.weight = Some(Weight { mass: 60.0, gravity: 3.71, rolling_resistance: 0.05 });
    let free = KeepOuts::default();
    let legs_with = |torque: f64| {
        let rover = Rover { wheels: Wheels { torque, ..rover.wheels }, ..rover.clone() };
        let site = DriveSite::new(&rover, &yard, &free);
        let settings = careful(&rover);
        let points = graph(&site, &settings, 60, 3);
        let map = DriveRoadmap::new(site, &points, &START, None, &settings);
        let legs = from_start(&map, &points);
        legs.iter().for_each(|(_, drive)| hold(&site, &settings, drive, "weak wheels"));
        (legs, map.tally().refused(LegRefusal::Torque))
    };
    let ((strong, none), (weak, refused)) = (legs_with(50.0), legs_with(1.6));
    assert!(
        none == 0 && refused > 2 && weak.len() > 2 && weak.len() < strong.len(),
        "{none} {refused}, {} of {}",
        weak.len(),
        strong.len()
    );
    // Ahead of a plan that was made for stronger wheels the proof finds the limit broken.
    let site = Site { rover: &rover, map: &yard, speed: 0.3.into(), direction: 0.0.into() };
    let torque = |drive: &Drive| {
        let leg = &drive.legs[0];
        site.replay(&leg.from, &leg.to, &leg.segments).expect("a way").max_torque
    };
    assert!(strong.iter().any(|(_, drive)| torque(drive) > 1.6));
}

#[test]
fn turns_and_reversals_are_solved_on_rough_ground_as_well() {
    let (yard, rover) = (cratered(), shipped("rocky8"));
    let free = KeepOuts::default();
    let site = DriveSite::new(&rover, &yard, &free);
    let manoeuvres = Manoeuvres { forward: true, reverse: true, turn_in_place: true };
    let settings = DriveSettings { manoeuvres, ..careful(&rover) };
    let points = graph(&site, &settings, 40, 4);
    let map = DriveRoadmap::new(site, &points, &START, None, &settings);
    let legs = from_start(&map, &points);
    legs.iter().for_each(|(_, drive)| hold(&site, &settings, drive, "rough manoeuvres"));
    let tally = map.tally();
    println!("{} solves; {tally}", tally.solves);
    let turned = |drive: &Drive| drive.legs[0].segments.iter().any(|s| matches!(s.motion, Motion::Turn { .. }));
    assert!(legs.iter().any(|(_, drive)| turned(drive)));
    // Only what lies steep, not what is hard to solve, is left out.
    assert!(tally.feasible * 2 > tally.asked && tally.refused(LegRefusal::Unsolved) * 20 < tally.asked, "{tally}");
}

#[test]
fn hulls_of_a_car_are_searched_as_those_of_flyers() {
    let car = PlanarVehicle::of(&shipped("generic"), 1.5, false);
    let hull = car.hull(2.0).expect("hulls");
    let (mut found, mut proven) = (0, 0);
    for seed in 0..6 {
        let at = |i: u64, k: u64| 10.0 * hashed_unit(seed, &[i, k]);
        let drawn = (0..100).map(|i| Point3::new(at(i, 0), at(i, 1) - 5.0, 0.0));
        let points: Vec<_> = [Point3::origin()].into_iter().chain(drawn).chain([Point3::new(8.0, 2.0, 0.0)]).collect();
        let start = hull.start(0.0, [0.0, 0.0]);
        let task = Task { start, candidates: &points, reach: &hull };
        let score = Score::named("high-velocity-90", seed, hull.farthest() / 2.0).expect("a score");
        let settings = BeamSettings { length: 8, ..BeamSettings::default() };
        let outcome = beam(&task, &score, |node, steps| hull.may_arrive(&points, node, steps), &settings);
        let Some(best) = outcome.found.first() else { continue };
        found += 1;
        for (k, pair) in best.nodes.windows(2).enumerate() {
            let mut legs = Vec::new();
            hull.legs(&pair[0], &points, &mut legs);
            assert!(legs.iter().any(|leg| leg.to == pair[1] && leg.duration == best.leg_times[k]), "seed {seed}");
        }
        let graph = LegGraph::explore(start, &points, &hull, 8);
        let exact = exact(&graph, &score, &ExactSettings { length: 8, ..ExactSettings::default() });
        let bound = exact.bound.expect("there is one");
        assert!(bound >= best.score - 1e-9, "seed {seed}: {bound} {}", best.score);
        proven += exact.proven;
    }
    println!("{found} of 6 graphs, {proven} optima proven");
    assert!(found >= 4, "{found}");
}
