//! What a build server needs: JUnit where it looks for it, a budget of time that never passes silently, workflows, and
//! exit codes that are explained.

use std::fs;

use crate::commands::{SMALL, hairpin, json, refused, run, told};
use serde_json::Value;

const STRICT: [&str; 2] = ["--set", "spec.deviation.max_m=0.01"];

#[test]
fn junit_goes_where_it_is_asked_for_with_the_commands_that_reproduce() {
    let place = tempfile::tempdir().unwrap();
    let here = place.path();
    let object = json(here, &[&SMALL[..], &STRICT, &["--out", "my out", "--junit", "ci/results.xml"]].concat());
    assert_eq!(
        (&object["exit_code"], &object["paths"]["junit_copy"]),
        (&Value::from(1), &Value::from("ci/results.xml"))
    );
    let junit = fs::read_to_string(here.join("ci/results.xml")).unwrap();
    assert_eq!(junit, fs::read_to_string(here.join("my out/junit.xml")).unwrap());
    // Each failing case has its own command, and a shell takes it as it stands.
    let commands: Vec<&str> =
        junit.lines().filter_map(|line| Some(line.split_once("again: ")?.1.split_once("</failure>")?.0)).collect();
    assert_eq!(commands.len(), 4, "{junit}");
    let typed = commands[2].replace("&apos;", "'").replace("hairpin ", "");
    assert_eq!(typed, "replay 'my out' --case 0002");
    let (code, out, error) = run(here, &["replay", "my out", "--case", "0002"]);
    assert!(code == 1 && out.starts_with("FAIL 1/1: reproduces"), "{out}{error}");

    // Of a judgement by another limit as well; a case that passes has none.
    let lax = ["judge", "my out", "--set", "spec.deviation.max_m=20", "--junit", "again.xml"];
    assert_eq!(run(here, &lax).0, 0);
    let junit = fs::read_to_string(here.join("again.xml")).unwrap();
    assert!(junit.contains("tests=\"4\" failures=\"0\"") && !junit.contains("again:"), "{junit}");
    // It may be flown again all the same, as it is.
    let (code, out, error) = run(here, &["replay", "my out", "--case", "0002"]);
    assert_eq!((code, out.trim_end()), (0, "PASS 1/1: as before: no violation"), "{error}");
    fs::create_dir(here.join("taken")).unwrap();
    refused(here, &["judge", "my out", "--junit", "taken"], &["--junit taken", "name a file"]);
}

/// A budget that ends amid the runs: nothing passes, and everything says why.
#[test]
fn what_a_budget_cuts_is_no_pass() {
    let place = tempfile::tempdir().unwrap();
    let here = place.path();
    // A program that takes a second for each mission.
    let slow = fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/executors/minimal_executor.py"))
        .unwrap()
        .replace("import json", "import json\nimport time")
        .replace(
            "def fly(mission, speed=2.0, step=0.02):",
            "def fly(mission, speed=2.0, step=0.2):\n    time.sleep(1)",
        );
    assert!(slow.contains("time.sleep"));
    fs::write(here.join("slow.py"), slow).unwrap();
    let sets = ["generate.search.cases=8", "execute.processes=1", "spec.deviation.max_m=20"];
    let program = "execute.command=\"python3 slow.py\"";
    let sets: Vec<&str> = sets.into_iter().chain([program]).flat_map(|set| ["--set", set]).collect();
    let few = [&SMALL[1..], &sets, &["--out", "a"]].concat();
    assert_eq!(json(here, &[&["generate"], &few[..]].concat())["counts"]["cases"], 8);
    let cut = [&["stress"], &few[..], &["--resume", "--budget", "3s", "--junit", "junit.xml"]].concat();
    let object = json(here, &cut);
    let verdict = object["verdict"].as_str().unwrap();
    assert!(object["exit_code"] == 5 && verdict.starts_with("INCONCLUSIVE 0/8 "), "{object}");
    assert!(verdict.contains("cut short by the budget of time: ") && verdict.contains(" of 8 cases not "), "{verdict}");
    assert!(object["budget"]["cut"].to_string().contains(" of 8 runs were not executed"), "{object}");
    let used = object["budget"]["used_s"].as_f64().unwrap();
    assert!(object["budget"]["seconds"] == 3.0 && used < 6.0, "eight missions take eight seconds: {object}");
    let (pass, open) = (object["counts"]["pass"].as_u64().unwrap(), object["counts"]["inconclusive"].as_u64().unwrap());
    assert!(pass + open == 8 && open > 0, "{object}");
    let junit = fs::read_to_string(here.join("junit.xml")).unwrap();
    assert!(junit.contains(&format!("failures=\"0\" errors=\"{open}\"")), "{junit}");
    assert!(junit.contains(": the budget of time was used up"), "{junit}");
    // The report says it, also when it is written anew.
    assert_eq!(json(here, &["report", "a"])["verdict"], object["verdict"]);
    let text = run(here, &[&cut[..cut.len() - 4], &["--budget", "0.1s"]].concat()).2;
    assert!(text.contains("the budget of 0.10 s cut it short: ") && text.contains("--resume"), "{text}");
    // What is there is kept: without a budget the rest is flown, and decides.
    fs::write(here.join("slow.py"), fs::read_to_string(here.join("slow.py")).unwrap().replace("sleep(1)", "sleep(0)"))
        .unwrap();
    let object = json(here, &[&["stress"], &few[..], &["--resume"]].concat());
    assert!(object["exit_code"] == 0 && object["budget"].is_null(), "{object}");
    assert!(object["verdict"].as_str().unwrap().starts_with("PASS 8/8 "), "{object}");
}

