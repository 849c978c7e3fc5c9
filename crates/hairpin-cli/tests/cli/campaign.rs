//! Whole campaigns through the binary: verdicts, exit codes, and what stands in the folder.

use std::fs;

use crate::commands::{SMALL, assert_same, contents, json, refused, run};
use hairpin_formats::folder::CampaignFolder;
use serde_json::Value;

#[test]
fn the_verdict_is_a_line_and_the_exit_code() {
    let folder = tempfile::tempdir().unwrap();
    let (code, out, _) =
        run(folder.path(), &[&SMALL[..], &["--set", "spec.deviation.max_m=20", "--out", "a"]].concat());
    assert_eq!(code, 0, "{out}");
    assert!(out.lines().last().unwrap().starts_with("PASS 4/4 (simulated, "), "{out}");
    assert!(out.starts_with("case"), "the table stands before it: {out}");

    let strict = [&SMALL[..], &["--set", "spec.deviation.max_m=0.01"]].concat();
    let object = json(folder.path(), &strict);
    assert_eq!(object["exit_code"], 1);
    assert!(object["verdict"].as_str().unwrap().starts_with("FAIL 4/4 "));
    assert_eq!((&object["counts"]["cases"], &object["counts"]["fail"]), (&Value::from(4), &Value::from(4)));
    assert!(object["worst"]["max_deviation_m"].as_f64().unwrap() > 0.01);
    // Without --out the folder has the scenario's name.
    assert_eq!(object["paths"]["folder"], "out/demo-quadrotor");
    for (_, path) in object["paths"].as_object().unwrap() {
        assert!(folder.path().join(path.as_str().unwrap()).exists(), "{path}");
    }

    let (code, _, error) = run(folder.path(), &strict);
    assert_eq!(code, 2);
    assert!(["--resume", "--force", "--out"].iter().all(|way| error.contains(way)), "{error}");
    assert_eq!(run(folder.path(), &[&strict[..], &["--force"]].concat()).0, 1);
}

/// The page of one verdict is not pointed at beside another.
#[test]
fn a_report_of_an_earlier_judgement_is_told_as_such() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let (_, _, error) = run(here, &[&SMALL[..], &["--set", "spec.deviation.max_m=20", "--out", "a"]].concat());
    assert!(error.contains("report: a/report.html"), "{error}");
    let strict = ["judge", "a", "--set", "spec.deviation.max_m=0.01"];
    let (code, _, error) = run(here, &strict);
    let told = "a/report.html is of an earlier judgement: hairpin report a writes it anew";
    assert!(code == 1 && error.contains(told) && !error.contains("report: "), "{error}");
    assert_eq!(json(here, &strict)["paths"]["report"], Value::Null);
    run(here, &["report", "a"]);
    assert!(fs::read_to_string(here.join("a/report.html")).unwrap().contains("FAIL 4/4"));
}

#[test]
fn a_violation_can_be_flown_again() {
    let folder = tempfile::tempdir().unwrap();
    let strict = ["--set", "spec.deviation.max_m=0.01", "--set", "execute.repeat=2", "--out", "a"];
    let vary = ["--set", "vary.\"world.wind_m_s\".uniform=[[-1,-1,0],[1,1,0]]"];
    let (code, _, error) = run(folder.path(), &[&SMALL[..], &strict, &vary].concat());
    assert_eq!(code, 1, "{error}");
    for file in fs::read_dir(folder.path().join("a/repro")).unwrap() {
        let file = file.unwrap().path();
        let object = json(folder.path(), &["replay", file.to_str().unwrap()]);
        assert_eq!((&object["exit_code"], &object["reproduces"]), (&Value::from(1), &Value::from(true)), "{object}");
    }
    let file = folder.path().join("a/repro/0000.json");
    let lenient = fs::read_to_string(&file).unwrap().replace("\"max_m\": 0.01", "\"max_m\": 50.0");
    fs::write(&file, lenient).unwrap();
    let object = json(folder.path(), &["replay", "a/repro/0000.json"]);
    assert_eq!((&object["exit_code"], &object["reproduces"]), (&Value::from(0), &Value::from(false)), "{object}");
}

