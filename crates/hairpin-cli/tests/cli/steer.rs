//! `hairpin steer`: every status and column of the batch contract, and answers that hold by equations of the test's
//! own.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use assert_cmd::Command;
use serde_json::Value;

/// Runs in `folder`; exit code, stdout, stderr.
fn run(folder: &Path, arguments: &[&str]) -> (i32, String, String) {
    let mut command = Command::cargo_bin("hairpin").expect("the binary is built with its tests");
    let output = command.current_dir(folder).args(arguments).output().unwrap();
    let text = |bytes| String::from_utf8(bytes).expect("UTF-8");
    (output.status.code().expect("no signal"), text(output.stdout), text(output.stderr))
}

/// One row of R.csv by column.
type Row = BTreeMap<String, String>;

/// Runs a batch of `queries`; its rows. Cells of these tests hold no commas.
fn batch(queries: &str, flags: &[&str]) -> Vec<Row> {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("q.csv"), queries).unwrap();
    let (code, out, error) =
        run(folder.path(), &[&["steer", "generic", "--queries", "q.csv", "--out", "r.csv"], flags].concat());
    assert_eq!(code, 0, "{out}{error}");
    let text = fs::read_to_string(folder.path().join("r.csv")).unwrap();
    let mut lines = text.lines();
    let names: Vec<&str> = lines.next().unwrap().split(',').collect();
    assert_eq!(names.len(), 22);
    let row = |line: &str| {
        let cells: Vec<&str> = line.split(',').collect();
        assert_eq!(cells.len(), names.len(), "{line}");
        names.iter().zip(cells).map(|(name, cell)| ((*name).to_owned(), cell.to_owned())).collect()
    };
    lines.map(row).collect()
}

fn number(row: &Row, column: &str) -> f64 {
    row[column].parse().unwrap_or_else(|_| panic!("{column} = {:?}", row[column]))
}

/// The rows of each query, in order.
fn by_query(rows: &[Row]) -> Vec<Vec<Row>> {
    let mut all: Vec<Vec<Row>> = Vec::new();
    for row in rows {
        match all.last_mut() {
            Some(last) if last[0]["id"] == row["id"] => last.push(row.clone()),
            _ => all.push(vec![row.clone()]),
        }
    }
    all
}

/// Where the rows of one query end, by the midpoint rule on 5 000 steps a segment: x, y, yaw, κ; largest |κ|, |κ′|.
fn drive(rows: &[Row], crab: f64) -> ([f64; 4], [f64; 2]) {
    let ([mut x, mut y, mut yaw, mut bend], mut most) = ([0.0f64; 4], [0.0f64; 2]);
    let mut before: Option<(f64, f64)> = None;
    for row in rows {
        if row["kind"] == "turn" {
            yaw += number(row, "turn_rad");
            (bend, before) = (0.0, None);
            continue;
        }
        let a: Vec<f64> = (0..6).map(|i| number(row, &format!("a{i}"))).collect();
        let (length, direction) = (number(row, "length_m"), number(row, "direction"));
        let at = |s: f64| a.iter().rev().fold(0.0, |sum, a| sum * s + a);
        if let Some((curvature, gear)) = before {
            assert!(gear != direction || (at(0.0) - curvature).abs() < 1e-6, "a jump of curvature: {rows:?}");
        }
        let steps = 5_000;
        let h = length / f64::from(steps);
        for i in 0..steps {
            let s = (f64::from(i) + 0.5) * h;
            let middle = yaw + direction * at(s) * 0.5 * h + crab;
            (x, y) = (x + direction * h * middle.cos(), y + direction * h * middle.sin());
            yaw += direction * at(s) * h;
            let slope = (1..6).rev().fold(0.0, |sum, i| sum * s + i as f64 * a[i]);
            most = [most[0].max(at(s).abs()), most[1].max(slope.abs())];
        }
        bend = at(length);
        before = Some((bend, direction));
    }
    ([x, y, yaw, bend], most)
}

