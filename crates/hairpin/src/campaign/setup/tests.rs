//! What draws share with the setup that they are draws of.

use std::sync::Arc;

use serde_json::{Value, json};

use super::*;
use crate::campaign::drive::DriveSetup;
use crate::campaign::flight::FlightSetup;

fn flights() -> Setup {
    let scenario: Scenario = serde_json::from_value(json!({
        "hairpin": 1,
        "robot": { "kind": "quadrotor", "name": "test", "mass_kg": 1.0, "inertia_kg_m2": [0.005, 0.005, 0.007],
            "thrust_coefficient_n_s2": 1.91e-6, "moment_coefficient_n_m_s2": 2.6e-7,
            "rotor_speed_rad_s": [0.0, 2200.0],
            "rotors": [{ "x_m": 0.1, "y_m": 0.1, "spin": 1 }, { "x_m": -0.1, "y_m": 0.1, "spin": -1 },
                { "x_m": -0.1, "y_m": -0.1, "spin": 1 }, { "x_m": 0.1, "y_m": -0.1, "spin": -1 }] },
        "world": { "size_m": [10.0, 10.0, 10.0], "obstacles": [
            { "sphere": { "center_m": [5.0, 5.0, 5.0], "radius_m": 1.0 } }] },
        "task": { "start_m": [1.0, 1.0, 1.0], "end_m": [9.0, 9.0, 9.0], "length": 3 },
    }))
    .expect("a scenario");
    Setup::new(scenario).expect("a setup")
}

fn drives() -> Setup {
    let scenario: Scenario = serde_json::from_value(json!({
        "hairpin": 1,
        "robot": { "kind": "rover", "name": "test", "limits": { "curvature_1_m": 1.0 } },
        "world": { "terrain": { "generator": "craters", "size_m": 20.0 } },
        "task": { "start": { "x_m": 10.0, "y_m": 10.0 }, "length": 3, "leg_m": [1.0, 5.0] },
    }))
    .expect("a scenario");
    Setup::new(scenario).expect("a setup")
}

fn drawn(setup: &Setup, key: &str, value: Value) -> Setup {
    setup.drawn(&[(key.to_owned(), value)]).expect(key)
}

#[test]
fn a_draw_builds_what_it_changes_and_shares_the_rest() {
    let nominal = flights();
    let flyer = |setup: &Setup| setup.own::<FlightSetup>().expect("it flies").clone();
    for (key, value, robot, world) in [
        ("execute.noise", json!(true), true, true),
        ("world.wind_m_s", json!([1.0, 0.0, 0.0]), true, true),
        ("robot.mass_kg", json!(1.1), false, true),
        ("world.obstacles[0].sphere.radius_m", json!(1.5), true, false),
    ] {
        let (old, new) = (flyer(&nominal), flyer(&drawn(&nominal, key, value)));
        let shared = (Arc::ptr_eq(&old.robot, &new.robot), Arc::ptr_eq(&old.world, &new.world));
        assert_eq!(shared, (robot, world), "{key}");
    }
    let heavier = drawn(&nominal, "robot.mass_kg", json!(1.1));
    assert_eq!(heavier.own::<FlightSetup>().expect("it flies").robot.mass, 1.1);
}

#[test]
fn generated_ground_is_made_once() {
    let nominal = drives();
    let map = |setup: &Setup| setup.own::<DriveSetup>().expect("it drives").map.clone();
    for (key, value, shared) in [
        ("execute.latency_s", json!(0.1), true),
        ("generate.kinematics", json!("exact"), true),
        ("world.terrain.relief_m", json!(0.01), false),
    ] {
        assert_eq!(Arc::ptr_eq(&map(&nominal), &map(&drawn(&nominal, key, value))), shared, "{key}");
    }
    let changed = nominal.changed(nominal.scenario.clone()).expect("the same");
    assert!(Arc::ptr_eq(&map(&nominal), &map(&changed)));
}