#[test]
fn the_parts_make_the_whole() {
    let folder = tempfile::tempdir().unwrap();
    run(folder.path(), &[&SMALL[..], &["--out", "whole"]].concat());
    let object = json(folder.path(), &[&["generate"], &SMALL[1..], &["--out", "parts"]].concat());
    assert_eq!(object["counts"]["cases"], 4);
    let (code, _, error) = run(folder.path(), &["judge", "parts"]);
    assert!(code == 2 && error.contains("hairpin execute"), "{error}");
    assert_eq!(json(folder.path(), &["execute", "parts"])["counts"]["runs"], 4);
    assert!([0, 1].contains(&run(folder.path(), &["judge", "parts"]).0));
    assert_eq!(run(folder.path(), &["report", "parts"]).0, 0);
    assert!(folder.path().join("parts/report.html").is_file());
    assert_same(&folder.path().join("whole"), &folder.path().join("parts"));

    let (code, _, error) = run(folder.path(), &["execute", "parts", "--set", "task.length=3"]);
    assert!(code == 2 && error.contains("task.length"), "{error}");
    // Judged by another limit, the same flights get another verdict.
    assert_eq!(run(folder.path(), &["judge", "parts", "--set", "spec.deviation.max_m=0.01"]).0, 1);
    assert_eq!(run(folder.path(), &["judge", "parts", "--set", "spec.deviation.max_m=20"]).0, 0);
}

#[test]
fn exported_waypoints_fly_again_as_missions() {
    let folder = tempfile::tempdir().unwrap();
    run(folder.path(), &[&SMALL[..], &["--out", "a"]].concat());
    let (code, _, error) = run(folder.path(), &["export", "a", "--to", "waypoints,csv,tum"]);
    assert_eq!(code, 0, "{error}");
    let text = fs::read_to_string(folder.path().join("a/export/0002.csv")).unwrap();
    assert!(text.starts_with("x_m,y_m,z_m\n") && text.lines().count() == 9, "{text}");
    for name in ["0002.planned.csv", "0002-0.csv", "0002.ref.tum", "0002.exec.tum"] {
        assert!(folder.path().join("a/export").join(name).is_file(), "{name}");
    }
    let before = json(folder.path(), &["judge", "a"]);
    run(folder.path(), &["execute", "a", "--missions", "a/export"]);
    let after = json(folder.path(), &["judge", "a"]);
    assert_eq!(before["worst"], after["worst"], "the same waypoints fly the same flight");

    fs::create_dir(folder.path().join("mine")).unwrap();
    fs::write(folder.path().join("mine/up.csv"), "x_m,y_m,z_m\n3,3,3\n3,3,9\n9,3,9\n").unwrap();
    assert_eq!(json(folder.path(), &["execute", "a", "--missions", "mine"])["counts"]["cases"], 1);
    let verdict = json(folder.path(), &["judge", "a"]);
    assert!(verdict["verdict"].as_str().unwrap().contains("all 1 witnessed"), "{verdict}");
}

