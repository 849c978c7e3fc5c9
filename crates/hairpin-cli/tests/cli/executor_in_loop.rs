//! A program of the user's in the loop of a search: what it flies there it flies again in the judgement, on any number
//! of threads and processes; and what it does wrong costs its own executions, or ends the search in words.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::time::{Duration, Instant};

use crate::commands::{contents, copy, json, refused, run, small_hull};
use hairpin_formats::folder::CampaignFolder;
use serde_json::Value;

const SLUGGISH: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data/sluggish.py");
const IN_LOOP: &str = r#"{ method = "in-loop", waypoints = 120, cases = 3, executions = 24 }"#;
const ADAPTIVE: &str = r#"{ method = "adaptive", waypoints = 150, cases = 3, executions = 42, rounds = 2 }"#;
/// As few of each as they can do with.
const LITTLE: [(&str, &str, &str); 3] = [
    ("loop", r#"{ method = "in-loop", waypoints = 60, cases = 2, executions = 8 }"#, "high-velocity-90"),
    (
        "rounds",
        r#"{ method = "adaptive", waypoints = 60, cases = 2, executions = 26, rounds = 2 }"#,
        "high-velocity-90",
    ),
    ("grown", r#"{ method = "beam", waypoints = 40, cases = 2, executions = 8 }"#, "executed"),
];

/// Hull legs under `search`, flown by the sluggish point with `more` of its options.
fn scenario(search: &str, score: &str, more: &str) -> String {
    let command = format!("python3 '{SLUGGISH}' {more}");
    let flown = format!("command = \"{}\"\ntimeout_s = 20.0", command.trim());
    small_hull(&format!("{search}\nscore = \"{score}\"")).replace("controller = \"minimum-snap\"", &flown)
}

/// Score, largest deviation of every case of a campaign.
fn came_to(folder: &Path) -> Vec<(f64, f64)> {
    let kept = CampaignFolder::open(folder).unwrap();
    let (cases, results) = (kept.read_cases().unwrap(), kept.read_results().unwrap());
    let both = cases.iter().zip(&results);
    both.map(|(case, result)| (case.score, result.measures.as_ref().unwrap().max_deviation)).collect()
}

/// What does not depend on how many processes there are: all but the key that says so, and the scenario in saved cases.
fn whatever_flies(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    contents(folder).into_iter().filter(|(name, _)| name != "scenario.toml" && !name.starts_with("repro/")).collect()
}

#[test]
fn threads_and_processes_change_nothing_and_what_is_found_flies_again() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    for (name, search, score) in LITTLE {
        fs::write(here.join("q.toml"), scenario(search, score, "")).unwrap();
        let mut first = None;
        for (threads, processes) in [("1", "1"), ("1", "3"), ("2", "1"), ("2", "3")] {
            let out = format!("{name}-{threads}-{processes}");
            let processes = format!("execute.processes={processes}");
            let told = json(here, &["stress", "q.toml", "--out", &out, "--threads", threads, "--set", &processes]);
            assert!(told["counts"]["cases"].as_u64().unwrap() >= 2, "{told}");
            for (score, deviation) in came_to(&here.join(&out)) {
                assert_eq!(score, deviation, "{out}: flown as in the loop");
            }
            let all = whatever_flies(&here.join(&out));
            match &first {
                None => first = Some(all),
                Some(first) => {
                    assert_eq!(first.keys().collect::<Vec<_>>(), all.keys().collect::<Vec<_>>());
                    let differs = first.iter().find(|(name, bytes)| all[*name] != **bytes).map(|(name, _)| name);
                    assert_eq!(differs, None, "{out}");
                }
            }
        }
    }
}

/// Messages of missions without what their cases are called.
fn missions(file: &Path) -> Vec<Value> {
    let text = fs::read_to_string(file).unwrap();
    let parsed = text.lines().map(|line| {
        let mut mission: Value = serde_json::from_str(line).unwrap();
        mission["case"] = Value::Null;
        mission
    });
    parsed.collect()
}

#[test]
fn the_loop_asks_for_what_the_judgement_asks_for_and_for_nothing_twice() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let log = here.join("asked.jsonl");
    fs::write(here.join("q.toml"), scenario(IN_LOOP, "high-velocity-90", &format!("--log '{}'", log.display())))
        .unwrap();
    json(here, &["generate", "q.toml", "--out", "a"]);
    let in_loop = missions(&log);
    assert!((3..=72).contains(&in_loop.len()), "{}", in_loop.len());
    for (place, mission) in in_loop.iter().enumerate() {
        assert!(!in_loop[..place].contains(mission), "{mission} was flown twice");
    }
    fs::remove_file(&log).unwrap();
    json(here, &["execute", "a"]);
    let judged = missions(&log);
    assert_eq!(judged.len(), 3);
    // Each case has a seed of its own, which it had in the loop.
    assert!(judged.iter().all(|mission| in_loop.contains(mission)));
    assert!(judged[0]["seed"] != judged[1]["seed"] && judged[1]["seed"] != judged[2]["seed"]);
    // What stands in a folder from elsewhere runs for nobody who does not allow it.
    copy(&here.join("a"), &here.join("theirs"));
    let words = ["sluggish.py", "--allow-commands"];
    refused(here, &["generate", "theirs/scenario.toml", "--out", "b"], &words);
}

