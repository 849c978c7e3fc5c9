//! Waypoint files made elsewhere: what is wrong with one is told with line, column and value, and costs nothing; what
//! other programs do to a good one is forgiven.

use std::fs;
use std::path::Path;

use crate::commands::{SMALL, assert_same, copy, json, refused, run};

const FINE: &str = "x_m,y_m,z_m\n3,3,3\n3,3,9\n9,3,9\n";

fn mission(folder: &Path, text: impl AsRef<[u8]>) {
    fs::create_dir_all(folder.join("mine")).unwrap();
    fs::write(folder.join("mine/up.csv"), text).unwrap();
}

#[test]
fn a_broken_file_is_told_and_costs_nothing() {
    let folder = tempfile::tempdir().unwrap();
    run(folder.path(), &[&SMALL[..], &["--out", "a"]].concat());
    copy(&folder.path().join("a"), &folder.path().join("before"));
    let fly = ["execute", "a", "--missions", "mine"];
    refused(folder.path(), &fly, &["mine", "No such file"]);
    fs::write(folder.path().join("mine"), FINE).unwrap();
    refused(folder.path(), &fly, &["mine", "Not a directory"]);
    fs::remove_file(folder.path().join("mine")).unwrap();
    fs::create_dir(folder.path().join("mine")).unwrap();
    refused(folder.path(), &fly, &["mine: no .csv file in it"]);
    let long = format!("x_m,y_m,z_m\n{}", "3,3,3\n4,4,4\n".repeat(5001));
    let table: [(&[u8], &[&str]); 16] = [
        (b"", &["line 1", "no column `x_m`"]),
        (b"3,3,3\n3,3,9\n", &["line 1", "no column `x_m`", "`3,3,3`"]),
        (b"x_m,y_m\n3,3\n4,4\n", &["line 1", "no column `z_m`"]),
        (b"x_m,y_m,z_m\n", &["0 waypoints, must be at least 2"]),
        (b"x_m,y_m,z_m\n3,3,3\n", &["1 waypoints, must be at least 2"]),
        (b"x_m,y_m,z_m\n3,3,3\n3,NaN,9\n", &["line 3, column `y_m`: `NaN`", "finite"]),
        (b"x_m,y_m,z_m\n3,3,3\n3,3,inf\n", &["line 3, column `z_m`: `inf`", "finite"]),
        (b"x_m,y_m,z_m\n3,3,3\n3,3,1e999\n", &["line 3, column `z_m`: `1e999`", "finite"]),
        (b"x_m,y_m,z_m\nthree,3,3\n3,3,9\n", &["line 2, column `x_m`: `three`"]),
        (b"x_m,y_m,z_m\n3,3,3\n3,,9\n", &["line 3, column `y_m`: ``"]),
        (b"x_m,y_m,z_m\n3,3,3\n3,3\n", &["line 3: 2 values, the header has 3"]),
        (b"x_m,y_m,z_m\n3,3,3\n3,3,9,1\n", &["line 3: 4 values, the header has 3"]),
        (b"x_m,y_m,z_m\n3,3,3\n3,3,3\n", &["line 3: the waypoint of line 2 again"]),
        (b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR", &["line 1", "no column `x_m`"]),
        (b"x_m,y_m,z_m\n3,3,3\n3,3,1e300\n", &["line 3, column `z_m`: `1e300`", "20000"]),
        (long.as_bytes(), &["line 10002: more than 10000 waypoints"]),
    ];
    for (text, words) in table {
        mission(folder.path(), text);
        refused(folder.path(), &fly, &[&["mine/up.csv"], words].concat());
    }
    // A folder that looks like a file.
    fs::remove_file(folder.path().join("mine/up.csv")).unwrap();
    fs::create_dir(folder.path().join("mine/up.csv")).unwrap();
    refused(folder.path(), &fly, &["mine/up.csv", "directory"]);
    assert_same(&folder.path().join("before"), &folder.path().join("a"));
}

#[test]
fn what_spreadsheets_write_flies_as_the_same_mission() {
    let folder = tempfile::tempdir().unwrap();
    run(folder.path(), &["generate", "demo-quadrotor", "--set", "generate.search.cases=1", "--out", "a"]);
    let mut flown = Vec::new();
    for text in [
        FINE.to_owned(),
        FINE.replace('\n', "\r\n"),
        format!("\u{feff}{FINE}"),
        FINE.trim_end().to_owned(),
        format!("{FINE}\n \n"),
        "note,z_m,\"y_m\", x_m\na,3,3,3\nb,9.0,3,3\nc,9,\"3\",9e0\n".to_owned(),
    ] {
        mission(folder.path(), &text);
        assert_eq!(json(folder.path(), &["execute", "a", "--missions", "mine"])["counts"]["cases"], 1, "{text:?}");
        flown.push(fs::read(folder.path().join("a/executions/part-00000.parquet")).unwrap());
        assert!(*flown.last().unwrap() == flown[0], "{text:?} flies otherwise");
    }
}

#[test]
fn a_waypoint_outside_the_world_is_warned_of_and_flown() {
    let folder = tempfile::tempdir().unwrap();
    run(folder.path(), &["generate", "demo-quadrotor", "--set", "generate.search.cases=1", "--out", "a"]);
    mission(folder.path(), "x_m,y_m,z_m\n3,3,3\n3,3,-9\n");
    let (code, _, error) = run(folder.path(), &["execute", "a", "--missions", "mine"]);
    assert!(code == 0 && error.contains("up.csv: waypoint 1 lies outside the world"), "{code}: {error}");
    let verdict = json(folder.path(), &["judge", "a"]);
    assert_eq!(verdict["exit_code"], 1, "{verdict}");
    assert!(verdict["verdict"].to_string().contains("worst crash"), "{verdict}");
}
