//! A campaign that is stopped, killed or met by another one ends as if nothing had happened.
#![cfg(unix)]

use std::fs;
use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use crate::commands::{SMALL, assert_same, json, refused, run, small_hull, without_baseline};
use hairpin::campaign::CaseNumber;
use hairpin::math::random::case_seed;
use hairpin_formats::folder::CampaignFolder;

/// More than anything here takes, even on a busy machine.
const PATIENCE: Duration = Duration::from_secs(120);

fn wait_until(what: &str, mut holds: impl FnMut() -> bool) {
    let began = Instant::now();
    while !holds() {
        assert!(began.elapsed() < PATIENCE, "{what} takes too long");
        std::thread::sleep(Duration::from_millis(1));
    }
}

/// As at a terminal: what runs the tests in the background ignores Ctrl-C, which would be handed on.
fn begin(folder: &Path, arguments: &[&str]) -> Child {
    let mut at_terminal = Command::new("env");
    at_terminal.arg("--default-signal=INT").arg(env!("CARGO_BIN_EXE_hairpin"));
    at_terminal
        .current_dir(folder)
        .args(without_baseline(arguments))
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap()
}

fn ctrl_c(child: &Child) {
    assert!(Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap().success());
}

/// The exit code, and what is left to read of stderr.
fn end(child: Child) -> (Option<i32>, String) {
    let output = child.wait_with_output().unwrap();
    (output.status.code(), String::from_utf8(output.stderr).unwrap())
}

/// Reads stderr up to the line with `words`.
fn hear(child: &mut Child, words: &str) {
    let mut stderr = child.stderr.take().unwrap();
    let mut lines = BufReader::with_capacity(1, &mut stderr).lines();
    assert!(lines.any(|line| line.unwrap().contains(words)), "it never says {words:?}");
    child.stderr = Some(stderr);
}

fn files_in(folder: &Path) -> usize {
    let sum = |entry: fs::DirEntry| if entry.path().is_dir() { files_in(&entry.path()) } else { 1 };
    fs::read_dir(folder).map_or(0, |entries| entries.flatten().map(sum).sum())
}

/// Every file under its own name is whole: tables between their magic words, objects that parse.
fn assert_whole(folder: &Path) {
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let path = entry.path();
        let name = entry.file_name().to_string_lossy().into_owned();
        let bytes = if path.is_dir() || name.starts_with('.') { Vec::new() } else { fs::read(&path).unwrap() };
        match name.rsplit('.').next().unwrap() {
            _ if path.is_dir() => assert_whole(&path),
            "parquet" => assert!(bytes.len() > 8 && bytes.starts_with(b"PAR1") && bytes.ends_with(b"PAR1"), "{name}"),
            "json" => drop(serde_json::from_slice::<serde_json::Value>(&bytes).expect(&name)),
            "toml" => assert!(bytes.ends_with(b"\n"), "{name}"),
            "html" => assert!(bytes.ends_with(b"</html>\n"), "{name}"),
            "xml" => assert!(bytes.trim_ascii_end().ends_with(b"</testsuites>"), "{name}"),
            _ => {}
        }
    }
}

#[test]
fn threads_change_nothing() {
    let folder = tempfile::tempdir().unwrap();
    for (threads, out) in [("1", "one"), ("2", "two")] {
        run(folder.path(), &[&SMALL[..], &["--threads", threads, "--out", out, "--set", "execute.repeat=2"]].concat());
    }
    assert_same(&folder.path().join("one"), &folder.path().join("two"));
}

#[test]
fn a_kill_at_any_moment_costs_nothing_but_time() {
    let folder = tempfile::tempdir().unwrap();
    let long = [&SMALL[..], &["--set", "execute.repeat=10", "--set", "execute.baseline=2"]].concat();
    run(folder.path(), &[&long[..], &["--out", "calm"]].concat());
    let (calm, hit) = (folder.path().join("calm"), folder.path().join("killed"));
    let all = files_in(&calm);
    let killed = [&long[..], &["--out", "killed", "--resume"]].concat();
    // Moments are told by how many files there are: nothing yet, amid the cases, amid the flights, at the end.
    let mut moments: Vec<usize> = (0..8).map(|round| case_seed(5, round) as usize % all).collect();
    moments.sort_unstable();
    for moment in moments {
        let mut child = begin(folder.path(), &killed);
        wait_until("a campaign", || files_in(&hit) >= moment || child.try_wait().unwrap().is_some());
        child.kill().unwrap();
        child.wait().unwrap();
        assert_whole(&hit);
    }
    let (code, _, error) = run(folder.path(), &killed);
    assert!([0, 1].contains(&code), "{error}");
    assert_whole(&hit);
    assert_same(&calm, &hit);

    refused(folder.path(), &[&killed[..], &["--seed", "11"]].concat(), &["`seed`"]);
}

