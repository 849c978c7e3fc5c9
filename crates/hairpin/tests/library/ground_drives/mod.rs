//! Closed-loop drives on the ground: controllers follow plans they can follow, and the plant slips as the closed form
//! says.

pub(crate) mod site;

use hairpin::campaign;
use hairpin::feasibility::reach::drive::{Pace, Slopes};
use hairpin::feasibility::steering::shooting::flat;
use hairpin::feasibility::steering::shooting::query::{Curvatures, Query};
use hairpin::feasibility::steering::shooting::rough;
use hairpin::feasibility::steering::shooting::solve::{Choices, Outcome, solve};
use hairpin::math::random::{stream, unit};
use hairpin::robot::ground::DifferentialDriveDescription;
use hairpin::robot::rover::{Response, Rover, Slip};
use hairpin::simulation::ground::{
    DriveSettings, GroundConditions, GroundController, GroundSortie, drive, planned_track,
};
use hairpin::trajectory::drive::{Gear, Motion, Planar, Segment, SegmentList};
use hairpin::trajectory::{Drive, Ended, SpeedProfile};
use hairpin::world::terrain::generate::{Recipe, generate};
use hairpin::world::terrain::{ElevationMap, Grid, HoleRule, KeepOut, KeepOutShape, KeepOuts};
use site::{CONTROLLERS, Site, car, flat_answer_within, plan, plane, robot_file, shipped};

/// Every motion there is: curves, a cusp into reverse, a turn in place.
fn mixed(speed: f64) -> Drive {
    use Gear::{Forward, Reverse};
    plan(
        &[
            vec![
                Segment::clothoid(1.0, 0.0, 0.6, Forward),
                Segment::clothoid(1.0, 0.6, 0.6, Forward),
                Segment::clothoid(1.0, 0.6, 0.0, Forward),
            ],
            vec![
                Segment::clothoid(1.0, 0.0, -0.7, Forward),
                Segment::clothoid(1.5, -0.7, 0.0, Forward),
                Segment::clothoid(1.0, 0.0, 0.5, Reverse),
                Segment::clothoid(1.0, 0.5, 0.0, Reverse),
            ],
            vec![
                Segment { motion: Motion::Turn { angle_rad: -2.0 }, gear: Forward },
                Segment::clothoid(1.5, 0.0, 0.5, Forward),
                Segment::clothoid(1.5, 0.5, 0.0, Forward),
            ],
        ],
        speed,
    )
}

#[test]
fn each_controller_follows_a_plan_of_every_motion() {
    for name in ["rocky8", "four-wheel", "generic"] {
        let site = Site::new(name, plane(0.0, 0.0));
        for ((word, controller), bound) in CONTROLLERS.iter().zip([0.03, 0.005, 0.01]) {
            let (flight, measures) = site.run(&mixed(0.1), controller, 1);
            // Pure pursuit cuts corners by the curvature's change over its lookahead; the others must not.
            assert!(measures.max_deviation < bound, "{name} {word}: {} m", measures.max_deviation);
            assert_eq!(flight.ended, Ended::Done, "{name} {word}");
            assert!(flight.reached.iter().all(Option::is_some) && flight.track.len() < 4000);
        }
    }
}

/// `plan` at the speeds of `pace`, from rest to rest.
fn paced(mut plan: Drive, pace: Pace, vehicle: &Rover) -> Drive {
    let segments: Vec<&[Segment]> = plan.legs.iter().map(|leg| leg.segments.as_slice()).collect();
    let mut wishes = vec![plan.speed; plan.legs.len() + 1];
    (wishes[0], wishes[plan.legs.len()]) = (0.0, 0.0);
    let profiles = pace.over(plan.speed, &wishes, &segments, &vehicle.response);
    plan.legs.iter_mut().zip(profiles).for_each(|(leg, profile)| leg.speed = profile);
    plan
}

/// A car at 2 m/s: three cusps, at waypoints and between them.
fn shunting() -> Drive {
    use Gear::{Forward, Reverse};
    plan(
        &[
            vec![Segment::clothoid(3.0, 0.0, 0.8, Forward)],
            vec![
                Segment::clothoid(2.0, -0.8, 0.0, Reverse),
                Segment::clothoid(2.0, 0.5, 0.0, Forward),
                Segment::clothoid(1.0, 0.0, 0.0, Forward),
            ],
            vec![Segment::clothoid(3.0, 0.0, -0.8, Reverse)],
        ],
        2.0,
    )
}

