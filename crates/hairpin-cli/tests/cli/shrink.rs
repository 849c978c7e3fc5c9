//! `hairpin shrink`, and saved cases that later runs begin with.

use std::fs;
use std::path::Path;

use crate::commands::{SMALL, json, refused, run};
use serde_json::Value;

const WIND: &str = "vary.\"world.wind_m_s\".uniform=[[-1,-1,0],[1,1,0]]";

/// A campaign whose worst case violates and the number of that case.
fn violating(here: &Path, more: &[&str]) -> String {
    let limit = |m: f64| format!("spec.deviation.max_m={m}");
    let first = json(here, &[&SMALL[..], &["--out", "a"], more].concat());
    let worst = first["worst"]["max_deviation_m"].as_f64().unwrap();
    let judged = json(here, &["judge", "a", "--set", &limit(0.8 * worst)]);
    assert_eq!(judged["exit_code"], 1);
    judged["worst"]["case"].as_str().unwrap().to_owned()
}

fn read(path: &Path) -> Value {
    serde_json::from_str(&fs::read_to_string(path).unwrap()).unwrap()
}

#[test]
fn a_witnessed_flight_gets_shorter_and_violates_still() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let case = violating(here, &["--set", WIND, "--set", "execute.repeat=2"]);
    let (code, out, error) = run(here, &["shrink", "a", "--case", &case]);
    assert_eq!(code, 0, "{out}{error}");
    let lines: Vec<&str> = out.lines().collect();
    assert!(lines[0].starts_with(&format!("case {case}: 8 waypoints, deviation ")), "{out}");
    assert!(
        lines[1].starts_with("8 waypoints -> ") && lines[1].contains(", still ") && lines[1].contains(" runs, "),
        "{out}"
    );

    let file = here.join(format!("a/repro/{case}-shrunk.json"));
    let repro = read(&file);
    let waypoints = repro["waypoints_m"].as_array().unwrap().len();
    assert!((2..8).contains(&waypoints), "{waypoints} waypoints are not fewer than 8");
    assert_eq!((&repro["evidence"], &repro["shrunk"]["waypoints"]), (&"witnessed".into(), &8.into()));
    assert_eq!(repro["profile"].as_array().unwrap().len(), waypoints - 1, "every leg has its witness");
    let again = json(here, &["replay", file.to_str().unwrap()]);
    assert_eq!((&again["exit_code"], &again["reproduces"]), (&1.into(), &true.into()), "{again}");

    // Asked again, it knows the answers and writes the same file.
    let before = fs::read(&file).unwrap();
    let object = json(here, &["shrink", "a", "--case", &case]);
    assert_eq!((&object["waypoints"], &object["finished"]), (&waypoints.into(), &true.into()));
    assert!(object["runs_now"] == 0 && fs::read(&file).unwrap() == before, "{object}");

    // Later runs begin with it, by their own spec, and keep it.
    let (code, _, error) = run(here, &["execute", "a"]);
    assert!(
        code == 0 && error.contains("saved cases first: ") && error.contains("-shrunk.json: deviation "),
        "{error}"
    );
    let object =
        json(here, &[&SMALL[..], &["--out", "b", "--set", "spec.deviation.max_m=90", "--repro", "a/repro"]].concat());
    assert_eq!(object["exit_code"], 0, "{object}");
    assert!(object["replayed"].as_array().unwrap().iter().all(|one| one["status"] == "pass"), "{object}");
    let strict =
        [&SMALL[..], &["--out", "c", "--set", "spec.deviation.max_m=89", "--set", "spec.acceleration.max_m_s2=0.1"]];
    let object = json(here, &[&strict.concat()[..], &["--repro", "a/repro"]].concat());
    assert!(object["replayed"].as_array().unwrap().iter().all(|one| one["status"] == "fail"), "{object}");
    run(here, &["judge", "a"]);
    assert!(file.is_file(), "judging keeps shrunk cases");
    refused(here, &[&SMALL[..], &["--out", "d", "--repro", "missing"]].concat(), &["--repro missing", "no repro file"]);
}

#[test]
fn a_search_that_stops_goes_on_to_the_same_end() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let hull = ["--set", "generate.reach=\"hull\"", "--set", "generate.timing={step_s=1.0}"];
    let case = violating(here, &hull);
    let whole = json(here, &["shrink", "a", "--case", &case, "--budget", "400"]);
    assert_eq!((&whole["finished"], &whole["evidence"]), (&true.into(), &"hull-feasible".into()), "{whole}");
    let file = here.join(format!("a/repro/{case}-shrunk.json"));
    let at_once = fs::read(&file).unwrap();
    fs::remove_file(&file).unwrap();
    fs::remove_file(here.join(format!("a/repro/{case}-shrink.state"))).unwrap();

    let part = json(here, &["shrink", "a", "--case", &case, "--budget", "3"]);
    assert_eq!((&part["finished"], &part["runs_now"]), (&false.into(), &3.into()));
    assert!(file.is_file(), "the smallest so far is kept");
    let rest = json(here, &["shrink", "a", "--case", &case, "--budget", "400"]);
    assert_eq!(rest["runs"], whole["runs"]);
    assert_eq!(fs::read(&file).unwrap(), at_once);
}

