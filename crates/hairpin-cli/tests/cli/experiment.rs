//! `hairpin experiment`: tables and figures are written, searches agree, mistakes are told.

use std::fs;

use crate::commands::{json, refused, run};

#[test]
fn table_1_of_robtest_is_written_beside_the_papers() {
    let folder = tempfile::tempdir().unwrap();
    let small = [
        "experiment",
        "robtest-table-1",
        "--set",
        "points=[6, 12]",
        "--set",
        "instances=2",
        "--set",
        "dfs_limit_s=0.02",
    ];
    let answer = json(folder.path(), &small);
    let rows = answer["tables"]["table-1"].as_array().unwrap();
    assert_eq!(rows.len(), 2, "{answer}");
    for row in rows {
        assert_eq!(row["proven"], 2, "{row}");
        let number = |key: &str| row[key].as_f64().unwrap();
        assert!(number("proof_s") > 0.0 && number("graph_s") > 0.0 && (0.4..1.0).contains(&number("density")), "{row}");
    }
    assert_eq!((rows[0]["dfs_ended"].as_u64(), rows[0]["paper_graph_s"].as_f64()), (Some(2), None), "{answer}");
    // 41.83 s there; hundredths of a second end none here, and a mean over those that ended would be none of all.
    assert_eq!(rows[1]["dfs_s"].as_f64(), None, "{answer}");
    assert_eq!(rows[1]["paper_dfs_s"], 41.83, "{answer}");
    let files: Vec<&str> = answer["files"].as_array().unwrap().iter().map(|file| file.as_str().unwrap()).collect();
    assert_eq!(files, ["out/robtest-table-1/table-1.csv", "out/robtest-table-1/table-1.svg"]);
    let table = fs::read_to_string(folder.path().join(files[0])).unwrap();
    assert!(table.starts_with("points,density,") && table.lines().count() == 3, "{table}");
    assert!(fs::read_to_string(folder.path().join(files[1])).unwrap().contains("paper: DFS"));
}

#[test]
fn sizes_that_are_none_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    for (set, why) in [("instance=2", "unknown field"), ("points", "KEY=VALUE"), ("points=\"all\"", "invalid type")] {
        refused(folder.path(), &["experiment", "robtest-table-1", "--set", set], &[why]);
    }
    let negative = ["--set", "points=[5]", "--set", "instances=1", "--set", "cutoffs_s=[-1.0]"];
    refused(
        folder.path(),
        &[&["experiment", "robtest-figure-7"], &negative[..]].concat(),
        &["`cutoffs_s` = -1", "0 … 1000000"],
    );
    assert!(fs::read_dir(folder.path()).unwrap().next().is_none());
}

#[test]
fn metrics_and_the_follow_up_are_told_and_drawn() {
    let folder = tempfile::tempdir().unwrap();
    let metrics = ["experiment", "metrics", "--set", "graphs=6", "--set", "reach=[\"hull\"]", "--set", "length=6"];
    let answer = json(folder.path(), &metrics);
    let rows = answer["tables"]["metrics"].as_array().unwrap();
    assert_eq!(rows.len(), 3, "{answer}");
    for row in rows {
        let number = |key: &str| row[key].as_f64().unwrap_or_else(|| panic!("{key} of {row}"));
        let five = ["least", "lower_quartile", "median", "upper_quartile", "greatest"].map(number);
        assert!(five.is_sorted() && five[0] < five[4] && number("trajectories") == 6.0, "{row}");
        // Of n values no skewness is beyond (n − 2)/√(n − 1).
        assert!(number("deviation") > 0.0 && number("skewness").abs() <= 4.0 / 5.0_f64.sqrt() + 1e-9, "{row}");
    }
    for name in ["deviation", "acceleration", "time"] {
        let figure = fs::read_to_string(folder.path().join(format!("out/metrics/{name}.svg"))).unwrap();
        assert!(figure.contains("hull"), "{name}");
    }
    let sets = ["graphs=4", "training=65", "runs=1", "executions=12", "length=6", "reach=\"hull\""];
    let sets: Vec<&str> = sets.iter().flat_map(|set| ["--set", set]).collect();
    let answer = json(folder.path(), &[&["experiment", "follow-up"], &sets[..]].concat());
    let rows = answer["tables"]["follow-up"].as_array().unwrap();
    let ways: Vec<&str> = rows.iter().map(|row| row["way"].as_str().unwrap()).collect();
    assert_eq!(ways, ["uniform", "random beam", "learned", "in the loop"], "{answer}");
    // 30 % of four are one: the limit is the second largest of the baseline.
    assert_eq!((&rows[1]["over_limit_percent"], &rows[1]["lift_percent"]), (&25.0.into(), &0.0.into()), "{answer}");
    assert_eq!(rows[2]["paper_lift_percent"], 26.0, "{answer}");
    for name in ["figure-9", "figure-10-top", "figure-10-side", "figure-11"] {
        assert!(folder.path().join(format!("out/follow-up/{name}.svg")).is_file(), "{name}");
    }
}