/// A search that the budget ends is no pass either, and a violation is one all the same.
#[test]
fn a_search_that_is_cut_is_told() {
    let place = tempfile::tempdir().unwrap();
    let here = place.path();
    let worst = "generate.search={ method = \"worst\", waypoints = 60, cases = 2, executions = 100000 }";
    let hull =
        ["stress", "demo-quadrotor", "--set", "generate.reach=\"hull\"", "--set", "generate.timing={ step_s = 1.0 }"];
    let asked = |most: &str, out: &str| {
        let most = format!("spec.deviation.max_m={most}");
        // Who steers so does not leave the world, however long is searched.
        let steered = ["--set", "execute.controller=\"stable-waypoint\"", "--set", "execute.repeat=1"];
        let more = [&["--set", worst], &steered[..], &["--budget", "3s", "--set", &most, "--out", out]].concat();
        json(here, &[&hull[..], &more].concat())
    };
    let object = asked("1000", "lax");
    let verdict = object["verdict"].as_str().unwrap();
    assert!(object["exit_code"] == 5 && verdict.starts_with("INCONCLUSIVE 0/2 "), "{object}");
    assert!(verdict.contains("the search after ") && verdict.contains(" of 200 000 executions"), "{verdict}");
    assert_eq!(object["counts"]["pass"], 2, "{object}");
    assert!(object["budget"]["used_s"].as_f64().unwrap() < 6.0, "{object}");
    let junit = fs::read_to_string(here.join("lax/junit.xml")).unwrap();
    assert!(junit.contains("errors=\"2\""), "5 is an error, never a pass: {junit}");
    // Judged again, it is still half a search.
    assert_eq!(json(here, &["judge", "lax"])["exit_code"], 5);
    assert_eq!(json(here, &["judge", "lax", "--set", "spec.deviation.max_m=0.01"])["exit_code"], 1);
}

#[test]
fn budgets_have_units() {
    let place = tempfile::tempdir().unwrap();
    for wrong in ["5", "0s", "5min", "-3s"] {
        let budget = format!("--budget={wrong}");
        refused(place.path(), &[&SMALL[..], &[&budget]].concat(), &["--budget", "90s, 5m or 1h"]);
    }
}

#[test]
fn workflows_are_written_once() {
    let place = tempfile::tempdir().unwrap();
    let here = place.path();
    for (server, file) in
        [("github", ".github/workflows/hairpin.yml"), ("gitlab", ".gitlab-ci.yml"), ("jenkins", "Jenkinsfile")]
    {
        let (code, out, error) = run(here, &["init", "ci", server, "--scenario", "my rover.toml"]);
        assert!(code == 0 && out.starts_with(&format!("{file} written")), "{out}{error}");
        assert!(error.contains("my rover.toml is not there yet") && error.contains("HAIRPIN_SOURCE"), "{error}");
        let text = fs::read_to_string(here.join(file)).unwrap();
        for wanted in [
            "my rover.toml",
            "--budget \"$BUDGET\"",
            "--junit hairpin-junit.xml",
            "--keep worst",
            "--repro hairpin-saved",
        ] {
            assert!(text.contains(wanted), "{file}: {wanted}");
        }
        fs::write(here.join(file), "mine").unwrap();
        refused(here, &["init", "ci", server], &[file, "--force", "--out"]);
        assert_eq!(fs::read_to_string(here.join(file)).unwrap(), "mine");
        assert_eq!(run(here, &["init", "ci", server, "--force", "--source", "https://example.org/h.git"]).0, 0);
        assert!(fs::read_to_string(here.join(file)).unwrap().contains("https://example.org/h.git"));
    }
    assert_eq!(json(here, &["init", "ci", "gitlab", "--out", "ci/hairpin.yml"])["file"], "ci/hairpin.yml");
}

