//! Logs of arms that leave something out: what they hide is told against the plan, and nothing passes that it may hide.

use std::fs;
use std::path::Path;

use crate::commands::{json, run};
use tempfile::TempDir;

const SCENARIO: &str = include_str!("../cases/logs/arm.toml");
const ROBOT: &str = include_str!("../../../../data/robots/arm/irb120.toml");

/// Joints of the run that was exported, every 10 ms.
struct Exported {
    rows: Vec<(f64, [f64; 6])>,
}

impl Exported {
    fn of(place: &Path, campaign: &str) -> Self {
        let (code, text, error) = run(place, &["export", campaign, "--to", "csv"]);
        assert_eq!(code, 0, "{text}{error}");
        let text = fs::read_to_string(place.join(campaign).join("export/0000-0.csv")).unwrap();
        let mut lines = text.lines();
        let names: Vec<&str> = lines.next().unwrap().split(',').collect();
        let column = |name: &str| names.iter().position(|found| *found == name).unwrap();
        let (time, joints) = (column("t"), [1, 2, 3, 4, 5, 6].map(|k| column(&format!("q{k}_rad"))));
        let row = |line: &str| {
            let cells: Vec<f64> = line.split(',').map(|cell| cell.parse().unwrap_or(0.0)).collect();
            (cells[time], joints.map(|column| cells[column]))
        };
        Self { rows: lines.map(row).collect() }
    }

    /// A log of the samples that are kept; with `swung`, the first joint swings by 0.17 rad for four seconds.
    fn log(&self, place: &Path, folder: &str, swung: bool, keep: impl Fn(usize) -> bool) {
        fs::create_dir_all(place.join(folder)).unwrap();
        let mut log = String::from("t_s,q1_rad,q2_rad,q3_rad,q4_rad,q5_rad,q6_rad\n");
        for (i, (t, q)) in self.rows.iter().enumerate().filter(|(i, _)| keep(*i)) {
            let mut q = *q;
            if swung && (500..900).contains(&i) {
                q[0] += 0.17 * (std::f64::consts::PI * (i as f64 - 500.0) / 400.0).sin();
            }
            log += &format!("{t:.4},{}\n", q.map(|q| format!("{q:.8}")).join(","));
        }
        fs::write(place.join(folder).join("0000-0.csv"), log).unwrap();
    }
}

/// Exit code and words of judging the logs in `folder`.
fn judged(place: &Path, campaign: &str, folder: &str, more: &[&str]) -> (i32, String) {
    let logs = format!("{folder}/*.csv");
    let (code, text, error) = run(place, &["execute", campaign, "--logs", &logs]);
    assert_eq!(code, 0, "{text}{error}");
    let (code, text, error) = run(place, &[&["judge", campaign][..], more].concat());
    (code, text + &error)
}

#[test]
fn a_log_decides_what_it_shows() {
    let place = TempDir::new().unwrap();
    let place = place.path();
    fs::write(place.join("arm.toml"), SCENARIO).unwrap();
    let (code, text, error) = run(place, &["stress", "arm.toml", "--out", "A"]);
    assert_eq!(code, 0, "{text}{error}");
    let exported = Exported::of(place, "A");
    let last = exported.rows.len() - 1;
    assert!(last > 1000, "{last}");
    exported.log(place, "full", true, |_| true);
    exported.log(place, "hole", true, |i| !(480..920).contains(&i));
    exported.log(place, "good", false, |_| true);
    exported.log(place, "tenth", false, |i| i % 10 == 0 || i == last);
    exported.log(place, "second", false, |i| i % 100 == 0 || i == last);
    exported.log(place, "ends", false, |i| i == 0 || i == last);
    let (code, text) = judged(place, "A", "full", &[]);
    assert!(code == 1 && text.contains("FAIL 1/1 (hardware, irb120, full/*.csv"), "{text}");
    // The swing is not in it, and nothing says that there was none.
    let (code, text) = judged(place, "A", "hole", &[]);
    assert!(code == 5 && text.contains("INCONCLUSIVE 0/1 (hardware, irb120, hole/*.csv, 1 run each)"), "{text}");
    assert!(
        text.contains("a gap of 4.41") && text.contains("hides moves ") && text.contains("% of the plan"),
        "{text}"
    );
    assert!(text.contains("estimated") && text.contains("the limit is 15.00 mm"), "{text}");
    let object = json(place, &["judge", "A"]);
    assert_eq!(object["exit_code"].as_i64(), Some(5), "{object}");
    let junit = fs::read_to_string(place.join("A/junit.xml")).unwrap();
    assert!(junit.contains("Inconclusive") && junit.contains("a gap of 4.41"), "{junit}");
    let moves: serde_json::Value = serde_json::from_slice(&fs::read(place.join("A/moves.json")).unwrap()).unwrap();
    let unseen = &moves["cases"][0]["runs"][0]["unseen"];
    assert!((unseen["longest_gap_s"].as_f64().unwrap() - 4.41).abs() < 0.02, "{unseen}");
    // At 100 Hz a healthy log passes with estimates.
    let (code, text) = judged(place, "A", "good", &[]);
    assert!(code == 0 && text.contains("PASS 1/1 (hardware") && text.contains("longest gap of the logs"), "{text}");
    // What is sampled as evenly and more slowly does not show what the limit asks, and says what would decide.
    for folder in ["tenth", "second"] {
        let (code, text) = judged(place, "A", folder, &[]);
        assert!(code == 5 && text.contains("INCONCLUSIVE 0/1 (hardware, irb120, "), "{folder}: {text}");
        assert!(
            text.contains(" mm off the path are not excluded there") && text.contains("`joints.acceleration_deg_s2`"),
            "{text}"
        );
    }
    // Two samples are no recording of a program, whatever they say.
    let (code, text, error) = run(place, &["execute", "A", "--logs", "ends/*.csv"]);
    assert!(code == 2 && error.contains("shorter than the program"), "{text}{error}");
}

