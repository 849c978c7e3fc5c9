//! Scores of the user's own: Python files that tell legs apart.

use std::fs;
use std::path::Path;

use crate::commands::{assert_same, json, refused, small_hull};
use hairpin::campaign::Case;
use hairpin_formats::folder::CampaignFolder;

const SEARCH: &str = r#"{ method = "exact", waypoints = 60, cases = 3 }
score = "python:my score.py""#;

fn begin(here: &Path, score: &str) {
    fs::write(here.join("q.toml"), small_hull(SEARCH)).unwrap();
    fs::write(here.join("my score.py"), score).unwrap();
}

fn cases(folder: &Path) -> Vec<Case> {
    CampaignFolder::open(folder).unwrap().read_cases().unwrap()
}

fn lengths(case: &Case) -> Vec<f64> {
    case.waypoints.windows(2).map(|pair| (pair[1] - pair[0]).norm()).collect()
}

#[test]
fn exact_and_beam_take_scores_of_the_users() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    // What it prints is no answer.
    begin(here, "import math\nprint('hello')\ndef score(leg):\n    return math.dist(leg['from_m'], leg['to_m'])\n");
    let exact = json(here, &["generate", "q.toml", "--out", "exact"]);
    assert_eq!(exact["counts"]["cases"], 3, "{exact}");
    let (found, beam) = (cases(&here.join("exact")), ["--set", "generate.search.method=\"beam\""]);
    json(here, &[&["generate", "q.toml", "--out", "beam"][..], &beam].concat());
    for (best, other) in found.iter().zip(cases(&here.join("beam"))) {
        assert!((best.score - lengths(best).iter().sum::<f64>()).abs() < 1e-9, "{best:?}");
        assert!(best.gap() == Some(0.0) && best.score >= other.score - 1e-9, "{} {}", best.score, other.score);
        assert!((other.score - lengths(&other).iter().sum::<f64>()).abs() < 1e-9);
    }
    // Legs of a step are as long as they are fast: the score by hand that says the same finds the same.
    let named = ["--set", "generate.score=\"high-velocity\""];
    json(here, &[&["generate", "q.toml", "--out", "named"][..], &named].concat());
    let waypoints = |folder: &str| cases(&here.join(folder)).into_iter().map(|case| case.waypoints).collect::<Vec<_>>();
    assert_eq!(waypoints("exact"), waypoints("named"));

    // A folder stands alone: the file is in it. Threads change nothing.
    json(here, &["generate", "q.toml", "--out", "one", "--threads", "1"]);
    assert_same(&here.join("exact"), &here.join("one"));
    let text = fs::read_to_string(here.join("my score.py")).unwrap();
    fs::write(here.join("my score.py"), text.replace("return ", "return -")).unwrap();
    refused(here, &["generate", "q.toml", "--out", "exact", "--resume"], &["`score.py` is not what it was"]);
    fs::rename(here.join("my score.py"), here.join("moved.py")).unwrap();
    assert!(here.join("exact/score.py").is_file());
    json(here, &["execute", "exact"]);
    json(here, &["judge", "exact"]);
}

#[test]
fn what_a_leg_leaves_to_the_next_is_added() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    begin(here, "def score(leg):\n    return 0\ndef left(leg):\n    return leg['length_m']\n");
    json(here, &["generate", "q.toml", "--out", "a"]);
    for case in cases(&here.join("a")) {
        let all = lengths(&case);
        let told: f64 = all[..all.len() - 1].iter().sum();
        assert!((case.score - told).abs() < 1e-9 && case.gap() == Some(0.0), "{}: {told}", case.score);
    }
}

#[test]
fn drives_are_scored_too() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    fs::write(here.join("mine.py"), "def score(leg):\n    return -leg['length_m']\n").unwrap();
    let sets = ["search.score=\"python:mine.py\"", "search.method=\"exact\"", "search.waypoints=16", "search.cases=1"];
    let sets: Vec<String> = sets.iter().map(|set| format!("generate.{set}")).chain(["task.length=3".into()]).collect();
    let mut typed = vec!["generate", "differential-drive", "--out", "a"];
    typed.extend(sets.iter().flat_map(|set| ["--set", set]));
    json(here, &typed);
    let case = &cases(&here.join("a"))[0];
    let along: f64 = case.waypoints.windows(2).map(|pair| (pair[1] - pair[0]).norm()).sum();
    assert!((case.score + along).abs() < 1e-6, "{} {along}", case.score);
}