/// Plans that come to rest at cusps are followed no worse than those that do not, by every controller, and come as near
/// to the cusps; where commands act late, and the controller does not look past a cusp, they are followed more than
/// twice as closely.
#[test]
fn plans_that_stop_at_cusps_are_followed_more_closely() {
    let mut site =
        Site { vehicle: car(), nominal: car(), map: plane(0.0, 0.0), conditions: GroundConditions::default() };
    let limits = &site.nominal.limits;
    let bounds = Curvatures { most: limits.curvature, most_rate: limits.curvature_rate };
    let resolve =
        |from: &Planar, to: &Planar, gear: Gear, direction| flat_answer_within(bounds, from, to, gear, direction);
    let controllers = [CONTROLLERS[0], CONTROLLERS[1], ("predictive", GroundController::Predictive(&resolve))];
    let stops = Slopes { waypoints: [2.0, 2.0], acceleration: 3.0 };
    for latency in [0.0, 0.05, 0.2] {
        site.conditions.latency = latency;
        for ((word, controller), bound) in controllers.iter().zip([0.07, 0.13, 0.01]) {
            let rash = site.run(&shunting(), controller, 1).1;
            for pace in [Pace::Trapezoid(stops), Pace::Ramp(stops)] {
                let (flight, measures) = site.run(&paced(shunting(), pace, &site.nominal), controller, 1);
                println!(
                    "{word}, latency {latency} s: {:.3} m, {:.3} m overshot; at one speed {:.3} m, {:.3} m",
                    measures.max_deviation,
                    measures.max_overshoot(),
                    rash.max_deviation,
                    rash.max_overshoot()
                );
                assert_eq!(flight.ended, Ended::Done, "{word} {latency}");
                let (off, over) = (measures.max_deviation, measures.max_overshoot());
                assert!(off < bound && off < rash.max_deviation + 1e-3, "{word} {latency}: {off} m");
                assert!(over < 0.11 && over < rash.max_overshoot() + 2e-3, "{word} {latency}: {over} m overshot");
                let past = latency == 0.2 && *word != "pure-pursuit";
                assert!(!past || 2.0 * off < rash.max_deviation, "{word} {latency}: {off} m, {} m", rash.max_deviation);
            }
        }
    }
}

#[test]
fn plans_take_the_time_of_their_speeds() {
    let car = car();
    let slopes = Slopes { waypoints: [1.0, 1.0], acceleration: 2.0 };
    for pace in [Pace::Constant, Pace::Trapezoid(slopes), Pace::Ramp(slopes)] {
        let plan = paced(shunting(), pace, &car);
        let path = planned_track(&car, &plane(0.0, 0.0), &plan).expect("a plan");
        let planned: f64 = (0..plan.legs.len()).map(|leg| plan.leg_time(leg)).sum();
        let taken = path.times()[path.len() - 1];
        assert!((taken - planned).abs() < 1e-6, "{pace:?}: {taken} s, {planned} s");
    }
    let mut wrong = shunting();
    wrong.legs[1].speed = SpeedProfile::Ramp { start: 0.0, end: 0.0 };
    let told = planned_track(&car, &plane(0.0, 0.0), &wrong).map(|_| ());
    assert_eq!(told.expect_err("a ramp that stands still").field(), "drive.legs.speed");
}

/// Wheels that follow no faster than their rate are where they are commanded to be at each instant of a plan that keeps
/// it: half a step behind they turn the body by less all the way.
#[test]
fn plans_of_steered_wheels_lead_where_their_curvature_does() {
    let car = car();
    assert!(car.response.lags() && car.response.steering_time_constant == 0.0);
    let mut farthest = 0.0_f64;
    for speed in [0.3, 1.5, 4.0] {
        for length in [0.5, 1.0, 2.0, 3.0] {
            let bend = Segment::clothoid(length, 0.0, 0.3 * length, Gear::Forward);
            let back = Segment::clothoid(2.0, 0.3 * length, 0.0, Gear::Forward);
            for leg in [vec![bend], vec![bend, back]] {
                let plan = plan(&[leg], speed);
                let path = planned_track(&car, &plane(0.0, 0.0), &plan).expect("a plan");
                let (end, to) = (path.poses()[path.len() - 1], plan.legs[0].to);
                let off = (end.translation.x - to.x).hypot(end.translation.y - to.y);
                let turned = (end.rotation.euler_angles().2 - to.yaw).abs();
                farthest = farthest.max(off);
                assert!(off < 2e-5 && turned < 2e-5, "{speed} m/s, {length} m: {off} m, {turned} rad");
            }
        }
    }
    assert!(farthest > 0.0);
}

