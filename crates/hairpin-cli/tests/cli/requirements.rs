//! `hairpin requirements rover`: two tables of what was measured in this run, and answers to wrong input.

use crate::commands::{json, run};
use tempfile::tempdir;

/// What a busy machine may fail: times are measured by the command, not in a test.
const BY_THE_CLOCK: [&str; 8] = ["R-2", "R-5", "R-7", "R-17", "R6", "R8", "R14", "R15"];

#[test]
fn every_requirement_and_test_is_measured_and_those_without_a_clock_are_met() {
    let folder = tempdir().unwrap();
    let object = json(folder.path(), &["requirements", "rover", "--queries", "30"]);
    let ids = |table: &str| -> Vec<String> {
        object[table].as_array().unwrap().iter().map(|row| row["id"].as_str().unwrap().to_owned()).collect()
    };
    assert_eq!(ids("requirements"), (1..=17).map(|i| format!("R-{i}")).collect::<Vec<_>>());
    let mut tests = ids("tests");
    tests.sort_by_key(|id| id[1..].parse::<u32>().unwrap());
    assert_eq!(tests, (1..=19).map(|i| format!("R{i}")).collect::<Vec<_>>());
    let mut all = true;
    for row in object["requirements"].as_array().unwrap().iter().chain(object["tests"].as_array().unwrap()) {
        let passed = row["passed"] == true;
        all &= passed;
        assert!(passed || BY_THE_CLOCK.contains(&row["id"].as_str().unwrap()), "{row}");
        assert!(row["measured"].as_str().unwrap().contains(char::is_numeric), "{row}");
    }
    let measured = |id: &str| {
        let rows = object["tests"].as_array().unwrap();
        rows.iter().find(|row| row["id"] == id).unwrap()["measured"].as_str().unwrap().to_owned()
    };
    for id in ["R2", "R6", "R11"] {
        assert!(measured(id).contains("p99"), "{id} tells slow queries, too: {}", measured(id));
    }
    // The example program in both frames: what is right in one is left in the other.
    assert_eq!(object["example"]["solved"], true);
    let goal_y = &object["example"]["rows"][1];
    assert_eq!((goal_y["right_down"].as_str(), goal_y["left_up"].as_str()), (Some("1.000000"), Some("-1.000000")));
    assert_eq!(object["exit_code"], i32::from(!all));
}

#[test]
fn wrong_input_is_2() {
    let folder = tempdir().unwrap();
    for arguments in [
        &["requirements"][..],
        &["requirements", "arm"],
        &["requirements", "rover", "--queries", "1"],
        &["requirements", "rover", "--terrain", "no-such.tif"],
    ] {
        let (code, _, error) = run(folder.path(), arguments);
        assert!(code == 2 && !error.is_empty(), "{arguments:?}: {code} {error}");
    }
    // A map without room for drives is said to be one.
    std::fs::write(
        folder.path().join("small.asc"),
        "ncols 3\nnrows 3\nxllcorner 0\nyllcorner 0\ncellsize 1\n0 0 0\n0 0 0\n0 0 0\n",
    )
    .unwrap();
    let (code, _, error) = run(folder.path(), &["requirements", "rover", "--terrain", "small.asc"]);
    assert!(code == 2 && error.contains("room"), "{code} {error}");
}