#[test]
fn scores_are_compared_in_the_graphs_of_each_set() {
    let folder = tempfile::tempdir().unwrap();
    let reach = "reach=[\"hull\", { set = \"hull\", waypoints = 120, sampling = \"clustered\" }]";
    let sets = ["graphs=3", "runs=1", "ceiling=6", "length=6", "waypoints=150", "kinds=[\"by-hand\"]", reach];
    let one = ["controllers=[\"stable-waypoint\"]"];
    let sets: Vec<&str> = sets.iter().chain(&one).flat_map(|set| ["--set", set]).collect();
    let answer = json(folder.path(), &[&["experiment", "scores"], &sets[..]].concat());
    let summary = answer["tables"]["summary"].as_array().unwrap();
    let of_graphs = |row: &serde_json::Value| ["reach", "waypoints", "sampling"].map(|key| row[key].to_string());
    assert_eq!(of_graphs(&summary[0]), ["\"hull\"", "150", "\"uniform\""], "{answer}");
    assert_eq!(of_graphs(&summary[1]), ["\"hull\"", "120", "\"clustered\""], "{answer}");
    let lifts = answer["tables"]["lifts"].as_array().unwrap();
    for best in summary {
        let own = lifts.iter().filter(|row| of_graphs(row) == of_graphs(best));
        let by_hand = own.filter(|row| !["uniform", "random beam"].contains(&row["way"].as_str().unwrap()));
        let largest = by_hand.map(|row| row["lift_percent"].as_f64().unwrap()).fold(f64::NEG_INFINITY, f64::max);
        assert_eq!(best["stable_waypoint_percent"].as_f64(), Some(largest), "{best}");
        let figure = format!("hull-{}-{}.svg", best["waypoints"], best["sampling"].as_str().unwrap());
        assert!(fs::read_to_string(folder.path().join("out/scores").join(figure)).unwrap().contains("best by hand"));
    }
    refused(
        folder.path(),
        &["experiment", "scores", "--set", "reach=[{ waypoints = 120 }]"],
        &["name of a reach set", "set"],
    );
    refused(folder.path(), &["experiment", "scores", "--set", "reach=[\"hall\"]"], &["hall", "hull"]);
}

/// `experiment NAME` with `sets`.
fn asked(folder: &std::path::Path, name: &str, sets: &[&str]) -> serde_json::Value {
    let sets: Vec<&str> = sets.iter().flat_map(|set| ["--set", set]).collect();
    json(folder, &[&["experiment", name], &sets[..]].concat())
}

#[test]
fn yields_tell_which_trajectories_have_a_witness() {
    let folder = tempfile::tempdir().unwrap();
    let sets = ["seconds=0.3", "lengths=[5]", "reach=[\"sphere\", \"hull\"]", "certified=3"];
    let answer = asked(folder.path(), "yields", &sets);
    let rows = answer["tables"]["yields"].as_array().unwrap();
    assert_eq!(rows.len(), 2, "{answer}");
    for row in rows {
        let number = |key: &str| row[key].as_f64().unwrap_or_else(|| panic!("{key} of {row}"));
        assert!(number("trajectories") >= 1.0 && (1.0..=3.0).contains(&number("certified")), "{row}");
        // A witness that may take a step a leg may take its own time as well.
        assert!(number("witnessed_in_step_percent") <= number("witnessed_percent"), "{row}");
        assert!(row["witness_slower_by"].is_null() || number("witness_slower_by") > 0.25, "{row}");
    }
    assert!(fs::read_to_string(folder.path().join("out/yields/yields.svg")).unwrap().contains("sphere"));
}

