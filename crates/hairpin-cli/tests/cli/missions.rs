//! Waypoint files made elsewhere: what is wrong with one is told with line, column and value, and costs nothing; what
//! other programs do to a good one is forgiven.

use std::fs;
use std::path::Path;

use crate::commands::{SMALL, assert_same, copy, json, refused, run, small_hull};

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
    fs::write(folder.path().join("mine"), "three\n").unwrap();
    refused(folder.path(), &fly, &["mine, line 1", "no column `x_m`"]);
    fs::remove_file(folder.path().join("mine")).unwrap();
    fs::create_dir(folder.path().join("mine")).unwrap();
    refused(folder.path(), &fly, &["mine: no .csv file in it, nor a .plan"]);
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
        FINE.replace(',', ";"),
        FINE.replace(',', "\t"),
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

const PLAN: &str = include_str!("../../../hairpin-formats/tests/fixtures/missions/cage.plan");

fn write(folder: &Path, name: &str, text: &str) {
    fs::create_dir_all(folder.join("mine")).unwrap();
    fs::write(folder.join("mine").join(name), text).unwrap();
}

/// Missions are what is counted; what a search finds and what is drawn stands beside them alone.
#[test]
fn missions_are_judged_and_compared_with_what_a_search_finds() {
    let folder = tempfile::tempdir().unwrap();
    write(folder.path(), "a.plan", PLAN);
    write(folder.path(), "slow.csv", "x_m,y_m,z_m\n3,3,3\n5.5,3,3\n8,3,3\n");
    let set = ["--set", "generate.search.cases=3", "--set", "execute.repeat=1", "--set", "execute.baseline=4"];
    let found =
        json(folder.path(), &[&["stress", "demo-quadrotor", "--missions", "mine", "--out", "s"][..], &set].concat());
    assert_eq!(found["counts"]["cases"], 2, "{found}");
    assert_eq!(found["share"]["cases"], "given", "{found}");
    let worst = &found["missions"]["worst"];
    assert_eq!((worst["searched"]["cases"].as_u64(), worst["random"]["cases"].as_u64()), (Some(3), Some(4)), "{worst}");
    let [stress, most] = [&worst["stress"], &worst["searched"]["worst"]].map(|value| value.as_f64().unwrap());
    assert!((worst["searched"]["ratio"].as_f64().unwrap() - stress / most).abs() < 1e-12, "{worst}");
    let each = found["missions"]["each"].as_array().unwrap();
    assert_eq!(each.len(), 2);
    assert_eq!(
        (each[0]["mission"]["name"].as_str(), each[0]["mission"]["feasible"].as_bool()),
        (Some("a"), Some(true))
    );
    // Two metres and a half at a time are less stressful than all that is searched for.
    assert_eq!(each[1]["searched"]["below"], 0, "{each:?}");
    let verdict = found["verdict"].as_str().unwrap();
    assert!(verdict.contains("the most stressful mission is"), "{found}");
    // It demands a speed that minimum-snap does not take.
    assert!(verdict.contains("1/2 inconclusive, not counted (0000, the mission demands 3 m/s"), "{found}");
    let junit = fs::read_to_string(folder.path().join("s/junit.xml")).unwrap();
    assert_eq!(junit.matches("<testcase ").count(), 2, "{junit}");
    let report = fs::read_to_string(folder.path().join("s/report.html")).unwrap();
    assert!(report.contains("FEASIBLE") && report.contains("searched.parquet"), "nothing of the missions' check");
    // Their witnesses hold by code that shares nothing with the claim.
    let verified = json(folder.path(), &["verify", "s"]);
    assert_eq!((verified["checked"].as_u64(), verified["failed"].as_u64()), (Some(2), Some(0)), "{verified}");
    // Judged again, from the folder alone, they say the same.
    assert_eq!(json(folder.path(), &["judge", "s"])["missions"], found["missions"]);
    // One file alone, and what is not followed is refused.
    let one = json(folder.path(), &["execute", "s", "--missions", "mine/slow.csv"]);
    assert_eq!(one["counts"]["cases"], 1, "{one}");
    assert_eq!(json(folder.path(), &["judge", "s"])["missions"]["worst"]["searched"]["cases"], 3);
    write(folder.path(), "a.plan", &PLAN.replace("\"command\": 203", "\"command\": 18"));
    refused(
        folder.path(),
        &["execute", "s", "--missions", "mine"],
        &["a.plan", "item 4 (command 18, loiter for turns)"],
    );
}

