//! A program of the user's flies, and what it does wrong costs its own missions alone.

use std::fs;

use crate::commands::{SMALL, contents, json, refused, run};
use serde_json::Value;

#[test]
fn an_executor_of_the_users_flies_and_fails_alone() {
    let folder = tempfile::tempdir().unwrap();
    let minimal = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/executors/minimal_executor.py");
    let good = format!("python3 '{minimal}'");
    let object = json(folder.path(), &[&SMALL[..], &["--executor", &good, "--out", "good"]].concat());
    assert_eq!(object["exit_code"], 0, "{object}");
    // It is told by its own name.
    let verdict = object["verdict"].as_str().unwrap();
    assert!(verdict.contains("executor minimal executor, 1 run each") && !verdict.contains("python3"), "{verdict}");
    let good = folder.path().join("good");
    for file in ["junit.xml", "report.html"] {
        let text = fs::read_to_string(good.join(file)).unwrap();
        assert!(text.contains("minimal executor") && !text.contains("python3"), "{file}");
    }
    let kept: Value = serde_json::from_str(&fs::read_to_string(good.join("executor.json")).unwrap()).unwrap();
    assert_eq!(kept, serde_json::json!({ "name": "minimal executor", "protocol": 1 }));
    // It flies exactly on the legs.
    assert!(object["worst"]["max_deviation_m"].as_f64().unwrap() < 1e-9, "{object}");

    let broken = fs::read_to_string(minimal).unwrap().replace("def fly(mission, speed=2.0, step=0.02):", "def fly(mission, speed=2.0, step=0.02):\n    if mission['case'] == '0001':\n        raise SystemExit('rotor 3 is gone')");
    assert!(broken.contains("rotor 3"));
    fs::write(folder.path().join("broken.py"), broken).unwrap();
    let object = json(folder.path(), &[&SMALL[..], &["--executor", "python3 broken.py", "--out", "bad"]].concat());
    assert_eq!(
        (&object["exit_code"], &object["counts"]["executor_failed"]),
        (&Value::from(4), &Value::from(1)),
        "{object}"
    );
    let trouble = "EXECUTOR FAILED 1/4 (0001, minimal executor, run 0: ended without \"end\" (exit status: 1); the last line of its stderr: rotor 3 is gone)";
    assert!(object["verdict"].as_str().unwrap().starts_with(trouble), "{object}");
    assert!(
        fs::read_to_string(folder.path().join("bad/junit.xml"))
            .unwrap()
            .contains("minimal executor, run 0: ended without")
    );
    let log = fs::read_to_string(folder.path().join("bad/executor-0001-0.log")).unwrap();
    assert!(log.contains("rotor 3 is gone"), "{log}");
    // Done at once, without attitudes: judged by what was flown, which is nothing.
    let idle = fs::read_to_string(minimal).unwrap().replace("def fly(mission, speed=2.0, step=0.02):", "def fly(mission, speed=2.0, step=0.02):\n    say(type='pose', t_s=0, p_m=mission['waypoints_m'][0])\n    return say(type='end', reason='done')");
    fs::write(folder.path().join("idle.py"), idle).unwrap();
    let (code, out, error) = run(folder.path(), &["execute", "bad", "--executor", "python3 idle.py"]);
    assert!(code == 0 && error.contains("4 runs came without q_wxyz"), "{out}{error}");
    let verdict = json(folder.path(), &["judge", "bad", "--set", "spec.deviation.max_m=100"]);
    assert!(verdict["verdict"].as_str().unwrap().starts_with("FAIL 4/4"), "{verdict}");
    assert_eq!(verdict["worst"]["ended"], "done", "{verdict}");
    assert!(
        verdict["worst"]["violations"][0].as_str().unwrap().starts_with("stopped at 1 of 8 waypoints"),
        "{verdict}"
    );
    assert_eq!(run(folder.path(), &["report", "bad"]).0, 0);
    assert!(fs::read_to_string(folder.path().join("bad/report.html")).unwrap().contains("sent no attitudes"));

    // What ran before was another one.
    let object = json(folder.path(), &["execute", "bad", "--executor", "no-such-program"]);
    assert!(!folder.path().join("bad/executor.json").exists());
    let trouble = "EXECUTOR FAILED 4/4 runs (0000, `no-such-program`, run 0: cannot start `no-such-program`: ";
    assert!(object["verdict"].as_str().unwrap().starts_with(trouble), "{object}");
    assert_eq!(
        (&object["exit_code"], &object["counts"]["executor_failed"]),
        (&Value::from(4), &Value::from(4)),
        "{object}"
    );
}

/// Two programs' runs of the same cases stand side by side, and the campaign that they are of stays as it was.
#[test]
fn runs_of_two_programs_stand_side_by_side() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let minimal = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/executors/minimal_executor.py");
    let minimal = format!("python3 '{minimal}'");
    let (code, out, error) = run(here, &[&SMALL[..], &["--out", "a"]].concat());
    assert!([0, 1].contains(&code), "{out}{error}");
    let before = contents(&here.join("a"));
    let beside = ["execute", "a", "--executor", &minimal, "--out", "b"];
    assert_eq!(json(here, &beside)["counts"]["runs"], 4);
    assert!(contents(&here.join("a")) == before, "a changed");
    refused(here, &beside, &["b", "--force"]);
    assert_eq!(json(here, &[&beside[..], &["--force"]].concat())["counts"]["runs"], 4);
    assert_eq!(json(here, &[&beside[..], &["--resume"]].concat())["counts"]["runs"], 4);
    refused(here, &["execute", "a", "--out", "a"], &["--out", "another folder"]);
    // What is wrong with the words is told before anything makes room.
    let kept = contents(&here.join("b"));
    for (wrong, words) in [("task.length=9", "only execute, vary, spec"), ("execute.repeat=0", "execute.repeat")] {
        refused(here, &["execute", "a", "--out", "b", "--force", "--set", wrong], &[words]);
        assert!(contents(&here.join("b")) == kept, "{wrong}: b changed");
    }
    assert!([0, 1].contains(&run(here, &["judge", "b"]).0));
    let (code, out, error) = run(here, &["compare", "a", "b"]);
    assert!([0, 1].contains(&code) && out.contains("max_deviation_m"), "{out}{error}");
    assert_eq!(run(here, &["verify", "b"]).0, 0);
}
