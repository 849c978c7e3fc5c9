//! Drives whose direction of travel turns in the body: found over craters, replayed by other code, followed by every
//! controller.

use hairpin::campaign::drive::Site;
use hairpin::feasibility::reach::drive::{
    DriveDraft, DriveSettings, DriveSite, GroundSampling, LegRefusal, Manoeuvres, sample_ground,
};
use hairpin::feasibility::reach::{DriveRoadmap, Reach};
use hairpin::feasibility::steering::shooting::families::Problem;
use hairpin::feasibility::steering::shooting::solve::{Choices, Outcome};
use hairpin::feasibility::steering::shooting::{Control, Query, generate as generate_drive, rough};
use hairpin::judgement::{Measures, Reference, Settings, measure};
use hairpin::robot::rover::{Rover, RoverDescription, Slip};
use hairpin::simulation::ground::{
    DriveSettings as RunSettings, GroundConditions, GroundController, GroundSortie, drive, planned_track,
};
use hairpin::trajectory::drive::{Gear, Motion, Planar, Segment, SegmentList};
use hairpin::trajectory::{Direction, Drive, DriveLeg, Ended, Passing};
use hairpin::world::Sampling;
use hairpin::world::terrain::generate::{Recipe, generate};
use hairpin::world::terrain::{ElevationMap, KeepOuts};
use nalgebra::Point3;