#[test]
fn what_goes_wrong_is_told_with_file_and_line() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let generate = ["generate", "q.toml", "--out", "a", "--force"];
    for (text, words) in [
        ("def score(leg):\n    return 1 / 0\n", &["my score.py", "line 2", "ZeroDivisionError"][..]),
        ("def score(leg):\n    return leg['speed']\n", &["line 2", "KeyError: 'speed'"]),
        ("def score(leg):\n    return 'much'\n", &["generate.score", "'much' is no number, of the leg"]),
        ("def score(leg):\n    return '5'\n", &["my score.py", "'5' is no number, of the leg"]),
        ("def score(leg):\n    return [5]\n", &["my score.py", "[5] is no number, of the leg"]),
        ("def score(leg)\n", &["line 1", "SyntaxError"]),
        ("def score(leg):\n    raise ValueError('no\\n  score')\n", &["line 2", "ValueError: no score"]),
        ("import sys\nsys.exit(3)\n", &["generate.score", "SystemExit: 3"]),
        ("def score(leg):\n    return float('nan')\n", &["nan is no finite number, of the leg", "'climb_m'"]),
        ("x = 1\n", &["it defines no function score(leg)"]),
        ("def score(leg):\n    return len(input())\n", &["line 2", "EOFError"]),
        ("def score(leg):\n    return 1e308\n", &["1e+308 must be within ±1e+100, of the leg"]),
    ] {
        begin(here, text);
        refused(here, &generate, words);
    }
    // What is no score at all is found out before anything is made.
    begin(here, "x = 1\n");
    refused(here, &["generate", "q.toml", "--out", "none"], &["it defines no function score(leg)"]);
    assert!(!here.join("none").exists());
    fs::remove_file(here.join("my score.py")).unwrap();
    refused(here, &generate, &["generate.score", "my score.py", "cannot be read"]);
    begin(here, "def score(leg):\n    return 1\n");
    let adaptive = ["--set", "generate.search.method=\"adaptive\""];
    refused(here, &[&generate[..], &adaptive].concat(), &["generate.score", "learns its own"]);
}

/// Whoever waits for an answer waits no longer than was said; what it was for is found again.
#[test]
fn a_time_limit_does_not_wait_for_an_answer() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let slow = "import os, time\ndef score(leg):\n    if os.path.exists('slow'):\n        time.sleep(3600)\n    return leg['length_m']\n";
    begin(here, slow);
    json(here, &["generate", "q.toml", "--out", "fast"]);
    fs::write(here.join("slow"), "").unwrap();
    let stopped = json(here, &["generate", "q.toml", "--out", "slow-one", "--time-limit", "2"]);
    assert_eq!((&stopped["exit_code"], &stopped["counts"]["cases"]), (&0.into(), &0.into()), "{stopped}");
    fs::remove_file(here.join("slow")).unwrap();
    json(here, &["generate", "q.toml", "--out", "slow-one", "--resume"]);
    assert_same(&here.join("fast"), &here.join("slow-one"));
    // Nor for the file to be loaded.
    begin(here, "import time\ntime.sleep(3600)\n");
    refused(here, &["generate", "q.toml", "--out", "never", "--time-limit", "0.5"], &["was not loaded in time"]);
    assert!(!here.join("never").exists());
}

/// Searches the hull's flights by a target.
fn with_target(here: &Path, target: &str) {
    let search = r#"{ method = "worst", waypoints = 60, cases = 2, executions = 15, target = "python:my target.py" }"#;
    fs::write(here.join("q.toml"), small_hull(search)).unwrap();
    fs::write(here.join("my target.py"), target).unwrap();
}

#[test]
fn the_worst_is_searched_by_a_target_of_the_users() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    with_target(
        here,
        "def target(run):\n    assert len(run['t_s']) == len(run['q_wxyz']) == len(run['channels']['vx_m_s'])\n    return run['t_s'][-1]\n",
    );
    json(here, &["stress", "q.toml", "--out", "a", "--set", "execute.baseline=0"]);
    let campaign = CampaignFolder::open(&here.join("a")).unwrap();
    let found = campaign.read_cases().unwrap();
    let results = campaign.read_results().unwrap();
    assert_eq!((found.len(), results.len()), (2, 2));
    for case in &found {
        let result = results.iter().find(|result| result.case == case.number).unwrap();
        let time = result.measures.as_ref().unwrap().total_time;
        assert!((case.score - time).abs() < 1e-9, "{} {time}", case.score);
    }
    let curve = fs::read_to_string(here.join("a/best-so-far.tsv")).unwrap();
    assert!(curve.lines().next().unwrap().contains("target"), "{curve}");
    // A folder stands alone, and threads change nothing.
    assert!(here.join("a/target.py").is_file());
    json(here, &["generate", "q.toml", "--out", "b", "--threads", "1"]);
    assert_eq!(cases(&here.join("b")), found);
    // It is a file's word only where something executes what it tries.
    let words = ["generate.search.target", "only the method `worst` has a target"];
    refused(here, &["generate", "q.toml", "--out", "c", "--set", "generate.search.method=\"exact\""], &words);
    with_target(here, "def target(run):\n    return 1 / 0\n");
    let words = ["`generate.search.target` = python:my target.py: File", "line 2", "ZeroDivisionError"];
    refused(here, &["generate", "q.toml", "--out", "d"], &words);
    for (out, told) in [("words", "'5'"), ("truth", "True")] {
        with_target(here, &format!("def target(run):\n    return {told}\n"));
        let no_number = format!("{told} is no number, of the run");
        let words = ["`generate.search.target` = python:my target.py: File", &no_number];
        refused(here, &["generate", "q.toml", "--out", out], &words);
    }
    with_target(here, "def score(leg):\n    return 1\n");
    refused(here, &["generate", "q.toml", "--out", "e"], &["it defines no function target(run)"]);
    let unknown = ["generate", "q.toml", "--out", "f", "--set", "generate.search.target=\"deviations\""];
    refused(here, &unknown, &["did you mean `deviation`?"]);
}
