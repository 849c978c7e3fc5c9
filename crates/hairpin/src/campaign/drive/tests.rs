//! Drives that are drawn, changed and crossed: each is held to its limits by another integrator, and of what is changed
//! no more is solved again than it takes.

use std::sync::atomic::{AtomicUsize, Ordering};

use nalgebra::{Isometry3, UnitQuaternion, Vector3};
use serde_json::{Value, json};

use super::DriveSetup;
use super::solve::DriveSolver;
use crate::campaign::graph::{Executions, Plan, Wanted};
use crate::campaign::kind::Solver;
use crate::campaign::scenario::KeyPath;
use crate::campaign::trial::{Sought, Trials};
use crate::campaign::{Evidence, Mistake, OwnSimulator, Scenario, Setup, Stop, how_obtained, verify};
use crate::judgement::Stress;
use crate::math::random::stream;
use crate::trajectory::drive::{Gear, Motion};
use crate::trajectory::{Drive, Track};

/// A shipped robot's table.
fn robot(file: &str) -> Value {
    let path = format!("{}/../../data/robots/{file}.toml", env!("CARGO_MANIFEST_DIR"));
    toml::from_str(&std::fs::read_to_string(path).unwrap()).unwrap()
}

/// A car on a plain with a pillar, which passes waypoints at speeds of their own.
fn car() -> Value {
    json!({
        "hairpin": 1, "robot": robot("ground/car"), "seed": 7,
        "world": { "terrain": { "generator": "flat", "size_m": 40, "cell_m": 0.25 },
            "keep_out": [{ "name": "pillar", "circle": { "center_m": [24, 21], "radius_m": 0.4 } }] },
        "task": { "start": { "x_m": 20, "y_m": 20, "yaw_deg": 0 }, "length": 6, "leg_m": [2, 5] },
        "generate": { "manoeuvres": ["forward", "reverse"],
            "speed": { "profile": "trapezoid", "waypoint_m_s": [0.5, 1.4], "acceleration_m_s2": 1.0 },
            "limits": { "speed_m_s": 1.5, "curvature_1_m": 1.0, "curvature_rate_1_m2": 1.5 },
            "search": { "waypoints": 40 } },
        "execute": { "controller": "stanley" },
        "spec": { "limits": { "path_deviation_m": 0.1 } },
    })
}

/// A rover among craters.
fn rover() -> Value {
    json!({
        "hairpin": 1, "robot": robot("rover/rocky8"), "seed": 42,
        "world": { "terrain": { "generator": "craters", "size_m": 30, "cell_m": 0.1 } },
        "task": { "start": { "x_m": 15, "y_m": 15, "yaw_deg": 0 }, "length": 5, "leg_m": [2, 5] },
        "generate": { "manoeuvres": ["forward", "reverse", "turn-in-place"],
            "limits": { "curvature_1_m": 1.0, "speed_m_s": 0.06, "tilt_deg": 25 }, "search": { "waypoints": 30 } },
        "execute": { "controller": "predictive" },
        "spec": { "limits": { "path_deviation_m": 0.25 } },
    })
}

fn built(mut value: Value, changes: &[(&str, Value)]) -> Result<Setup, String> {
    for (key, new) in changes {
        KeyPath::parse(key).unwrap().put(&mut value, new.clone()).unwrap();
    }
    let scenario: Scenario = serde_json::from_value(value).unwrap();
    let told = |mistakes: Vec<Mistake>| mistakes.iter().map(ToString::to_string).collect::<Vec<_>>().join("; ");
    Setup::build(scenario.into()).map_err(told)
}

fn setup(value: Value, changes: &[(&str, Value)]) -> Setup {
    built(value, changes).unwrap()
}

fn solver(setup: &Setup) -> DriveSolver<'_> {
    DriveSolver::new(setup.own::<DriveSetup>().unwrap()).unwrap()
}

fn drive(plan: &Plan) -> &Drive {
    plan.witness.as_ref().and_then(|witness| witness.commands()).unwrap()
}

/// Follows it by the equations of the proof.
fn hold(setup: &Setup, plan: &Plan, told: &str) {
    let proof = verify(setup, &plan.clone().case(setup.scenario.seed(), 0, 0)).proof.expect("a witness");
    assert!(proof.ok(), "{told}: {:?}", proof.findings);
    let drive = drive(plan);
    assert_eq!((plan.waypoints.len(), plan.leg_times.len()), (drive.legs.len() + 1, drive.legs.len()), "{told}");
    for (pair, leg) in plan.waypoints.windows(2).zip(&drive.legs) {
        assert_eq!(
            [pair[0].x, pair[0].y, pair[1].x, pair[1].y],
            [leg.from.x, leg.from.y, leg.to.x, leg.to.y],
            "{told}"
        );
    }
}

/// Legs of `b` with other commands than those of `a`.
fn solved_again(a: &Plan, b: &Plan) -> Vec<usize> {
    let legs = drive(a).legs.iter().zip(&drive(b).legs).enumerate();
    legs.filter(|(_, (a, b))| a.segments != b.segments).map(|(leg, _)| leg).collect()
}