/// Panics unless the rows of one query end in `goal` (x, y, yaw, κ) within the bounds of `generic`.
fn check(rows: &[Row], goal: [f64; 4], crab: f64) {
    assert!(rows.iter().all(|row| row["status"] == "ok"), "{rows:?}");
    let ([x, y, yaw, bend], [most, rate]) = drive(rows, crab);
    assert!((x - goal[0]).hypot(y - goal[1]) < 0.0101, "{x} {y}, not {goal:?}: {rows:?}");
    assert!((0.5 * (yaw - goal[2])).sin().abs() < 0.0051 && (bend - goal[3]).abs() < 0.0101, "{rows:?}");
    assert!(most <= 1.0 + 1e-9 && rate <= 1.0 + 1e-9, "{most} {rate}: {rows:?}");
    let told = (number(&rows[0], "err_x_m") - (x - goal[0])).hypot(number(&rows[0], "err_y_m") - (y - goal[1]));
    assert!(told < 1e-4, "the replay tells {told} m else: {rows:?}");
    assert!((number(&rows[0], "max_curvature_1_m") - most).abs() < 1e-3);
}

/// A stream of numbers in [−1, 1) from a seed (splitmix64).
fn uniform(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed;
    move || {
        state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = state;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
}

#[test]
fn hard_queries_are_all_answered_within_the_bounds() {
    let mut next = uniform(5);
    let mut goals = Vec::new();
    let mut text = String::from("id,x,y,yaw,k0,kf\r\n");
    for id in 0..120 {
        let goal = [4.0 * next(), 4.0 * next(), 3.2 * next(), if id % 3 == 0 { next() } else { 0.0 }];
        text += &format!(
            "{id},{},{},{},{},{}\r\n",
            goal[0],
            goal[1],
            goal[2],
            if id % 2 == 0 { 0.0 } else { next() },
            goal[3]
        );
        goals.push(goal);
    }
    for flags in [&["--reversals"][..], &["--turns"], &[]] {
        let queries = by_query(&batch(&text, flags));
        assert_eq!(queries.len(), goals.len());
        for (rows, goal) in queries.iter().zip(&goals) {
            check(rows, *goal, 0.0);
            let reversed = rows.iter().any(|row| row["direction"] == "-1");
            let turned = rows.iter().any(|row| row["kind"] == "turn");
            assert!(
                (!reversed || flags.contains(&"--reversals")) && (!turned || flags.contains(&"--turns")),
                "{rows:?}"
            );
            let numbers: Vec<usize> = rows.iter().map(|row| row["segment"].parse().unwrap()).collect();
            assert_eq!(numbers, (0..rows.len()).collect::<Vec<_>>());
        }
    }
}

#[test]
fn straight_back_is_one_line_in_reverse_whatever_else_is_allowed() {
    let rows = by_query(&batch("id,x,y,yaw,k0,kf\n0,-2,0,0,0,0\n1,2,0,0,0,0\n", &["--reversals", "--turns"]));
    for (rows, direction) in rows.iter().zip(["-1", "1"]) {
        assert_eq!((rows.len(), rows[0]["direction"].as_str(), rows[0]["kind"].as_str()), (1, direction, "arc"));
    }
    let folder = tempfile::tempdir().unwrap();
    let asked = ["steer", "generic", "--to=-2,0,0", "--reversals", "--turns", "--json"];
    // A place to keep out of beside the way changes nothing.
    for more in [&[][..], &["--keep-out-circle", "0.7,0,0.05"]] {
        let (code, out, error) = run(folder.path(), &[&asked[..], more].concat());
        let object: Value = serde_json::from_str(&out).unwrap_or_else(|why| panic!("{why}: {out}{error}"));
        assert_eq!((code, object["segments"].as_array().unwrap().len()), (0, 1), "{object}");
    }
}

#[test]
fn columns_mean_what_they_say() {
    let head = "id,sx,sy,syaw,x,y,yaw,k0,kf,v0,vf,direction,frame,max_curvature,tolerance_m\n";
    let rows = batch(
        &format!(
            "{head}plain,0,0,0,5,1,0.3,0,0,,,,,,\nplace,50,-20,2,5,1,0.3,0,0,0.5,1,,enu,,\nned,0,0,0,5,-1,-0.3,0,0,,,,ned,,\n\
             crab,0,0,0,5,1,0.3,0,0,,,0.4,,,\nwide,0,0,0,5,2,0.3,0,0,,,,,0.4,\nabove,0,0,0,5,1,0.3,0.5,0,,,,,0.4,0.02\n"
        ),
        &["--reversals"],
    );
    let queries = by_query(&rows);
    check(&queries[0], [5.0, 1.0, 0.3, 0.0], 0.0);
    // Flat ground is the same everywhere, and left in one frame is right in the other.
    for (other, sign) in [(&queries[1], 1.0), (&queries[2], -1.0)] {
        for (a, b) in queries[0].iter().zip(other) {
            for column in ["a0", "a1", "a2", "a3", "a4", "a5", "turn_rad"] {
                assert_eq!(number(a, column), sign * number(b, column), "{column}");
            }
            assert_eq!(a["length_m"], b["length_m"]);
        }
    }
    check(&queries[3], [5.0, 1.0, 0.3, 0.0], 0.4);
    check(&queries[4], [5.0, 2.0, 0.3, 0.0], 0.0);
    assert!(number(&queries[4][0], "max_curvature_1_m") <= 0.4 * (1.0 + 1e-9));
    let [above] = &queries[5][..] else { panic!("{:?}", queries[5]) };
    assert_eq!(
        (above["status"].as_str(), above["limit"].as_str(), above["kind"].as_str()),
        ("infeasible", "curvature_1_m", "")
    );
    assert!((number(above, "excess") - 0.1).abs() < 1e-12);
}

#[test]
fn every_status_and_the_start_value() {
    let text = "\u{feff}id,x,y,yaw,k0,kf\r\n\"good, really\",3,0,0,0,0\r\nbad,3,zero,0,0,0\r\nshort,3\r\nsharp,3,0,0,0,2\r\nfar,1e9,0,0,0,0\r\n";
    let text = text.replace("good, really", "good");
    let statuses = |flags: &[&str]| -> Vec<String> {
        by_query(&batch(&text, flags)).iter().map(|rows| rows[0]["status"].clone()).collect()
    };
    assert_eq!(statuses(&[]), ["ok", "invalid", "invalid", "infeasible", "invalid"]);
    assert_eq!(statuses(&["--time-limit-ms", "1000"]), ["ok", "invalid", "invalid", "infeasible", "invalid"]);
    assert_eq!(statuses(&["--time-limit-ms", "0"]), ["time_limit", "invalid", "invalid", "infeasible", "invalid"]);
    let start = batch("id,x,y,yaw,k0,kf\nq,4,2,0.5,0,0\n", &["--time-limit-ms", "0"]);
    assert!(start[0]["kind"] == "arc" && number(&start[0], "length_m") > 0.0, "{start:?}");
    let invalid = batch("id,x,y,yaw,k0,kf\nq,4,nan,0.5,0,0\nr,4,2,0.5,0,0\n", &[]);
    assert_eq!((invalid[0]["limit"].as_str(), invalid[0]["length_m"].as_str()), ("y", ""));
}

#[test]
fn files_are_the_same_on_any_number_of_threads() {
    let mut next = uniform(9);
    let mut text = String::from("id,x,y,yaw,k0,kf\n");
    for id in 0..200 {
        text += &format!("q{id},{},{},{},0,0\n", 5.0 * next(), 5.0 * next(), 3.0 * next());
    }
    let without_time = |threads: &str| {
        let mut rows = batch(&text, &["--reversals", "--threads", threads]);
        rows.iter_mut().for_each(|row| drop(row.remove("time_us")));
        rows
    };
    assert_eq!(without_time("1"), without_time("3"));
}

#[test]
fn broken_files_and_flags_are_2() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    fs::write(path.join("short.csv"), "id,x,y,yaw,k0\na,1,2,0,0\n").unwrap();
    fs::write(path.join("quote.csv"), "id,x,y,yaw,k0,kf\n\"a,1,2,0,0,0\n").unwrap();
    fs::write(path.join("empty.csv"), "").unwrap();
    fs::write(path.join("q.csv"), "id,x,y,yaw,k0,kf\na,1,2,0,0,0\n").unwrap();
    fs::write(path.join("own.toml"), "kind = \"rover\"\nname = \"own\"\n[limits]\ncurvature_1_m = -1\n").unwrap();
    for (arguments, told) in [
        (vec!["steer", "generic"], "--to"),
        (vec!["steer", "generic", "--queries", "none.csv"], "none.csv"),
        (vec!["steer", "generic", "--queries", "short.csv"], "`kf`"),
        (vec!["steer", "generic", "--queries", "quote.csv"], "quotes"),
        (vec!["steer", "generic", "--queries", "empty.csv"], "`id`"),
        (vec!["steer", "anafi", "--to", "1,0,0"], "no rover"),
        (vec!["steer", "genric", "--to", "1,0,0"], "did you mean `generic`?"),
        (vec!["steer", "own.toml", "--to", "1,0,0"], "own.toml"),
        (vec!["steer", "generic", "--to", "1,0"], "X,Y,YAW"),
        (vec!["steer", "generic", "--to", "1,0,x"], "X,Y,YAW"),
        (vec!["steer", "generic", "--to", "1e9,0,0"], "`x`"),
        (vec!["steer", "generic", "--to", "1,0,0", "--max-curvature", "0"], "> 0"),
        (vec!["steer", "generic", "--to", "1,0,0", "--queries", "q.csv"], "cannot be used with"),
        (vec!["steer", "generic", "--queries", "q.csv", "--time-limit-ms", "-1"], "milliseconds"),
        (vec!["steer", "generic", "--to", "1,0,0", "--out", "r.csv"], "cannot be used with"),
        (vec!["steer", "generic", "--from", "1,0,0", "--out", "r.csv"], "cannot be used with"),
        (vec!["steer", "generic", "--to", "1,0,0", "--resume"], "cannot be used with"),
        (vec!["steer", "quadrotor", "--to", "1,0,0"], "no rover"),
    ] {
        let (code, out, error) = run(path, &arguments);
        assert!(code == 2 && out.is_empty() && error.contains(told), "{arguments:?}: {code} {out} {error}");
    }
}

