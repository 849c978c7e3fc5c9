//! `check-executor`: a sound program passes, each mistake has its sentence, and what was said is shown.
#![cfg(unix)]

use std::path::Path;
use std::process::Command;
use std::time::{Duration, Instant};

use crate::commands::{json, refused, run};
use serde_json::{Value, json};

const MISBEHAVING: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/hostile/misbehaving_executor.py");
const MINIMAL: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/executors/minimal_executor.py");

fn checked(kind: &str) -> Value {
    let place = tempfile::tempdir().unwrap();
    let command = format!("python3 '{MISBEHAVING}' {kind}");
    json(place.path(), &["check-executor", &command, "--timeout", "1"])
}

fn step<'a>(checked: &'a Value, name: &str) -> &'a Value {
    let steps = checked["steps"].as_array().unwrap();
    steps.iter().find(|step| step["step"] == name).unwrap_or_else(|| panic!("no {name}: {checked}"))
}

#[test]
fn a_sound_program_passes_and_is_measured() {
    let all = checked("sound");
    assert_eq!((&all["exit_code"], &all["verdict"]), (&json!(0), &json!("PASS 7/7 steps (straight line)")), "{all}");
    assert_eq!(
        all["program"],
        json!({ "name": "straight line", "version": "3", "protocol": 2, "deterministic": true })
    );
    assert_eq!(
        (&all["again"]["same_process"]["same"], &all["again"]["new_process"]["same"]),
        (&json!(true), &json!(true))
    );
    assert!(all["speed"]["executions_per_s"].as_f64().unwrap() > 1.0, "{all}");
    let said = step(&all, "mission")["said"].as_array().unwrap();
    let mission: Value = serde_json::from_str(said[2]["line"].as_str().unwrap()).unwrap();
    assert_eq!(
        (&said[2]["by"], &mission["type"], mission["waypoints_m"].as_array().unwrap().len()),
        (&json!("hairpin"), &json!("mission"), 4)
    );
    assert_eq!(mission["yaw_rad"], json!([0.0, 0.0, 0.0, 0.0]));
    assert_eq!(mission["limits"], json!({ "max_speed_m_s": 6.0, "max_tilt_deg": 45.0 }));
    assert_eq!(mission["accept"]["radius_m"], mission["accept_m"]);
    assert_eq!(
        step(&all, "refusal")["findings"][0]["sentence"],
        "a mission without waypoints is refused: no waypoints"
    );
}

#[test]
fn every_mistake_has_its_sentence() {
    for (kind, place, sentence) in [
        ("hang", "mission", "time-out: no \"end\" within 1 s (execute.timeout_s)"),
        ("slow", "mission", "time-out: no \"end\" within 1 s (execute.timeout_s)"),
        ("flood", "mission", "does not follow"),
        ("nan", "mission", "NaN is no JSON number: must be finite"),
        ("ned", "mission", "as NED has it"),
        ("falling-leg", "mission", "leg = 0 after 2: must never fall"),
        ("mixed-leg", "mission", "must be in all poses or in none"),
        ("exit", "mission", "ended without \"end\" (exit status: 1); the last line of its stderr: rotor 3 is gone"),
        // Whose answer comes first is chance, and so is when: after the other's, amid it, or amid the next one's.
        ("fork", "", "sent more after its \"end\"|is no message|does not follow|must be 0"),
        ("twice", "again", "sent more after its \"end\", where one mission has one answer"),
        ("noise", "again", "though it says that it is deterministic"),
        ("short", "mission", "says \"done\" and comes no nearer than"),
        (
            "banner",
            "handshake",
            "is no message: expected value at line 1 column 1; it reads `Simulator 3.1, copyright everybody` (log to stderr",
        ),
        ("stays", "bye", "does not exit within 2 s of \"bye\""),
    ] {
        let begun = Instant::now();
        let all = checked(kind);
        assert_eq!(all["exit_code"], 4, "{kind}: {all}");
        let steps = all["steps"].as_array().unwrap().iter().filter(|step| place.is_empty() || step["step"] == place);
        let mut findings = steps.flat_map(|step| step["findings"].as_array().unwrap());
        let told = |one: &Value| {
            one["kind"] == "mistake"
                && sentence.split('|').any(|words| one["sentence"].as_str().unwrap().contains(words))
        };
        assert!(findings.any(told), "{kind}: {all}");
        assert!(all["verdict"].as_str().unwrap().starts_with("EXECUTOR FAILED ("), "{kind}: {}", all["verdict"]);
        assert!(begun.elapsed() < Duration::from_secs(30), "{kind}: {:?}", begun.elapsed());
    }
}