#[test]
fn the_header_and_the_parameter_that_did_it_are_told() {
    let folder = tempfile::tempdir().unwrap();
    let origin = "world.origin={lat_deg=47.3977,lon_deg=8.5456,alt_amsl_m=488.0,x_axis_heading_deg=73.5}";
    let arguments = [&SMALL[..], &["--out", "a", "--set", origin, "--set", "execute.repeat=5"]].concat();
    let wind = "vary.\"world.wind_m_s\".uniform=[[-3,0,0],[3,0,0]]";
    let limit = "vary.\"spec.deviation.max_m\".uniform=[0.001,0.002]";
    let object = json(folder.path(), &[&arguments[..], &["--set", wind, "--set", limit]].concat());
    let frame = &object["frame"];
    assert_eq!((&frame["origin"]["x_axis_heading_deg"], &frame["aligned"]), (&Value::from(73.5), &Value::from(false)));
    assert_eq!(
        (&frame["length_counts"], &frame["leg_source"]["executor"]),
        (&Value::from("waypoints"), &Value::from(4))
    );
    let above = frame["start"]["alt_amsl_m"].as_f64().unwrap() - 488.0;
    assert!((above - 3.0).abs() < 0.01, "{frame}");
    let found = object["influences"].as_array().unwrap();
    let keys: Vec<&str> = found.iter().map(|one| one["key"].as_str().unwrap()).collect();
    assert!(keys.contains(&"world.wind_m_s[0]") && !keys.contains(&"world.wind_m_s[1]"), "{keys:?}");
    assert!(found.iter().all(|one| one["rank_correlation"].as_f64().unwrap().abs() <= 1.0));
    // Limits drawn per run are those it is judged by.
    assert_eq!(object["counts"]["fail"], 4, "{object}");
    assert_eq!(object["worst"]["evidence"], "witnessed");
    let report = fs::read_to_string(folder.path().join("a/report.html")).unwrap();
    let page = &report[..report.find("<script").unwrap()];
    for words in ["x heads 73.5° by compass", "not aligned", "Which parameter did it", "at the worst moment: "] {
        assert!(page.contains(words), "{words}");
    }
    let (_, out, _) = run(folder.path(), &["judge", "a"]);
    assert!(out.contains("length: 8 counts waypoints") && out.contains("  world.wind_m_s[0]"), "{out}");
}

#[test]
fn waypoints_on_earth_need_the_cages_place() {
    let folder = tempfile::tempdir().unwrap();
    let origin = "world.origin={lat_deg=47.3977,lon_deg=8.5456,alt_amsl_m=488.0,x_axis_heading_deg=73.5}";
    run(folder.path(), &[&SMALL[..], &["--out", "a", "--set", origin]].concat());
    let (code, out, error) = run(folder.path(), &["export", "a", "--to", "geodetic,waypoints"]);
    assert_eq!(code, 0, "{out}{error}");
    let text = fs::read_to_string(folder.path().join("a/export/0001.geodetic.csv")).unwrap();
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!((lines[0], lines.len()), ("lat_deg,lon_deg,alt_amsl_m,relative_alt_m", 9));
    assert!(lines[1..].iter().all(|line| line.starts_with("47.397") && line.contains(",8.545")), "{text}");
    // Both kinds of file side by side: those in metres fly.
    assert_eq!(json(folder.path(), &["execute", "a", "--missions", "a/export"])["counts"]["cases"], 4);

    // The demo's world may have a place of its own, so one without is asked for by name.
    let unplaced = fs::read_to_string(folder.path().join("a/scenario.toml")).unwrap();
    let start = unplaced.find("[world.origin]").expect("written as a table");
    let end = start + unplaced[start + 1..].find('[').map_or(unplaced.len() - start, |at| at + 1);
    fs::write(folder.path().join("a/scenario.toml"), format!("{}{}", &unplaced[..start], &unplaced[end..])).unwrap();
    let (code, _, error) = run(folder.path(), &["export", "a", "--to", "geodetic"]);
    assert!(code == 2 && error.contains("`world.origin`"), "{error}");
}

#[test]
fn a_time_limit_keeps_what_exists() {
    let folder = tempfile::tempdir().unwrap();
    let arguments =
        ["generate", "demo-quadrotor", "--set", "generate.search.cases=1000000", "--time-limit", "1.5", "--out", "a"];
    let object = json(folder.path(), &arguments);
    assert_eq!(object["exit_code"], 0);
    assert!(object["counts"]["cases"].as_u64().unwrap() > 0);
}