/// Where nothing else takes them, the answers are in the object.
#[test]
fn machines_get_the_answers_without_a_file_too() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("q.csv"), "id,x,y,yaw,k0,kf\n7,4,1,0.5,0,0\nb,x,1,0,0,0\n").unwrap();
    let ask = ["steer", "generic", "--queries", "q.csv", "--json"];
    let object = |more: &[&str]| -> Value {
        let (code, out, error) = run(folder.path(), &[&ask[..], more].concat());
        assert_eq!(code, 0, "{error}");
        serde_json::from_str(&out).unwrap_or_else(|why| panic!("{why}: {out}{error}"))
    };
    let answers = object(&[])["answers"].as_array().unwrap().clone();
    let filed = object(&["--out", "r.csv"]);
    assert!(filed.get("answers").is_none() && filed["queries"] == 2, "{filed}");
    let table = fs::read_to_string(folder.path().join("r.csv")).unwrap();
    let mut lines = table.lines();
    let names: Vec<&str> = lines.next().unwrap().split(',').collect();
    assert_eq!(lines.clone().count(), answers.len());
    for (line, answer) in lines.zip(&answers) {
        assert_eq!(answer.as_object().unwrap().len(), names.len(), "{answer}");
        for (name, cell) in names.iter().zip(line.split(',')).filter(|(name, _)| **name != "time_us") {
            let told = match &answer[*name] {
                Value::Null => String::new(),
                Value::String(text) => text.clone(),
                number => number.as_f64().unwrap().to_string(),
            };
            assert_eq!(told, cell, "{name} of {answer}");
        }
    }
}

