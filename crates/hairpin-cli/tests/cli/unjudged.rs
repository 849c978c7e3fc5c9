//! Asking for nothing is not passing: a scenario without a limit is refused unless it says so, and then nothing passes.

use std::fs;
use std::path::Path;

use crate::commands::{SMALL, json, refused, run, small_hull};
use serde_json::json;

/// Two cases of small graphs, `spec` in place of the limits.
fn without_limits(here: &Path, spec: &str) {
    let search = r#"{ method = "beam", waypoints = 60, cases = 2 }"#;
    let whole = small_hull(search);
    let (before, _) = whole.split_once("[spec]").unwrap();
    fs::write(here.join("q.toml"), before.replace("seed = 3", &format!("seed = 3\n{spec}"))).unwrap();
}

#[test]
fn a_scenario_without_a_limit_is_refused_before_anything_is_flown() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    without_limits(here, "");
    let words = ["q.toml", "`spec` = {}", "spec.deviation.max_m", "spec.total_time.max_s", "spec = \"none\""];
    for command in ["stress", "generate"] {
        refused(here, &[command, "q.toml", "--out", "a"], &words);
        assert!(!here.join("a").exists(), "{command}");
    }
    let (code, out, _) = run(here, &["stress", "q.toml", "--out", "a", "--json"]);
    let object: serde_json::Value = serde_json::from_str(&out).unwrap();
    assert!(code == 2 && object["mistakes"][0]["field"] == "spec", "{object}");
    // A share of nothing is no limit either, nor is a table without keys.
    for spec in ["spec = {}", "spec = { violation_share = 0.5 }", "spec = { confidence = 0.9 }"] {
        without_limits(here, spec);
        refused(here, &["stress", "q.toml", "--out", "a"], &["spec.deviation.max_m", "spec = \"none\""]);
    }
    without_limits(here, "spec = \"nothing\"");
    refused(here, &["stress", "q.toml", "--out", "a"], &["`spec` = \"nothing\"", "none"]);
    // Each kind of robot tells its own keys.
    for (kind, limits, key) in [
        ("rover", "{ limits = {} }", "spec.limits.path_deviation_m"),
        ("car", "{ limits = { violation_share = 0.05 } }", "spec.limits.total_time_s"),
        ("arm", "{}", "spec.path.max_mm, spec.arrival.max_late_ms, spec.regression.baseline"),
        ("boat", "{}", "spec.deviation.max_m"),
    ] {
        let set = format!("spec={limits}");
        refused(here, &["stress", kind, "--set", &set, "--out", "a"], &[key, "spec = \"none\""]);
    }
    assert!(!here.join("a").exists());
    // What flies nothing asks for no limit.
    without_limits(here, "");
    assert_ne!(run(here, &["explain", "q.toml", "--graphs", "1"]).0, 2);
}