#[test]
fn what_was_learned_here_is_flown_by_another_simulator() {
    let folder = tempfile::tempdir().unwrap();
    refused(folder.path(), &["experiment", "transfer"], &["executor", "experiments/with-rotorpy"]);
    let minimal = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/executors/minimal_executor.py");
    let executor = format!("executor=\"python3 '{minimal}'\"");
    let sets = ["cases=3", "training=26", "length=5", "waypoints=60", "simulator=\"a point\"", &executor];
    let answer = asked(folder.path(), "transfer", &sets);
    let rows = answer["tables"]["transfer"].as_array().unwrap();
    let names: Vec<&str> = rows.iter().map(|row| row["simulator"].as_str().unwrap()).collect();
    assert_eq!(names, ["hairpin, geometric", "a point"], "{answer}");
    let trajectories = answer["tables"]["trajectories"].as_array().unwrap();
    for (row, key) in rows.iter().zip(["hairpin_m", "other_m"]) {
        assert_eq!(row["trajectories"], 6, "{row}");
        for way in ["uniform", "learned"] {
            let own = trajectories.iter().filter(|trajectory| trajectory["way"] == way);
            let values: Vec<f64> = own.map(|trajectory| trajectory[key].as_f64().unwrap()).collect();
            let mean = values.iter().sum::<f64>() / values.len() as f64;
            assert!((mean - row[format!("{way}_m")].as_f64().unwrap()).abs() < 1e-9, "{row} {values:?}");
        }
    }
    assert!(folder.path().join("out/transfer/transfer.svg").is_file());
    let broken = ["cases=3", "training=26", "length=5", "waypoints=60", "executor=\"false\""];
    let sets: Vec<&str> = broken.iter().flat_map(|set| ["--set", set]).collect();
    let (code, _, error) = run(folder.path(), &[&["experiment", "transfer"], &sets[..]].concat());
    assert!(code == 4 && error.contains("EXECUTOR FAILED: other simulator, case 0000: "), "{code}: {error}");
}

#[test]
fn requirements_of_rovers_are_a_table_beside_the_sources() {
    let folder = tempfile::tempdir().unwrap();
    let answer = asked(folder.path(), "rover-requirements", &["queries=20"]);
    let [requirements, tests] = ["requirements", "tests"].map(|name| answer["tables"][name].as_array().unwrap());
    assert_eq!((requirements.len(), tests.len()), (17, 19), "{answer}");
    let convergence = tests.iter().find(|test| test["id"] == "R2").unwrap();
    assert_eq!((&convergence["result"], &convergence["source"]), (&"met".into(), &"passed, August 2007".into()));
    let figure = fs::read_to_string(folder.path().join("out/rover-requirements/times.svg")).unwrap();
    assert!(figure.contains("rocky8, rough ground") && figure.contains("R-5"));
    refused(folder.path(), &["experiment", "rover-requirements", "--set", "queries=3"], &["queries", "20"]);
}