/// A boulder between the wheels' tracks.
#[test]
fn an_underside_that_sets_down_ends_the_run() {
    let grid = Grid { columns: 161, rows: 161, first_center: [-4.0, -4.0], cell: [0.05, 0.05] };
    let boulder = |high: f64| {
        let heights: Vec<f32> = (0..161 * 161)
            .map(|i| {
                let (x, y) = (-4.0 + 0.05 * f64::from(i % 161), 4.0 - 0.05 * f64::from(i / 161));
                let off = (x - 2.0).powi(2) + y * y;
                (high * (-off / 0.02).exp()) as f32
            })
            .collect();
        ElevationMap::new(grid, &heights, HoleRule::Error).expect("a map")
    };
    let line = plan(&[vec![Segment::straight(3.0, Gear::Forward)]], 0.1);
    for (high, ended) in [(0.15, Ended::Done), (0.6, Ended::BellyContact)] {
        let site = Site::new("rocky8", boulder(high));
        let (flight, _) = site.run(&line, &GroundController::Stanley, 1);
        assert_eq!(flight.ended, ended, "{high}");
        let least = flight.track.channel("belly_clearance_m").expect("told").iter().copied().fold(f64::MAX, f64::min);
        assert_eq!(least < 0.0, ended == Ended::BellyContact, "{least}");
    }
}

/// How fast a vehicle 1 m to the left of a line comes to it: overshoot, m, and the way after which it stays within 5
/// cm, m.
fn lateral_step(site: &Site, controller: &GroundController, speed: f64) -> (f64, f64) {
    let line = plan(&[vec![Segment::straight(12.0, Gear::Forward)]], speed);
    let (flight, _) = site.run(&line, controller, 1);
    assert_eq!(flight.ended, Ended::Done);
    let places: Vec<_> = (0..flight.track.len()).map(|i| flight.track.position(i)).collect();
    let overshoot = places.iter().map(|p| -p.y).fold(0.0, f64::max);
    let settled = places.iter().rev().find(|p| p.y.abs() > 0.05).map_or(0.0, |p| p.x);
    (overshoot, settled)
}

/// The gains are fixed here, and are not touched for the sake of an experiment.
#[test]
fn a_lateral_step_of_one_metre_settles_without_much_overshoot() {
    for name in ["rocky8", "generic"] {
        for latency in [0.0, 0.5] {
            let mut site = Site::new(name, plane(0.0, 0.0));
            site.conditions = GroundConditions { latency, start_offset: [0.0, 1.0, 0.0], ..site.conditions };
            site.vehicle.response = Response { steering_time_constant: 0.2, ..site.vehicle.response };
            for (word, controller) in &CONTROLLERS {
                let (overshoot, settled) = lateral_step(&site, controller, 0.1);
                assert!(overshoot < 0.1 && settled < 5.0, "{name} {word}: {overshoot} {settled}");
            }
        }
    }
    // A car at 2 m/s, its steering as fast as its servo.
    for latency in [0.0, 0.05] {
        let conditions = GroundConditions { latency, start_offset: [0.0, 1.0, 0.0], ..GroundConditions::default() };
        let site = Site { vehicle: car(), nominal: car(), map: plane(0.0, 0.0), conditions };
        let limits = &site.nominal.limits;
        let bounds = Curvatures { most: limits.curvature, most_rate: limits.curvature_rate };
        let resolve =
            |from: &Planar, to: &Planar, gear: Gear, direction| flat_answer_within(bounds, from, to, gear, direction);
        for (word, controller) in
            [CONTROLLERS[0], CONTROLLERS[1], ("predictive", GroundController::Predictive(&resolve))]
        {
            let (overshoot, settled) = lateral_step(&site, &controller, 2.0);
            assert!(overshoot < 0.1 && settled < 6.0, "car {word}: {overshoot} {settled}");
        }
    }
}

#[test]
fn the_same_arguments_give_the_same_bytes_and_noise_has_its_seed() {
    let mut site = Site::new("rocky8", plane(0.1, 0.05));
    site.conditions = GroundConditions { latency: 0.2, noise: 1.0, ..site.conditions };
    for (word, controller) in &CONTROLLERS {
        let run = |seed| site.run(&mixed(0.1), controller, seed).0;
        assert_eq!(run(3), run(3), "{word}");
        assert_ne!(run(3).track, run(4).track, "{word}");
    }
}

