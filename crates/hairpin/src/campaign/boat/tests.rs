//! A campaign of boats in small: keys and their bounds, cases that are proven, runs that repeat.

use nalgebra::Point3;
use serde_json::{Value, json};

use crate::campaign::passage::{Certainty, Demands};
use crate::campaign::passes::passes;
use crate::campaign::scenario::KeyPath;
use crate::campaign::{Known, OwnSimulator, Scenario, Setup, Stop, execute_run, generate, judge, verify};
use crate::trajectory::ProfileLeg;

fn scenario() -> Value {
    json!({
        "hairpin": 1,
        "robot": { "kind": "boat", "name": "test", "mass_kg": 23.8, "yaw_inertia_kg_m2": 1.76,
            "centre_of_gravity_m": 0.046, "length_m": 1.255, "beam_m": 0.29, "speed_m_s": 0.3,
            "hydrodynamics": { "x_du_kg": -2.0, "y_dv_kg": -10.0, "n_dr_kg_m2": -1.0, "x_u_kg_s": -0.72,
                "x_uu_kg_m": -1.33, "x_uuu_kg_s_m2": -5.87, "y_v_kg_s": -0.89, "y_vv_kg_m": -36.5, "n_r_kg_m2_s": -1.9 },
            "thrust": { "ahead_n": 2.0, "sway_n": 1.5, "yaw_n_m": 1.5, "time_constant_s": 0.3 } },
        "seed": 4,
        "world": { "size_m": [24.0, 16.0], "keep_in_margin_m": 1.0, "current_m_s": [0.05, 0.02],
            "keep_out": [{ "name": "buoy", "circle": { "center_m": [10.0, 8.0], "radius_m": 0.5 } }] },
        "task": { "start_m": [3.0, 3.0], "end_m": [20.0, 12.0], "length": 5 },
        "generate": { "search": { "waypoints": 15, "cases": 2, "width": 5 } },
        "spec": { "deviation": { "max_m": 1.0 } },
    })
}

fn changed(changes: &[(&str, Value)]) -> Result<Setup, Vec<String>> {
    let mut value = scenario();
    for (key, new) in changes {
        KeyPath::parse(key).unwrap().put(&mut value, new.clone()).unwrap();
    }
    let scenario: Scenario = serde_json::from_value(value).unwrap();
    Setup::build(scenario.into()).map_err(|mistakes| mistakes.iter().map(ToString::to_string).collect())
}

#[test]
fn every_bound_holds() {
    assert!(changed(&[]).is_ok());
    for (key, value, words) in [
        ("hairpin", json!(2), "hairpin = 2: must be 1"),
        ("robot.beam_m", json!(2.0), "robot.beam_m = 2: must be"),
        ("world.size_m", json!([24.0, 0.0]), "world.size_m[1] = 0: must be > 0"),
        ("world.keep_in_margin_m", json!(8.0), "must be ≥ 0 and < 8 m"),
        ("world.current_m_s", json!([0.0, 200.0]), "world.current_m_s[1] = 200: must be"),
        ("world.keep_out[0].circle.radius_m", json!(0.0), "world.keep_out[0].circle.radius_m = 0: must be"),
        (
            "world.keep_out[0].circle.center_m",
            json!([25.0, 17.0]),
            "world.keep_out[0] = `buoy`, x 24.50 … 25.50, y 16.50 … 17.50 m: must be at least in part inside the waters",
        ),
        ("task.length", json!(1), "task.length = 1: must be 2 …"),
        ("task.end_m", json!([23.5, 3.0]), "task.end_m[0] = 23.5: must be inside the waters: 1 … 23 m"),
        ("task.start_m", json!([10.5, 8.0]), "the hull's radius, from `buoy`"),
        ("generate.leg_time_s", json!([80.0, 10.0]), "must be rising"),
        ("generate.velocities", json!(0), "generate.velocities = 0: must be 1 … 64"),
        ("generate.search.sampling", json!("sobol"), "waypoints of boats are drawn no other way"),
        ("generate.limits.thrust_share", json!(1.5), "thrust_share = 1.5: must be > 0 and ≤ 1"),
        ("generate.score", json!("swift"), "must be one of across-current, random"),
        ("execute.command", json!(" "), "must be a program and its arguments"),
        ("execute.speed_m_s", json!(3.0), "execute.speed_m_s = 3: must be"),
        ("spec.violation_share", json!(1.0), "must be ≥ 0 and < 1"),
    ] {
        let found = changed(&[(key, value)]).err().unwrap_or_default();
        assert!(found.iter().any(|mistake| mistake.contains(words)), "{key}: {found:?} should say {words:?}");
    }
    let still = [("generate.search.method", json!("in-loop")), ("generate.search.stress", json!("tilt"))];
    assert!(changed(&still).is_err(), "a boat does not tilt");
}

