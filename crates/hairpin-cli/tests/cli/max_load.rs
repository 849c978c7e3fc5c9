//! `hairpin max-load --graph` as its users find it: answers, exit codes, refusals.

use std::fs;

use crate::commands::{json, refused, run};
use serde_json::json as object;

/// 0 – 1 – 2 – 3 in a ring with a chord, and point 4 without an arc.
const RING: &str = "0,1.5,,4,\n1.5,0,2.25,,\n,2.25,0,3,\n4,,3,0,\n,,,,\n";

#[test]
fn the_heaviest_path_is_told_in_the_files_unit() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("ring.csv"), RING).unwrap();
    for method in ["auto", "subsets", "branch", "dfs"] {
        let answer = json(folder.path(), &["max-load", "--graph", "ring.csv", "--method", method]);
        assert_eq!(answer["cost"], object!(9.25), "{answer}");
        assert_eq!(answer["bound"], answer["cost"], "{answer}");
        assert_eq!((&answer["proven"], &answer["gap_percent"]), (&object!(true), &object!(0.0)));
        let path: Vec<u64> = answer["path"].as_array().unwrap().iter().map(|p| p.as_u64().unwrap()).collect();
        assert!(path == [0, 3, 2, 1] || path == [1, 2, 3, 0], "{answer}");
        assert!(answer["time_s"].as_f64().is_some() && answer["scale"] == object!(100));
    }
    let fixed = json(folder.path(), &["max-load", "--graph", "ring.csv", "--start", "1", "--end", "2"]);
    assert_eq!((&fixed["path"], &fixed["cost"]), (&object!([1, 0, 3, 2]), &object!(8.5)));
    let alone = json(folder.path(), &["max-load", "--graph", "ring.csv", "--start", "4"]);
    assert_eq!((&alone["path"], &alone["cost"], &alone["exit_code"]), (&object!([4]), &object!(0.0), &object!(0)));
    let several = json(folder.path(), &["max-load", "--graph", "ring.csv", "--programs", "3"]);
    let costs: Vec<f64> =
        several["paths"].as_array().unwrap().iter().map(|path| path["cost"].as_f64().unwrap()).collect();
    assert_eq!(costs, [9.25, 8.5, 7.75]);
    let (code, out, _) = run(folder.path(), &["max-load", "--graph", "ring.csv"]);
    assert!(code == 0 && out.contains("optimal") && out.contains("→") && out.contains("left out"), "{out}");
}

#[test]
fn no_path_is_an_answer_with_its_reason() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("ring.csv"), RING).unwrap();
    let graph = ["max-load", "--graph", "ring.csv"];
    let none = json(folder.path(), &[&graph[..], &["--start", "0", "--end", "4"]].concat());
    assert_eq!((&none["path"], &none["exit_code"]), (&object!(null), &object!(3)));
    assert!(none["reason"].as_str().unwrap().contains("from point 0 to point 4"), "{none}");
    let dear = json(folder.path(), &[&graph[..], &["--min-cost", "9.251"]].concat());
    assert_eq!((&dear["path"], &dear["exit_code"]), (&object!(null), &object!(3)));
    assert!(dear["reason"].as_str().unwrap().contains("9.251"), "{dear}");
    let enough = json(folder.path(), &[&graph[..], &["--min-cost", "9.25"]].concat());
    assert_eq!(enough["cost"], object!(9.25));
}

#[test]
fn what_is_no_table_is_refused_with_its_place() {
    let folder = tempfile::tempdir().unwrap();
    let graph = ["max-load", "--graph", "g.csv"];
    for (text, words) in [
        ("0,1\n1,0,2\n", &["g.csv", "line 2", "3 cells"][..]),
        ("0,1\n-1,0\n", &["line 2", "column 1", "-1"]),
        ("0,NaN\n1,0\n", &["line 1", "column 2", "NaN"]),
        ("", &["g.csv", "empty"]),
        ("0,9000000000000000000\n1,0\n", &["9000000000000000000", "must be at most"]),
    ] {
        fs::write(folder.path().join("g.csv"), text).unwrap();
        refused(folder.path(), &graph, words);
    }
    refused(folder.path(), &["max-load", "--graph", "nowhere.csv"], &["nowhere.csv"]);
    fs::write(folder.path().join("g.csv"), "0,1\n1,0\n").unwrap();
    refused(folder.path(), &[&graph[..], &["--start", "2"]].concat(), &["start", "2"]);
    refused(folder.path(), &[&graph[..], &["--min-cost", "-3"]].concat(), &["min-cost", "-3"]);
    refused(folder.path(), &[&graph[..], &["--programs", "2", "--method", "dfs"]].concat(), &["dfs", "2"]);
    // What is of cells alone.
    for (more, name) in [
        (&["--out", "o"][..], "--out"),
        (&["--force"], "--force"),
        (&["--out", "o", "--force"], "--out"),
        (&["--set", "generate.mode=1"], "--set"),
        (&["irb120"], "CELL"),
    ] {
        refused(folder.path(), &[&graph[..], more].concat(), &[name, "cannot be used with"]);
    }
}