/// Open loop, the plant and the proof are two integrators of one motion.
#[test]
fn a_plan_on_rough_ground_ends_where_the_replay_ends() {
    let recipe = Recipe { size_m: 20.0, relief_m: 0.15, rock_cover: 0.0, seed: 5, ..Recipe::default() };
    let map = generate(&recipe).expect("a map");
    for name in ["rocky8", "four-wheel"] {
        let mut rover = shipped(name);
        rover.slip = Slip { at_20_deg: 0.3, side_at_20_deg: 0.15 };
        for lag in [0.0, 0.4] {
            rover.response = Response { steering_time_constant: lag, ..rover.response };
            let mut plan = plan(
                &[vec![
                    Segment::clothoid(1.5, 0.2, 0.7, Gear::Forward),
                    Segment::clothoid(1.5, 0.7, -0.4, Gear::Forward),
                    Segment::clothoid(1.0, -0.4, 0.0, Gear::Forward),
                ]],
                0.1,
            );
            let start = Planar { x: 8.0, y: 9.0, yaw: 0.6, curvature: 0.2 };
            plan.legs[0].from = start;
            let path = planned_track(&rover, &map, &plan).expect("a plan");
            let end = path.poses()[path.len() - 1];
            let (_, _, yaw) = end.rotation.euler_angles();
            let goal = Planar { x: end.translation.x, y: end.translation.y, yaw, curvature: 0.0 };
            let site = campaign::drive::Site {
                rover: &rover,
                map: &map,
                speed: SpeedProfile::Constant { speed: plan.speed },
                direction: 0.0.into(),
            };
            let replay = site.replay(&start, &goal, &plan.legs[0].segments).expect("a replay");
            let off = replay.error.iter().fold(0.0_f64, |most, e| most.max(e.abs()));
            assert!(off < 1e-3, "{name} with lag {lag}: {:?}", replay.error);
        }
    }
}

#[test]
fn a_side_slope_of_fifty_degrees_tips_it_over() {
    let line = plan(&[vec![Segment::straight(3.0, Gear::Forward)]], 0.1);
    for (degrees, ended) in [(30.0_f64, Ended::Done), (50.0, Ended::TipOver)] {
        let mut site = Site::new("four-wheel", plane(0.0, degrees.to_radians().tan()));
        // Half the track 0.25 m, the centre of mass 0.25 m over the contacts: 45°.
        site.vehicle.body.centre_of_mass.z = 0.25 - 0.17;
        let (flight, measures) = site.run(&line, &GroundController::Stanley, 1);
        assert_eq!(flight.ended, ended);
        let margin = measures.min_tip_over_margin.expect("told");
        assert!((margin - (45.0 - degrees)).abs() < 1e-3, "{margin}");
    }
}

#[test]
fn runs_end_where_they_must() {
    let far = plan(&[vec![Segment::straight(3.0, Gear::Forward)]], 0.1);
    let ended = |site: &Site, plan: &Drive, keep_outs: Vec<KeepOut>, settings: DriveSettings| {
        let keep_outs = KeepOuts::new(keep_outs).expect("places");
        let sortie = GroundSortie {
            vehicle: &site.vehicle,
            nominal: &site.nominal,
            terrain: &site.map,
            keep_outs: &keep_outs,
            clearance_radius: 0.5,
            drive: plan,
        };
        drive(&sortie, &GroundController::PurePursuit, &site.conditions, &settings, 1).expect("a run")
    };
    let site = Site::new("rocky8", plane(0.0, 0.0));
    let lander = KeepOut { name: "lander".into(), shape: KeepOutShape::Circle { center_m: [2.0, 0.4], radius_m: 0.3 } };
    let hit = ended(&site, &far, vec![lander.clone()], DriveSettings::default());
    assert_eq!((hit.ended, hit.reached[1]), (Ended::Obstacle, None));
    let place = hit.track.position(hit.track.len() - 1);
    assert!((((place.x - 2.0).powi(2) + 0.16).sqrt() - 0.8).abs() < 0.011, "{place}");
    let through = DriveSettings { keep_outs: false, ..DriveSettings::default() };
    assert_ne!(ended(&site, &far, vec![lander], through).ended, Ended::Obstacle);
    let limit = DriveSettings { time_limit: Some(5.0), ..DriveSettings::default() };
    assert_eq!(ended(&site, &far, vec![], limit).ended, Ended::Time);
    // Wheels that spin on a climb which the plan thought firm.
    let mut steep = Site::new("rocky8", plane(0.4, 0.0));
    steep.vehicle.slip.at_20_deg = 0.92;
    let stuck = ended(&steep, &far, vec![], DriveSettings { patience: 20.0, ..DriveSettings::default() });
    assert_eq!(stuck.ended, Ended::Stuck);
    // Beside a plan that keeps to the map.
    let mut edge = Site::new("rocky8", plane(0.0, 0.0));
    edge.conditions.start_offset = [0.0, 0.0, 2.5];
    let mut close = plan(&[vec![Segment::straight(3.0, Gear::Forward)]], 0.1);
    (close.legs[0].from.x, close.legs[0].to.x) = (-19.0, -16.0);
    assert_eq!(ended(&edge, &close, vec![], DriveSettings::default()).ended, Ended::OffMap);
}

