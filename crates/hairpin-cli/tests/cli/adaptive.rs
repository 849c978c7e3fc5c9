//! Adaptive campaigns: rounds of executing and learning, and what they are worth.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use crate::commands::{assert_same, json, refused};
use hairpin_formats::folder::CampaignFolder;
use serde_json::Value;

/// Small graphs of hull legs, flown by minimum snap.
const SCENARIO: &str = r#"
hairpin = 1
robot = "flightgoggles"
seed = 3
[world]
size_m = [18, 18, 18]
[task]
start_m = [3, 3, 3]
end_m = [15, 15, 15]
length = 10
[generate]
reach = "hull"
timing = { step_s = 1.0 }
search = { method = "adaptive", waypoints = 200, cases = 6, executions = 300, rounds = 3 }
[execute]
controller = "minimum-snap"
[spec]
deviation = { max_m = 0.5, from = "nearest-leg" }
"#;

fn adaptive(here: &Path, command: &str, out: &str, more: &[&str]) -> Value {
    fs::write(here.join("q.toml"), SCENARIO).unwrap();
    json(here, &[&[command, "q.toml", "--out", out], more].concat())
}

/// Graph and score of every case.
fn found(folder: &Path) -> Vec<(u64, f64)> {
    CampaignFolder::open(folder).unwrap().read_cases().unwrap().iter().map(|case| (case.graph, case.score)).collect()
}

/// Graph, executions, stress: the rows of best-so-far.tsv.
fn curve(folder: &Path) -> Vec<(u64, u64, f64)> {
    let table = fs::read_to_string(folder.join("best-so-far.tsv")).unwrap();
    let mut lines = table.lines();
    assert_eq!(lines.next(), Some("graph\texecutions\tmax_deviation_m"));
    let row = |line: &str| {
        let [graph, executions, stress] = line.split('\t').collect::<Vec<_>>()[..] else { panic!("{line}") };
        (graph.parse().unwrap(), executions.parse().unwrap(), stress.parse().unwrap())
    };
    lines.map(row).collect()
}

#[test]
fn rounds_beat_as_many_uniform_draws_in_the_same_graphs() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let told = adaptive(here, "stress", "rounds", &[]);
    // One round is nothing but uniform draws.
    let drawn = adaptive(here, "generate", "drawn", &["--set", "generate.search.rounds=1"]);
    let (rounds, uniform) = (found(&here.join("rounds")), found(&here.join("drawn")));
    let graphs = |found: &[(u64, f64)]| found.iter().map(|(graph, _)| *graph).collect::<Vec<_>>();
    assert_eq!((graphs(&rounds), rounds.len()), (graphs(&uniform), 6));
    let mean = |found: &[(u64, f64)]| found.iter().map(|(_, score)| score).sum::<f64>() / 6.0;
    assert!(mean(&rounds) > 1.08 * mean(&uniform), "{rounds:?} {uniform:?}");

    let kept = CampaignFolder::open(&here.join("rounds")).unwrap();
    for (result, (_, score)) in kept.read_results().unwrap().iter().zip(&rounds) {
        let deviation = result.measures.as_ref().unwrap().max_deviation;
        assert!((score - deviation).abs() < 1e-12, "{score} {deviation}: the score is the judge's own number");
    }
    let tally = kept.read_tally().unwrap();
    assert_eq!(
        tally.rounds.iter().map(|round| (round.executions, round.drawn, round.by_hand)).collect::<Vec<_>>(),
        [(100, 100, 0), (100, 10, 10), (100, 10, 10)]
    );
    for round in &tally.rounds[1..] {
        assert!(round.chosen_mean.unwrap() > 1.2 * round.drawn_mean.unwrap(), "{round:?}");
        assert!(round.by_hand_mean.unwrap() > round.drawn_mean.unwrap(), "{round:?}");
    }
    assert_eq!(drawn["generation"]["rounds"].as_array().unwrap().len(), 1);

    // The curve rises to what was kept, over all executions.
    assert_eq!(told["paths"]["best_so_far"], "rounds/best-so-far.tsv");
    let mut ends: BTreeMap<u64, (u64, f64)> = BTreeMap::new();
    for (graph, executions, stress) in curve(&here.join("rounds")) {
        let (before, least) = ends.insert(graph, (executions, stress)).unwrap_or((0, 0.0));
        assert!(before < executions && least <= stress);
    }
    let expected: BTreeMap<u64, (u64, f64)> = rounds.iter().map(|(graph, score)| (*graph, (50, *score))).collect();
    assert_eq!(ends, expected);
    let page = fs::read_to_string(here.join("rounds/report.html")).unwrap();
    assert!(page.contains("Stress against executions") && page.contains("ρ of the largest"));

    // What was learned is a model like any other.
    let learned = ["--set", "generate.search.method=\"exact\"", "--set", "generate.search.cases=1"];
    let model = ["--set", "generate.score=\"learned:rounds/score-model.json\""];
    adaptive(here, "generate", "learned", &[learned, [model[0], model[1], "--seed", "4"]].concat());
}