#[test]
fn what_was_said_is_shown() {
    let place = tempfile::tempdir().unwrap();
    let (code, out, error) = run(place.path(), &["check-executor", &format!("python3 '{MINIMAL}'")]);
    assert_eq!(code, 0, "{out}{error}");
    for words in [
        "handshake: minimal executor, protocol 1;",
        "    > {\"type\":\"hello\",\"hairpin\":2}",
        "    > {\"type\":\"hello\",\"hairpin\":1}",
        "    < {\"type\": \"ready\", \"protocol\": 1, \"name\": \"minimal executor\"}",
        "more characters)",
        "more lines (--json has them)",
        "  remark: ",
        "PASS 7/7 steps (minimal executor)",
    ] {
        assert!(out.contains(words), "{words}: {out}");
    }
    assert!(out.lines().all(|line| line.chars().count() < 240), "{out}");
}

#[test]
fn other_robots_and_wrong_words() {
    let place = tempfile::tempdir().unwrap();
    let command = format!("python3 '{MISBEHAVING}'");
    let all = json(place.path(), &["check-executor", &command, "--scenario", "demo-rover"]);
    assert_eq!(all["exit_code"], 0, "{}", all["verdict"]);
    let said = step(&all, "mission")["said"].as_array().unwrap();
    let mission: Value = serde_json::from_str(said[2]["line"].as_str().unwrap()).unwrap();
    let (waypoints, yaws) = (mission["waypoints_m"].as_array().unwrap(), mission["yaw_rad"].as_array().unwrap());
    assert_eq!(waypoints.len(), yaws.len());
    assert!(yaws.iter().any(|yaw| yaw.as_f64().unwrap().abs() > 0.01), "{yaws:?}");
    refused(place.path(), &["check-executor", ""], &["execute.command"]);
    refused(place.path(), &["check-executor", "python3 'x"], &["a quote that never ends"]);
    refused(place.path(), &["check-executor", &command, "--timeout", "0"], &["execute.timeout_s"]);
    refused(place.path(), &["check-executor", &command, "--scenario", "nowhere.toml"], &["nowhere.toml"]);
    let absent = json(place.path(), &["check-executor", "no-such-program"]);
    assert_eq!(absent["exit_code"], 4);
    assert!(absent["verdict"].as_str().unwrap().contains("cannot start `no-such-program`"), "{}", absent["verdict"]);
}

const EXAMPLES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/executors");

/// Lines of the user's own part.
fn own_lines(file: &str) -> usize {
    let text = std::fs::read_to_string(format!("{EXAMPLES}/{file}")).unwrap();
    let own = text.lines().skip_while(|line| !line.contains("---- yours")).skip(1);
    own.take_while(|line| !line.contains("---- the ")).count()
}

/// What the default search finds with it is worse than what chance does.
fn is_stressed(place: &Path, command: &str) {
    let search = "generate.search={ method = \"worst\", executions = 20, cases = 2 }";
    let sets = ["--set", search, "--set", "execute.repeat=1", "--set", "execute.baseline=10", "--set", "task.length=5"];
    let told = json(
        place,
        &[&["stress", "demo-quadrotor", "--executor", command, "--out", "out", "--force"], &sets[..]].concat(),
    );
    assert_eq!(told["counts"]["executor_failed"], 0, "{told}");
    assert!(told["stress_percent"].as_f64().unwrap() > 0.0, "{told}");
    let verdict = told["verdict"].as_str().unwrap();
    assert!(verdict.contains("skeleton, 1 run each") && verdict.contains("random feasible ones"), "{verdict}");
}

#[test]
fn the_skeleton_in_python_is_sound() {
    let place = tempfile::tempdir().unwrap();
    assert!(own_lines("skeleton.py") <= 30);
    let command = format!("python3 '{EXAMPLES}/skeleton.py'");
    let all = json(place.path(), &["check-executor", &command]);
    assert_eq!(all["verdict"], "PASS 7/7 steps (python skeleton)", "{all}");
    is_stressed(place.path(), &command);
}

#[test]
fn the_skeleton_in_cpp_is_sound() {
    let place = tempfile::tempdir().unwrap();
    assert!(own_lines("skeleton.cpp") <= 30);
    let program = place.path().join("skeleton");
    let mut compiler = Command::new("g++");
    compiler
        .args(["-std=c++17", "-Wall", "-Wextra", "-Werror", "-o"])
        .arg(&program)
        .arg(format!("{EXAMPLES}/skeleton.cpp"));
    let Ok(compiled) = compiler.output() else {
        eprintln!("no g++ here: not compiled");
        return;
    };
    assert!(compiled.status.success(), "{}", String::from_utf8_lossy(&compiled.stderr));
    let command = format!("'{}'", program.display());
    let all = json(place.path(), &["check-executor", &command]);
    assert_eq!(all["verdict"], "PASS 7/7 steps (C++ skeleton)", "{all}");
    is_stressed(place.path(), &command);
}