#[test]
fn a_kill_between_the_files_of_a_checkpoint_costs_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let asked = ["generate", "demo-quadrotor", "--set", "generate.search.cases=6", "--set", "execute.repeat=1"];
    run(folder.path(), &[&asked[..], &["--out", "calm"]].concat());
    let calm = folder.path().join("calm");
    run(folder.path(), &["generate", "demo-quadrotor", "--set", "generate.search.cases=3", "--out", "few"]);
    let early = fs::read_to_string(folder.path().join("few/generation.json")).unwrap();
    let early = early.replace("\"complete\": true", "\"complete\": false");
    // The files that a checkpoint of all six had written when it was killed, over those of three.
    for (out, written) in [("a", 0), ("b", 1), ("c", 2)] {
        let killed = folder.path().join(out);
        run(folder.path(), &[&asked[..], &["--out", out]].concat());
        fs::write(killed.join("generation.json"), &early).unwrap();
        let old = ["waypoints.parquet", "results.parquet"];
        for name in &old[written..] {
            fs::copy(folder.path().join("few").join(name), killed.join(name)).unwrap();
        }
        if written == 1 {
            let object = json(folder.path(), &["execute", out]);
            assert_eq!(object["counts"]["cases"], 3, "what is whole can be used: {object}");
            for table in ["executions", "runs"] {
                fs::remove_dir_all(killed.join(table)).unwrap();
            }
        }
        let (code, _, error) = run(folder.path(), &[&asked[..], &["--out", out, "--resume"]].concat());
        assert_eq!(code, 0, "{error}");
        assert_same(&calm, &killed);
    }
    // Before the first tally nothing is known.
    fs::remove_file(calm.join("generation.json")).unwrap();
    assert_eq!(run(folder.path(), &[&asked[..], &["--out", "calm", "--resume"]].concat()).0, 0);
    assert_same(&calm, &folder.path().join("a"));
}

#[test]
fn ctrl_c_once_keeps_what_is_done_and_resume_finishes_it() {
    let folder = tempfile::tempdir().unwrap();
    let long = [&SMALL[..], &["--set", "execute.repeat=20", "--threads", "1"]].concat();
    run(folder.path(), &[&long[..], &["--out", "calm"]].concat());
    let stopped = [&long[..], &["--out", "stopped", "--resume", "-v"]].concat();

    // While trajectories are searched for.
    let mut child = begin(folder.path(), &stopped);
    hear(&mut child, "campaign folder");
    ctrl_c(&child);
    let (code, error) = end(child);
    assert!(code == Some(130) && error.contains("--resume goes on"), "{code:?}: {error}");

    // While they are flown.
    let flights = || {
        let kept = CampaignFolder::open(&folder.path().join("stopped")).unwrap();
        let all = (0..4).flat_map(|case| (0..20).map(move |run| (CaseNumber(case), run)));
        all.filter(|(case, run)| kept.has_valid_run(*case, *run)).count()
    };
    let child = begin(folder.path(), &stopped);
    wait_until("the cases", || {
        let tally = fs::read_to_string(folder.path().join("stopped/generation.json")).unwrap_or_default();
        tally.contains("\"complete\": true")
    });
    std::thread::sleep(Duration::from_millis(200));
    ctrl_c(&child);
    let (code, error) = end(child);
    assert!(code == Some(130) && error.contains("--resume goes on"), "{code:?}: {error}");
    let kept = flights();
    assert!((3..80).contains(&kept), "{kept}");
    assert_whole(&folder.path().join("stopped"));

    let (code, _, error) = run(folder.path(), &stopped);
    assert!([0, 1].contains(&code) && flights() == 80, "{error}");
    assert_same(&folder.path().join("calm"), &folder.path().join("stopped"));
}