#[test]
fn rounds_are_the_same_on_any_number_of_threads_and_begin_anew_where_they_were_stopped() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let small = ["cases=2", "executions=39", "waypoints=80"].map(|set| format!("generate.search.{set}"));
    let small = small.each_ref().map(|set| ["--set", set]);
    let small = small.as_flattened();
    let with = |out: &str, more: &[&str]| adaptive(here, "stress", out, &[small, more].concat());
    with("two", &["--threads", "2"]);
    with("one", &["--threads", "1"]);
    assert_same(&here.join("one"), &here.join("two"));
    // What is complete is not done again.
    with("one", &["--resume"]);
    assert_same(&here.join("one"), &here.join("two"));
    // A campaign that time ended is one of the same cases when it is resumed without.
    with("stopped", &["--time-limit", "0.001"]);
    with("stopped", &["--resume"]);
    assert_same(&here.join("one"), &here.join("stopped"));
    // Half of the rounds have half of the time.
    let told = with("timed", &["--set", "generate.search.time_s=0.000001"]);
    assert_eq!((told["exit_code"].as_u64(), &told["counts"]["cases"]), (Some(5), &Value::from(0)), "{told}");
    assert!(told["verdict"].as_str().unwrap().starts_with("INCONCLUSIVE 0/2"), "{told}");
    // More than there is time for: no round is told that executed nothing. How many there are is up to the machine.
    let more = ["generate.search.executions=90000", "generate.search.rounds=3", "generate.search.time_s=0.6"];
    let more: Vec<&str> = more.iter().flat_map(|set| ["--set", set]).collect();
    let told = adaptive(here, "generate", "long", &[small, &more[..]].concat());
    let rounds = told["generation"]["rounds"].as_array().unwrap();
    assert!(!rounds.is_empty() && rounds.iter().all(|round| round["executions"].as_u64().unwrap() > 0), "{told}");
    let executed: u64 = rounds.iter().map(|round| round["executions"].as_u64().unwrap()).sum();
    assert!(executed < 90_000 && told["counts"]["cases"] == 2, "{told}");
}

/// Without waypoints between its ends a task has one trajectory, whatever the graph.
#[test]
fn a_trajectory_found_in_many_graphs_is_one_case() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let one_leg = ["task.length=2", "task.end_m=[5,5,5]", "generate.search.cases=13"];
    let sets: Vec<&str> = one_leg
        .iter()
        .chain(&["generate.search.executions=26", "generate.search.rounds=2"])
        .flat_map(|set| ["--set", set])
        .collect();
    let told = adaptive(here, "generate", "one", &sets);
    assert_eq!((found(&here.join("one")).len(), &told["generation"]["duplicates"]), (1, &12.into()), "{told}");
}

#[test]
fn what_a_graph_used_up_left_of_the_executions_is_said() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    adaptive(here, "stress", "few", &["--set", "generate.search.waypoints=50", "--set", "generate.search.cases=1"]);
    let rounds = CampaignFolder::open(&here.join("few")).unwrap().read_tally().unwrap().rounds;
    let made: u64 = rounds.iter().map(|round| round.executions).sum();
    assert!(0 < made && made < 300, "{made}");
    let sentence = format!("{made} of the search's 300 executions were made: its graphs gave no further trajectories.");
    let report = fs::read_to_string(here.join("few/report.html")).unwrap();
    assert!(report.contains(&sentence), "{sentence}");
}

#[test]
fn what_cannot_work_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    fs::write(here.join("q.toml"), SCENARIO).unwrap();
    let table: [(&[&str], &[&str]); 7] = [
        (&["generate.search.executions=38"], &["39 …", "in each of 3 rounds", "13 to learn from"]),
        (&["generate.search.cases=200"], &["600 …", "one in each of 200 graphs"]),
        (&["generate.search.move_waypoints=true"], &["must be false", "stays on its graphs' legs"]),
        (&["generate.search.confirm=2"], &["generate.search.confirm", "only the method `in-loop` confirms"]),
        (&["generate.search.explore=1.5"], &["generate.search.explore", "≤ 1"]),
        (&["vary.\"task.length\"={choice=[5,6]}"], &["`task.length` not varied"]),
        (&["generate.search.method=\"exact\"", "generate.search.time_s=3"], &["time_s", "only the method `adaptive`"]),
    ];
    for (sets, words) in table {
        let mut typed = vec!["generate", "q.toml", "--out", "no"];
        typed.extend(sets.iter().flat_map(|set| ["--set", set]));
        refused(here, &typed, words);
    }
}

#[test]
fn drives_have_rounds_too() {
    let folder = tempfile::tempdir().unwrap();
    let sets = ["method=\"adaptive\"", "cases=2", "executions=30", "rounds=2", "waypoints=16"];
    let sets: Vec<String> =
        sets.iter().map(|set| format!("generate.search.{set}")).chain(["task.length=4".into()]).collect();
    let mut typed = vec!["generate", "differential-drive", "--out", "drives"];
    typed.extend(sets.iter().flat_map(|set| ["--set", set]));
    let told = json(folder.path(), &typed);
    let rounds = told["generation"]["rounds"].as_array().unwrap();
    assert_eq!((rounds.len(), &rounds[1]["executions"], &rounds[1]["drawn"]), (2, &15.into(), &3.into()), "{told}");
    assert!(rounds[1]["r2"].is_number() && rounds[1]["unlearned"].is_null(), "{told}");
    assert_eq!(found(&folder.path().join("drives")).len(), 2);
}
