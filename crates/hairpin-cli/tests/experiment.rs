//! `hairpin experiment`: tables and figures are written, searches agree, mistakes are told.

mod commands;

use std::fs;

use commands::{json, refused};

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
    assert!(fs::read_dir(folder.path()).unwrap().next().is_none());
}
