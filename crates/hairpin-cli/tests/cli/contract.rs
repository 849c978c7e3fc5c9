//! What other programs count on: where files are written, one JSON document on stdout and nothing else, and that what
//! is not known is said to be unknown.

use std::fs;
use std::path::Path;
use std::process::Command;

use crate::commands::without_baseline;
use serde_json::{Value, json};

const SMALL: [&str; 6] = ["stress", "demo-quadrotor", "--set", "generate.search.cases=2", "--set", "execute.repeat=1"];
const MINIMAL: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/executors/minimal_executor.py");

/// Exit code, stdout, stderr.
fn run(folder: &Path, arguments: &[&str]) -> (i32, String, String) {
    let mut command = Command::new(env!("CARGO_BIN_EXE_hairpin"));
    command.current_dir(folder).args(without_baseline(arguments)).env("XDG_STATE_HOME", folder.join(".state"));
    let output = command.output().unwrap();
    let text = |bytes| String::from_utf8(bytes).expect("UTF-8");
    (output.status.code().expect("no signal"), text(output.stdout), text(output.stderr))
}

/// All of stdout as one document, with its exit code, and stderr.
fn json(folder: &Path, arguments: &[&str]) -> (Value, String) {
    let (code, out, error) = run(folder, &[arguments, &["--json"]].concat());
    let object: Value = serde_json::from_str(&out).unwrap_or_else(|e| panic!("{arguments:?}: {e}: {out}{error}"));
    assert_eq!(object["exit_code"], code, "{arguments:?}: {object}");
    (object, error)
}