#[test]
fn the_loop_finds_more_than_chance() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let mean = |search: &str, out: &str| {
        fs::write(here.join("q.toml"), scenario(search, "random", "")).unwrap();
        json(here, &["stress", "q.toml", "--out", out]);
        let all = came_to(&here.join(out));
        all.iter().map(|(_, deviation)| deviation).sum::<f64>() / all.len() as f64
    };
    let chance = mean(r#"{ method = "uniform", waypoints = 150, cases = 60, per_graph = 20 }"#, "chance");
    let looped = mean(r#"{ method = "in-loop", waypoints = 150, cases = 3, executions = 60 }"#, "loop");
    let rounds = mean(r#"{ method = "adaptive", waypoints = 150, cases = 3, executions = 180 }"#, "rounds");
    assert!(looped > 1.2 * chance && rounds > 1.2 * chance, "{chance} {looped} {rounds}");
}

#[test]
fn what_fails_is_no_trial_and_counts() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let once = [("2", "3")];
    for (kind, pools) in [("error", &[("1", "1"), ("2", "3")][..]), ("exit", &once), ("nan", &once)] {
        let mut kept = Vec::new();
        for (threads, processes) in pools {
            fs::write(here.join("q.toml"), scenario(ADAPTIVE, "high-velocity-90", &format!("--sick {kind}"))).unwrap();
            let out = format!("{kind}-{processes}");
            let processes = format!("execute.processes={processes}");
            let arguments = ["generate", "q.toml", "--out", &out, "--threads", threads, "--set", &processes];
            let (code, said, error) = run(here, &arguments);
            assert_eq!(code, 0, "{said}{error}");
            assert!(error.contains("executions in the loop failed; the last: "), "{error}");
            let tally: Value =
                serde_json::from_slice(&fs::read(here.join(&out).join("generation.json")).unwrap()).unwrap();
            let count = |key: &str| {
                tally["rounds"].as_array().unwrap().iter().map(|round| round[key].as_u64().unwrap()).sum::<u64>()
            };
            assert_eq!(count("executions"), 42, "{tally}");
            assert!((5..=25).contains(&count("failed")), "{tally}");
            kept.push(whatever_flies(&here.join(&out)));
        }
        assert!(kept.iter().all(|one| *one == kept[0]), "{kind}: processes change what is found");
    }
}

/// As of controllers in our simulator: `controllers.rs`.
#[test]
fn a_search_in_which_a_program_fails_passes_of_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    fs::copy(SLUGGISH, here.join("sluggish.py")).unwrap();
    let own = scenario(ADAPTIVE, "high-velocity-90", "--sick error").replace(SLUGGISH, "sluggish.py");
    fs::write(here.join("q.toml"), own).unwrap();
    let wide = ["--set", "spec.deviation.max_m=1000", "--set", "execute.baseline=0", "--json"];
    let (code, said, error) = run(here, &[&["stress", "q.toml", "--out", "a"], &wide[..]].concat());
    assert_eq!(code, 4, "{said}{error}");
    let told: Value = serde_json::from_str(&said).unwrap();
    let failed = told["search"]["failed"].as_u64().unwrap();
    let verdict = told["verdict"].as_str().unwrap();
    assert!(verdict.starts_with(&format!("EXECUTOR FAILED {failed}/42 executions of the search (")), "{verdict}");
    // The same again stays so; a program whose file was changed decides anew, whatever command starts it.
    let judged = || {
        let (code, said, _) = run(here, &["judge", "a"]);
        (code, said.lines().last().unwrap_or_default().to_owned())
    };
    assert_eq!(run(here, &["execute", "a"]).0, 0);
    assert_eq!(judged().0, 4);
    fs::write(here.join("sluggish.py"), fs::read_to_string(SLUGGISH).unwrap() + "# repaired\n").unwrap();
    let (code, said, error) = run(here, &["execute", "a"]);
    assert!(code == 0 && !error.contains("stays EXECUTOR FAILED"), "{said}{error}");
    let (code, verdict) = judged();
    assert!(code == 0 && verdict.contains("before another executor flew the cases"), "{verdict}");
}