#[test]
fn drives_and_programs_get_shorter_too() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let rover = ["stress", "demo-rover", "--out", "rover", "--set", "generate.search.cases=1"];
    for (arguments, witness) in [(&rover[..], "drive"), (&["stress", "demo-arm", "--out", "arm"][..], "program")] {
        let worst = json(here, arguments)["worst"].clone();
        let (name, case) = (arguments[3], worst["case"].as_str().unwrap());
        assert_eq!(worst["status"], "fail", "{worst}");
        let object = json(here, &["shrink", name, "--case", case]);
        let (before, after) = (object["waypoints_before"].as_u64().unwrap(), object["waypoints"].as_u64().unwrap());
        assert!(after < before && object["finished"] == true, "{object}");
        assert!(object["value"].as_f64().unwrap() > object["limit"].as_f64().unwrap(), "{object}");
        let file = object["repro"].as_str().unwrap();
        let repro = read(&here.join(file));
        assert!(!repro[witness].is_null() && repro["waypoints_m"].as_array().unwrap().len() as u64 == after);
        let again = json(here, &["replay", file]);
        assert_eq!((&again["exit_code"], &again["reproduces"]), (&1.into(), &true.into()), "{again}");
    }
}

#[test]
fn what_cannot_be_shrunk_is_said() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    run(here, &[&SMALL[..], &["--out", "a", "--set", "spec.deviation.max_m=50"]].concat());
    refused(here, &["shrink", "a", "--case", "0"], &["case 0000 does not violate", "nothing to shrink"]);
    refused(here, &["shrink", "a", "--case", "77"], &["--case 77", "cases 0000, 0001, 0002, 0003"]);
    // A choice keeps its numbers, and a folder without cases is told to have none.
    let worst = json(here, &["select", "a", "--cases", "1", "--by", "stress", "--out", "one"])["cases"][0].clone();
    let told = format!("the case {} alone", worst.as_str().unwrap());
    refused(here, &["shrink", "one", "--case", "77"], &["--case 77", &told]);
    run(here, &[&SMALL[..], &["--out", "none", "--set", "generate.limits.max_speed_m_s=0.01"]].concat());
    refused(here, &["shrink", "none", "--case", "0"], &["--case 0", "no cases"]);
}

/// A program may refuse what it cannot fly; only one that flies not even the case itself has failed.
#[test]
fn a_program_that_refuses_candidates_does_not_end_the_search() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let minimal = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/executors/minimal_executor.py");
    let minimal = fs::read_to_string(minimal).unwrap();
    let picky = "        if len(message[\"waypoints_m\"]) < 5:\n            say(type=\"error\", message=\"five or more\")\n            continue\n        fly(message)\n";
    let picky = minimal.replace("        fly(message)\n", picky);
    assert_ne!(picky, minimal);
    fs::write(here.join("picky.py"), &picky).unwrap();
    let fly = ["--executor", "python3 picky.py", "--set", "execute.repeat=1", "--set", "execute.baseline=0"];
    let fast = ["--set", "spec.total_time.max_s=0.5", "--out", "a"];
    let object = json(here, &[&SMALL[..], &fly, &fast].concat());
    assert_eq!(object["worst"]["status"], "fail", "{object}");
    let case = object["worst"]["case"].as_str().unwrap();
    let (code, out, error) = run(here, &["shrink", "a", "--case", case, "--budget", "15", "--json"]);
    let shrunk: Value = serde_json::from_str(&out).unwrap();
    let waypoints = shrunk["waypoints"].as_u64().unwrap();
    assert!(code == 0 && (5..8).contains(&waypoints), "{out}{error}");
    assert!(error.contains(" candidates were not flown, and count as within spec: reports: five or more"), "{error}");

    fs::remove_file(here.join(format!("a/repro/{case}-shrink.state"))).unwrap();
    fs::write(here.join("picky.py"), minimal.replace("        fly(message)\n", "        sys.exit(\"no\")\n")).unwrap();
    let (code, _, error) = run(here, &["shrink", "a", "--case", case]);
    assert!(code == 4 && error.contains("the executor failed"), "{error}");
}