fn text(path: &Path) -> String {
    fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// The executor of the examples with `line` first in its `fly`.
fn executor(folder: &Path, name: &str, line: &str) -> String {
    let head = "def fly(mission, speed=2.0, step=0.02):";
    let program = text(Path::new(MINIMAL)).replace(head, &format!("{head}\n    {line}"));
    assert!(program.contains(line));
    fs::write(folder.join(name), program).unwrap();
    format!("python3 {name}")
}

#[test]
fn exports_stand_in_a_folder_of_the_campaign_and_are_told() {
    let place = tempfile::tempdir().unwrap();
    run(place.path(), &[&SMALL[..], &["--out", "a"]].concat());
    let (object, error) = json(place.path(), &["export", "a", "--to", "waypoints,csv,tum"]);
    assert!(error.is_empty(), "{error}");
    let told: Vec<&str> = object["files"].as_array().unwrap().iter().map(|file| file.as_str().unwrap()).collect();
    let names = ["0000.csv", "0001.csv", "0000.planned.csv", "0000-0.csv", "0001.planned.csv"];
    let more = ["0001-0.csv", "0000.ref.tum", "0000.exec.tum", "0001.ref.tum", "0001.exec.tum"];
    let expected: Vec<String> = names.iter().chain(&more).map(|name| format!("a/export/{name}")).collect();
    assert_eq!(told, expected);
    assert!(told.iter().all(|file| place.path().join(file).is_file()));
    assert_eq!((&object["attitude_unknown"], &object["missing"]), (&json!([]), &json!([])));
    let (code, out, error) = run(place.path(), &["export", "a", "--to", "tum"]);
    assert_eq!((code, out.lines().collect::<Vec<_>>()), (0, expected[6..].iter().map(String::as_str).collect()));
    assert!(error.contains("evo_ape"), "it says who opens them: {error}");

    // What was made of flights goes with them; other people's files stay.
    for name in ["a/mine.csv", "a/export/mine.csv"] {
        fs::write(place.path().join(name), "1").unwrap();
    }
    run(place.path(), &["execute", "a"]);
    let there = |name: &str| place.path().join("a").join(name).exists();
    assert!(!there("export/0000.exec.tum") && !there("export/0000-0.csv"));
    assert!(there("mine.csv") && there("export/mine.csv") && there("export/0001.csv"), "missions are of the cases");
    // Another campaign in their place has none of them.
    run(place.path(), &[&SMALL[..], &["--out", "a", "--force"]].concat());
    assert!(!there("export/0001.csv") && there("export/mine.csv"));
}

#[test]
fn a_few_cases_are_exported_by_name_or_the_worst() {
    let place = tempfile::tempdir().unwrap();
    run(place.path(), &[&SMALL[..], &["--set", "generate.search.cases=3", "--out", "a"]].concat());
    let files = |more: &[&str]| {
        let (object, _) = json(place.path(), &[&["export", "a", "--to", "waypoints"], more].concat());
        object["files"].as_array().unwrap().iter().map(|file| file.as_str().unwrap().to_owned()).collect::<Vec<_>>()
    };
    assert_eq!(files(&["--case", "0002", "--case", "1"]), ["a/export/0001.csv", "a/export/0002.csv"]);
    let worst = json(place.path(), &["judge", "a"]).0["worst"]["case"].as_str().unwrap().to_owned();
    assert_eq!(files(&["--worst", "1"]), [format!("a/export/{worst}.csv")]);
    for (more, words) in [
        (["--case", "7"], ["--case 0007", "the cases 0000, 0001, 0002"]),
        (["--worst", "4"], ["--worst 4", "at most 3"]),
    ] {
        let (code, _, error) = run(place.path(), &[&["export", "a", "--to", "waypoints"][..], &more].concat());
        assert!(code == 2 && words.iter().all(|word| error.contains(word)), "{error}");
    }
}

#[test]
fn an_end_that_nobody_told_is_said_wherever_a_verdict_rests_on_it() {
    let place = tempfile::tempdir().unwrap();
    let poses = "[say(type='pose', t_s=t, p_m=p) for t, p in enumerate(mission['waypoints_m'])]";
    for (name, told, unsaid) in [("told", "", 0), ("assumed", ", assumed=True", 2)] {
        let end = format!("return say(type='end', reason='done'{told})");
        let program = executor(place.path(), &format!("{name}.py"), &format!("{poses}\n    {end}"));
        let (object, error) = json(place.path(), &[&SMALL[..], &["--executor", &program, "--out", name]].concat());
        assert_eq!(object["counts"]["executor_failed"], 0, "{object}{error}");
        assert_eq!(error.contains("did not say how 2 of 2 runs ended"), unsaid > 0, "{error}");
        let page = fs::read_to_string(place.path().join(name).join("report.html")).unwrap();
        assert_eq!(page.contains("did not say how 2 of 2 runs ended"), unsaid > 0);
        assert_eq!(json(place.path(), &["execute", name]).0["counts"]["end_unsaid"], unsaid);
    }
    // Who says nothing at all has made a mistake.
    let silent = executor(place.path(), "silent.py", &format!("{poses}\n    return say(type='end')"));
    let (object, _) = json(place.path(), &[&SMALL[..], &["--executor", &silent, "--out", "silent"]].concat());
    assert_eq!(object["counts"]["executor_failed"], 2, "{object}");
}

#[test]
fn an_unknown_attitude_is_said_wherever_one_would_be_read() {
    let place = tempfile::tempdir().unwrap();
    let pose = "say(type='pose', t_s=0, p_m=[3, 3, 3])\n    say(type='pose', t_s=1, p_m=[3, 3, 4])";
    let silent = executor(place.path(), "silent.py", &format!("{pose}\n    return say(type='end', reason='time')"));
    let (object, error) = json(place.path(), &[&SMALL[..], &["--executor", &silent, "--out", "a"]].concat());
    assert_eq!(object["counts"]["attitude_unknown"], 2, "{object}");
    assert!(error.contains("2 runs came without q_wxyz"), "{error}");
    assert_eq!(json(place.path(), &["judge", "a"]).0["counts"]["attitude_unknown"], 2);
    let (object, error) = json(place.path(), &["export", "a", "--to", "tum"]);
    assert_eq!(object["attitude_unknown"], json!(["a/export/0000.exec.tum", "a/export/0001.exec.tum"]));
    assert!(error.contains("attitude is unknown in 2 files, such as a/export/0000.exec.tum"), "{error}");
    // A plan without a witness has no attitudes either.
    let steps = ["--set", "generate.reach=hull", "--set", "generate.timing.step_s=1.0", "--out", "b"];
    run(place.path(), &[&SMALL[..], &steps].concat());
    let (object, _) = json(place.path(), &["export", "b", "--to", "tum,csv"]);
    let unknown = ["0000.ref.tum", "0001.ref.tum", "0000.planned.csv", "0001.planned.csv"];
    assert_eq!(object["attitude_unknown"], json!(unknown.map(|name| format!("b/export/{name}"))));
}

#[test]
fn what_has_no_track_is_told_and_hides_nothing_else() {
    let place = tempfile::tempdir().unwrap();
    let broken = executor(place.path(), "broken.py", "if mission['case'] == '0001': raise SystemExit('no')");
    run(place.path(), &[&SMALL[..], &["--executor", &broken, "--out", "a"]].concat());
    let (object, _) = json(place.path(), &["export", "a", "--to", "tum"]);
    assert_eq!(object["files"], json!(["a/export/0000.ref.tum", "a/export/0000.exec.tum"]));
    assert_eq!(object["missing"], json!(["case 0001 has no .tum: its executor failed"]));
}

#[test]
fn missions_are_the_cases_asked_for() {
    let place = tempfile::tempdir().unwrap();
    run(place.path(), &["generate", "demo-quadrotor", "--set", "generate.search.cases=2", "--out", "a"]);
    fs::create_dir(place.path().join("mine")).unwrap();
    for (name, height) in [("up", 9), ("low", 4), ("mid", 6)] {
        let file = format!("x_m,y_m,z_m\n3,3,3\n3,3,{height}\n9,3,{height}\n");
        fs::write(place.path().join(format!("mine/{name}.csv")), file).unwrap();
    }
    let (object, _) = json(place.path(), &["execute", "a", "--missions", "mine", "--set", "execute.repeat=1"]);
    assert_eq!(object["missions"], json!(["low", "mid", "up"]), "in the order of their cases");
    let (object, _) = json(place.path(), &["judge", "a"]);
    assert_eq!((&object["counts"]["asked"], &object["counts"]["cases"]), (&json!(3), &json!(3)));
    let junit = text(&place.path().join("a/junit.xml"));
    assert!(junit.contains("tests=\"3\"") && !junit.contains("<skipped"), "{junit}");
    let resumed = ["generate", "demo-quadrotor", "--set", "generate.search.cases=2", "--out", "a", "--resume"];
    let (code, _, error) = run(place.path(), &[&resumed[..], &["--set", "execute.repeat=1"]].concat());
    assert!(code == 2 && error.contains("missions made elsewhere"), "{error}");
}

#[test]
fn five_is_never_a_pass() {
    let place = tempfile::tempdir().unwrap();
    // No violation in two cases at random says nothing of one in a hundred.
    let lenient = ["--set", "spec.deviation.max_m=40", "--set", "spec.violation_share=0.01", "--out", "a"];
    let drawn = ["--set", "generate.search.method=uniform", "--set", "generate.search.waypoints=100"];
    let (object, _) = json(place.path(), &[&SMALL[..], &drawn, &lenient].concat());
    assert_eq!((&object["exit_code"], &object["counts"]["pass"]), (&json!(5), &json!(2)), "{object}");
    let share = &object["share"];
    assert_eq!((&share["cases"], &share["violated"], &share["of"]), (&json!("random"), &json!(0), &json!(2)));
    assert!(share["high"].as_f64().unwrap() > 0.8, "{share}");
    let junit = text(&place.path().join("a/junit.xml"));
    assert!(junit.contains("tests=\"2\" failures=\"0\" errors=\"2\""), "{junit}");
    assert!(junit.contains("type=\"Inconclusive\"") && junit.contains("straddles"), "{junit}");
    // Nothing was found in no time: that is no proof that there is nothing.
    let (code, out, _) = run(place.path(), &[&SMALL[..], &["--time-limit", "0", "--out", "b"]].concat());
    assert_eq!(code, 5, "{out}");
    assert!(out.lines().last().unwrap().starts_with("INCONCLUSIVE 0/2 (0 graphs searched, witness): "), "{out}");
    assert!(text(&place.path().join("b/junit.xml")).contains("errors=\"2\""));
    let generate = [&["generate"], &SMALL[1..], &["--time-limit", "0", "--out", "c"]].concat();
    let (object, _) = json(place.path(), &generate);
    assert_eq!((&object["exit_code"], &object["counts"]["cases"]), (&json!(0), &json!(0)));
}

#[test]
fn every_answer_for_machines_is_one_document() {
    let place = tempfile::tempdir().unwrap();
    assert_eq!(json(place.path(), &["new", "quadrotor"]).0["file"], "quadrotor.toml");
    run(place.path(), &[&SMALL[..], &["--out", "a"]].concat());
    let (object, _) = json(place.path(), &["report", "a"]);
    assert_eq!(object["report"], "a/report.html");
    for wrong in [
        &["stress", "quadrotor.toml", "--threads", "0"][..],
        &["stres", "quadrotor.toml"],
        &["export", "a", "--to", "plan9"],
        &["export", "nowhere", "--to", "tum"],
        &["new", "quadrotor"],
        &["report", "nowhere"],
    ] {
        let (object, error) = json(place.path(), wrong);
        assert_eq!(object["exit_code"], 2, "{wrong:?}");
        assert!(!object["error"].as_str().unwrap().is_empty() && !error.is_empty(), "{wrong:?}: {object}");
    }
}

/// Clap says on lines of their own what is missing, what is possible and what may have been meant.
#[test]
fn wrong_usage_is_told_to_machines_as_a_whole() {
    let place = tempfile::tempdir().unwrap();
    for (wrong, told) in [
        (&["fit", "a.csv"][..], "the following required arguments were not provided: --robot <"),
        (&["fit", "a.csv"], "; --out <"),
        (
            &["steer", "generic", "--to", "1,0,0", "--cost", "none"],
            "for '--cost <NAME>' [possible values: any, curvature,",
        ),
        (
            &["stress", "quadrotor.toml", "--thread", "1"],
            "unexpected argument '--thread' found; tip: a similar argument exists: '--threads'",
        ),
        (&["max-load", "--graph", "g.csv", "--out", "o"], " cannot be used with '--"),
    ] {
        let (object, error) = json(place.path(), wrong);
        let sentence = object["error"].as_str().unwrap();
        assert!(sentence.contains(told), "{sentence}");
        assert!(!sentence.contains('\n') && !sentence.contains("Usage"), "{sentence}");
        assert!(!sentence.contains("more information") && error.contains("more information"), "{sentence}: {error}");
    }
}

#[test]
fn a_share_has_an_interval_where_it_estimates_something() {
    let place = tempfile::tempdir().unwrap();
    let strict = ["--set", "spec.deviation.max_m=0.001"];
    let (object, _) = json(place.path(), &[&SMALL[..], &strict, &["--out", "a"]].concat());
    let verdict = object["verdict"].as_str().unwrap();
    assert!(verdict.contains("; 2 of 2 searched violate; ") && !verdict.contains(['[', ']']), "{verdict}");
    assert_eq!(object["share"], json!({ "cases": "searched", "violated": 2, "of": 2, "low": null, "high": null }));
    assert_eq!(object["worst"]["draws"], Value::Null);
    let junit = text(&place.path().join("a/junit.xml"));
    assert!(junit.contains("<property name=\"cases\" value=\"searched\"/>"), "{junit}");
    let page = text(&place.path().join("a/report.html"));
    assert!(page.contains("of cases that were searched: no estimate of how often others do"));
    // Some of a campaign's are no estimate of it, whatever it was.
    run(place.path(), &["select", "a", "--cases", "1", "--by", "stress", "--out", "few"]);
    let (object, _) = json(place.path(), &["judge", "few"]);
    assert!(object["verdict"].as_str().unwrap().contains("; 1 of 1 selected violate; "), "{object}");
    // The draws within one case are at random.
    let windy = ["--set", "execute.repeat=9", "--set", "generate.search.cases=1", "--out", "b"];
    let (object, _) = json(place.path(), &[&SMALL[..2], &strict, &windy].concat());
    let told = "; 8 of 8 draws of `[vary]` violate: share 100.0 % [63.1, 100.0]; ";
    assert!(object["verdict"].as_str().unwrap().contains(told), "{object}");
    let draws = &object["worst"]["draws"];
    assert_eq!((&draws["violated"], &draws["of"], &draws["high"]), (&json!(8), &json!(8), &json!(1.0)), "{draws}");
    assert!((draws["low"].as_f64().unwrap() - 0.025_f64.powf(1.0 / 8.0)).abs() < 1e-9, "{draws}");
    // A report is made of what the folder holds, and says the same.
    assert_eq!(json(place.path(), &["report", "b"]).0["verdict"], object["verdict"]);
}

#[test]
fn a_flight_is_judged_from_the_path_that_its_controller_follows() {
    let place = tempfile::tempdir().unwrap();
    let largest = |controller: &str, from: &str| {
        let out = format!("{controller}-{from}");
        let controller = format!("execute.controller={controller}");
        let from = format!("spec.deviation.from={from}");
        let sets = ["--set", &controller, "--set", &from, "--out", &out];
        let (object, _) = json(place.path(), &[&SMALL[..], &sets].concat());
        let told = object["worst"]["max_deviation_m"].as_f64().unwrap();
        // The report measures from the same path.
        assert_eq!(json(place.path(), &["report", &out]).0["verdict"], object["verdict"]);
        told
    };
    // A minimum-snap curve swings out of the legs by metres; its controller stays near it.
    let [leg, path] = ["leg", "path"].map(|from| largest("minimum-snap", from));
    assert!(leg > 3.0 && path < 0.5 * leg, "{leg} {path}");
    let page = text(&place.path().join("minimum-snap-path/report.html"));
    assert!(page.contains("the distance from the curve that the controller makes of the waypoints"));
    // Others follow the plan, or the legs.
    assert!(largest("geometric", "path") < 0.2 && largest("geometric", "leg") > 3.0);
    assert!(largest("stable-waypoint", "leg") < largest("stable-waypoint", "path"));
}