#[test]
fn one_question_in_words_as_json_and_as_a_picture() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    let (code, out, error) = run(path, &["steer", "generic", "--to", "4,1,0.5", "--plot", "drive.svg"]);
    assert!(code == 0 && out.contains("ok (generic") && error.is_empty(), "{out}{error}");
    assert!(fs::read_to_string(path.join("drive.svg")).unwrap().starts_with("<svg"));
    let object = |arguments: &[&str]| -> (i32, serde_json::Value) {
        let (code, out, error) = run(path, &[&["steer", "generic", "--json"], arguments].concat());
        (code, serde_json::from_str(&out).unwrap_or_else(|_| panic!("{out}{error}")))
    };
    // From a pose to a pose of the same map; in the other frame it is the mirror image.
    let (code, enu) = object(&["--from", "10,5,1.5707963267948966", "--to", "9,9,1.8"]);
    assert!(code == 0 && enu["status"] == "ok" && enu["length_m"].as_f64().unwrap() < 4.5, "{enu}");
    let (_, ned) = object(&["--frame", "ned", "--from", "5,10,0", "--to", "9,9,-0.22920367320510344"]);
    assert!((enu["length_m"].as_f64().unwrap() - ned["length_m"].as_f64().unwrap()).abs() < 1e-6, "{enu}{ned}");
    assert!(
        (enu["segments"][0]["curvature"][1].as_f64().unwrap() + ned["segments"][0]["curvature"][1].as_f64().unwrap())
            .abs()
            < 1e-6
    );
    let (code, sharp) = object(&["--to", "3,0,0,1.5"]);
    assert_eq!((code, sharp["limit"].as_str(), sharp["excess"].as_f64()), (3, Some("curvature_1_m"), Some(0.5)));
    assert_eq!(sharp["nearest"]["kf"], 1.0);
    let (code, start) = object(&["--to", "3,1,0", "--time-limit-ms", "0"]);
    assert_eq!((code, start["status"].as_str()), (5, Some("time_limit")));
    let (_, aside) = object(&["--to", "0,1,0", "--reversals"]);
    let (_, around) = object(&["--to", "0,1,0"]);
    assert!(aside["reversals"].as_u64().unwrap() > 0 && around["reversals"] == 0);
    let metres =
        |answer: &serde_json::Value, key: &str| answer[key].as_f64().unwrap_or_else(|| panic!("{key}: {answer}"));
    assert!(metres(&aside, "length_m") < 0.5 * metres(&around, "length_m"));
    // The long way round says so, and names the goal beside it that needs none.
    assert!(metres(&around, "detour") > 2.0 && metres(&enu, "detour") < 1.5 && enu.get("nearest_goal").is_none());
    let near = ["x", "y", "yaw", "kf"].map(|key| metres(&around["nearest_goal"], key).to_string()).join(",");
    let (code, direct) = object(&[&format!("--to={near}")]);
    assert!(code == 0 && metres(&direct, "detour") < 1.51, "{near}: {direct}");
    // The long way round names the reversal that spares it.
    assert!((metres(&around, "with_reversals_m") - metres(&aside, "length_m")).abs() < 1e-9);
    assert!(enu.get("with_reversals_m").is_none() && aside.get("with_reversals_m").is_none());
    let (code, own) = {
        fs::write(path.join("own.toml"), "kind = \"rover\"\nname = \"own\"\n[limits]\ncurvature_1_m = 0.25\n").unwrap();
        let (code, out, _) = run(path, &["steer", "own.toml", "--to", "8,3,0.5", "--json"]);
        (code, serde_json::from_str::<serde_json::Value>(&out).unwrap())
    };
    assert!(code == 0 && own["robot"] == "own" && own["max_curvature_1_m"].as_f64().unwrap() <= 0.25 + 1e-9, "{own}");
}