#[test]
fn drives_are_drawn_by_numbers_and_are_feasible() {
    for (value, length) in [(car(), 6), (rover(), 5)] {
        let setup = setup(value, &[]);
        let solver = solver(&setup);
        let drawn: Vec<Plan> = (0..4).map(|number| solver.draw(number, &Stop::never()).unwrap()).collect();
        for (number, plan) in drawn.iter().enumerate() {
            hold(&setup, plan, &format!("draw {number}"));
            assert_eq!((plan.waypoints.len(), plan.seen.len()), (length, length - 1));
            assert_eq!(plan.waypoints[0], drawn[0].waypoints[0], "all begin at the task's start");
            let twice = |k: usize| plan.waypoints[..k].contains(&plan.waypoints[k]);
            assert!(!(0..length).any(twice), "no waypoint comes twice");
            assert!(drawn[..number].iter().all(|other| other.waypoints[1..] != plan.waypoints[1..]), "draws differ");
        }
        assert!(drive(&solver.draw(2, &Stop::never()).unwrap()) == drive(&drawn[2]), "a number is a drive");
    }
}

/// What was planned by wider limits of the suspension or the body is found by narrower ones.
#[test]
fn joints_and_tilt_are_held_to_the_limits_that_are_asked() {
    let wide = setup(rover(), &[]);
    let plan = solver(&wide).draw(0, &Stop::never()).unwrap();
    for (key, told) in [("robot.limits.joint_deg", ".joint_angle"), ("generate.limits.tilt_deg", ".tilt")] {
        let narrow = setup(rover(), &[(key, json!(1))]);
        let findings = verify(&narrow, &plan.clone().case(42, 0, 0)).proof.expect("a witness").findings;
        assert!(!findings.is_empty() && findings.iter().all(|one| one.field.ends_with(told)), "{findings:?}");
    }
}

/// Findings of the proof of a drive of `value` that was planned as it is, under `changes`; fields without their leg.
fn found_under(value: Value, number: u64, changes: &[(&str, Value)]) -> Vec<String> {
    let plan = solver(&setup(value.clone(), &[])).draw(number, &Stop::never()).unwrap();
    let asked = setup(value, changes);
    let findings = verify(&asked, &plan.case(asked.scenario.seed(), 0, 0)).proof.expect("a witness").findings;
    findings
        .into_iter()
        .map(|one| one.field.split_once('.').map_or(one.field.clone(), |(_, what)| what.into()))
        .collect()
}

#[test]
fn speeds_are_held_to_those_that_are_asked() {
    let slow = found_under(car(), 0, &[("generate.limits.speed_m_s", json!(1.0))]);
    assert!(["speed", "turn_rate"].iter().all(|what| slow.iter().any(|one| one == what)), "{slow:?}");
    let mut free = rover();
    free["generate"]["limits"].as_object_mut().unwrap().remove("speed_m_s");
    assert!(found_under(free.clone(), 0, &[]).is_empty());
    let slow = found_under(free, 0, &[("robot.speed_m_s", json!(0.2))]);
    assert!(slow.iter().any(|one| one == "speed"), "{slow:?}");
}

/// Every drive of each scenario has what is taken from it, in one leg at least of a few draws.
#[test]
fn manoeuvres_are_held_to_those_that_are_asked() {
    for (value, without, told) in [
        (two_wheels(), json!(["forward"]), "turn_in_place"),
        (car(), json!(["forward"]), "reverse"),
        (car(), json!(["reverse"]), "forward"),
    ] {
        let under = |number| found_under(value.clone(), number, &[("generate.manoeuvres", without.clone())]);
        let found: Vec<String> = (0..3).flat_map(under).collect();
        assert!(!found.is_empty() && found.iter().all(|one| one == told), "{told}: {found:?}");
    }
}

/// A keep-out that was put on a waypoint, or grew: circles and polygons.
#[test]
fn what_the_world_keeps_out_is_kept_out_of() {
    let plan = solver(&setup(car(), &[])).draw(0, &Stop::never()).unwrap();
    let [x, y] = [plan.waypoints[2].x, plan.waypoints[2].y];
    let corners = json!([[x - 0.1, y - 0.1], [x + 0.1, y - 0.1], [x, y + 0.1]]);
    for place in [
        json!({ "name": "put", "circle": { "center_m": [x, y], "radius_m": 0.1 } }),
        json!({ "name": "put", "polygon": { "points_m": corners } }),
        json!({ "name": "grown", "circle": { "center_m": [24, 21], "radius_m": 3.5 } }),
    ] {
        let found = found_under(car(), 0, &[("world.keep_out", json!([place]))]);
        assert!(!found.is_empty() && found.iter().all(|one| one == "keep_out[0].clearance"), "{found:?}");
    }
}

#[test]
fn waypoints_lie_on_the_ground() {
    let setup = setup(rover(), &[]);
    let mut case = solver(&setup).draw(0, &Stop::never()).unwrap().case(42, 0, 0);
    case.waypoints[3].z += 1e-3;
    let findings = verify(&setup, &case).proof.expect("a witness").findings;
    assert_eq!(findings.iter().map(|one| one.field.as_str()).collect::<Vec<_>>(), ["legs[2].height"]);
}

/// A differential drive on a plain, at 0.2 of 0.22 m/s: the outer wheel leaves |κ| ≤ 1.25 1/m.
fn two_wheels() -> Value {
    json!({
        "hairpin": 1, "robot": robot("ground/differential-drive"), "seed": 3,
        "world": { "terrain": { "generator": "flat", "size_m": 20, "cell_m": 0.1 } },
        "task": { "start": { "x_m": 10, "y_m": 10, "yaw_deg": 0 }, "length": 4, "leg_m": [1, 4] },
        "generate": { "manoeuvres": ["forward", "turn-in-place"], "limits": { "speed_m_s": 0.2 },
            "speed": { "profile": "trapezoid" }, "search": { "waypoints": 40 } },
        "execute": { "controller": "pure-pursuit" },
        "spec": { "limits": { "path_deviation_m": 0.3 } },
    })
}

