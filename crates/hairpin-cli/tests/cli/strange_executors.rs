//! Executors that answer twice, late or not at all, and a hairpin that is killed: each mission has its own answer or
//! none, and nothing stays behind.
#![cfg(unix)]

use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use crate::commands::{SMALL, hairpin, json, run};
use hairpin_formats::folder::CampaignFolder;
use serde_json::Value;

const FLOWN_TWICE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/hostile/extra_flight_executor.py");

/// More than anything here takes, even on a busy machine.
const PATIENCE: Duration = Duration::from_secs(60);

#[test]
fn a_second_answer_is_a_mistake_of_its_own_case() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let fly = |more: &str, workers: &str, out: &str| {
        let executor = format!("python3 '{FLOWN_TWICE}'{more}");
        let workers = format!("execute.workers={workers}");
        json(here, &[&SMALL[..], &["--executor", &executor, "--set", &workers, "--out", out]].concat())
    };
    assert_eq!(fly(" --once", "1", "once")["exit_code"], 0);
    for (workers, out) in [("1", "alone"), ("4", "together")] {
        let object = fly("", workers, out);
        assert_eq!((&object["exit_code"], &object["counts"]["executor_failed"]), (&4.into(), &1.into()), "{object}");
        let log = fs::read_to_string(here.join(out).join("executor-0001-0.log")).unwrap();
        assert!(log.starts_with("sent more after its \"end\""), "{log}");
        for case in ["0000", "0002", "0003"] {
            let flown = |folder: &str| {
                let kept = CampaignFolder::open(&here.join(folder)).unwrap();
                kept.read_run(case.parse().unwrap(), 0).unwrap()
            };
            assert!(flown("once") == flown(out), "{out}: case {case} is not what it is without a second answer");
        }
    }
}

#[test]
fn a_program_that_hangs_is_given_up_and_resumed() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let minimal = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/executors/minimal_executor.py");
    let good = fs::read_to_string(minimal).unwrap();
    let head = "def fly(mission, speed=2.0, step=0.02):\n";
    let waits = "open('waited', 'a').write('.'); import time; time.sleep(600)\n";
    let hangs = good.replace(head, &format!("{head}    {waits}"));
    let silent = waits.to_owned();
    let waited = || {
        let marks = fs::read(here.join("waited")).unwrap();
        fs::remove_file(here.join("waited")).unwrap();
        marks.len()
    };
    let asked = ["stress", "demo-quadrotor", "--set", "generate.search.cases=5", "--set", "execute.repeat=1"];
    let limited = ["--set", "execute.timeout_s=2", "--set", "execute.workers=1", "--executor", "python3 program.py"];
    for (out, text, left) in [("hung", &hangs, 3), ("silent", &silent, 0)] {
        fs::write(here.join("program.py"), text).unwrap();
        let arguments = [&asked[..], &limited, &["--out", out]].concat();
        let object = json(here, &arguments);
        assert_eq!((&object["exit_code"], &object["counts"]["executor_failed"]), (&4.into(), &5.into()), "{object}");
        // On a machine that is busy enough one is given up before it says so.
        assert!((1..=3).contains(&waited()), "{out}: of five the last two are not waited for");
        fs::write(here.join("program.py"), &good).unwrap();
        let object = json(here, &[&arguments[..], &["--resume"]].concat());
        let code = if left == 0 { 0 } else { 4 };
        assert_eq!(
            (&object["exit_code"], &object["counts"]["executor_failed"]),
            (&code.into(), &Value::from(left)),
            "{out}: {object}"
        );
        let logs = fs::read_dir(here.join(out)).unwrap().flatten();
        let logs = logs.filter(|entry| entry.file_name().to_string_lossy().ends_with(".log")).count();
        assert_eq!(logs, left, "of what was flown in the end there is none");
    }
    // Saved cases are waited for no longer.
    let far = ["--set", "spec.deviation.max_m=0.0001"];
    run(here, &[&asked[..], &far, &["--out", "saved"]].concat());
    assert!(fs::read_dir(here.join("saved/repro")).unwrap().count() >= 5);
    fs::write(here.join("program.py"), &hangs).unwrap();
    let arguments = ["execute", "silent", "--repro", "saved/repro", "--set", "execute.timeout_s=2"];
    assert_eq!(run(here, &arguments).0, 4);
    let waited = waited();
    assert!((1..=6).contains(&waited), "{waited}: three saved ones, and as many of the campaign at most");
}

fn is_alive(pid: &str) -> bool {
    let asked = Command::new("ps").args(["-o", "stat=", "-p", pid]).output().unwrap();
    let state = String::from_utf8_lossy(&asked.stdout).trim().to_owned();
    !state.is_empty() && !state.starts_with('Z')
}

fn wait_until(what: &str, mut holds: impl FnMut() -> bool) {
    let begun = Instant::now();
    while !holds() {
        assert!(begun.elapsed() < PATIENCE, "{what} takes too long");
        std::thread::sleep(Duration::from_millis(10));
    }
}

/// Writes the numbers of a program, of a child of it, and of one that leaves its group, and waits with them.
fn with_children(folder: &Path, first: &str) {
    let text = format!(
        "import os, subprocess, sys, time\nchildren = [subprocess.Popen(['sleep', '600']), subprocess.Popen(['setsid', 'sleep', '600'])]\n\
         time.sleep(0.2)\nopen('pids.new', 'w').write(' '.join(map(str, [os.getpid()] + [child.pid for child in children])))\n\
         os.rename('pids.new', 'pids')\n{first}"
    );
    fs::write(folder.join("program.py"), text).unwrap();
}

#[test]
fn nothing_survives_a_kill() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let pids = || fs::read_to_string(here.join("pids")).unwrap_or_default();
    let executor = [&SMALL[..], &["--executor", "python3 program.py", "--set", "execute.workers=1"]].concat();
    let score = ["generate", "demo-quadrotor", "--set", "generate.score=\"python:program.py\""];
    for (arguments, then) in [(&executor[..], "time.sleep(600)\n"), (&score, "def score(leg):\n    time.sleep(600)\n")]
    {
        let _ = fs::remove_file(here.join("pids"));
        with_children(here, then);
        let mut child = hairpin(here, &[arguments, &["--out", "a", "--force"]].concat());
        let mut child = child.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
        wait_until("its children", || !pids().is_empty());
        child.kill().unwrap();
        child.wait().unwrap();
        let all = pids();
        // As far as it goes: who leaves his group is known where the system tells environments.
        let known = if cfg!(target_os = "linux") { 3 } else { 2 };
        assert_eq!(all.split(' ').count(), 3);
        for pid in all.split(' ').take(known) {
            wait_until("its end", || !is_alive(pid));
        }
    }
}