/// What a search finds beside missions is counted nowhere, and where whoever executes fails in all of it, nothing is
/// there to compare with. The missions are judged and reported all the same.
#[test]
fn missions_are_judged_whatever_becomes_of_the_search_beside_them() {
    let folder = tempfile::tempdir().unwrap();
    mission(folder.path(), "x_m,y_m,z_m\n2,2,5\n6,2,5\n6,6,5\n");
    let sluggish = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data/sluggish.py");
    let command = format!("command = \"python3 '{sluggish}' --sick error --always --but 3\"");
    let in_loop = r#"{ method = "in-loop", waypoints = 60, cases = 2, executions = 8 }"#;
    let beam = r#"{ method = "beam", waypoints = 40, cases = 2 }"#;
    let in_loop_failed = "the search beside it failed (sluggish point: none of the executions in the loop came to a \
                          flight; the last: reports: not today)";
    let beam_failed = "none of 2 that a search finds was executed (";
    for (out, search, limit, outcome, code, failed) in [
        ("a", in_loop, "0.01", "FAIL 1/1", 1, in_loop_failed),
        ("b", in_loop, "15", "PASS 1/1", 0, in_loop_failed),
        ("c", beam, "15", "PASS 1/1", 0, beam_failed),
    ] {
        let text = small_hull(search).replace("controller = \"minimum-snap\"", &command);
        fs::write(folder.path().join("s.toml"), text.replace("max_m = 0.5", &format!("max_m = {limit}"))).unwrap();
        let found = json(folder.path(), &["stress", "s.toml", "--missions", "mine", "--out", out]);
        let verdict = found["verdict"].as_str().unwrap();
        assert!(verdict.starts_with(outcome) && found["exit_code"] == code, "{found}");
        assert!(verdict.contains(&format!(" m: nothing to compare with; {failed}")), "{verdict}");
        // What is counted is the mission's, not the scenario's.
        assert_eq!((&found["counts"]["cases"], &found["frame"]["length"]), (&1.into(), &3.into()), "{found}");
        let junit = fs::read_to_string(folder.path().join(out).join("junit.xml")).unwrap();
        assert_eq!((junit.matches("<testcase ").count(), junit.matches("<failure ").count()), (1, code));
        let report = fs::read_to_string(folder.path().join(out).join("report.html")).unwrap();
        assert!(report.contains("3 counts waypoints") && !report.contains("5 counts waypoints"));
        let judged = json(folder.path(), &["judge", out]);
        assert_eq!((&judged["verdict"], &judged["missions"]), (&found["verdict"], &found["missions"]));
        // Gone on with, it is searched again, and comes to the same.
        let again = json(folder.path(), &["stress", "s.toml", "--missions", "mine", "--out", out, "--resume"]);
        assert_eq!(again["verdict"], found["verdict"]);
    }
}

/// The folder's own search is what missions are compared with, where it was judged.
#[test]
fn missions_of_a_judged_campaign_are_compared_with_it() {
    let folder = tempfile::tempdir().unwrap();
    run(folder.path(), &[&SMALL[..], &["--out", "a"]].concat());
    mission(folder.path(), FINE);
    let (code, _, error) = run(folder.path(), &["execute", "a", "--missions", "mine"]);
    assert_eq!(code, 0, "{error}");
    let judged = json(folder.path(), &["judge", "a"]);
    assert_eq!(judged["missions"]["worst"]["searched"]["cases"], 4, "{judged}");
    assert_eq!(judged["counts"]["cases"], 1);
    // A stop makes two cases of a mission: each begins and ends at rest.
    let held = PLAN.replace("[0, 1, 0, null, 38.03364", "[3, 1, 0, null, 38.03364");
    fs::remove_file(folder.path().join("mine/up.csv")).unwrap();
    write(folder.path(), "a.plan", &held);
    let executed = json(folder.path(), &["execute", "a", "--missions", "mine"]);
    assert_eq!(executed["missions"], serde_json::json!(["a 0-1", "a 1-2"]), "{executed}");
}
