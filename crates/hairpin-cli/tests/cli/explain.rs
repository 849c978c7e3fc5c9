//! `hairpin explain`: where candidates are lost, and the smallest change that helps.

use std::path::Path;

use crate::commands::{json, run};
use serde_json::Value;

const FLIGHT: [&str; 10] = [
    "explain",
    "demo-quadrotor",
    "--set",
    "generate.reach=\"hull\"",
    "--set",
    "generate.timing={step_s=1.0}",
    "--set",
    "generate.search.waypoints=150",
    "--set",
    "generate.limits.max_speed_m_s=9",
];

fn lost(object: &Value, stage: &str) -> u64 {
    let lost = object["deaths"]["lost"].as_array().unwrap();
    lost.iter().filter(|one| one["stage"] == stage).map(|one| one["count"].as_u64().unwrap()).sum()
}

fn change<'a>(object: &'a Value, key: &str) -> Option<&'a Value> {
    object["changes"].as_array().unwrap().iter().find(|change| change["key"] == key)
}

/// What is told to help does, and half of it does not.
fn holds(here: &Path, arguments: &[&str], key: &str, object: &Value) {
    let change = change(object, key).unwrap_or_else(|| panic!("{key}: {object}"));
    let (from, to) = (change["from"].as_f64().unwrap(), change["to"].as_f64().unwrap());
    let at = |value: f64| {
        let set = format!("{key}={value}");
        json(here, &[arguments, &["--set", &set, "--time-limit", "0"]].concat())["exit_code"].as_i64().unwrap()
    };
    assert_eq!((at(to), at(0.5 * (from + to))), (0, 3), "{change}");
}

#[test]
fn a_flight_that_is_too_slow_for_its_end_needs_speed_or_waypoints() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    // 20.8 m in three legs of one second.
    let slow =
        [&FLIGHT[..], &["--set", "task.length=4", "--set", "generate.limits.max_speed_m_s=6.5", "--graphs", "4"]]
            .concat();
    let object = json(here, &slow);
    assert_eq!((&object["exit_code"], &object["solved"], &object["graphs"]), (&3.into(), &0.into(), &4.into()));
    let verdict = object["verdict"].as_str().unwrap();
    assert!(
        verdict.starts_with("NOTHING FEASIBLE (proof, hull): no chain of 4 waypoints from start to end"),
        "{verdict}"
    );
    assert!(
        verdict.contains("; smallest change: ") && verdict.contains("max_speed 6.5") && verdict.contains(" m/s"),
        "{verdict}"
    );
    holds(here, &slow, "generate.limits.max_speed_m_s", &object);
    // What people read is what was tried, not rounded back to where nothing is feasible.
    for one in object["changes"].as_array().unwrap().iter().filter(|one| one["to"].is_f64()) {
        let (_, told) = one["words"].as_str().unwrap().split_once(" → ").unwrap();
        assert_eq!(told.split(' ').next().unwrap().parse::<f64>().unwrap(), one["to"].as_f64().unwrap(), "{one}");
    }
    let length = change(&object, "task.length").unwrap();
    assert!(length["words"] == format!("length {}", length["to"]) && length["to"].as_u64().unwrap() > 4, "{length}");
    let relative: Vec<f64> =
        object["changes"].as_array().unwrap().iter().map(|change| change["relative"].as_f64().unwrap()).collect();
    assert!(relative.is_sorted(), "{relative:?}");
    let asked = object["deaths"]["asked"].as_u64().unwrap();
    let counted: u64 =
        ["limits", "reach", "world", "obstacle", "end-point"].map(|stage| lost(&object, stage)).iter().sum();
    assert_eq!(asked, counted + object["deaths"]["left"].as_u64().unwrap());
    assert!(lost(&object, "limits") > asked / 2, "{object}");

    // A key that is off by a unit or two is found as well.
    let far =
        json(here, &[&slow[..], &["--set", "generate.limits.max_speed_m_s=0.1", "--set", "task.length=12"]].concat());
    holds(here, &[&slow[..], &["--set", "task.length=12"]].concat(), "generate.limits.max_speed_m_s", &far);

    // Where something is feasible, nothing has to change.
    let (code, out, _) = run(here, &FLIGHT);
    assert!(code == 0 && out.lines().last().unwrap().starts_with("FEASIBLE (hull): "), "{out}");
    assert!(out.contains("lost at") && out.contains("pairs of waypoints near the start"), "{out}");

    // Commands that find nothing say where to ask.
    let words = ["generate", FLIGHT[1]];
    let (code, _, error) = run(here, &[&words[..], &slow[2..slow.len() - 2], &["--out", "a"]].concat());
    assert!(code == 3 && error.contains("hairpin explain a/scenario.toml"), "{error}");
    assert_eq!(run(here, &["explain", "a/scenario.toml", "--time-limit", "0"]).0, 3);
}

