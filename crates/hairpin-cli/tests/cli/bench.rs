//! Whole commands, measured by the binary itself.

use std::fs;

use crate::commands::{json, run};

const INPUTS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../bench/commands");

#[test]
fn a_row_is_run_as_it_is_typed_and_leaves_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let asked = ["bench", "commands", "start", "--repeats", "2", "--inputs", INPUTS, "--scratch", "."];
    let told = json(folder.path(), &asked);
    let row = &told["rows"][0];
    assert_eq!(row["row"], "start");
    assert!(row["commands"][0]["command"].as_str().unwrap().starts_with("hairpin steer "), "{row}");
    assert_eq!(row["commands"][0]["runs"], 2);
    let number = |value: &serde_json::Value| value.as_f64().unwrap();
    let cpu_s = number(&row["commands"][0]["cpu_s"]);
    assert!((1e-4..5.0).contains(&cpu_s), "{row}");
    let figure = &row["figures"][0];
    assert!((number(&figure["measured"]) - 1e3 * cpu_s).abs() < 1e-9, "{row}");
    let ratio = number(&figure["measured"]) / number(&figure["kernel"]);
    assert!((number(&figure["ratio"]) / ratio - 1.0).abs() < 1e-9, "{row}");
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0, "its folder is gone");
}

#[test]
fn rows_are_listed_and_what_is_missing_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let (code, out, _) = run(folder.path(), &["bench", "commands", "--list"]);
    assert!(code == 0 && out.contains("steer-anywhere") && out.contains("--reversals"), "{out}");
    for (arguments, told) in [
        (vec!["bench", "commands", "start"], "--inputs DIR"),
        (vec!["bench", "commands", "no-such", "--inputs", INPUTS], "select-20000"),
        (vec!["bench", "commands", "start", "--repeats", "0"], "1..=100"),
        (vec!["bench", "beam", "commands"], "commands"),
    ] {
        let (code, out, error) = run(folder.path(), &arguments);
        assert!(code == 2 && error.contains(told) && out.is_empty(), "{arguments:?}: {out}{error}");
    }
}