#[test]
fn a_certificate_holds_until_it_is_changed() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("ring.csv"), RING).unwrap();
    for method in ["subsets", "branch"] {
        let ask = ["max-load", "--graph", "ring.csv", "--method", method, "--certificate", "proof.json"];
        assert_eq!(json(folder.path(), &ask)["cost"], object!(9.25));
        let check = ["max-load", "--graph", "ring.csv", "--verify", "proof.json"];
        let answer = json(folder.path(), &check);
        assert_eq!((&answer["verified"], &answer["exit_code"]), (&object!(true), &object!(0)), "{answer}");
        let text = fs::read_to_string(folder.path().join("proof.json")).unwrap();
        let changed = text.replacen("\"cost\":925", "\"cost\":924", 1);
        assert_ne!(changed, text);
        fs::write(folder.path().join("proof.json"), changed).unwrap();
        let answer = json(folder.path(), &check);
        assert_eq!((&answer["verified"], &answer["exit_code"]), (&object!(false), &object!(1)), "{answer}");
    }
    fs::write(folder.path().join("other.json"), "{}").unwrap();
    refused(
        folder.path(),
        &["max-load", "--graph", "ring.csv", "--verify", "other.json"],
        &["other.json", "certificate"],
    );
}

#[test]
fn points_may_come_several_times() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("ring.csv"), RING).unwrap();
    let graph = ["max-load", "--graph", "ring.csv", "--visits", "2"];
    let answer = json(folder.path(), &[&graph[..], &["--certificate", "walk.json"]].concat());
    let path: Vec<usize> = answer["path"].as_array().unwrap().iter().map(|p| p.as_u64().unwrap() as usize).collect();
    assert!((0..4).all(|point| path.iter().filter(|p| **p == point).count() <= 2), "{answer}");
    let moves: std::collections::BTreeSet<&[usize]> = path.windows(2).collect();
    assert!(
        moves.len() == path.len() - 1 && answer["cost"].as_f64().unwrap() > 9.25 && answer["proven"] == true,
        "{answer}"
    );
    // Every move of the ring once, both ways.
    let often = json(folder.path(), &["max-load", "--graph", "ring.csv", "--visits", "16"]);
    assert_eq!(often["cost"], object!(21.5), "{often}");
    let verify = ["max-load", "--graph", "ring.csv", "--verify", "walk.json"];
    let (code, out, _) = run(folder.path(), &verify);
    assert!(code == 0 && out.contains("VERIFIED: no path that comes to no point more than 2 times"), "{out}");
    let text = fs::read_to_string(folder.path().join("walk.json")).unwrap();
    fs::write(folder.path().join("walk.json"), text.replace("\"visits\":2", "\"visits\":3")).unwrap();
    let (code, out, _) = run(folder.path(), &verify);
    assert!(code == 1 && out.contains("NOT VERIFIED"), "{out}");
    let (code, out, _) = run(folder.path(), &graph);
    assert!(code == 0 && out.contains("use no move twice"), "{out}");
    let several = json(folder.path(), &[&graph[..], &["--programs", "3"]].concat());
    assert_eq!(several["paths"].as_array().unwrap().len(), 3);
    refused(folder.path(), &[&graph[..], &["--method", "subsets"]].concat(), &["--visits"]);
}

#[test]
fn questions_of_the_bench_are_written_for_other_solvers() {
    let folder = tempfile::tempdir().unwrap();
    let asked = ["bench", "max-load-fixed", "--write", "questions", "--questions", "2"];
    let index = json(folder.path(), &asked);
    let questions = index["questions"].as_array().unwrap();
    assert_eq!(questions.len(), 2, "{index}");
    assert_eq!((&questions[0]["start"], &questions[0]["end"]), (&object!(0), &object!(49)));
    let written = fs::read_to_string(folder.path().join("questions/questions.json")).unwrap();
    assert!(written.contains("max-load-fixed-001.csv"), "{written}");
    let answer = json(
        folder.path(),
        &[
            "max-load",
            "--graph",
            "questions/max-load-fixed-001.csv",
            "--start",
            "0",
            "--end",
            "49",
            "--time-limit",
            "0",
        ],
    );
    assert_eq!((&answer["points"], &answer["scale"]), (&object!(50), &object!(1)), "{answer}");
    assert!((0.6..0.9).contains(&answer["density"].as_f64().unwrap()), "{answer}");
    refused(folder.path(), &["bench", "beam", "--write", "q"], &["max-load-15"]);
}