#[test]
fn answers_that_are_none_name_what_would_be_one() {
    let folder = tempfile::tempdir().unwrap();
    let ask = |arguments: &[&str]| -> (i32, serde_json::Value) {
        let (code, out, error) = run(folder.path(), &[&["steer", "generic", "--json"], arguments].concat());
        (code, serde_json::from_str(&out).unwrap_or_else(|_| panic!("{out}{error}")))
    };
    // Beside the start is no place for a cubic; a goal that is one is named in the map, in either frame.
    for (frame, from, to) in [("enu", "2,1,0.4", "2.2,2.5,0.4"), ("ned", "1,2,0.4", "2.5,2.2,0.4")] {
        let whole = ["--control", "cubic", "--frame", frame, "--from", from];
        let (code, answer) = ask(&[&whole[..], &["--to", to]].concat());
        assert!(code != 0, "{answer}");
        let part = |key: &str| answer["nearest_goal"][key].as_f64().unwrap_or_else(|| panic!("{key}: {answer}"));
        let there = format!("{},{},{},{}", part("x"), part("y"), part("yaw"), part("kf"));
        let (code, again) = ask(&[&whole[..], &["--to", &there]].concat());
        assert_eq!(code, 0, "{there}: {again}");
    }
    // Walled in, a vehicle needs more than it is allowed.
    let wall = ["--keep-out-polygon", "1.2,-9,1.4,-9,1.4,9,1.2,9", "--to=-2,0,0"];
    let (code, alone) = ask(&wall);
    let (_, both) = ask(&[&wall[..], &["--reversals"]].concat());
    assert_eq!((code, &alone["limit"], &both["status"]), (3, &"keep_out".into(), &"ok".into()), "{alone} {both}");
    assert_eq!(
        (&alone["with_reversals_m"], &alone["keep_out"]["place"]),
        (&both["length_m"], &"--keep-out-polygon 0".into())
    );
    assert!(alone["excess"].as_f64().unwrap() > 0.0 && alone["keep_out"]["after_m"].as_f64().unwrap() > 0.5, "{alone}");
}

