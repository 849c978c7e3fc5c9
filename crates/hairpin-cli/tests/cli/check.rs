//! `hairpin check`: a mission made elsewhere against a robot's claim; the exit codes and keys of the contract.

use std::fs;
use std::path::Path;

use serde_json::{Value, json};

use crate::commands::{json, refused, run};

const PLAN: &str = include_str!("../../../hairpin-formats/tests/fixtures/missions/cage.plan");

/// The answer for a text, by a robot and more.
fn checked(folder: &Path, text: &str, more: &[&str]) -> Value {
    fs::write(folder.join("mine.plan"), text).unwrap();
    json(folder, &[&["check", "mine.plan", "--robot", "flightgoggles"][..], more].concat())
}

fn contract(found: &Value) -> [&Value; 3] {
    [&found["feasible"], &found["waypoint"], &found["limit"]]
}

#[test]
fn a_mission_that_can_be_flown_is_feasible() {
    let folder = tempfile::tempdir().unwrap();
    for more in [&[][..], &["--world", "cage-30m"], &["--world", "demo-quadrotor"]] {
        let found = checked(folder.path(), PLAN, more);
        assert_eq!(found["exit_code"], 0, "{found}");
        assert_eq!((contract(&found), &found["excess"]), ([&json!(true), &Value::Null, &Value::Null], &Value::Null));
        let legs = found["legs"].as_array().unwrap();
        assert_eq!(legs.len(), 2);
        for leg in legs {
            // From rest to 3 m/s, or back: twice the length by the speed.
            let [length, time] = ["length_m", "witness_s"].map(|key| leg[key].as_f64().unwrap());
            assert!((time - 2.0 * length / 3.0).abs() < 1e-9 && leg["demanded_m_s"] == 3.0, "{leg}");
            assert!(leg["fastest_alone_s"].as_f64().unwrap() < time && leg["nearest"]["limit"].is_string(), "{leg}");
        }
        assert!(found["notes"].to_string().contains("camera shutter"), "{found}");
    }
    let (code, out, _) = run(folder.path(), &["check", "mine.plan", "--robot", "flightgoggles"]);
    assert!(code == 0 && out.contains("FEASIBLE mine.plan (witnessed, flightgoggles): 3 waypoints"), "{out}");
    assert!(out.contains("0→1") && out.contains("item 3") && out.contains("own home"), "{out}");
}

#[test]
fn the_first_limit_that_breaks_is_told_with_its_excess() {
    let folder = tempfile::tempdir().unwrap();
    // 18 m/s is the robot's top speed; the scenario's limit is 6 m/s.
    for (more, most) in [(&[][..], 18.0), (&["--world", "demo-quadrotor"], 6.0)] {
        let found = checked(folder.path(), &PLAN.replace("[1, 3, -1", "[1, 25, -1"), more);
        assert_eq!(found["exit_code"], 1, "{found}");
        assert_eq!(contract(&found), [&json!(false), &json!(1), &json!("speed")], "{found}");
        assert!((found["excess"].as_f64().unwrap() - (25.0 - most)).abs() < 1e-9, "{found}");
        assert_eq!((&found["evidence"], &found["broken"]["source"]), (&json!("proven"), &json!("item 3")));
    }
    // 50 m above home is 22 m above what the ceiling leaves: 30 m, less 2 m.
    let high = PLAN.replace("-78.50790000, 8]", "-78.50790000, 50]").replace("\"Altitude\": 8", "\"Altitude\": 50");
    let found = checked(folder.path(), &high, &["--world", "cage-30m"]);
    assert_eq!(contract(&found), [&json!(false), &json!(2), &json!("cage")], "{found}");
    assert!((found["excess"].as_f64().unwrap() - 22.0).abs() < 1e-3, "{found}");
    // Outside of its own fence.
    let found = checked(folder.path(), &PLAN.replace("[38.0339,", "[38.03366,"), &[]);
    assert_eq!((&found["exit_code"], &found["limit"]), (&json!(1), &json!("fence")), "{found}");
}

#[test]
fn what_is_not_found_out_is_inconclusive() {
    let folder = tempfile::tempdir().unwrap();
    let found = checked(folder.path(), &PLAN.replace("\"command\": 203", "\"command\": 18"), &[]);
    assert_eq!((&found["exit_code"], &found["feasible"]), (&json!(5), &Value::Null), "{found}");
    assert!(found["verdict"].as_str().unwrap().contains("item 4 (command 18, loiter for turns)"), "{found}");
    // A hold is modelled: it rests there, and each part is flown from rest to rest.
    let found = checked(folder.path(), &PLAN.replace("[0, 1, 0, null, 38.03364", "[4, 1, 0, null, 38.03364"), &[]);
    assert_eq!(found["mission"]["stops"], json!([{ "waypoint": 1, "hold_s": 4.0 }]), "{found}");
    assert_eq!(found["exit_code"], 0, "{found}");
}

#[test]
fn what_is_no_mission_or_no_robot_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
    write("one.csv", "x_m,y_m,z_m\n3,3,3\n");
    write("twice.csv", "x_m,y_m,z_m\n3,3,3\n3,3,3\n");
    write("mine.plan", PLAN);
    let by = |mission: &'static str| ["check", mission, "--robot", "flightgoggles"];
    refused(folder.path(), &by("one.csv"), &["one.csv: 1 waypoints, must be at least 2"]);
    refused(folder.path(), &by("twice.csv"), &["line 3: the waypoint of line 2 again"]);
    refused(folder.path(), &by("none.csv"), &["none.csv"]);
    refused(folder.path(), &["check", "mine.plan"], &["--robot"]);
    refused(folder.path(), &["check", "mine.plan", "--robot", "anafy"], &["did you mean `anafi`?"]);
    refused(folder.path(), &["check", "mine.plan", "--robot", "irb120"], &["not checked"]);
    refused(folder.path(), &[&by("mine.plan")[..], &["--world", "cage-30"]].concat(), &["cage-30"]);
}