/// The shell of a workflow's step, run as the server runs it: twice, so that what failed once is run first.
#[test]
fn the_steps_of_a_workflow_run() {
    let place = tempfile::tempdir().unwrap();
    let here = place.path();
    run(here, &["init", "ci", "jenkins", "--scenario", "demo-quadrotor"]);
    let text = fs::read_to_string(here.join("Jenkinsfile")).unwrap();
    let scripts: Vec<&str> = text.split("'''").skip(1).step_by(2).collect();
    assert_eq!(scripts.len(), 3, "{text}");
    let small = "\"$SCENARIO\" --set generate.search.cases=2 --set execute.repeat=1 --set execute.baseline=0 \
                 --set spec.deviation.max_m=0.01 --set generate.search.waypoints=100";
    let shell = |script: &str| {
        let mut command = std::process::Command::new("sh");
        let bin = std::path::Path::new(env!("CARGO_BIN_EXE_hairpin")).parent().unwrap().to_owned();
        let path = format!("{}:{}", bin.display(), std::env::var("PATH").unwrap());
        command.args(["-e", "-c", &script.replace("\"$SCENARIO\"", small)]).current_dir(here);
        command.env("PATH", path).env("WORKSPACE", here).env("XDG_STATE_HOME", here.join(".state"));
        command.env("SCENARIO", "demo-quadrotor").env("BUDGET", "5m").env("HAIRPIN_SOURCE", "");
        told(&mut command)
    };
    let saved = || -> Vec<(std::path::PathBuf, String)> {
        let files = fs::read_dir(here.join("hairpin-saved")).unwrap().map(|entry| entry.unwrap().path());
        files.map(|file| (file.clone(), fs::read_to_string(file).unwrap())).collect()
    };
    for first in [true, false] {
        let (code, out, error) = shell(scripts[0]);
        assert!(code == 0, "hairpin is on the path: {out}{error}");
        let (code, out, error) = shell(scripts[1]);
        assert!(code == 1 && out.contains("\nFAIL "), "{out}{error}");
        assert_eq!(error.contains("saved cases first: 2 of 2 violate"), !first, "{error}");
        let (code, out, error) = shell(scripts[2]);
        assert!(code == 0, "{out}{error}");
        assert!(here.join("hairpin-junit.xml").is_file() && here.join("out/ci/report.html").is_file());
        assert_eq!(saved().len(), 2);
    }
    // Another commit's violations have the same numbers in its campaign: what failed before stays beside them.
    let before = saved();
    let (code, out, error) = shell(&scripts[1].replace("\"$SCENARIO\"", "\"$SCENARIO\" --seed 77"));
    assert!(code == 1 && error.contains("saved cases first: 2 of 2 violate"), "{out}{error}");
    assert_eq!(shell(scripts[2]).0, 0);
    let after = saved();
    assert!(after.len() == 4 && before.iter().all(|one| after.contains(one)), "{} files", after.len());
    let (.., error) = shell(scripts[1]);
    assert!(error.contains("saved cases first: 4 of 4 violate"), "{error}");
}

#[test]
fn exit_codes_are_explained_and_help_still_works() {
    let place = tempfile::tempdir().unwrap();
    let (code, out, error) = run(place.path(), &["help", "exit-codes"]);
    assert!(code == 0 && error.is_empty(), "{error}");
    for code in ["0", "1", "2", "3", "4", "5", "70", "74", "130"] {
        assert!(out.lines().any(|line| line.starts_with(&format!("{code:>4}  "))), "{code}: {out}");
    }
    let (code, out, _) = told(&mut hairpin(place.path(), &["help", "judge"]));
    assert!(code == 0 && out.contains("Usage: hairpin judge") && out.contains("Examples:"), "{out}");
}