/// The smallest executor, made to do `first` before it flies.
fn executor(folder: &Path, first: &str) {
    let minimal = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/executors/minimal_executor.py");
    let head = "def fly(mission, speed=2.0, step=0.02):\n";
    let text = fs::read_to_string(minimal).unwrap();
    assert!(text.contains(head));
    fs::write(folder.join("executor.py"), text.replace(head, &format!("{head}    {first}\n"))).unwrap();
}

const WITH_EXECUTOR: [&str; 4] = ["--executor", "python3 executor.py", "--set", "execute.workers=1"];

#[test]
fn ctrl_c_twice_ends_at_once_and_takes_the_users_program_along() {
    let folder = tempfile::tempdir().unwrap();
    // It flies the first mission, then neither flies nor minds being asked to end.
    let stubborn = "import os, signal, time\n    signal.signal(signal.SIGTERM, signal.SIG_IGN)\n    \
                    if os.path.exists('pid'): open('idle', 'w').close(); time.sleep(600)\n    \
                    print(os.getpid(), file=open('pid', 'w'))";
    executor(folder.path(), stubborn);
    let asked = [&SMALL[..], &WITH_EXECUTOR, &["--out", "a", "--resume"]].concat();
    let mut child = begin(folder.path(), &asked);
    wait_until("the second flight", || folder.path().join("idle").is_file());
    ctrl_c(&child);
    hear(&mut child, "Ctrl-C again quits at once");
    ctrl_c(&child);
    let (code, error) = end(child);
    assert_eq!(code, Some(130), "{error}");
    assert!(!error.contains("the runs that have landed"), "it ended in order, not at once: {error}");
    let pid = fs::read_to_string(folder.path().join("pid")).unwrap();
    let alive = || {
        let asked = Command::new("ps").args(["-o", "stat=", "-p", pid.trim()]).output().unwrap();
        let state = String::from_utf8_lossy(&asked.stdout).trim().to_owned();
        !state.is_empty() && !state.starts_with('Z')
    };
    wait_until("its end", || !alive());
    assert_whole(&folder.path().join("a"));

    executor(folder.path(), "");
    assert_eq!(run(folder.path(), &asked).0, 0);
    run(folder.path(), &[&SMALL[..], &WITH_EXECUTOR, &["--out", "calm"]].concat());
    assert_same(&folder.path().join("calm"), &folder.path().join("a"));
}

#[test]
fn a_second_process_is_told_that_the_folder_is_in_use() {
    let folder = tempfile::tempdir().unwrap();
    executor(folder.path(), "import os, time\n    while not os.path.exists('go'): time.sleep(0.005)");
    let asked = [&SMALL[..], &WITH_EXECUTOR, &["--out", "a"]].concat();
    let child = begin(folder.path(), &asked);
    wait_until("the cases", || folder.path().join("a/generation.json").is_file());
    for more in ["--resume", "--force"] {
        refused(folder.path(), &[&asked[..], &[more]].concat(), &["another hairpin is writing to a"]);
    }
    refused(folder.path(), &asked, &["a holds a campaign already"]);
    for command in ["execute", "judge"] {
        refused(folder.path(), &[command, "a"], &["another hairpin is writing to a"]);
    }
    // Who only reads need not wait.
    assert_eq!(json(folder.path(), &["verify", "a"])["checked"], 4);
    assert_eq!(run(folder.path(), &["export", "a", "--to", "waypoints"]).0, 0);
    fs::remove_dir_all(folder.path().join("a/export")).unwrap();
    fs::write(folder.path().join("go"), "").unwrap();
    let (code, error) = end(child);
    assert_eq!(code, Some(0), "{error}");

    run(folder.path(), &[&SMALL[..], &WITH_EXECUTOR, &["--out", "calm"]].concat());
    assert_same(&folder.path().join("calm"), &folder.path().join("a"));
}