/// An arm whose file says how fast its joints may accelerate is bounded by that.
#[test]
fn the_robots_own_accelerations_bound_what_samples_hide() {
    let place = TempDir::new().unwrap();
    let place = place.path();
    let robot = ROBOT.replace("[joints]", "[joints]\nacceleration_deg_s2 = [600, 600, 600, 900, 900, 1200]");
    fs::write(place.join("irb.toml"), robot).unwrap();
    fs::write(place.join("arm.toml"), SCENARIO.replace("\"irb120\"", "\"irb.toml\"")).unwrap();
    let (code, text, error) = run(place, &["stress", "arm.toml", "--out", "A"]);
    assert_eq!(code, 0, "{text}{error}");
    let exported = Exported::of(place, "A");
    let last = exported.rows.len() - 1;
    exported.log(place, "good", false, |_| true);
    exported.log(place, "tenth", false, |i| i % 10 == 0 || i == last);
    let (code, text) = judged(place, "A", "good", &[]);
    assert!(code == 0 && !text.contains("joints, estimated"), "{text}");
    // Some 15 m/s² for a tenth of a second: 19 mm, more than 15 and less than 60.
    let (code, text) = judged(place, "A", "tenth", &[]);
    assert!(code == 5 && text.contains("a_max h²/8") && !text.contains("joints, estimated"), "{text}");
    let (code, text) = judged(place, "A", "tenth", &["--set", "spec.path.max_mm=60"]);
    assert!(code == 0, "{text}");
    // What was proven clear of runs within a limit is not claimed of others.
    let verdict = |max: &str| {
        let (_, text, error) = run(place, &["judge", "A", "--set", &format!("spec.path.max_mm={max}")]);
        assert!(text.contains("clear: all links"), "{text}{error}");
        text
    };
    for max in ["60", "14", "15"] {
        assert_eq!(verdict(max).contains("clear: all links within 15 mm of the path"), max == "60", "{max}");
    }
}

/// Where the tool is tells neither the arm's posture nor the turns of its axes, and moves are proven clear in one.
#[test]
fn joints_are_held_against_the_programs_postures() {
    let place = TempDir::new().unwrap();
    let place = place.path();
    // Its last axis has room for a turn more.
    fs::write(place.join("irb.toml"), ROBOT.replace(", -400]", ", -800]").replace(", 400]", ", 800]")).unwrap();
    fs::write(place.join("arm.toml"), SCENARIO.replace("\"irb120\"", "\"irb.toml\"")).unwrap();
    let (code, text, error) = run(place, &["stress", "arm.toml", "--out", "A"]);
    assert_eq!(code, 0, "{text}{error}");
    let exported = Exported::of(place, "A");
    let turn = std::f64::consts::TAU;
    let log = |name: &str, turned: &dyn Fn(usize, f64) -> f64| {
        let mut text = String::from("t_s,q1_rad,q2_rad,q3_rad,q4_rad,q5_rad,q6_rad\n");
        for (i, (t, q)) in exported.rows.iter().enumerate() {
            let q = [q[0], q[1], q[2], q[3], q[4], turned(i, q[5])];
            text += &format!("{t:.4},{}\n", q.map(|q| format!("{q:.8}")).join(","));
        }
        fs::write(place.join(name), text).unwrap();
        let (code, text, error) = run(place, &["judge", name, "--campaign", "A"]);
        (code, text + &error)
    };
    let (code, text) = log("own.csv", &|_, q| q);
    assert!(code == 0 && !text.contains("clearance of the links is not shown"), "{text}");
    // A controller's lag and what servos are off.
    let (code, text) = log("near.csv", &|i, q| q + 0.03 * (i as f64 / 50.0).sin());
    assert_eq!(code, 0, "{text}");
    let (code, text) = log("turned.csv", &|_, q| q + turn);
    assert!(code == 5 && text.contains("INCONCLUSIVE") && text.contains("axis 6 stands at "), "{text}");
    assert!(text.contains(", and the nearest posture of the program has it at "), "{text}");
    // A log of poses shows where the tool was, and nothing of the links.
    let table = fs::read_to_string(place.join("A/export/0000-0.csv")).unwrap();
    let names: Vec<&str> = table.lines().next().unwrap().split(',').collect();
    let column = |name: &str| names.iter().position(|found| *found == name).unwrap();
    let kept = ["t", "x_m", "y_m", "z_m", "qw", "qx", "qy", "qz"].map(column);
    let line = |line: &str| {
        let cells: Vec<&str> = line.split(',').collect();
        kept.map(|column| cells[column]).join(",") + "\n"
    };
    fs::write(place.join("poses.csv"), table.lines().map(line).collect::<String>()).unwrap();
    let (code, text, error) = run(place, &["judge", "poses.csv", "--campaign", "A"]);
    let unshown = "clearance of the links is not shown: the log tells poses and no joints";
    assert!(code == 0 && text.contains(unshown), "{text}{error}");
}