#[test]
fn mistakes_are_told_by_field() {
    let site = Site::new("rocky8", plane(0.0, 0.0));
    let none = KeepOuts::new(vec![]).expect("none");
    let field = |plan: &Drive, conditions: &GroundConditions, settings: &DriveSettings| {
        let sortie = GroundSortie {
            vehicle: &site.vehicle,
            nominal: &site.nominal,
            terrain: &site.map,
            keep_outs: &none,
            clearance_radius: 0.0,
            drive: plan,
        };
        drive(&sortie, &GroundController::Stanley, conditions, settings, 1).map(|_| ()).expect_err("a mistake").field()
    };
    let good = plan(&[vec![Segment::straight(3.0, Gear::Forward)]], 0.1);
    let (conditions, settings) = (GroundConditions::default(), DriveSettings::default());
    let beyond = plan(&[vec![Segment::straight(30.0, Gear::Forward)]], 0.1);
    assert_eq!(field(&beyond, &conditions, &settings), "drive.legs");
    assert_eq!(field(&Drive { speed: 0.0, ..good.clone() }, &conditions, &settings), "drive.speed");
    assert_eq!(field(&Drive { legs: vec![], ..good.clone() }, &conditions, &settings), "drive.legs");
    assert_eq!(field(&good, &GroundConditions { latency: -1.0, ..conditions }, &settings), "latency");
    assert_eq!(
        field(&good, &GroundConditions { start_offset: [f64::NAN; 3], ..conditions }, &settings),
        "start_offset"
    );
    assert_eq!(field(&good, &conditions, &DriveSettings { accept: 0.0, ..settings }), "accept");
}

/// An answer of the rough solver for the nominal vehicle.
fn rough_answer(site: &Site, from: &Planar, to: &Planar, gear: Gear) -> Option<SegmentList> {
    let bounds = Curvatures { most: 1.0, most_rate: 1.0 };
    let on = campaign::drive::Site {
        rover: &site.nominal,
        map: &site.map,
        speed: SpeedProfile::Constant { speed: 0.1 },
        direction: 0.0.into(),
    };
    let choices = Choices { gear, flat: flat::Settings::default(), ..Choices::default() };
    let mut shape = |query: &Query| {
        let solution = solve(query, &bounds, &choices, || false);
        (solution.outcome == Outcome::Solved).then_some(solution.segments)
    };
    let answer = on.solve(from, to, &bounds, &rough::Settings::default(), &mut shape);
    (answer.status == rough::Status::Ok).then_some(answer.segments)
}