/// The keys that are wrong with a changed scenario, with what they must be.
fn wrong(mut value: Value, changes: &[(&str, Value)]) -> Vec<(String, String)> {
    for (key, new) in changes {
        KeyPath::parse(key).unwrap().put(&mut value, new.clone()).unwrap();
    }
    let scenario: Scenario = serde_json::from_value(value).unwrap();
    let mistakes = Setup::build(scenario.into()).expect_err("something is wrong");
    mistakes.into_iter().map(|mistake| (mistake.key, mistake.bound)).collect()
}

#[test]
fn driven_wheels_keep_their_limits_at_the_commanded_speed() {
    for profile in ["trapezoid", "constant"] {
        let setup = setup(two_wheels(), &[("generate.speed.profile", json!(profile))]);
        let own = setup.own::<DriveSetup>().unwrap();
        assert!((own.bounds().most - 1.25).abs() < 1e-9, "{:?}", own.bounds());
        let solver = solver(&setup);
        for number in 0..3 {
            hold(&setup, &solver.draw(number, &Stop::never()).unwrap(), profile);
        }
    }
    // As it was bounded at 0.11 m/s: the outer wheel would go at 0.4 m/s.
    let setup = setup(two_wheels(), &[]);
    let plan = solver(&setup).draw(0, &Stop::never()).unwrap();
    let mut case = plan.case(3, 0, 0);
    let mut drive = case.commands().cloned().unwrap();
    let arc = drive.legs.iter_mut().flat_map(|leg| &mut leg.segments).find_map(|segment| match &mut segment.motion {
        Motion::Arc { curvature, length_m } if *length_m > 0.0 => Some(curvature),
        _ => None,
    });
    arc.expect("it drives")[0] = 12.5;
    case.witness = Some(drive.into());
    let findings = verify(&setup, &case).proof.expect("a witness").findings;
    assert!(findings.iter().any(|finding| finding.field.ends_with(".wheel_speed")), "{findings:?}");
    let told = wrong(two_wheels(), &[("generate.limits.speed_m_s", json!(0.22))]);
    assert!(told[0].0 == "generate.limits.speed_m_s" && told[0].1.contains("wheel_speed_m_s"), "{told:?}");
    let told = wrong(two_wheels(), &[("generate.speed.acceleration_m_s2", json!(2.5))]);
    assert_eq!(told[0].0, "generate.speed.acceleration_m_s2", "nothing is left to steer with");
}

/// κ′ = δ̇/(L v): at 4 m/s half of what it is at the car's own 2 m/s.
#[test]
fn cars_bend_as_slowly_as_they_steer() {
    let setup = setup(car(), &[("generate.limits", json!({ "speed_m_s": 4.0 }))]);
    let rate = setup.own::<DriveSetup>().unwrap().bounds().most_rate;
    assert!((rate - 183.3_f64.to_radians() / (0.3302 * 4.0)).abs() < 1e-9, "{rate}");
    hold(&setup, &solver(&setup).draw(0, &Stop::never()).unwrap(), "at 4 m/s");
}

/// At one speed wheels swing with their lag where the gear changes, in the plan as in the witness.
#[test]
fn planned_motions_end_legs_where_their_witness_does() {
    let at_one_speed = json!({ "profile": "constant" });
    let setup = setup(car(), &[("generate.speed", at_one_speed)]);
    let own = setup.own::<DriveSetup>().unwrap();
    let (solver, mut changes) = (solver(&setup), 0);
    for number in 0..4 {
        let case = solver.draw(number, &Stop::never()).unwrap().case(7, 0, 0);
        let drive = case.commands().unwrap();
        let gears: Vec<Gear> = drive.legs.iter().flat_map(|leg| &leg.segments).map(|segment| segment.gear).collect();
        changes += gears.windows(2).filter(|pair| pair[0] != pair[1]).count();
        let track = super::plan::track(own, &case).unwrap();
        assert_eq!(super::verify::strays(own, drive, &track), vec![]);
        let aside = track.poses().iter().map(|pose| Isometry3::translation(0.0, 0.04, 0.0) * pose).collect();
        let aside = Track::new(track.times().to_vec(), aside, track.channels().to_vec()).unwrap();
        let found = super::verify::strays(own, drive, &aside);
        assert!(found.iter().any(|finding| finding.field.ends_with("planned.waypoint")), "{found:?}");
    }
    assert!(changes > 0);
}

/// The plan's speeds are those of its timing, from rest to rest: no difference of places tells them.
#[test]
fn planned_velocities_are_those_of_the_timing() {
    for (manoeuvres, number) in [(json!(["forward", "reverse"]), 0), (json!(["forward"]), 1), (json!(["reverse"]), 2)] {
        let setup = setup(car(), &[("generate.manoeuvres", manoeuvres)]);
        let own = setup.own::<DriveSetup>().unwrap();
        let case = &solver(&setup).draw(number, &Stop::never()).unwrap().case(7, 0, 0);
        let track = super::plan::track(own, case).unwrap();
        let [x, y] = ["vx_m_s", "vy_m_s"].map(|name| track.channel(name).unwrap());
        let speeds: Vec<f64> = x.iter().zip(y).map(|(x, y)| x.hypot(*y)).collect();
        assert!(speeds[0] == 0.0 && speeds[speeds.len() - 1] < 1e-6, "from rest to rest");
        assert!(speeds.iter().all(|speed| *speed <= 1.5 + 1e-9));
        for (pair, times) in speeds.windows(2).zip(track.times().windows(2)) {
            let acceleration = (pair[1] - pair[0]).abs() / (times[1] - times[0]);
            assert!(acceleration <= 1.0 + 1e-3, "{acceleration} m/s²");
        }
        // From rest by 1 m/s²: v = t, s = t²/2.
        for row in super::plan::timed(own, case, 50.0).iter().take(8) {
            let way = (row.position - case.waypoints[0]).norm();
            assert!((row.velocity.norm() - row.t).abs() < 1e-3, "{} at {} s", row.velocity.norm(), row.t);
            assert!((way - 0.5 * row.t * row.t).abs() < 1e-3, "{way} m at {} s", row.t);
        }
    }
}