#[test]
fn a_program_that_flies_nothing_ends_the_search() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    // A busy machine takes its time to begin a program: who is waited for in vain has more of it than that takes.
    for (sick, words, limit) in [
        ("--sick error --always", "executions in the loop came to a flight", "execute.timeout_s=10"),
        ("--sick silent --always", "without an answer", "execute.timeout_s=2"),
        ("--no-such-option", "ended without \"ready\"", "execute.timeout_s=10"),
    ] {
        fs::write(here.join("q.toml"), scenario(IN_LOOP, "high-velocity-90", sick)).unwrap();
        let begun = Instant::now();
        let limit = ["--set", limit, "--set", "execute.processes=1"];
        let (code, said, error) = run(here, &[&["stress", "q.toml", "--out", "a", "--force"], &limit[..]].concat());
        assert_eq!(code, 4, "{said}{error}");
        assert!(error.contains("EXECUTOR FAILED: ") && error.contains(words), "{error}");
        assert!(begun.elapsed() < Duration::from_secs(60), "{:?}", begun.elapsed());
    }
    // It ends after as many executions as a pool for all cases has, and those of the graph under way, whatever graphs
    // there are still.
    let grown = r#"{ method = "beam", waypoints = 40, cases = 2, executions = 8 }"#;
    for (search, score, most) in
        [(IN_LOOP, "high-velocity-90", 3 * 24), (grown, "executed", 2 * 8), (ADAPTIVE, "high-velocity-90", 42)]
    {
        fs::write(here.join("q.toml"), scenario(search, score, "--sick error --always")).unwrap();
        let (code, said, error) = run(here, &["stress", "q.toml", "--out", "a", "--force", "--threads", "1"]);
        assert!(code == 4 && error.contains("executions in the loop came to a flight"), "{said}{error}");
        let told = error.split(" executions in the loop failed").next().unwrap().rsplit(' ').next().unwrap();
        assert!(told.parse::<u64>().is_ok_and(|all| (1..=most + 30).contains(&all)), "{search}: {error}");
    }
    // With a program that flies it goes on.
    fs::write(here.join("q.toml"), scenario(IN_LOOP, "high-velocity-90", "")).unwrap();
    json(here, &["stress", "q.toml", "--out", "b"]);
}