/// Twelve drives over rough ground, by seed, with slip, latency and lag of steering that the plan does not know.
#[test]
fn predictive_tracking_stays_closer_than_pure_pursuit_where_the_ground_gives_way() {
    let recipe = Recipe { size_m: 24.0, relief_m: 0.5, rock_cover: 0.0, seed: 11, ..Recipe::default() };
    let mut site = Site::new("rocky8", generate(&recipe).expect("a map"));
    site.conditions.latency = 0.3;
    // The plans are drawn without a look at the underside; here it is about the path.
    site.vehicle.body.belly.height = 1.0;
    site.vehicle.slip = Slip { at_20_deg: 0.3, side_at_20_deg: 0.15 };
    site.vehicle.response = Response { steering_time_constant: 0.2, ..site.vehicle.response };
    let mut sums = [[0.0; 2]; 3];
    for seed in 0..12 {
        let mut random = stream(seed);
        let mut draw = |low: f64, high: f64| low + (high - low) * unit(&mut random);
        let start = Planar { x: draw(9.0, 15.0), y: draw(9.0, 15.0), yaw: draw(-3.0, 3.0), curvature: 0.0 };
        let mut segments = vec![];
        let mut bend = 0.0;
        for _ in 0..4 {
            let next = draw(-0.6, 0.6);
            segments.push(Segment::clothoid(1.5, bend, next, Gear::Forward));
            bend = next;
        }
        let mut plan = plan(&[segments], 0.1);
        plan.legs[0].from = start;
        let path = planned_track(&site.nominal, &site.map, &plan).expect("a plan on the map");
        let end = path.position(path.len() - 1);
        (plan.legs[0].to.x, plan.legs[0].to.y) = (end.x, end.y);
        let resolve = |from: &Planar, to: &Planar, gear: Gear, _| rough_answer(&site, from, to, gear);
        let predictive = ("predictive", GroundController::Predictive(&resolve));
        let controllers = [&CONTROLLERS[0], &CONTROLLERS[1], &predictive];
        for (sum, (word, controller)) in sums.iter_mut().zip(controllers) {
            let (flight, measures) = site.run(&plan, controller, seed);
            assert_eq!(flight.ended, Ended::Done, "seed {seed} {word}");
            sum[0] += measures.max_deviation / 12.0;
            sum[1] += measures.mean_deviation / 12.0;
        }
    }
    for ((word, _), [worst, mean]) in CONTROLLERS.iter().zip(sums) {
        println!("{word}: mean of the largest deviations {worst:.4} m, of the mean ones {mean:.4} m");
    }
    let [pursuit, stanley, predictive] = sums;
    assert!(predictive[0] < pursuit[0] && predictive[1] < pursuit[1], "{predictive:?} {pursuit:?} {stanley:?}");
}

/// Cars and differential drives are driven as the vehicles that the generator steers.
#[test]
fn cars_and_differential_drives_follow_their_plans() {
    let drive = toml::from_str::<DifferentialDriveDescription>(&robot_file("differential-drive")).expect("its keys");
    let drive = drive.build().expect("its numbers").vehicle();
    use Gear::{Forward, Reverse};
    let ways = vec![
        Segment::clothoid(1.5, 0.0, 0.9, Forward),
        Segment::clothoid(1.5, 0.9, -0.5, Forward),
        Segment::clothoid(1.0, -0.5, 0.0, Forward),
        Segment::clothoid(1.0, 0.0, 0.8, Reverse),
    ];
    for (vehicle, bound) in [(car(), 0.2), (drive, 0.02)] {
        let speed = vehicle.default_speed;
        let site = Site {
            vehicle: vehicle.clone(),
            nominal: vehicle,
            map: plane(0.0, 0.0),
            conditions: GroundConditions::default(),
        };
        let mut segments = ways.clone();
        if site.nominal.limits.turns_in_place {
            segments.push(Segment { motion: Motion::Turn { angle_rad: 1.0 }, gear: Forward });
        }
        for (word, controller) in &CONTROLLERS {
            let (flight, measures) = site.run(&plan(&[segments.clone()], speed), controller, 1);
            assert_eq!(flight.ended, Ended::Done, "{} {word}", site.nominal.name);
            assert!(measures.max_deviation < bound, "{} {word}: {}", site.nominal.name, measures.max_deviation);
            assert!(flight.track.channel("tip_over_margin_deg").is_none());
        }
    }
}

/// Across a slope pure pursuit hangs below its line by the drift over its lookahead; what learns the slip does not.
#[test]
fn predictive_tracking_learns_a_steady_drift() {
    let mut site = Site::new("rocky8", plane(0.0, 0.3));
    site.vehicle.slip = Slip { at_20_deg: 0.3, side_at_20_deg: 0.15 };
    let line = plan(&[vec![Segment::straight(10.0, Gear::Forward)]], 0.1);
    let resolve = |from: &Planar, to: &Planar, gear: Gear, _| rough_answer(&site, from, to, gear);
    let below = |controller: &GroundController| {
        let (flight, _) = site.run(&line, controller, 1);
        let middle = flight.track.len() / 2;
        -flight.track.position(middle).y
    };
    let drift = 0.15 * 0.3_f64.atan().sin() / 20_f64.to_radians().sin() * 0.3_f64.atan().cos();
    let pursuit = below(&GroundController::PurePursuit);
    assert!((pursuit - drift * 0.53).abs() < 0.1 * pursuit, "{pursuit}: 0.53 m ahead");
    let predictive = below(&GroundController::Predictive(&resolve));
    assert!(predictive.abs() < 0.01, "{predictive}");
}
