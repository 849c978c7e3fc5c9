//! `hairpin judge LOG` on what arms log: joints of a bag or a table, against the program that was run.

use std::fs;

use nalgebra::Point3;
use serde_json::Value;

use crate::commands::{copy, json, refused, run};
use crate::fake_vehicle::{Row, joint_states, judged, number, odometry, rows};

const NAMES: [&str; 6] = ["joint_1", "joint_2", "joint_3", "joint_4", "joint_5", "joint_6"];
/// Drivers publish joints by the alphabet, or however they like.
const ORDER: [usize; 6] = [2, 0, 1, 5, 4, 3];

const CELL: &str = r#"
hairpin = 1
robot = "irb120"
seed = 3
[world]
tool = { tcp_mm = [0, 0, 100], radius_mm = 20 }
[task]
points = [[300, 100, 400], [350, -100, 300], [400, 50, 350], [250, 200, 450]]
[generate]
moves = { speeds = ["v500"], zones = ["fine", "z10"] }
search = { programs = 2 }
[execute]
baseline = 0
[spec]
path = { max_mm = 15 }
arrival = { max_late_ms = 200 }
"#;

#[test]
fn an_arms_joints_come_to_what_the_simulation_was() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    fs::write(here.join("cell.toml"), CELL).unwrap();
    let (code, out, error) = run(here, &["stress", "cell.toml", "--out", "out"]);
    assert_eq!(code, 0, "{out}{error}");
    assert_eq!(run(here, &["export", "out", "--to", "csv"]).0, 0);
    let ran = rows(&here.join("out/export/0001-0.csv"));
    let close = |a: f64, b: f64, within: f64| assert!((a - b).abs() < within, "{a} {b}");
    let scenario = fs::read_to_string(here.join("out/scenario.toml")).unwrap();

    // As a bag, in whatever order, and as a table in degrees.
    let degrees = |row: &Row| row.joints.map(|q| format!(";{}", q.to_degrees()).replace('.', ",")).concat();
    let line = |row: &Row| format!("{}{}\n", row.t.to_string().replace('.', ","), degrees(row));
    let header = "time_s;axis_1_deg;axis_2_deg;axis_3_deg;axis_4_deg;axis_5_deg;axis_6_deg\n".to_owned();
    let table = header + &ran.iter().map(line).collect::<String>();
    let bag = joint_states(&ran, NAMES, ORDER);
    let mut latest = Vec::new();
    for (name, bytes) in [("night.mcap", &bag), ("night.csv", &table.clone().into_bytes())] {
        let log = judged(here, name, bytes, &[]);
        let sentence = log["verdict"].as_str().unwrap();
        assert!(sentence.starts_with(&format!("PASS 0001 (hardware, irb120, {name}): ")), "{sentence}");
        assert_eq!((&log["case"], &log["matched"]["by"]), (&"0001".into(), &"track".into()));
        close(number(&log["measures"]["max_deviation_m"]), number(&log["simulated_max_deviation_m"]), 1e-5);
        latest.push(number(&log["measures"]["latest"]["late_s"]));
        assert_eq!(log["finished"], true);
    }
    close(latest[0], latest[1], 1e-5);
    let log = judged(here, "night.mcap", &bag, &[]);
    assert_eq!(log["joints"]["order"], Value::from(ORDER.map(|joint| NAMES[joint]).to_vec()));
    assert_eq!((&log["joints"]["axes"], &log["joints"]["unit"]), (&Value::from(NAMES.to_vec()), &"rad".into()));
    let joints = &judged(here, "night.csv", table.as_bytes(), &[])["joints"];
    let columns = (1..=6).map(|axis| format!("axis_{axis}_deg")).collect::<Vec<_>>();
    assert_eq!((&joints["axes"], &joints["unit"]), (&Value::from(columns), &"deg".into()));
    // What `execute --logs` and `judge OUT` make of the same table.
    fs::create_dir(here.join("logs")).unwrap();
    for case in ["0000", "0001"] {
        fs::copy(here.join(format!("out/export/{case}-0.csv")), here.join(format!("logs/{case}.csv"))).unwrap();
    }
    assert_eq!(run(here, &["export", "out", "--to", "csv"]).0, 0);
    copy(&here.join("out"), &here.join("hardware"));
    let (code, out, error) = run(here, &["execute", "hardware", "--logs", "logs/*.csv"]);
    assert_eq!(code, 0, "{out}{error}");
    let whole = json(here, &["judge", "hardware"]);
    assert!(whole["verdict"].as_str().unwrap().starts_with("PASS 2/2 (hardware"), "{whole}");
    let both = json(here, &["judge", "logs", "--campaign", "out", "--page", "logs.html"]);
    let page = fs::read_to_string(here.join("logs.html")).unwrap();
    assert!(page.contains("\"unit\":\"mm\"") && page.contains("<h2>Logs, the worst first</h2>"), "a page of programs");
    let worst = both["logs"].as_array().unwrap().iter().map(|log| number(&log["measures"]["max_deviation_m"]));
    close(worst.fold(0.0, f64::max), number(&whole["worst"]["max_deviation_m"]), 1e-5);

    // Axis 1 stands 0.05 rad off: the tool is that much of its distance from the axis beside its way.
    let mut bent = ran.clone();
    bent.iter_mut().for_each(|row| row.joints[0] += 0.05);
    let log = judged(here, "bent.mcap", &joint_states(&bent, NAMES, ORDER), &[]);
    let sentence = log["verdict"].as_str().unwrap();
    assert!(sentence.starts_with("FAIL 0001 (hardware, irb120, bent.mcap): "), "{sentence}");
    let turn = nalgebra::Rotation3::from_axis_angle(&nalgebra::Vector3::z_axis(), 0.05);
    let nearest = |p: Point3<f64>| ran.iter().map(|row| (row.p - p).norm()).fold(f64::INFINITY, f64::min);
    let least = ran.iter().map(|row| nearest(turn * row.p)).fold(0.0, f64::max);
    let most = ran.iter().map(|row| 0.05 * row.p.coords.xy().norm()).fold(0.0, f64::max);
    let found = number(&log["measures"]["max_deviation_m"]);
    // Samples are up to 5 mm apart.
    assert!(found > least - 3e-3 && found < most + 5e-4, "{least} {found} {most}");

    // A turn on, the tool is where it was, and the joint cannot be there.
    let mut turned = ran.clone();
    turned.iter_mut().for_each(|row| row.joints[0] += std::f64::consts::TAU);
    let log = judged(here, "turned.mcap", &joint_states(&turned, NAMES, ORDER), &[]);
    let sentence = log["verdict"].as_str().unwrap();
    let words = ["axis 1 stands at ", "its range is -165.0° to 165.0° (0.5° beyond are allowed"];
    assert!(log["status"] == "inconclusive" && words.iter().all(|word| sentence.contains(word)), "{sentence}");

    // It rests before its last target for good.
    let last = ran[ran.len() - 1];
    let goes = |row: &Row| row.t < 1.0 || (row.p - last.p).norm() > 0.004;
    let mut resting: Vec<Row> = ran.iter().copied().filter(goes).collect();
    let rests = resting[resting.len() - 1];
    resting.extend((1..200).map(|i| Row { t: rests.t + 0.01 * f64::from(i), ..rests }));
    let log = judged(here, "rests.mcap", &joint_states(&resting, NAMES, ORDER), &["--case", "0001"]);
    assert!(log["status"] == "inconclusive" && log["finished"] == true, "{log}");
    assert!(log["verdict"].as_str().unwrap().contains("→pHome) was never arrived at: "), "{log}");

    // What `--to` ends is said to end by it.
    let log = judged(here, "part.csv", table.as_bytes(), &["--case", "0001", "--to", "1.5"]);
    let sentence = log["verdict"].as_str().unwrap();
    assert!(log["status"] == "inconclusive" && sentence.contains("--to at t = 1.50 s, on move "), "{sentence}");

    // It waits 0.3 s on its way.
    let mut late = ran.clone();
    late.iter_mut().filter(|row| row.t > 1.5).for_each(|row| row.t += 0.3);
    let log = judged(here, "late.mcap", &joint_states(&late, NAMES, ORDER), &[]);
    assert!(log["verdict"].as_str().unwrap().contains("late "), "{log}");
    assert_eq!(log["status"], "fail");
    close(number(&log["measures"]["latest"]["late_s"]), latest[0] + 0.3, 0.02);

    // By another clock nothing can be late.
    let unix: Vec<Row> = ran.iter().map(|row| Row { t: row.t + 1.7e9, ..*row }).collect();
    let by_unix = table.lines().next().unwrap().to_owned() + "\n" + &unix.iter().map(line).collect::<String>();
    fs::write(here.join("unix.csv"), &by_unix).unwrap();
    let words = ["unix.csv", "the log's first time = 1700000000.000 s", "another clock", "--from", "offset-removed"];
    refused(here, &["judge", "unix.csv", "--campaign", "out", "--case", "0001"], &words);
    let log = judged(here, "unix.csv", by_unix.as_bytes(), &["--from", "1700000000"]);
    assert_eq!(log["status"], "pass", "{log}");

    // The recorder runs 0.5 s before the program does: nothing is fitted, `--from` names it, or it is taken off as
    // asked.
    let stands = (0..50).map(|i| Row { t: -0.5 + 0.01 * f64::from(i), ..ran[0] });
    let early: Vec<Row> = stands.chain(ran.iter().copied()).collect();
    let bytes = joint_states(&early, NAMES, ORDER);
    let log = judged(here, "early.mcap", &bytes, &[]);
    assert_eq!(log["status"], "fail", "{log}");
    close(number(&log["clock_offset_s"]), 0.5, 0.05);
    let from = format!("{}", number(&log["program_begins_s"]) + 0.5);
    let log = judged(here, "early.mcap", &bytes, &["--from", &from]);
    assert_eq!(log["status"], "pass", "{log}");
    close(number(&log["measures"]["latest"]["late_s"]), latest[0], 1e-3);
    let log = judged(here, "early.mcap", &bytes, &["--set", "execute.log_clock=\"offset-removed\""]);
    assert!(log["status"] == "pass" && log["clock_offset_removed"] == true, "{log}");
    assert!(log["verdict"].as_str().unwrap().contains("ms removed as asked"), "{log}");

    // It stops on the way.
    let short: Vec<Row> = ran.iter().copied().filter(|row| row.t < 0.6 * ran[ran.len() - 1].t).collect();
    let log = judged(here, "short.mcap", &joint_states(&short, NAMES, ORDER), &["--case", "0001"]);
    assert!(log["status"] == "inconclusive" && log["finished"] == false, "{log}");
    assert!(log["verdict"].as_str().unwrap().contains(": what was left of the program is not judged"), "{log}");

    // Joints of another arm, another unit, and what says nothing to an arm.
    let other = ["a", "b", "c", "d", "e", "f"];
    fs::write(here.join("other.mcap"), joint_states(&ran, other, ORDER)).unwrap();
    let words = ["other.mcap", "its joints are c, a, b, f, e, d", "this arm's are joint_1, joint_2", "none is taken"];
    refused(here, &["judge", "other.mcap", "--campaign", "out"], &words);
    let mut wrong = ran.clone();
    wrong.iter_mut().for_each(|row| row.joints = row.joints.map(f64::to_degrees));
    fs::write(here.join("degrees.mcap"), joint_states(&wrong, NAMES, ORDER)).unwrap();
    refused(
        here,
        &["judge", "degrees.mcap", "--campaign", "out"],
        &["joint_", " rad, ", "its range is ", "another unit"],
    );
    let degrees = |row: &Row| format!("{},{}\n", row.t, row.joints.map(|q| q.to_string()).join(","));
    let wrong = wrong.iter().map(degrees).collect::<String>();
    fs::create_dir(here.join("wrong")).unwrap();
    for case in ["0000", "0001"] {
        let header = "t_s,q1_rad,q2_rad,q3_rad,q4_rad,q5_rad,q6_rad\n";
        fs::write(here.join(format!("wrong/{case}.csv")), format!("{header}{wrong}")).unwrap();
    }
    copy(&here.join("out"), &here.join("other"));
    let words = ["wrong", "0000.csv", " rad, ", "its range is ", "another unit"];
    refused(here, &["execute", "other", "--logs", "wrong/*.csv"], &words);
    refused(here, &["judge", "night.mcap", "--campaign", "out", "--turn", "90"], &["its base's frame"]);
    let words = ["--world: what an arm must not meet is its cell's; leave --world"];
    refused(here, &["judge", "night.mcap", "--campaign", "out", "--world", "cage-30m"], &words);
    fs::write(here.join("odom.mcap"), odometry(&ran, "map")).unwrap();
    refused(here, &["judge", "odom.mcap", "--campaign", "out"], &["without joints"]);
    assert_eq!(fs::read_to_string(here.join("out/scenario.toml")).unwrap(), scenario);
}