#[test]
fn what_nothing_was_asked_of_is_unjudged() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    without_limits(here, "spec = \"none\"");
    let object = json(here, &["stress", "q.toml", "--out", "a"]);
    assert_eq!((&object["exit_code"], &object["counts"]["unjudged"]), (&json!(0), &json!(2)), "{object}");
    assert_eq!((&object["counts"]["pass"], &object["worst"]["status"]), (&json!(0), &json!("unjudged")), "{object}");
    let verdict = object["verdict"].as_str().unwrap();
    assert!(verdict.starts_with("UNJUDGED 2 (simulated, "), "{verdict}");
    assert!(!verdict.contains("3/N") && verdict.contains("spec = \"none\""), "{verdict}");
    let junit = fs::read_to_string(here.join("a/junit.xml")).unwrap();
    assert!(junit.contains("tests=\"2\"") && junit.matches("<skipped").count() == 2, "{junit}");
    assert!(!fs::read_to_string(here.join("a/report.html")).unwrap().contains("class=\"verdict pass\""));
    // The folder says it too, and every other command reads it.
    let kept = fs::read_to_string(here.join("a/scenario.toml")).unwrap();
    assert!(kept.contains("spec = \"none\""), "{kept}");
    assert_eq!(json(here, &["execute", "a"])["exit_code"], 0);
    assert!(json(here, &["judge", "a"])["verdict"].as_str().unwrap().starts_with("UNJUDGED 2 ("));
    for command in [&["report", "a"][..], &["verify", "a"], &["export", "a", "--to", "waypoints"]] {
        assert_eq!(run(here, command).0, 0, "{command:?}");
    }
    assert_eq!(run(here, &["select", "a", "--cases", "1", "--out", "one"]).0, 0);
    assert!(json(here, &["judge", "one"])["verdict"].as_str().unwrap().starts_with("UNJUDGED 1 ("));
    let resumed = json(here, &["stress", "q.toml", "--out", "a", "--resume"]);
    assert!(resumed["verdict"].as_str().unwrap().starts_with("UNJUDGED 2 ("), "{resumed}");
    // A limit takes the word's place, and the word that of the limits.
    let strict = json(here, &["judge", "a", "--set", "spec.deviation.max_m=0.0001"]);
    assert_eq!((&strict["exit_code"], &strict["counts"]["fail"]), (&json!(1), &json!(2)), "{strict}");
    let lax = json(here, &["judge", "a", "--set", "spec.deviation.max_m=500"]);
    assert_eq!((&lax["exit_code"], &lax["counts"]["pass"]), (&json!(0), &json!(2)), "{lax}");
    assert_eq!(json(here, &["judge", "a", "--set", "spec=none"])["counts"]["unjudged"], 2);
    refused(here, &["judge", "a", "--set", "spec={}"], &["spec.deviation.max_m", "spec = \"none\""]);
    // A folder of before, whose scenario says neither, is refused until it does.
    fs::write(here.join("a/scenario.toml"), kept.replace("spec = \"none\"\n", "")).unwrap();
    refused(here, &["judge", "a"], &["a/scenario.toml", "spec = \"none\""]);
    refused(here, &["execute", "a"], &["a/scenario.toml", "spec = \"none\""]);
    assert_eq!(json(here, &["judge", "a", "--set", "spec=none"])["counts"]["unjudged"], 2);
}

#[test]
fn crashes_and_broken_executors_count_all_the_same() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    without_limits(here, "spec = \"none\"");
    let minimal = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/executors/minimal_executor.py");
    let minimal = fs::read_to_string(minimal).unwrap();
    for (name, from, to) in [
        ("crash.py", "say(type=\"end\", reason=\"done\")", "say(type=\"end\", reason=\"crash\")"),
        ("late.py", "say(type=\"end\", reason=\"done\")", "say(type=\"end\", reason=\"time\")"),
        ("away.py", "p_m=points[-1]", "p_m=[90, 90, 90]"),
        ("none.py", "    points, t, i", "    raise SystemExit('rotor 3 is gone')\n    points, t, i"),
    ] {
        assert!(minimal.contains(from), "{name}");
        fs::write(here.join(name), minimal.replace(from, to)).unwrap();
    }
    run(here, &["generate", "q.toml", "--out", "a"]);
    for (name, code, start, status) in [
        ("crash.py", 1, "FAIL 2/2 (", "fail"),
        ("late.py", 0, "UNJUDGED 2 (", "unjudged"),
        ("away.py", 1, "FAIL 2/2 (", "fail"),
        ("none.py", 4, "EXECUTOR FAILED 2/2 (", "executor-failed"),
    ] {
        run(here, &["execute", "a", "--executor", &format!("python3 {name}")]);
        let object = json(here, &["judge", "a"]);
        assert_eq!((&object["exit_code"], &object["worst"]["status"]), (&json!(code), &json!(status)), "{object}");
        assert!(object["verdict"].as_str().unwrap().starts_with(start), "{name}: {object}");
    }
}