/// Who passes on the timed reference comes to the plan's end, and is seen often enough to be judged.
#[test]
fn the_timed_reference_ends_where_the_plan_does() {
    let setup = setup(car(), &[]);
    let own = setup.own::<DriveSetup>().unwrap();
    let case = &solver(&setup).draw(0, &Stop::never()).unwrap().case(7, 0, 0);
    let (rows, track) = (setup.kind().timed(case), super::plan::track(own, case).unwrap());
    let (end, last) = (*track.times().last().unwrap(), rows.last().unwrap());
    assert!((last.t - end).abs() < 1e-9 && (last.position - track.position(track.len() - 1)).norm() < 1e-9);
    assert!(rows.windows(2).all(|pair| pair[1].t > pair[0].t && pair[1].t - pair[0].t < 0.1 + 1e-9));
    // Time limits are reckoned as they were from two rows a second.
    assert_eq!(setup.kind().planned_s(&rows), (2.0 * end).floor() / 2.0);
}

#[test]
fn keys_without_meaning_for_its_ground_are_refused() {
    for (changes, key) in [
        (vec![("world.terrain.relief_m", json!(3))], "world.terrain.relief_m"),
        (vec![("world.terrain.rock_cover", json!(0.3))], "world.terrain.rock_cover"),
        (vec![("world.terrain.origin_m", json!([100, 100]))], "world.terrain.origin_m"),
        (vec![("world.terrain.height_m", json!([0, 1]))], "world.terrain.height_m"),
    ] {
        let told = wrong(car(), &changes);
        assert!(told.len() == 1 && told[0].0 == key, "{told:?}");
    }
    let rocks = [("world.terrain.generator", json!("fractal")), ("world.terrain.rock_cover", json!(0.01))];
    setup(rover(), &rocks);
    setup(car(), &[("world.terrain.relief_m", json!(0))]);
}

/// Exports would write places past the poles, wrapped.
#[test]
fn origins_lie_on_earth() {
    let origin = json!({ "lat_deg": 47.0, "lon_deg": 8.0, "alt_amsl_m": 400.0, "x_axis_heading_deg": 90.0 });
    let key = |part: &str| format!("world.origin.{part}");
    for vehicle in [car(), two_wheels()] {
        setup(vehicle.clone(), &[("world.origin", origin.clone())]);
        for (part, value, bound) in [
            ("lat_deg", -122.3, "≥ -90 and ≤ 90°"),
            ("lon_deg", 375.0, "≥ -180 and ≤ 180°"),
            ("alt_amsl_m", 1e9, "≥ -1000 and ≤ 20000 m"),
            ("x_axis_heading_deg", 730.0, "≥ 0 and ≤ 360°"),
        ] {
            let told = wrong(vehicle.clone(), &[("world.origin", origin.clone()), (key(part).as_str(), json!(value))]);
            assert_eq!(told, [(key(part), bound.to_owned())]);
        }
    }
}

/// A plan in reverse is told as that; one that goes forward, driven with the nose behind, as what was not planned.
#[test]
fn what_goes_backwards_is_told() {
    let turned = |track: &Track| {
        let about = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), std::f64::consts::PI);
        let poses = track.poses().iter().map(|pose| pose * Isometry3::from_parts(Default::default(), about)).collect();
        Track::new(track.times().to_vec(), poses, track.channels().to_vec()).unwrap()
    };
    for (gear, as_it_is, nose_behind) in [
        ("reverse", Some("legs 0, 1, 2, 3, 4, as planned;"), None),
        ("forward", None, Some("legs 0, 1, 2, 3, 4, where the plan goes forward;")),
    ] {
        let setup = setup(car(), &[("generate.manoeuvres", json!([gear]))]);
        let case = solver(&setup).draw(0, &Stop::never()).unwrap().case(7, 0, 0);
        let track = super::plan::track(setup.own().unwrap(), &case).unwrap();
        for (track, wanted) in [(track.clone(), as_it_is), (turned(&track), nose_behind)] {
            let told = setup.backwards(&case, &track);
            assert!(told.as_deref().is_none_or(|told| wanted.is_some_and(|words| told.contains(words))), "{told:?}");
            assert_eq!(told.is_some(), wanted.is_some(), "{gear}");
        }
    }
}

#[test]
fn draws_end_where_the_task_does_and_say_why_there_are_none() {
    let at_the_end = setup(car(), &[("task.end_m", json!([26.0, 26.0]))]);
    let plan = solver(&at_the_end).draw(0, &Stop::never()).unwrap();
    hold(&at_the_end, &plan, "to an end");
    assert_eq!([plan.waypoints[5].x, plan.waypoints[5].y], [26.0, 26.0]);
    let too_far = setup(car(), &[("task.end_m", json!([35.0, 35.0])), ("task.length", json!(3))]);
    let why = solver(&too_far).draw(0, &Stop::never()).unwrap_err();
    assert!(why.contains("none in 6 draws of 40 waypoints: every walk ends too early"), "{why}");
}