#[test]
fn precision_steps_and_costs_are_what_was_asked_for() {
    let folder = tempfile::tempdir().unwrap();
    let ask = |arguments: &[&str]| -> serde_json::Value {
        let (_, out, error) =
            run(folder.path(), &[&["steer", "generic", "--json", "--to", "5,2.5,-0.8"], arguments].concat());
        serde_json::from_str(&out).unwrap_or_else(|_| panic!("{out}{error}"))
    };
    let number =
        |answer: &serde_json::Value, key: &str| answer[key].as_f64().unwrap_or_else(|| panic!("{key}: {answer}"));
    let plain = ask(&[]);
    // Shorter steps take more of them, and none are too few.
    let slow = ask(&["--step-scale", "0.5"]);
    assert!(slow["status"] == "ok" && number(&slow, "iterations") > number(&plain, "iterations"), "{slow} {plain}");
    let none = ask(&["--iterations", "0", "--control", "cubic"]);
    assert!(none["status"] != "ok" && none["iterations"] == 0, "{none}");
    // A looser precision is met in no more steps, a stricter one is met as well.
    let strict = ask(&["--tolerance-m", "1e-7", "--tolerance-yaw-rad", "1e-7", "--tolerance-curvature-1-m", "1e-7"]);
    assert!(strict["status"] == "ok" && number(&strict["errors"], "x_m").abs() < 1e-7, "{strict}");
    assert!(number(&strict, "iterations") >= number(&plain, "iterations"), "{strict} {plain}");
    // A cost is lowered, and named; what has none to lower is refused.
    let cost = |name: &str| number(&ask(&["--cost", name])["cost"], "value");
    let bent = |answer: &serde_json::Value, rate: bool| {
        let a: Vec<f64> =
            answer["segments"][0]["curvature"].as_array().unwrap().iter().map(|a| a.as_f64().unwrap()).collect();
        let length = number(&answer["segments"][0], "length_m");
        let at = |s: f64| match rate {
            false => a.iter().rev().fold(0.0, |sum, a| sum * s + a),
            true => (1..6).rev().fold(0.0, |sum, k| sum * s + k as f64 * a[k]),
        };
        let square = |i: u32| at(length * (f64::from(i) + 0.5) / 4000.0).powi(2) * length / 4000.0;
        (0..4000).map(square).sum::<f64>()
    };
    assert!(cost("curvature") < 0.9999 * bent(&plain, false) && cost("rate") < 0.99 * bent(&plain, true));
    let (rate, value) = (ask(&["--cost", "rate"]), cost("rate"));
    assert!((bent(&rate, true) / value - 1.0).abs() < 1e-4, "{rate}");
    for (flags, told) in [
        (vec!["--cost", "tilt"], "--terrain"),
        (vec!["--cost", "rate", "--control", "cubic"], "cubic has 0 parameters to spare for it: 5 for 5 conditions"),
        (vec!["--cost", "rate", "--control", "arc"], "arc has 0 parameters to spare for it: 2 for 2 conditions"),
        (vec!["--cost", "rate", "--control", "turn-drive-turn"], "turn-drive-turn has 0 parameters"),
        (vec!["--step-scale", "0"], "0.01 to 1"),
        (vec!["--iterations=-1"], "100000"),
        (vec!["--tolerance-yaw-rad", "0"], "> 0"),
        (vec!["--keep-out-circle", "1,2"], "three finite numbers"),
        (vec!["--keep-out-polygon", "0,0,1,1"], "three pairs"),
        (vec!["--keep-out-polygon", "0,0,1,1,2,2"], "not all on one line"),
    ] {
        let (code, out, error) = run(folder.path(), &[&["steer", "generic", "--to", "4,1,0"], &flags[..]].concat());
        assert!(code == 2 && out.is_empty() && error.contains(told), "{flags:?}: {code} {out} {error}");
    }
}