fn rocky8() -> Rover {
    let path = format!("{}/../../data/robots/rover/rocky8.toml", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(path).expect("a shipped rover");
    toml::from_str::<RoverDescription>(&text).expect("its keys").build().expect("its numbers")
}

fn yard(relief_m: f64, least_crater_m: f64) -> ElevationMap {
    let recipe = Recipe {
        size_m: 30.0,
        relief_m,
        rock_cover: 0.0,
        crater_area_m2: 40.0,
        least_crater_m,
        seed: 3,
        ..Recipe::default()
    };
    generate(&recipe).expect("a yard")
}

const START: Planar = Planar { x: 15.0, y: 15.0, yaw: 0.3, curvature: 0.0 };

/// Replays a leg with another integrator; the worst of its errors in m and rad.
fn off(rover: &Rover, map: &ElevationMap, drive: &Drive, leg: &DriveLeg) -> f64 {
    let site = Site { rover, map, speed: drive.speed.into(), direction: leg.direction };
    let replay = site.replay(&leg.from, &leg.to, &leg.segments).expect("a way");
    let [x, y, yaw] = replay.error;
    x.hypot(y).max(yaw.abs()).max(replay.error_curvature.abs())
}

#[test]
fn every_manoeuvre_over_craters_turns_its_direction_from_waypoint_to_waypoint() {
    let (map, rover, free) = (yard(0.5, Recipe::default().least_crater_m), rocky8(), KeepOuts::default());
    let site = DriveSite::new(&rover, &map, &free);
    let settings = DriveSettings {
        directions: [-0.4, 0.5],
        manoeuvres: Manoeuvres { forward: true, reverse: true, turn_in_place: true },
        seed: 2,
        ..DriveSettings::of(&rover)
    };
    let asked = GroundSampling {
        count: 30,
        margin: 1.0,
        around: Some(([START.x, START.y], 8.0)),
        sampling: Sampling::Uniform,
        seed: 4,
    };
    let mut points = vec![Point3::new(START.x, START.y, 0.0)];
    points.extend(sample_ground(&site, &settings, &asked, &|| false).expect("places"));
    let roadmap = DriveRoadmap::new(site, &points, &START, None, &settings);
    let mut legs = Vec::new();
    roadmap.legs(&roadmap.start(), &points, &mut legs);
    let drives: Vec<Drive> = legs.iter().map(|leg| roadmap.drive(&[roadmap.start(), leg.to]).expect("a leg")).collect();
    let tally = roadmap.tally();
    println!("{tally}");
    // Only what lies steep, not what is hard to solve, is left out.
    assert!(drives.len() > 10 && tally.refused(LegRefusal::Unsolved) * 20 < tally.asked, "{tally}");
    let mut ends = Vec::new();
    for drive in &drives {
        let leg = &drive.legs[0];
        assert!(off(&rover, &map, drive, leg) < 0.01, "{leg:?}");
        assert_eq!(leg.direction.start, drives[0].legs[0].direction.start);
        ends.push(leg.direction.end);
        let (start, end) = (drive.passing(0).expect("a start"), drive.passing(1).expect("an end"));
        let same = DriveDraft::new(&[start, end], &settings).driven(&site, &settings).expect("the same leg");
        assert_eq!(same.legs[0].segments, leg.segments);
    }
    ends.sort_by(f64::total_cmp);
    assert!(ends[0] < -0.2 && ends[ends.len() - 1] > 0.3 && ends.iter().all(|end| (-0.4..=0.5).contains(end)));
    let any = |is: fn(&Segment) -> bool| drives.iter().any(|drive| drive.legs[0].segments.iter().any(is));
    assert!(any(|s| s.gear == Gear::Reverse) && any(|s| matches!(s.motion, Motion::Turn { .. })));
    // Wheels that are steered as slowly as this turn no direction on the way.
    let mut slow = rover.clone();
    slow.wheels.steer_rate = 1e-3;
    let site = DriveSite::new(&slow, &map, &free);
    let still = DriveRoadmap::new(site, &points, &START, None, &settings);
    legs.clear();
    still.legs(&still.start(), &points, &mut legs);
    assert!(legs.len() < 10 && still.tally().refused(LegRefusal::Steering) > 10, "{}", still.tally());
}

/// A body that does not turn, and whose direction of travel turns evenly, goes round the circle of radius 1/δ′.
fn quarters(speed: f64) -> Drive {
    let quarter = std::f64::consts::FRAC_PI_2;
    let leg = |from: [f64; 2], to: [f64; 2], direction: Direction, gear: Gear| DriveLeg {
        from: Planar { x: from[0], y: from[1], ..Planar::default() },
        to: Planar { x: to[0], y: to[1], ..Planar::default() },
        segments: vec![Segment::straight(2.0 * quarter, gear)],
        speed: speed.into(),
        direction,
    };
    let (out, back) = (Direction { start: 0.0, end: quarter }, Direction { start: quarter, end: 0.0 });
    let legs = vec![
        leg([0.0, 0.0], [2.0, 2.0], out, Gear::Forward),
        // On with the bend the other way, and back along all of it.
        leg([2.0, 2.0], [4.0, 4.0], back, Gear::Forward),
        leg([4.0, 4.0], [2.0, 2.0], out, Gear::Reverse),
    ];
    Drive { legs, speed, turn_rate: 0.3 }
}

#[test]
fn a_direction_that_turns_evenly_drives_circles_without_turning_the_body() {
    let (map, rover) = (yard(0.0, f64::INFINITY), rocky8());
    let mut plan = quarters(0.1);
    for leg in &mut plan.legs {
        for at in [&mut leg.from, &mut leg.to] {
            (at.x, at.y) = (at.x + START.x, at.y + START.y);
        }
    }
    let path = planned_track(&rover, &map, &plan).expect("a plan");
    let legs = path.channel("leg").expect("legs").to_vec();
    for (k, leg) in legs.iter().enumerate() {
        let (at, leg) = (path.position(k), *leg as usize);
        // Centres of the circles of the legs, as the crow would draw them.
        let centre = [[0.0, 2.0], [4.0, 2.0], [4.0, 2.0]][leg];
        let off = (at.x - START.x - centre[0]).hypot(at.y - START.y - centre[1]) - 2.0;
        assert!(off.abs() < 1e-4, "leg {leg}: {off} m");
    }
    let last = path.position(path.len() - 1);
    assert!((last.x - START.x - 2.0).hypot(last.y - START.y - 2.0) < 1e-4, "{last}");
    plan.legs.iter().for_each(|leg| assert!(off(&rover, &map, &plan, leg) < 1e-4, "{leg:?}"));
}

struct Run {
    vehicle: Rover,
    nominal: Rover,
    map: ElevationMap,
    latency: f64,
}

impl Run {
    /// The predictive controller's solver.
    fn resolve(&self, from: &Planar, to: &Planar, gear: Gear, direction: Direction) -> Option<SegmentList> {
        let site = Site { rover: &self.nominal, map: &self.map, speed: 0.1.into(), direction };
        let bounds = site.bounds();
        let choices = Choices { gear, ..Choices::default() };
        let mut shape = |query: &Query| {
            let query = Query::new(query.start_curvature, query.goal, &bounds).ok()?;
            let problem = Problem { query, speed: 0.1.into(), swing: direction.swing(), free_end: false };
            let found = generate_drive(&problem, Control::Quintic, &bounds, &choices, || false, |_| {}).solution;
            (found.outcome == Outcome::Solved).then_some(found.segments)
        };
        let answer = site.solve(from, to, &bounds, &rough::Settings::default(), &mut shape);
        (answer.status == rough::Status::Ok).then_some(answer.segments)
    }

    fn drive(&self, plan: &Drive, controller: &GroundController) -> (Ended, Measures) {
        let none = KeepOuts::default();
        let sortie = GroundSortie {
            vehicle: &self.vehicle,
            nominal: &self.nominal,
            terrain: &self.map,
            keep_outs: &none,
            clearance_radius: 0.0,
            drive: plan,
        };
        let conditions = GroundConditions { latency: self.latency, ..GroundConditions::default() };
        let flight = drive(&sortie, controller, &conditions, &RunSettings::default(), 1).expect("a drive");
        assert!(flight.track.channel("travel_direction_rad").is_some());
        let path = planned_track(&self.nominal, &self.map, plan).expect("a plan");
        let ends = plan.legs.iter().map(|leg| [leg.to.x, leg.to.y]);
        let first = plan.legs[0].from;
        let waypoints: Vec<Point3<f64>> =
            std::iter::once([first.x, first.y]).chain(ends).map(|[x, y]| Point3::new(x, y, 0.0)).collect();
        let settings = Settings { reference: Reference::Path(&path), ..Settings::default() };
        (flight.ended, measure(&flight.track, &waypoints, &settings).expect("measures"))
    }
}

/// Nearly as closely as straight ahead (`ground_drives/main.rs`), on rolling ground; and where it gives way and
/// commands act late, in the same order.
#[test]
fn each_controller_follows_a_direction_that_turns() {
    let (map, rover, free) = (yard(0.3, f64::INFINITY), rocky8(), KeepOuts::default());
    let site = DriveSite::new(&rover, &map, &free);
    let settings = DriveSettings {
        manoeuvres: Manoeuvres { forward: true, reverse: true, turn_in_place: false },
        speed: 0.1,
        ..DriveSettings::of(&rover)
    };
    let passing = |x: f64, y: f64, yaw: f64, direction: f64| Passing {
        at: Planar { x: START.x + x, y: START.y + y, yaw, curvature: 0.0 },
        direction,
    };
    // There and, in reverse, on.
    let passings = [
        passing(0.0, 0.0, 0.0, 0.0),
        passing(3.0, 1.5, 0.3, 0.6),
        passing(6.0, 1.5, 0.1, -0.5),
        passing(3.0, 0.5, 0.2, 0.3),
    ];
    let plan = DriveDraft::new(&passings, &settings).driven(&site, &settings).expect("a plan");
    plan.legs.iter().for_each(|leg| assert!(off(&rover, &map, &plan, leg) < 0.01, "{leg:?}"));
    assert!(plan.legs.iter().any(|leg| leg.segments[0].gear == Gear::Reverse));
    let slips = Rover { slip: Slip { at_20_deg: 0.3, side_at_20_deg: 0.15 }, ..rover.clone() };
    for (vehicle, latency, bounds) in [(&rover, 0.0, [0.03, 0.005, 0.02]), (&slips, 0.3, [0.08, 0.15, 0.04])] {
        let run = Run { vehicle: vehicle.clone(), nominal: rover.clone(), map: map.clone(), latency };
        let resolve = |from: &Planar, to: &Planar, gear: Gear, direction| run.resolve(from, to, gear, direction);
        let controllers = [
            ("pure-pursuit", GroundController::PurePursuit),
            ("stanley", GroundController::Stanley),
            ("predictive", GroundController::Predictive(&resolve)),
        ];
        for ((word, controller), bound) in controllers.iter().zip(bounds) {
            let (ended, measures) = run.drive(&plan, controller);
            println!("{word}, latency {latency} s: {:.4} m", measures.max_deviation);
            assert_eq!(ended, Ended::Done, "{word}");
            assert!(measures.max_deviation < bound, "{word} {latency}: {} m", measures.max_deviation);
        }
    }
}