/// Nowhere is the underside so high, which takes 50 000 draws to find out: minutes, where ground is steep.
#[test]
fn places_are_looked_for_no_longer_than_one_may() {
    // Nowhere but about the start.
    let around =
        |x: f64, y: f64| json!({ "name": "ring", "circle": { "center_m": [15.0 + x, 15.0 + y], "radius_m": 20 } });
    let ring = [(21.5, 0.0), (-21.5, 0.0), (0.0, 21.5), (0.0, -21.5)].map(|(x, y)| around(x, y));
    let setup = setup(rover(), &[("world.keep_out", json!(ring))]);
    let asked = AtomicUsize::new(0);
    let cancelled = || asked.fetch_add(1, Ordering::Relaxed) > 20;
    solver(&setup).draw(0, &Stop { cancelled: &cancelled, ..Stop::never() }).unwrap_err();
    assert!(asked.into_inner() < 30, "asked after it was over");
}

#[test]
fn what_has_no_commands_is_drawn_by_its_own_reach_set() {
    for (reach, evidence) in
        [("none", Evidence::Unchecked), ("sphere", Evidence::Unchecked), ("hull", Evidence::HullFeasible)]
    {
        let setup = setup(car(), &[("generate.reach", json!(reach)), ("generate.step_s", json!(3.0))]);
        let solver = solver(&setup);
        let plans = [0, 1].map(|number| solver.draw(number, &Stop::never()).unwrap());
        assert_ne!(plans[0].waypoints, plans[1].waypoints, "{reach}");
        for plan in &plans {
            assert_eq!((plan.evidence, plan.waypoints.len(), &plan.leg_times[..]), (evidence, 6, &[3.0; 5][..]));
            assert!(plan.witness.is_none() && solver.over(0, plan, &plan.waypoints).is_some(), "{reach}");
            assert!(solver.altered(plan, 1, &mut stream(1)).is_none(), "{reach}");
        }
    }
}

/// Sets that ask nothing of the ground lead over what it does not carry as well, where there is no motion to run.
#[test]
fn what_the_ground_does_not_carry_is_left_out() {
    let far = [
        ("world.terrain.relief_m", json!(1.0)),
        ("generate.reach", json!("none")),
        ("generate.step_s", json!(20.0)),
        ("task.leg_m", json!([4, 14])),
    ];
    let setup = setup(rover(), &far);
    let (solver, mut left_out) = (solver(&setup), 0);
    for graph in 0..20 {
        let outcome = solver.solve(graph, Executions::none(), Wanted::Cases, &Stop::never());
        for (_, plan) in &outcome.plans {
            super::plan::track(setup.own().unwrap(), &plan.clone().case(42, graph, 0)).unwrap();
        }
        left_out += usize::from(outcome.reason.is_some_and(|reason| reason.contains("its ground carries it")));
    }
    assert!(left_out > 0);
}

#[test]
fn a_changed_waypoint_costs_the_legs_beside_it() {
    for (value, least) in [(car(), 15), (rover(), 8)] {
        let setup = setup(value, &[]);
        let solver = solver(&setup);
        let (mut random, mut found) = (stream(3), 0);
        let mut plan = solver.draw(0, &Stop::never()).unwrap();
        let (mut speeds, mut headings, mut gears) = (0, 0, 0);
        for turn in 0..60 {
            let leg = turn % (plan.waypoints.len() - 1);
            let Some(child) = solver.altered(&plan, leg, &mut random) else { continue };
            found += 1;
            hold(&setup, &child, &format!("child {turn}"));
            assert_eq!(child.waypoints, plan.waypoints);
            let again = solved_again(&plan, &child);
            assert!(again.len() <= 2 && again.last().is_none_or(|last| last - again[0] <= 1), "{turn}: {again:?}");
            assert!(again.iter().all(|one| one.abs_diff(leg) <= 1), "{turn}: {again:?} of leg {leg}");
            let (old, new) = (drive(&plan), drive(&child));
            assert!(old != new, "{turn}: nothing was changed");
            assert_eq!(old.legs[0].from, new.legs[0].from, "{turn}: the start stays");
            let count = |drive: &Drive, gear| {
                drive.legs.iter().flat_map(|leg| &leg.segments).filter(|segment| segment.gear == gear).count()
            };
            headings += usize::from((0..=old.legs.len()).any(|k| old.passing(k) != new.passing(k)));
            speeds += usize::from(again.is_empty());
            gears += usize::from(count(old, Gear::Reverse) != count(new, Gear::Reverse));
            plan = child;
        }
        println!("{found} of 60 found: {headings} with other headings, {speeds} other speeds, {gears} other gears");
        assert!(found >= least, "{found}");
        assert!(headings > 0 && gears > 0);
        assert_eq!(speeds > 0, setup.scenario.section("generate").unwrap()["speed"]["waypoint_m_s"].is_array());
    }
}

#[test]
fn what_is_not_moved_is_not_solved_again_and_comes_to_the_same() {
    let setup = setup(rover(), &[]);
    let solver = solver(&setup);
    let plan = solver.draw(1, &Stop::never()).unwrap();
    let mut tried = 0;
    for index in 1..plan.waypoints.len() {
        let mut points = plan.waypoints.clone();
        (points[index].x, points[index].y) = (points[index].x + 0.05, points[index].y - 0.05);
        let Some(moved) = solver.over(0, &plan, &points) else { continue };
        tried += 1;
        hold(&setup, &moved, "moved");
        assert!(solved_again(&plan, &moved).iter().all(|leg| leg + 1 == index || *leg == index));
        let old = drive(&plan);
        let passings: Vec<_> =
            (0..points.len()).map(|k| old.passing(k).unwrap().moved_to(&moved.waypoints[k])).collect();
        assert!(&solver.through(0, &passings).unwrap() == drive(&moved), "as if all legs had been solved");
    }
    assert!(tried > 0);
    assert!(solver.over(0, &plan, &plan.waypoints[1..]).is_none(), "as many points as it has");
}