#[test]
fn the_default_is_measured_cell_by_cell_and_goes_on_where_it_ended() {
    let folder = tempfile::tempdir().unwrap();
    let sets = "sets=[\"task.length=5\", \"generate.search.waypoints=24\"]";
    let families = format!(
        "families=[{{ scenario=\"quadrotor\", robots=[\"flightgoggles\"], controllers=[\"fixed-velocity\", \"hovering\"], {sets} }}]"
    );
    let sizes = ["experiment", "defaults", "--runs", "2", "--cases", "2", "--executions", "12", "--pairs", "3"];
    let small = ["--set", "fresh=1", "--set", "singles=3", "--set", "chance=2", "--set", &families];
    let asked = |seed: &'static str, only: &'static str| {
        [&sizes[..], &small[..], &["--seed-of", seed, "--only", only]].concat()
    };
    let answer = json(folder.path(), &asked("c0ffee", "flightgoggles/"));
    let rows = answer["tables"]["summary"].as_array().unwrap();
    assert_eq!((rows.len(), &rows[0]["cell"]), (1, &"flightgoggles/fixed-velocity".into()), "{answer}");
    let number = |row: &serde_json::Value, key: &str| row[key].as_f64().unwrap_or_else(|| panic!("{key} of {row}"));
    let interval = ["low_percent", "lift_percent", "high_percent"].map(|key| number(&rows[0], key));
    assert!(interval.is_sorted() && (0.0..=1.0).contains(&number(&rows[0], "a12")), "{answer}");
    // What nobody can fly is told, and no other cell is lost by it.
    let notes = answer["notes"].to_string();
    assert!(notes.contains("flightgoggles/hovering: not measured") && notes.contains("c0ffee"), "{notes}");

    let ways = answer["tables"]["ways"].as_array().unwrap();
    let names: Vec<&str> = ways.iter().map(|row| row["way"].as_str().unwrap()).collect();
    let all = ["single", "best of as many", "cmaes", "in-loop", "in-loop-moves", "worst-in-graph", "worst"];
    assert_eq!(names, all, "{answer}");
    // Two cases at most in each run, fewer where no two differ.
    for row in &ways[1..] {
        assert!((1.0..=4.0).contains(&number(row, "cases")) && number(row, "executions_a_case") >= 1.0, "{row}");
    }
    assert!(number(&ways[1], "executions_a_case") >= 12.0 && number(&ways[0], "cases") == 6.0, "{answer}");
    let default = &answer["tables"]["default-run"][0];
    assert!(default["pairs"] == 3 && number(default, "ahead_of_ten_times_by_chance") <= 3.0, "{default}");
    assert!(number(default, "by_chance_at") >= 1.0, "{default}");

    let cell = folder.path().join("out/defaults/cells/flightgoggles.fixed-velocity.json");
    let record: serde_json::Value = serde_json::from_str(&fs::read_to_string(&cell).unwrap()).unwrap();
    let run = &record["runs"][0];
    // The best of each half of what was drawn, as it was found.
    let uniform: Vec<f64> = run["uniform"].as_array().unwrap().iter().map(|one| one.as_f64().unwrap()).collect();
    let found = |case: usize| run["best"][case]["found"].as_f64().unwrap();
    let half = uniform.len() / 2;
    let most = |part: &[f64]| part.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    assert_eq!([found(0), found(1)], [most(&uniform[..half]), most(&uniform[half..])], "{run}");
    let text = fs::read_to_string(folder.path().join("out/defaults/defaults.md")).unwrap();
    assert!(text.contains("| flightgoggles/fixed-velocity | ") && text.contains(" of 3 | "), "{text}");

    // What is there is not measured again, and not taken for what other settings would give.
    let written = fs::metadata(&cell).unwrap().modified().unwrap();
    let again = json(folder.path(), &asked("c0ffee", "fixed-velocity"));
    assert_eq!(again["tables"], answer["tables"]);
    assert_eq!(fs::metadata(&cell).unwrap().modified().unwrap(), written);
    // What was interrupted within a cell goes on with the next of its runs.
    let mut part = record.clone();
    part["runs"].as_array_mut().unwrap().truncate(1);
    part["pairs"].as_array_mut().unwrap().clear();
    fs::write(&cell, part.to_string()).unwrap();
    let again = json(folder.path(), &asked("c0ffee", "fixed-velocity"));
    assert_eq!(again["tables"]["ways"], answer["tables"]["ways"]);
    let kept: serde_json::Value = serde_json::from_str(&fs::read_to_string(&cell).unwrap()).unwrap();
    assert_eq!((kept["runs"].as_array().unwrap().len(), kept["pairs"].as_array().unwrap().len()), (2, 3));
    refused(folder.path(), &asked("decaf", "fixed-velocity"), &["other settings", "flightgoggles.fixed-velocity.json"]);
    refused(folder.path(), &asked("c0ffee", "anafi/"), &["`only`", "anafi/"]);
    refused(folder.path(), &["experiment", "yields", "--pairs", "3"], &["pairs", "yields"]);
}