#[test]
fn start_tables_are_made_kept_and_refused_where_they_do_not_fit() {
    let folder = tempfile::tempdir().unwrap();
    let (code, out, error) = run(folder.path(), &["start-table", "generic", "--out", "arcs.table"]);
    assert!(code == 0 && out.contains("8976 goals"), "{out}{error}");
    assert!(fs::metadata(folder.path().join("arcs.table")).unwrap().len() < 200_000);
    let (_, again, _) = run(folder.path(), &["start-table", "generic", "--out", "again.table", "--json"]);
    let again: serde_json::Value = serde_json::from_str(&again).unwrap();
    assert!(again["arcs"].as_u64() > Some(5000), "{again}");
    let read = |name: &str| fs::read(folder.path().join(name)).unwrap();
    assert_eq!(read("arcs.table"), read("again.table"));
    let ask = |more: &[&str]| -> serde_json::Value {
        let (_, out, error) =
            run(folder.path(), &[&["steer", "generic", "--to", "4.2,2.1,0.3", "--json"], more].concat());
        serde_json::from_str(&out).unwrap_or_else(|_| panic!("{out}{error}"))
    };
    let (plain, table) = (ask(&[]), ask(&["--start-table", "arcs.table"]));
    assert_eq!((&plain["status"], &table["status"]), (&"ok".into(), &"ok".into()), "{table}");
    assert!(table["iterations"].as_u64() < plain["iterations"].as_u64(), "{table} {plain}");
    // A vehicle that steers otherwise, a file that is none, and one that was touched.
    fs::write(folder.path().join("own.toml"), "kind = \"rover\"\nname = \"own\"\n[limits]\ncurvature_1_m = 0.25\n")
        .unwrap();
    let mut bytes = read("arcs.table");
    bytes[5000] ^= 1;
    fs::write(folder.path().join("touched.table"), bytes).unwrap();
    for (rover, file, told) in [
        ("own.toml", "arcs.table", "made for vehicles with"),
        ("generic", "own.toml", "no start table"),
        ("generic", "touched.table", "checksum"),
        ("generic", "none.table", "none.table"),
    ] {
        let (code, _, error) = run(folder.path(), &["steer", rover, "--to", "4,1,0", "--start-table", file]);
        assert!(code == 2 && error.contains(told), "{file}: {code} {error}");
    }
}