#[test]
fn a_child_of_two_has_the_beginning_of_one_and_the_rest_of_the_other() {
    let setup = setup(car(), &[]);
    let solver = solver(&setup);
    let plans: Vec<Plan> = (0..8).map(|number| solver.draw(number, &Stop::never()).unwrap()).collect();
    let (mut random, mut found) = (stream(1), 0);
    for a in &plans {
        for b in &plans {
            for leg in 0..5 {
                let Some(child) = solver.crossed(0, a, b, leg, &mut random) else { continue };
                found += 1;
                hold(&setup, &child, "crossed");
                assert_eq!(child.waypoints, [&a.waypoints[..=leg], &b.waypoints[leg + 1..]].concat());
                for k in (0..5).filter(|k| *k != leg) {
                    let from = if k < leg { a } else { b };
                    assert_eq!(drive(&child).legs[k].segments, drive(from).legs[k].segments);
                }
            }
        }
    }
    assert!(found > 20, "{found}");
    assert!(solver.crossed(0, &plans[0], &plans[1], 5, &mut random).is_none(), "there is no such leg");
}

/// What the wheels of the rover among craters may do: something of what they need there.
fn wheels() -> Value {
    json!({ "steer_limit_deg": 60, "steer_rate_deg_s": 8, "speed_rad_s": 0.8, "acceleration_rad_s2": 0.1 })
}

/// They were held by nothing: any value gave the same drives, and the proof confirmed them.
#[test]
fn wheels_are_held_to_what_they_may_do() {
    let own = ("robot.wheels", wheels());
    let setup = setup(rover(), std::slice::from_ref(&own));
    let solver = solver(&setup);
    for number in 0..3 {
        hold(&setup, &solver.draw(number, &Stop::never()).unwrap(), &format!("draw {number}"));
    }
    let mut value = rover();
    value["robot"]["wheels"] = wheels();
    for (key, narrow, told) in [
        ("steer_limit_deg", json!(2), "steer_angle"),
        ("steer_rate_deg_s", json!(0.05), "steer_rate"),
        ("speed_rad_s", json!(0.45), "wheel_speed"),
        ("acceleration_rad_s2", json!(2e-4), "wheel_acceleration"),
    ] {
        let found = found_under(value.clone(), 0, &[(&format!("robot.wheels.{key}"), narrow)]);
        assert!(found.iter().any(|field| field == told), "{key}: {found:?}");
        // Drives of a robot whose file says nothing of it are held to it as well.
        let sides = ["steer_angle", "steer_rate", "wheel_speed", "wheel_acceleration", "curvature", "curvature_rate"];
        assert!(found.iter().all(|field| sides.contains(&field.as_str())), "{key}: {found:?}");
    }
}

#[test]
fn what_the_wheels_cannot_do_is_refused_with_its_limit() {
    let weak = setup(rover(), &[("robot.wheels", json!({ "speed_rad_s": 0.01 }))]);
    let why = weak.kind().solver().err().unwrap();
    assert_eq!(why, "straight ahead at 0.06 m/s a wheel turns at 0.4615 rad/s, and `robot.wheels.speed_rad_s` is 0.01");
    // What swings its wheels too slowly finds no legs but where it may stand for it.
    let forward = ("generate.manoeuvres", json!(["forward"]));
    let slow = setup(rover(), &[("robot.wheels", json!({ "steer_rate_deg_s": 1e-3 })), forward]);
    let outcome = solver(&slow).solve(0, Executions::none(), Wanted::Cases, &Stop::never());
    assert!(outcome.plans.is_empty(), "{:?}", outcome.plans.len());
    // Straight legs have no commands, and say so.
    let straight = setup(rover(), &[("robot.wheels", wheels()), ("generate.reach", json!("hull"))]);
    let mut said = Vec::new();
    super::assumptions::claim(straight.own().unwrap(), &mut said);
    assert!(said.iter().any(|sentence| sentence.contains("rad/s²) are not held: straight legs")), "{said:?}");
}

/// Whatever stands level breaks no limit of tilt: legs over slopes of any steepness passed, and nobody said so.
#[test]
fn limits_that_the_model_does_not_have_are_named() {
    let hills = ("world.terrain", json!({ "generator": "fractal", "size_m": 40, "cell_m": 0.25 }));
    let limits = [("generate.limits.tilt_deg", json!(10)), ("generate.limits.belly_clearance_m", json!(0.1))];
    let told = |setup: Setup| setup.unknown_shapes();
    let all = [std::slice::from_ref(&hills), &limits[..]].concat();
    let words = "slopes of the map are not modelled, nor generate.limits.tilt_deg and generate.limits.belly_clearance_m held: \
                 no suspension";
    assert_eq!(told(setup(car(), &all)).as_deref(), Some(words));
    // On level ground nothing tilts.
    assert_eq!(told(setup(car(), &limits)), None);
    assert_eq!(told(setup(rover(), &limits)), None);
}