#[test]
fn cases_are_proven_sailed_and_judged_and_what_is_tampered_with_is_found() {
    let setup = changed(&[]).expect("a setup");
    let (mut cases, stop) = (Vec::new(), Stop::never());
    generate(&setup, &Known::default(), &OwnSimulator, &stop, &mut |found, _| cases.extend_from_slice(found));
    assert_eq!(cases.len(), 2);
    for case in &cases {
        let verified = verify(&setup, case);
        let proof = verified.proof.expect("a witness");
        assert!(proof.ok(), "{:?}", proof.findings);
        assert!(verified.with_lag.expect("thrusters lag").position > 0.0);
        let runs = [0, 0].map(|run| execute_run(&setup, case, run));
        assert_eq!(runs[0], runs[1]);
        let result = judge(&setup, case, &runs[..1]).expect("a result");
        assert!(result.measures.expect("measured").max_deviation > 0.0);
        let mut tampered = case.clone();
        let profile = tampered.profile().expect("a profile").clone();
        let bent = |leg: &ProfileLeg| {
            let mut leg = leg.clone();
            leg.coefficients[2][5] *= 1.001;
            leg
        };
        tampered.witness = Some(crate::trajectory::Profile { legs: profile.legs.iter().map(bent).collect() }.into());
        assert!(!verify(&setup, &tampered).proof.expect("a witness").ok());
    }
}

/// Runs were the same whatever was drawn, and counted as draws.
#[test]
fn what_no_run_reads_is_not_drawn() {
    let mistakes = |key: &str, ends: [f64; 2], changes: &[(&str, Value)]| {
        let drawn = ("vary", json!({ key: { "uniform": ends } }));
        changed(&[&[drawn][..], changes].concat()).err().unwrap_or_default().join("; ")
    };
    let (open, tracked) = (("world.keep_out", json!([])), ("execute.controller", json!("tracking")));
    let round = ("robot.radius_m", json!(0.7));
    for (key, ends, changes, why) in [
        ("world.keep_in_margin_m", [0.5, 1.0], vec![], "a key that runs read: plans keep the margin"),
        ("robot.speed_m_s", [0.1, 0.3], vec![], "a key that runs read: who steers knows the nominal boat's"),
        ("robot.radius_m", [0.6, 0.7], vec![open], "there are none"),
        ("robot.length_m", [1.2, 1.3], vec![round], "a radius of its own"),
        ("execute.speed_m_s", [0.1, 0.3], vec![tracked], "`tracking` has no use for it"),
    ] {
        let found = mistakes(key, ends, &changes);
        assert!(found.contains(why), "{key}: {found}");
    }
    for (key, ends) in
        [("robot.radius_m", [0.6, 0.7]), ("robot.mass_kg", [23.0, 24.0]), ("execute.speed_m_s", [0.1, 0.3])]
    {
        assert_eq!(mistakes(key, ends, &[]), "", "{key}");
    }
}

/// The disc is 0.644 m in radius: its middle alone keeps the margin.
#[test]
fn a_hull_that_may_reach_over_the_edges_is_named() {
    for (margin, named) in [(1.0, false), (0.65, false), (0.64, true), (0.0, true)] {
        let setup = changed(&[("world.keep_in_margin_m", json!(margin))]).expect("a setup");
        assert_eq!(setup.unknown_shapes().is_some(), named, "{margin}");
        let mut said = Vec::new();
        super::assumptions::claim(setup.own().expect("a boat"), &mut said);
        let told = said.iter().find(|sentence| sentence.contains(&format!("keeps {margin} m from the edges")));
        assert_eq!(told.expect("a sentence").contains("may reach over them"), named, "{margin}");
    }
}