#[test]
fn a_limit_on_what_is_not_there_is_no_pass() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    without_limits(here, "spec = { clearance = { min_m = 0.3 } }");
    let object = json(here, &["stress", "q.toml", "--out", "a"]);
    assert_eq!((&object["exit_code"], &object["counts"]["inconclusive"]), (&json!(5), &json!(2)), "{object}");
    assert!(object["worst"]["message"].as_str().unwrap().contains("nothing that `spec` limits was measured"));
}

#[test]
fn a_share_that_the_cases_cannot_show_is_told_before_the_run() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let drawn = ["--set", "generate.search.method=uniform", "--set", "generate.search.waypoints=100"];
    let share = ["--set", "spec.violation_share=0.01", "--set", "spec.deviation.max_m=40"];
    let (code, out, error) = run(here, &[&SMALL[..], &drawn, &share, &["--out", "a"]].concat());
    assert_eq!(code, 5, "{out}{error}");
    let told =
        "`spec.violation_share` = 0.01: of 4 cases none can show so small a share at 95 % confidence; it takes 368";
    assert!(error.contains(told), "{error}");
    let (_, _, error) = run(here, &["execute", "a"]);
    assert!(error.contains(told), "{error}");
    // Told before: also where nothing is found in no time.
    let (_, _, error) = run(
        here,
        &[
            "generate",
            "rover",
            "--set",
            "spec.limits={ path_deviation_m = 1, violation_share = 0.1, confidence = 0.99 }",
            "--set",
            "generate.search.cases=50",
            "--set",
            "generate.search.method=uniform",
            "--time-limit",
            "0",
            "--out",
            "b",
        ],
    );
    assert!(
        error.contains("`spec.limits.violation_share` = 0.1: of 50 cases") && error.contains("it takes 51"),
        "{error}"
    );
    // Of cases that are searched the count decides, and any number of them shows it.
    let (code, out, error) = run(here, &[&SMALL[..], &share, &["--out", "c"]].concat());
    assert!(code == 0 && out.contains("; 0 of 4 searched violate, within the 1 % allowed of them; "), "{out}{error}");
    assert!(!error.contains("violation_share") && !out.contains("3/N"), "{out}{error}");
    // As shipped, scenarios have as many cases as their share takes.
    for kind in ["rover", "car", "differential-drive"] {
        let (_, _, error) = run(here, &["generate", kind, "--time-limit", "0", "--out", kind]);
        assert!(!error.contains("violation_share"), "{kind}: {error}");
    }
}

#[test]
fn programs_of_a_cloud_are_read_by_what_comes_after() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    fs::write(here.join("p.csv"), "x_mm,y_mm,z_mm\n300,0,300\n300,100,300\n350,0,350\n").unwrap();
    fs::write(here.join("cell.toml"), "hairpin = 1\nrobot = \"irb120\"\n[task]\npoints = \"p.csv\"\n").unwrap();
    for cell in ["irb120", "cell.toml"] {
        let out = format!("of-{cell}");
        assert_eq!(json(here, &["max-load", "--cloud", "p.csv", cell, "--out", &out])["exit_code"], 0, "{cell}");
        assert_eq!(json(here, &["execute", &out])["exit_code"], 0, "{cell}");
        assert!(json(here, &["judge", &out])["verdict"].as_str().unwrap().starts_with("UNJUDGED 1 ("), "{cell}");
    }
    refused(here, &["stress", "cell.toml", "--out", "no"], &["spec.path.max_mm", "spec = \"none\""]);
    // One point that can be met is nothing to load an arm with.
    fs::write(here.join("one.csv"), "x_mm,y_mm,z_mm\n300,0,300\n9000,0,300\n9000,100,300\n").unwrap();
    let object = json(here, &["max-load", "--cloud", "one.csv", "irb120"]);
    assert_eq!(
        (&object["exit_code"], &object["path"], &object["cost"]),
        (&json!(3), &json!(null), &json!(null)),
        "{object}"
    );
    let (code, out, _) = run(here, &["max-load", "--cloud", "one.csv", "irb120"]);
    assert!(code == 3 && out.starts_with("NOTHING FEASIBLE: no move from one point of the cloud"), "{out}");
}