#[test]
fn what_no_run_reads_is_not_drawn() {
    let mistakes = |key: &str, value: Value| {
        let mut scenario = rover();
        scenario["vary"] = json!({ key: { "uniform": value } });
        scenario["robot"]["wheels"] = wheels();
        let scenario: Scenario = serde_json::from_value(scenario).unwrap();
        let found = Setup::build(scenario.into()).err().unwrap_or_default();
        found.into_iter().map(|mistake| mistake.to_string()).collect::<Vec<_>>()
    };
    for (key, range, why) in [
        ("robot.limits.tilt_deg", json!([20.0, 30.0]), "plans keep this limit"),
        ("robot.limits.curvature_rate_1_m2", json!([0.5, 2.0]), "plans keep this limit"),
        ("robot.mass_kg", json!([20.0, 60.0]), "nothing weighs"),
        ("robot.wheels.steer_limit_deg", json!([20.0, 30.0]), "plans keep what the wheels may do"),
        ("robot.wheels.speed_rad_s", json!([0.1, 1.0]), "plans keep what the wheels may do"),
    ] {
        let found = mistakes(key, range);
        assert!(found.iter().any(|told| told.contains(key) && told.contains(why)), "{key}: {found:?}");
    }
    assert!(mistakes("robot.slip_at_20_deg", json!([0.1, 0.3])).is_empty());
}

/// No run of the worst cases may have had the scenario's own.
#[test]
fn controllers_that_are_drawn_are_told() {
    let told = |choice: Value, repeat: u64| {
        let drawn = ("vary", json!({ "execute.controller": { "choice": choice } }));
        how_obtained(&setup(car(), &[drawn, ("execute.repeat", json!(repeat))]))[2].clone()
    };
    assert_eq!(told(json!(["stanley", "pure-pursuit"]), 4), "stanley or pure-pursuit, as drawn");
    assert_eq!(told(json!(["pure-pursuit"]), 2), "stanley or pure-pursuit, as drawn");
    assert_eq!(told(json!(["stanley"]), 4), "stanley", "there is no other");
    assert_eq!(told(json!(["pure-pursuit"]), 1), "stanley", "run 0 is nominal");
}

/// What was saved of a car is nothing that another kind of vehicle could be asked to drive.
#[test]
fn vehicles_take_over_scenarios_of_their_own_kind_alone() {
    let all: Vec<Scenario> = [car(), two_wheels(), rover()].map(|value| serde_json::from_value(value).unwrap()).into();
    for (own, saved) in all.iter().enumerate() {
        let takes = |now: &Scenario| saved.clone().adopt(&**now).is_some();
        assert_eq!(all.iter().map(takes).collect::<Vec<_>>(), [0, 1, 2].map(|other| own == other), "{own}");
    }
}

/// A limit that was drawn when a case was saved is none of the limits that it is held to now.
#[test]
fn what_is_drawn_of_the_spec_is_taken_over() {
    let with = |vary: Value| -> Scenario {
        let mut scenario = car();
        scenario["vary"] = vary;
        serde_json::from_value(scenario).unwrap()
    };
    let uniform = |low: f64, high: f64| json!({ "uniform": [low, high] });
    let mut saved = with(json!({ "spec.deviation.max_m": uniform(1.0, 4.0), "robot.speed_tau_s": uniform(0.1, 0.3) }));
    let now = with(json!({ "spec.clearance.min_m": uniform(0.1, 0.2), "robot.speed_tau_s": uniform(0.4, 0.5) }));
    let (then, wanted) = (saved.vary()["robot.speed_tau_s"].clone(), now.vary()["spec.clearance.min_m"].clone());
    saved.adopt(&*now).unwrap();
    let drawn: Vec<_> = saved.vary().iter().collect();
    let [robot, spec] = ["robot.speed_tau_s".to_owned(), "spec.clearance.min_m".to_owned()];
    assert_eq!(drawn, [(&robot, &then), (&spec, &wanted)]);
}

/// Runs were the same whatever was drawn, and counted as draws.
#[test]
fn what_of_cars_and_plains_no_run_reads_is_not_drawn() {
    let mistakes = |changes: &[(&str, Value)]| {
        let mut scenario = car();
        for (key, value) in changes {
            KeyPath::parse(key).unwrap().put(&mut scenario, value.clone()).unwrap();
        }
        let scenario: Scenario = serde_json::from_value(scenario).unwrap();
        let found = Setup::build(scenario.into()).err().unwrap_or_default();
        found.into_iter().map(|mistake| mistake.to_string()).collect::<Vec<_>>().join("; ")
    };
    let drawn = |key: &str, ends: [f64; 2]| ("vary", json!({ key: { "uniform": ends } }));
    let open = || ("world.keep_out", json!([]));
    let late = || ("execute.latency_s", json!(0.1));
    let own = || ("execute.controller", json!("python:mine.py"));
    let hills = || ("world.terrain", json!({ "generator": "fractal", "size_m": 40, "cell_m": 0.25, "seed": 3 }));
    for (changes, why) in [
        (vec![drawn("robot.speed_m_s", [1.0, 1.5])], "plans command it"),
        (vec![drawn("robot.speed_m_s", [1.0, 1.5]), own()], "plans command it"),
        (vec![drawn("world.terrain.seed", [1.0, 9.0])], "flat ground is the same"),
        (vec![drawn("world.terrain.size_m", [40.0, 50.0])], "flat ground is the same"),
        (vec![drawn("robot.length_m", [0.5, 0.6]), open()], "there are none"),
        (vec![drawn("robot.response.latency_s", [0.0, 0.1]), late()], "execute.latency_s takes its place"),
        (vec![("vary", json!({ "world.keep_out[0].name": { "choice": ["a", "b"] } }))], "it is a word"),
    ] {
        let found = mistakes(&changes);
        assert!(found.contains(why), "{changes:?}: {found}");
    }
    for changes in [
        vec![drawn("robot.length_m", [0.5, 0.6])],
        vec![drawn("robot.response.latency_s", [0.0, 0.1])],
        vec![drawn("robot.limits.acceleration_m_s2", [2.0, 9.0])],
        vec![drawn("world.terrain.seed", [1.0, 9.0]), hills()],
    ] {
        assert_eq!(mistakes(&changes), "", "{changes:?}");
    }
}