/// A boat that stops amid a mission does not turn there in no time, whichever way the water flows.
#[test]
fn a_stop_leaves_the_bow_where_it_is() {
    for current in [[0.05, 0.02], [0.0, 0.0]] {
        let setup = changed(&[("world.current_m_s", json!(current))]).expect("a setup");
        let waypoints = [[3.0, 3.0], [8.0, 4.0], [6.0, 11.0]].map(|[x, y]| Point3::new(x, y, 0.0));
        let asked = Demands { waypoints: &waypoints, speeds: &[None, None], stops: &[1], hold: 0.0 };
        let passed = passes(&setup, &asked).expect("an answer").witness.expect("a witness");
        let [before, after] = passed.witness.profile().expect("a profile").legs.as_slice() else { panic!("two legs") };
        let turned = after.derivative(0.0, 0).z - before.derivative(before.duration, 0).z;
        assert!(libm::remainder(turned, std::f64::consts::TAU).abs() < 1e-9, "{current:?}: {turned} rad");
        assert!(after.derivative(0.0, 1).norm() < 1e-12, "it stops there");
    }
}

/// Searches move waypoints in space; a boat's stay on the water, and its trips within their limit of time.
#[test]
fn waypoints_that_a_search_moves_stay_on_the_water() {
    let moving = [
        ("generate.search.method", json!("in-loop")),
        ("generate.search.executions", json!(60)),
        ("generate.search.move_waypoints", json!(true)),
        ("generate.search.cases", json!(1)),
        ("generate.limits.max_time_s", json!(300.0)),
    ];
    let setup = changed(&moving).expect("a setup");
    let mut cases = Vec::new();
    generate(&setup, &Known::default(), &OwnSimulator, &Stop::never(), &mut |found, _| cases.extend_from_slice(found));
    let [case] = &cases[..] else { panic!("{} cases", cases.len()) };
    assert!(case.waypoints.iter().all(|point| point.z == 0.0), "{:?}", case.waypoints);
    assert!(case.profile().expect("a profile").duration() <= 300.0);
    let proof = verify(&setup, case).proof.expect("a witness");
    assert!(proof.ok(), "{:?}", proof.findings);
}

/// With the current behind it a boat is faster over ground than through the water, and only the limit of speeds is a
/// proof that it is not.
#[test]
fn a_current_behind_a_boat_carries_it_faster_than_it_sails() {
    let waypoints = [[3.0, 3.0], [10.0, 3.0], [16.0, 3.0], [22.0, 3.0]].map(|[x, y]| Point3::new(x, y, 0.0));
    let asked = Demands { waypoints: &waypoints, speeds: &[Some(0.62); 3], stops: &[], hold: 0.0 };
    let flowing = [("world.current_m_s", json!([0.25, 0.0]))];
    let passed = passes(&changed(&flowing).expect("a setup"), &asked).expect("an answer");
    let leg = &passed.legs[1];
    assert!(passed.witness.is_some() && leg.top_speed.is_some_and(|top| (top - 0.62).abs() < 0.05), "{passed:?}");
    let still = passes(&changed(&[("world.current_m_s", json!([0.0, 0.0]))]).expect("a setup"), &asked);
    let broken = still.expect("an answer").legs[1].broken.clone().expect("faster than it sails");
    assert_eq!(broken.certainty, Certainty::NotFound, "{broken:?}");
    let limited = changed(&[flowing[0].clone(), ("generate.limits.max_speed_m_s", json!(0.5))]).expect("a setup");
    let broken = passes(&limited, &asked).expect("an answer").legs[1].broken.clone().expect("above the limit");
    assert_eq!((broken.limit, broken.certainty), ("speed", Certainty::Proven));
}
