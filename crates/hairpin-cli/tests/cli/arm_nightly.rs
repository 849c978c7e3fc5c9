//! Arms night after night: logs of a controller instead of runs of ours, and a release against the one before.

use std::fs;
use std::path::Path;
use std::process::Output;

use assert_cmd::Command;
use serde_json::Value;
use tempfile::TempDir;

fn hairpin(folder: &Path, arguments: &[&str]) -> Output {
    let mut command = Command::cargo_bin("hairpin").unwrap();
    command.current_dir(folder).args(arguments).env("XDG_STATE_HOME", folder.join(".state")).output().unwrap()
}

/// Exit code and what was told on both streams.
fn told(folder: &Path, arguments: &[&str]) -> (i32, String) {
    let output = hairpin(folder, arguments);
    let text = [&output.stdout, &output.stderr].map(|bytes| String::from_utf8_lossy(bytes).into_owned()).concat();
    (output.status.code().unwrap(), text)
}

fn json(output: &Output) -> Value {
    serde_json::from_slice(&output.stdout).unwrap_or_else(|error| {
        panic!("{error}: {} {}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr))
    })
}

/// A cell without anything in it, whose programs take a second to find and to run.
fn cell(place: &Path, more: &str) {
    let text = format!(
        "hairpin = 1\nrobot = \"irb120\"\nseed = 3\n[world]\ntool = {{ tcp_mm = [0, 0, 100], radius_mm = 20 }}\n\
         [task]\npoints = [[300, 100, 400], [350, -100, 300], [400, 50, 350], [250, 200, 450]]\n\
         [generate]\nmoves = {{ speeds = [\"v500\"], zones = [\"fine\", \"z10\"] }}\nsearch = {{ programs = 2 }}\n\
         [execute]\nrepeat = 3\n{more}\n[spec]\npath = {{ max_mm = 20 }}\narrival = {{ max_late_ms = 200 }}\n"
    );
    fs::write(place.join("arm.toml"), text).unwrap();
}

/// Runs of `folder`, as `CASE-RUN.csv`, with `changed` applied to time (s) and place (m) of each sample.
fn record(place: &Path, folder: &str, to: &str, changed: impl Fn(f64, [f64; 3]) -> (f64, [f64; 3])) {
    let (code, text) = told(place, &["export", folder, "--to", "csv"]);
    assert_eq!(code, 0, "{text}");
    fs::create_dir_all(place.join(to)).unwrap();
    for case in 0..2 {
        for run in 0..3 {
            let text = fs::read_to_string(place.join(folder).join(format!("export/{case:04}-{run}.csv"))).unwrap();
            let mut lines = text.lines();
            let names: Vec<&str> = lines.next().unwrap().split(',').collect();
            let column = |name: &str| names.iter().position(|found| *found == name).unwrap();
            let wanted = ["t", "x_m", "y_m", "z_m", "qw", "qx", "qy", "qz"].map(column);
            // As such controllers write: semicolons, decimal commas, ms and mm.
            let mut log = String::from("time_ms;x_mm;y_mm;z_mm;qw;qx;qy;qz\n");
            for line in lines {
                let cells: Vec<f64> = line.split(',').map(|cell| cell.parse().unwrap_or(0.0)).collect();
                let [t, x, y, z, qw, qx, qy, qz] = wanted.map(|i| cells[i]);
                let (t, [x, y, z]) = changed(t, [x, y, z]);
                let numbers =
                    [1e3 * t, 1e3 * x, 1e3 * y, 1e3 * z, qw, qx, qy, qz].map(|n| n.to_string().replace('.', ","));
                log += &(numbers.join(";") + "\n");
            }
            fs::write(place.join(to).join(format!("irb_{case:04}-{}.csv", run + 1)), log).unwrap();
        }
    }
}

#[test]
fn logs_are_judged_like_runs_of_ours() {
    let place = TempDir::new().unwrap();
    let place = place.path();
    cell(place, "");
    let (code, text) = told(place, &["stress", "arm.toml", "--out", "out/arm"]);
    assert!(code == 0 && text.contains("PASS 2/2 (simulated, irb120"), "{text}");
    // A clock that is 120 ms ahead: told, and not taken off.
    record(place, "out/arm", "nightly", |t, p| (t + 0.12, p));
    let (code, text) = told(place, &["execute", "out/arm", "--logs", "nightly/irb_*.csv"]);
    assert_eq!(code, 0, "{text}");
    let judged = hairpin(place, &["judge", "out/arm", "--json"]);
    let judged = json(&judged);
    let verdict = judged["verdict"].as_str().unwrap();
    assert!(verdict.starts_with("PASS 2/2 (hardware, irb120, nightly/irb_*.csv, 3 runs each): "), "{verdict}");
    assert!(verdict.contains("an offset of +12") && verdict.contains("ms is estimated and not removed"), "{verdict}");
    let offset = judged["offsets"][0]["offset_s"].as_f64().unwrap();
    assert!((offset - 0.12).abs() < 0.03 && judged["offsets"][0]["removed"] == false, "{offset}");
    // Taken off where that is asked for, and then arrivals are in time.
    let strict = ["--set", "spec.arrival.max_late_ms=60"];
    assert_eq!(told(place, &["judge", "out/arm", strict[0], strict[1]]).0, 1);
    let removed = ["--set", "execute.log_clock=\"offset-removed\"", "--logs", "nightly/irb_*.csv"];
    assert_eq!(told(place, &[&["execute", "out/arm"][..], &removed[..]].concat()).0, 0);
    let (code, text) = told(place, &["judge", "out/arm"]);
    assert!(code == 0 && text.contains("ms removed as asked"), "{text}");
    assert!(!text.contains("simulated"), "{text}");
    // A tool that sits 30 mm too high is found in logs, too; named in the scenario they are looked for beside it.
    record(place, "out/arm", "tilted", |t, [x, y, z]| (t - 0.12, [x, y, z + 0.03]));
    cell(place, "logs = \"tilted/irb_*.csv\"");
    let (code, text) = told(place, &["stress", "arm.toml", "--out", "out/tilted"]);
    assert!(code == 1 && text.contains("FAIL 2/2 (hardware") && text.contains("worst 30."), "{text}");
    let kept = fs::read_to_string(place.join("out/tilted/scenario.toml")).unwrap();
    assert!(kept.contains("logs = \"../../tilted/irb_*.csv\""), "{kept}");
    let report = fs::read_to_string(place.join("out/tilted/report.html")).unwrap();
    assert!(
        report.contains("Recorded on a real controller (hardware)") && report.contains("Clocks: arrivals of 6 runs")
    );
    let (code, text) = told(place, &["replay", "out/tilted/repro/0000.json"]);
    assert!(code == 2 && text.contains("execute.logs"), "{text}");
    // The next night begins with nothing: saved cases are of recordings, too.
    cell(place, "logs = \"nightly/irb_*.csv\"");
    let (code, text) = told(place, &["stress", "arm.toml", "--out", "out/tilted", "--force"]);
    assert!(code == 0 && text.contains("PASS 2/2 (hardware") && !text.contains("saved cases first"), "{text}");
    let (code, text) = told(place, &["execute", "out/tilted", "--logs", "nightly/irb_0000-*.csv"]);
    assert!(code == 2 && text.contains("0001"), "{text}");
    let (code, text) = told(place, &["judge", "out/tilted"]);
    assert!(code == 0 && text.contains("nightly/irb_*.csv"), "{text}");
    // Logs outside of a folder are read for whoever named them, and for others where they allow it.
    assert_eq!(told(place, &["execute", "out/tilted"]).0, 0);
    fs::rename(place.join("out/tilted"), place.join("out/received")).unwrap();
    let (code, text) = told(place, &["execute", "out/received"]);
    assert!(code == 2 && text.contains("../../nightly/irb_*.csv") && text.contains("--allow-commands"), "{text}");
    assert_eq!(told(place, &["execute", "out/received", "--allow-commands"]).0, 0);
    #[cfg(unix)]
    {
        // Within it they are, unless they are links that lead out.
        let own = ["execute", "out/received", "--logs", "out/received/logs/irb_*.csv"];
        fs::rename(place.join("nightly"), place.join("out/received/logs")).unwrap();
        let (code, text) = told(place, &own);
        assert_eq!(code, 0, "{text}");
        assert_eq!(told(place, &["execute", "out/received"]).0, 0);
        fs::rename(place.join("out/received/logs"), place.join("away")).unwrap();
        std::os::unix::fs::symlink(place.join("away"), place.join("out/received/logs")).unwrap();
        let (code, text) = told(place, &["execute", "out/received"]);
        assert!(code == 2 && text.contains("is a link"), "{text}");
    }
}

#[test]
fn broken_logs_are_told_with_file_line_and_reason() {
    let place = TempDir::new().unwrap();
    let place = place.path();
    cell(place, "");
    assert_eq!(told(place, &["stress", "arm.toml", "--out", "out"]).0, 0);
    record(place, "out", "logs", |t, p| (t, p));
    let path = place.join("logs/irb_0001-2.csv");
    let good = fs::read_to_string(&path).unwrap();
    let lines: Vec<&str> = good.lines().collect();
    let refused = |wanted: &[&str]| {
        let (code, text) = told(place, &["execute", "out", "--logs", "logs/irb_*.csv"]);
        assert!(code == 2 && wanted.iter().all(|word| text.contains(word)), "{wanted:?}: {text}");
    };
    fs::write(&path, lines[..lines.len() / 2].join("\n")).unwrap();
    refused(&["irb_0001-2.csv", &format!("line {}", lines.len() / 2), "shorter than the program"]);
    let mut backwards = lines.clone();
    backwards.swap(40, 41);
    fs::write(&path, backwards.join("\n")).unwrap();
    refused(&["irb_0001-2.csv", "line 42", "later than"]);
    fs::write(&path, good.replace("x_mm", "x")).unwrap();
    refused(&["irb_0001-2.csv, line 1", "of three coordinates"]);
    fs::remove_file(&path).unwrap();
    refused(&["case 0001 has 2 logs", "`execute.repeat` = 3"]);
    fs::write(place.join("logs/irb_0007-1.csv"), &good).unwrap();
    refused(&["irb_0007-1.csv", "there is no case 0007"]);
    fs::rename(place.join("logs/irb_0007-1.csv"), place.join("logs/irb_night.csv")).unwrap();
    refused(&["irb_night.csv", "CASE-RUN"]);
    let (code, text) = told(place, &["execute", "out", "--logs", "none/*.csv"]);
    assert!(code == 2 && text.contains("none"), "{text}");
}

#[test]
fn a_release_is_held_against_the_one_before() {
    let place = TempDir::new().unwrap();
    let place = place.path();
    cell(place, "");
    let release = |name: &str, baseline: Option<&str>, seed_of_noise: &str, more: &[&str]| {
        let out = format!("baselines/{name}");
        let noise = format!("execute.noise_mm={seed_of_noise}");
        let against = baseline
            .map(|baseline| format!("spec.regression={{ baseline = \"baselines/{baseline}\", band_sigma = 4 }}"));
        let mut arguments = vec!["stress", "arm.toml", "--out", &out, "--set", &noise];
        arguments.extend(against.iter().flat_map(|against| ["--set", against.as_str()]));
        arguments.extend(more);
        told(place, &arguments)
    };
    assert_eq!(release("7.13", None, "0.01", &[]).0, 0);
    let (code, text) = release("7.14", Some("7.13"), "0.012", &[]);
    assert!(code == 0 && text.contains("against 7.13: no move outside the baseline's band"), "{text}");
    // An axis that is slower within spec.
    let slower = [
        "--set",
        "execute.faults={ axis = 1, slower = 0.7 }",
        "--set",
        "spec.arrival.max_late_ms=5000",
        "--set",
        "spec.path.max_mm=500",
    ];
    let (code, text) = release("7.15", Some("7.14"), "0.01", &slower);
    let sentence = text.lines().find(|line| line.starts_with("REGRESSION ")).unwrap_or_else(|| panic!("{text}"));
    assert!(code == 1 && sentence.starts_with("REGRESSION 7.15 against 7.14 (3 + 3 runs): "), "{sentence}");
    let moves = sentence.split("runs): ").nth(1).unwrap();
    assert!(
        moves.contains("/10 moves outside the baseline's band, worst ")
            && moves.contains(" (band ±")
            && moves.contains("; all still within spec"),
        "{sentence}"
    );
    // The folder stands alone: the earlier ones may go.
    fs::rename(place.join("baselines/7.14"), place.join("gone")).unwrap();
    let again = hairpin(place, &["judge", "baselines/7.15", "--json"]);
    let again_json = json(&again);
    assert_eq!((again.status.code(), again_json["verdict"].as_str()), (Some(1), Some(sentence)));
    let found = &again_json["regression"];
    assert_eq!(found["releases"], serde_json::json!(["7.13", "7.14", "7.15"]));
    assert!(!found["worse"].as_array().unwrap().is_empty());
    let trends = found["trends"].as_array().unwrap();
    assert!(trends.len() == 20 && trends.iter().any(|trend| trend["slope"].as_f64().is_some_and(|slope| slope > 1e-3)));
    let junit = fs::read_to_string(place.join("baselines/7.15/junit.xml")).unwrap();
    assert!(junit.contains("type=\"Regression\"") && junit.contains("against 7.14"), "{junit}");
    assert_eq!(told(place, &["report", "baselines/7.15"]).0, 0);
    let report = fs::read_to_string(place.join("baselines/7.15/report.html")).unwrap();
    assert!(report.contains("<h2>Against 7.14</h2>") && report.contains("From release to release"));
    // Some of its programs are held against nothing.
    let (code, text) = told(place, &["select", "baselines/7.15", "--cases", "1", "--out", "baselines/one"]);
    assert!(code == 0, "{text}");
    assert_eq!(told(place, &["report", "baselines/one"]).0, 0);
    // Back again, moves are better; one after a move that is over sooner may take longer from arrival to arrival.
    let (code, text) = release("7.16", Some("7.15"), "0.01", &[]);
    assert!(code <= 1 && text.contains(" better than the band"), "{text}");
    // Other programs, too few repeats, no baseline: wrong input that says so.
    let (code, text) = release("7.17", Some("7.16"), "0.01", &["--set", "generate.search.programs=1"]);
    assert!(code == 2 && text.contains("case 0001 of the baseline `7.16` was not run"), "{text}");
    let (code, text) = release("7.17", Some("7.16"), "0.01", &["--force", "--set", "generate.moves.speeds=[\"v300\"]"]);
    assert!(code == 2 && text.contains("case 0000 has the moves of the baseline"), "{text}");
    assert_eq!(release("once", None, "0.01", &["--set", "execute.repeat=1"]).0, 0);
    let (code, text) = release("7.17", Some("once"), "0.01", &["--force"]);
    assert!(code == 2 && text.contains("1 run: must be at least 2"), "{text}");
    assert_eq!(told(place, &["generate", "arm.toml", "--out", "raw"]).0, 0);
    let (code, text) = release("7.17", Some("../raw"), "0.01", &["--force"]);
    assert!(code == 2 && text.contains("moves.json"), "{text}");
}