#[test]
fn a_stopped_search_of_an_arms_graph_is_done_again() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let asked = ["stress", "irb120", "--set", "task.points.count=10", "--set", "execute.repeat=1"];
    let asked = [&asked[..], &["--set", "generate.search.programs=3", "--seed", "5"]].concat();
    run(here, &[&asked[..], &["--out", "calm"]].concat());
    assert!(here.join("calm/optimum.json").is_file());
    for moment in ["0.001", "0.01"] {
        let stopped = [&asked[..], &["--out", "stopped", "--resume"]].concat();
        run(here, &[&stopped[..], &["--time-limit", moment]].concat());
        run(here, &stopped);
        assert_same(&here.join("calm"), &here.join("stopped"));
        fs::remove_dir_all(here.join("stopped")).unwrap();
    }
    // As a kill leaves it before the last file is written: the proof is not there yet, and nothing says that all is.
    run(here, &[&asked[..], &["--out", "killed"]].concat());
    let tally = here.join("killed/generation.json");
    let text = fs::read_to_string(&tally).unwrap().replace("\"stopped\": false", "\"stopped\": true");
    fs::write(&tally, text.replace("\"complete\": true", "\"complete\": false")).unwrap();
    for name in ["optimum.json", "reasons.csv", "graph.csv"] {
        fs::remove_file(here.join("killed").join(name)).unwrap();
    }
    run(here, &[&asked[..], &["--out", "killed", "--resume"]].concat());
    assert_same(&here.join("calm"), &here.join("killed"));
}

#[test]
#[cfg(target_os = "linux")]
fn what_it_was_started_to_ignore_it_ignores() {
    let folder = tempfile::tempdir().unwrap();
    let calm = run(folder.path(), &[&SMALL[..], &["--out", "calm"]].concat()).0;
    // As `nohup` starts it, and shells start what runs in the background.
    for signal in ["HUP", "INT"] {
        let mut shell = Command::new("sh");
        let script = format!("trap '' {signal}; exec \"$@\"");
        shell.current_dir(folder.path()).args(["-c", &script, "sh", env!("CARGO_BIN_EXE_hairpin")]);
        shell
            .args(without_baseline(&[&SMALL[..], &["--out", signal]].concat()))
            .stdout(Stdio::null())
            .stderr(Stdio::piped());
        let child = shell.spawn().unwrap();
        let begun = folder.path().join(signal);
        wait_until("the first file", || files_in(&begun) > 0);
        Command::new("kill").args([&format!("-{signal}"), &child.id().to_string()]).status().unwrap();
        let (code, error) = end(child);
        assert!(code == Some(calm) && !error.contains("stopping"), "{signal}: {code:?}: {error}");
        assert_same(&folder.path().join("calm"), &begun);
    }
}

/// A run whose controller is not waited for any more is no run: it is flown when the campaign goes on.
#[test]
fn ctrl_c_leaves_no_run_that_only_its_end_made_fail() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let begun = here.join("begun");
    let slow = format!(
        "import os, time\nopen({begun:?}, 'a').write('run\\n')\ndef control(t_s, state, reference):\n    \
         time.sleep(0.002 if os.path.exists('slow') else 0)\n    \
         target = reference['waypoints_m'][min(reference['next'], len(reference['waypoints_m']) - 1)]\n    \
         return {{'v_m_s': [0.5 * (a - b) for a, b in zip(target, state['p_m'])]}}\n"
    );
    fs::write(here.join("slow.py"), slow).unwrap();
    let scenario = small_hull("{ method = \"uniform\", waypoints = 60, cases = 4 }")
        .replace("\"minimum-snap\"", "\"python:slow.py\"\ncontrol_rate_hz = 20.0");
    fs::write(here.join("q.toml"), scenario).unwrap();
    let search = ["stress", "q.toml", "--threads", "1", "--out"];
    let calm = run(here, &[&search[..], &["calm"]].concat());
    fs::write(here.join("slow"), "").unwrap();
    fs::remove_file(&begun).unwrap();
    let child = begin(here, &[&search[..], &["hit"]].concat());
    // The file is loaded once more, to see whether it can be.
    wait_until("the second run", || fs::read_to_string(&begun).is_ok_and(|text| text.lines().count() >= 2));
    ctrl_c(&child);
    let (code, error) = end(child);
    assert_eq!(code, Some(130), "{error}");
    let kept = CampaignFolder::open(&here.join("hit")).unwrap();
    let facts = (0..4).flat_map(|case| kept.facts_of(CaseNumber(case)).unwrap());
    assert!(facts.into_iter().all(|facts| facts.message.is_none()), "a run that was stopped counts as one that failed");
    fs::remove_file(here.join("slow")).unwrap();
    let again = run(here, &[&search[..], &["hit", "--resume"]].concat());
    assert_eq!(calm.0, again.0, "{}{}", again.1, again.2);
    assert_same(&here.join("calm"), &here.join("hit"));
}