#[test]
fn a_walled_in_flight_is_told_what_is_in_the_way() {
    let folder = tempfile::tempdir().unwrap();
    let wall = "world.obstacles=[{name=\"wall\",box={center_m=[9,15,15],size_m=[1,30,30]}}]";
    let object = json(folder.path(), &[&FLIGHT[..], &["--set", wall]].concat());
    assert_eq!(object["exit_code"], 3, "{object}");
    assert!(object["deaths"]["lost"].as_array().unwrap().iter().any(|one| one["limit"] == "wall"), "{object}");
    assert_eq!(change(&object, "world.obstacles").unwrap()["words"], "no obstacles");
}

#[test]
fn drives_and_arms_have_their_own_reasons() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let stiff = ["explain", "demo-rover", "--graphs", "1", "--set", "generate.limits.curvature_1_m=0.002"];
    let object =
        json(here, &[&stiff[..], &["--set", "generate.search.waypoints=12", "--set", "task.length=3"]].concat());
    assert_eq!(object["exit_code"], 3, "{object}");
    assert!(lost(&object, "reach") > 0 && object["deaths"]["left"] == 0, "{object}");
    let words = change(&object, "generate.limits.curvature_1_m").unwrap()["words"].as_str().unwrap();
    assert!(words.starts_with("curvature 0.002 → 0."), "{words}");

    // As long as it takes: a change that a slow machine had no time to look for is not told.
    let patient = ["explain", "demo-arm", "--time-limit", "900"];
    let object = json(here, &[&patient[..], &["--set", "generate.search.min_cost=1e9"]].concat());
    assert_eq!(object["exit_code"], 3, "{object}");
    let least = change(&object, "generate.search.min_cost").unwrap()["to"].as_f64().unwrap();
    assert!(least > 100.0 && least < 1e6, "{object}");
    assert!(object["deaths"]["left"].as_u64().unwrap() > 0, "{object}");
    assert_eq!(json(here, &["explain", "demo-arm"])["exit_code"], 0);

    // A clearance that no place has is no mistake in the number of points.
    let wide = ["demo-arm", "--set", "generate.moves.clearance_mm=400"];
    let object = json(here, &[&patient[..], &wide[1..]].concat());
    assert!(object["exit_code"] == 3 && object["deaths"]["asked"] == 0, "{object}");
    assert!(object["verdict"].as_str().unwrap().contains("generate.moves.clearance_mm = 400"), "{object}");
    let least = change(&object, "generate.moves.clearance_mm").unwrap();
    assert!(least["to"].as_f64().unwrap() < 400.0, "{object}");
    let (code, out, _) = run(here, &[&["generate"], &wide[..], &["--out", "wide"]].concat());
    assert!(code == 3 && out.contains("generate.moves.clearance_mm = 400"), "{out}");

    // Keep-outs are left out like obstacles.
    let out = ["explain", "demo-arm", "--set", "world.obstacles=[]", "--set", "world.keep_out_mm=[\"z > 0\"]"];
    let given = [&out[..], &["--set", "task.points=[[300,0,400],[300,100,300]]"]].concat();
    let object = json(here, &given);
    assert_eq!(
        (&object["exit_code"], &change(&object, "world.keep_out_mm").unwrap()["words"]),
        (&3.into(), &"no keep-outs".into())
    );

    // Where arcs are moves of the graph they are counted with them.
    let [without, with] = ["false", "true"].map(|arcs| {
        let arcs = format!("generate.moves.arcs={arcs}");
        json(here, &["explain", "demo-arm", "--set", "task.points.count=6", "--set", &arcs])
    });
    let count = |object: &Value| object["deaths"]["asked"].as_u64().unwrap();
    assert_eq!(count(&with), count(&without) + 6 * 5 * 4, "{with}");
    let no_arc =
        |object: &Value| object["deaths"]["lost"].as_array().unwrap().iter().any(|one| one["limit"] == "no arc");
    assert!(no_arc(&with) && !no_arc(&without), "{with}");
}