#[test]
fn tolerances_hold_at_both_ends_in_every_form() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    let lax = ["--tolerance-m", "0.1", "--tolerance-yaw-rad", "0.1"];
    for (to, more, most) in [("0,0,0.005", &[][..], 0.0), ("0,0,0", &[], 0.0), ("0.05,0,0.001", &lax, 0.05)] {
        let asked = [&["steer", "generic", "--to", to, "--json"][..], more].concat();
        let (code, out, error) = run(path, &asked);
        let object: Value = serde_json::from_str(&out).unwrap_or_else(|why| panic!("{why}: {out}{error}"));
        assert!(code == 0 && object["length_m"].as_f64().unwrap() <= most, "{to}: {object}");
        assert_eq!((&object["segments"][0]["kind"], object["segments"].as_array().unwrap().len()), (&"arc".into(), 1));
        let (code, out, _) = run(path, &asked[..asked.len() - more.len() - 1]);
        assert!(code == 0 && out.contains("ok (generic"), "{out}");
    }
    // The same in a file: one row, segment 0, arc, length 0.
    fs::write(
        path.join("q.csv"),
        "id,x,y,yaw,k0,kf\nthere,0,0,0.005,0,0\nzero,0,0,0,0.2,0.2\nnear,0.3,0.005,0.01,0,0\n",
    )
    .unwrap();
    let (code, _, error) = run(path, &["steer", "generic", "--queries", "q.csv", "--out", "r.csv"]);
    assert_eq!(code, 0, "{error}");
    let answers = fs::read_to_string(path.join("r.csv")).unwrap();
    let rows: Vec<Vec<&str>> = answers.lines().skip(1).map(|row| row.split(',').collect()).collect();
    for (id, a0) in [("there", "0"), ("zero", "0.2")] {
        let own: Vec<_> = rows.iter().filter(|row| row[0] == id).collect();
        assert_eq!(own.len(), 1, "{answers}");
        assert_eq!((&own[0][1..5], own[0][7], own[0][9]), (&["0", "arc", "1", "ok"][..], "0", a0), "{answers}");
    }
    let near: f64 = rows.iter().filter(|row| row[0] == "near").map(|row| row[7].parse::<f64>().unwrap()).sum();
    assert!(near < 0.31, "{answers}");
}

#[test]
fn cars_and_differential_drives_are_steered() {
    let folder = tempfile::tempdir().unwrap();
    let (code, out, error) = run(folder.path(), &["steer", "car", "--to", "4,1,0.5", "--json"]);
    let object: Value = serde_json::from_str(&out).unwrap_or_else(|why| panic!("{why}: {out}{error}"));
    assert!(code == 0 && object["robot"] == "car", "{object}");
    let length = object["length_m"].as_f64().unwrap();
    assert!(length > 4.1 && length < 4.6, "{object}");
    // |κ| ≤ tan 24° / 0.3302 m.
    assert!(object["max_curvature_1_m"].as_f64().unwrap() <= 1.3485, "{object}");
    let (code, out, error) = run(folder.path(), &["steer", "differential-drive", "--to", "1,1,1.5", "--turns"]);
    assert_eq!(code, 0, "{out}{error}");
    let (code, _, error) = run(folder.path(), &["steer", "car", "--to", "1,1,1.5", "--turns"]);
    assert!(code == 2 && error.contains("cannot turn in place"), "{error}");
    // A file of that name goes first, and stderr says so.
    fs::write(folder.path().join("car"), "kind = \"rover\"\nname = \"mine\"\n[limits]\ncurvature_1_m = 1\n").unwrap();
    let (code, out, error) = run(folder.path(), &["steer", "car", "--to", "4,1,0.5"]);
    assert!(
        code == 0 && out.contains("ok (mine") && error.contains("`car` is a file here and a shipped name"),
        "{out}{error}"
    );
}