#[test]
fn what_is_kept_is_confirmed_under_what_varies() {
    let stress = |changes: &[(&str, Value)]| {
        let setup = setup(car(), changes);
        let plan = solver(&setup).draw(0, &Stop::never()).unwrap();
        let trials = Trials { setup: &setup, executor: &OwnSimulator, graph: 0, seed: None };
        let ran = trials.execute_for((&plan, 0), &[Sought::Measured(Stress::MaxDeviation)], &[0.0]).unwrap();
        (ran.trials[0].executions, ran.trials[0].stress)
    };
    let confirmed = ("generate.search.confirm", json!(2));
    let late = ("vary", json!({ "execute.latency_s": { "uniform": [0.4, 0.5] } }));
    let (once, alone) = stress(&[]);
    let (same, still) = stress(std::slice::from_ref(&late));
    let (thrice, varied) = stress(&[confirmed.clone(), late]);
    let (_, unvaried) = stress(&[confirmed]);
    assert_eq!((once, same, thrice), (1, 1, 3));
    assert_eq!(still, alone, "run 0 is nominal");
    assert!(varied > 1.2 * unvaried, "{varied} with the latencies of runs 1 and 2, {unvaried} without");
}

/// Legs over a cliff were witnesses, and nobody said that slopes are nothing to such a vehicle.
#[test]
fn slopes_that_are_not_modelled_are_named() {
    let hills = [("world.terrain", json!({ "generator": "fractal", "size_m": 40, "cell_m": 0.25 }))];
    let named = Some("slopes of the map are not modelled: no suspension");
    let (level, steep) = (setup(car(), &[]), setup(car(), &hills));
    assert_eq!((level.unknown_shapes(), steep.unknown_shapes().as_deref()), (None, named));
    assert_eq!(setup(rover(), &hills[..0]).unknown_shapes(), None, "it stands on its wheels");
    let mut said = Vec::new();
    super::assumptions::claim(steep.own().unwrap(), &mut said);
    assert!(
        said.iter().any(|sentence| sentence.starts_with("Slopes of the map are not modelled for `car`")),
        "{said:?}"
    );
}

/// Minutes went into graphs of which no leg could leave the start.
#[test]
fn where_drives_cannot_begin_nothing_is_searched() {
    let at = |x: f64, y: f64| ("task.start", json!({ "x_m": x, "y_m": y, "yaw_deg": 0 }));
    let mistakes = |changes: &[(&str, Value)]| built(car(), changes).err();
    let inside = mistakes(&[at(24.0, 21.1)]).unwrap();
    assert!(inside.contains("task.start") && inside.contains("outside `pillar`; it is 0.300 m inside"), "{inside}");
    let beside = setup(car(), &[at(24.0, 21.41)]);
    assert_eq!(beside.kind().solver().err().unwrap(), "already at `task.start` drives enter a keep-out");
    let end = mistakes(&[("task.end_m", json!([24.0, 21.0]))]).unwrap();
    assert!(end.contains("task.end_m") && end.contains("m inside"), "{end}");
    // Where legs are straight it is a place that none leaves.
    let straight = setup(car(), &[at(24.0, 21.1), ("generate.reach", json!("none"))]);
    let why = straight.kind().solver().err().unwrap();
    assert!(why.starts_with("`task.start` is 0.300 m inside `pillar`, and no drive comes nearer"), "{why}");
    let steep = setup(rover(), &[("generate.limits.tilt_deg", json!(1e-3))]);
    let why = steep.kind().solver().err().unwrap();
    assert_eq!(why, "already at `task.start` drives tilt more than allowed");
}

/// Of an end beside a keep-out every leg was solved, and refused, in graph after graph. What the vehicle's radius
/// leaves, but for how exactly legs end, is searched.
#[test]
fn where_drives_cannot_end_nothing_is_searched() {
    let ends = |y: f64, changes: &[(&str, Value)]| {
        let end = ("task.end_m", json!([24.0, y]));
        setup(car(), &[std::slice::from_ref(&end), changes].concat()).kind().solver().err()
    };
    let radius = setup(car(), &[]).own::<DriveSetup>().unwrap().radius();
    let why = ends(21.41, &[]).unwrap();
    let words = format!("`task.end_m` is 0.010 m from `pillar`, and no drive comes nearer to it than {radius:.3} m");
    assert!(why.starts_with(&words), "{why}");
    let precision = ("generate.solver.position_m", json!(0.01));
    let solved = |off: f64| ends(21.4 + radius + off, std::slice::from_ref(&precision));
    assert!(solved(-0.011).is_some() && solved(-0.009).is_none() && solved(0.0).is_none());
    let straight = |off: f64| ends(21.4 + radius + off, &[precision.clone(), ("generate.reach", json!("none"))]);
    assert!(straight(-1e-3).is_some() && straight(1e-9).is_none());
    assert!(ends(21.41, &[("world.keep_out", json!([]))]).is_none());
}