#[test]
fn wrong_input_costs_no_run() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    run(here, &[&SMALL[..], &["--out", "a"]].concat());
    let before = contents(&here.join("a"));
    refused(here, &["execute", "a", "--repro", "nowhere", "--set", "execute.repeat=2"], &["nowhere", "no repro file"]);
    fs::create_dir(here.join("mine")).unwrap();
    fs::write(here.join("mine/0000.json"), "{").unwrap();
    refused(here, &[&SMALL[..], &["--out", "a", "--force", "--repro", "mine"]].concat(), &["0000.json", "no repro"]);
    refused(here, &["execute", "a", "--repro", "mine"], &["0000.json"]);
    let plans = "vary.\"task.length\"={choice=[5,6]}";
    refused(here, &["execute", "a", "--set", plans], &["`task` and `generate`", "must stay"]);
    assert_eq!(contents(&here.join("a")), before);

    // Another kind of robot in the same folder: what was saved of the first is left out.
    let (code, ..) = run(here, &["judge", "a", "--set", "spec.deviation.max_m=0.001"]);
    assert_eq!(code, 1);
    assert!(here.join("a/repro/0000.json").is_file());
    let drive = ["stress", "differential-drive", "--out", "a", "--force", "--set", "generate.search.cases=1"];
    let drive = [&drive[..], &["--set", "execute.repeat=1", "--set", "task.length=3"]].concat();
    refused(here, &[&drive[..], &["--repro", "a/repro"]].concat(), &["another kind of robot"]);
    let (code, _, error) = run(here, &drive);
    assert!([0, 1, 5].contains(&code) && error.contains("of another kind of robot and left out"), "{code}: {error}");
}

#[test]
fn values_drawn_for_plans_are_kept_and_ranked() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let vary = "vary={\"task.length\"={choice=[4,7]},\"robot.mass_kg\"={uniform=[0.9,1.1]}}";
    let sets = ["--set", vary, "--set", "execute.repeat=2", "--set", "spec.deviation.max_m=0.001"];
    let told = json(here, &[&SMALL[..], &["--out", "a", "--set", "generate.search.cases=6"], &sets].concat());
    let keys: Vec<&str> =
        told["influences"].as_array().unwrap().iter().map(|one| one["key"].as_str().unwrap()).collect();
    assert!(keys.contains(&"task.length") && keys.contains(&"robot.mass_kg"), "{told}");
    let kept = CampaignFolder::open(&here.join("a")).unwrap();
    let (cases, results) = (kept.read_cases().unwrap(), kept.read_results().unwrap());
    for (case, result) in cases.iter().zip(&results) {
        let drawn = result.drawn.iter().find(|(key, _)| key == "task.length").map(|(_, value)| value.clone());
        // Case 0 is nominal.
        assert_eq!(drawn, (case.number.0 > 0).then(|| case.waypoints.len().into()), "case {}", case.number);
        let repro = fs::read_to_string(here.join(format!("a/repro/{:04}.json", case.number))).unwrap();
        let repro: Value = serde_json::from_str(&repro).unwrap();
        assert_eq!(repro["scenario"]["task"]["length"], case.waypoints.len(), "case {}", case.number);
        let vary = repro["scenario"]["vary"].as_object().unwrap();
        assert_eq!(vary.keys().collect::<Vec<_>>(), ["robot.mass_kg"]);
        let again = json(here, &["replay", &format!("a/repro/{:04}.json", case.number)]);
        assert_eq!(again["reproduces"], true, "{again}");
    }
    // With other words for it: missions made elsewhere were drawn by nobody.
    run(here, &["export", "a", "--to", "waypoints"]);
    json(here, &["execute", "a", "--missions", "a/export"]);
    let told = json(here, &["judge", "a"]);
    let keys: Vec<&str> =
        told["influences"].as_array().unwrap().iter().map(|one| one["key"].as_str().unwrap()).collect();
    assert!(!keys.contains(&"task.length") && keys.contains(&"robot.mass_kg"), "{told}");
}
