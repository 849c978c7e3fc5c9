//! `hairpin fit` over logs that `export` wrote of a vehicle that is not as its file says.

use std::fs;

use serde_json::Value;

use crate::commands::{refused, run};

const SCENARIO: &str = r#"
hairpin = 1
spec = "none"
robot = "flightgoggles"
seed = 5
[world]
size_m = [40, 40, 40]
[task]
start_m = [8, 8, 10]
end_m = [30, 30, 20]
length = 8
[generate]
reach = "sphere"
timing = { step_s = 0.4 }
search = { method = "uniform", waypoints = 200, cases = 5 }
[execute]
controller = "stable-waypoint"
"#;

/// The logs of a vehicle with a slower controller and commands that are late: the simulation comes nearer to logs that
/// the fit has not seen, the numbers are near the true ones, and what is written is read.
#[test]
fn a_fit_helps_on_logs_that_it_has_not_seen() {
    let place = tempfile::tempdir().unwrap();
    let here = place.path();
    let real = format!("{SCENARIO}bandwidth = 0.8\nlatency_s = 0.08\n");
    fs::write(here.join("real.toml"), real).unwrap();
    fs::write(here.join("nominal.toml"), SCENARIO).unwrap();
    let gusts = "world.gusts={ std_m_s = 0.3, correlation_s = 2.0 }";
    let (code, _, errors) =
        run(here, &["stress", "real.toml", "--out", "real", "--set", gusts, "--set", "execute.baseline=0"]);
    assert_eq!(code, 0, "{errors}");
    assert_eq!(run(here, &["export", "real", "--to", "csv"]).0, 0);
    assert_eq!(run(here, &["generate", "nominal.toml", "--out", "plan"]).0, 0);
    let found = |folder: &str| fs::read_dir(here.join(folder)).into_iter().flatten();
    let mut logs: Vec<String> = ["real", "real/export"]
        .iter()
        .flat_map(|folder| found(folder))
        .map(|entry| entry.unwrap().path().display().to_string())
        .filter(|path| path.ends_with("-0.csv"))
        .collect();
    logs.sort();
    assert_eq!(logs.len(), 5);
    let logs: Vec<&str> = logs.iter().map(String::as_str).collect();
    let how = ["--robot", "flightgoggles", "--campaign", "plan", "--out", "mine.toml", "--holdout", "0.2", "--json"];
    // A log says once what it says, under whatever name it comes again.
    fs::create_dir(here.join("copies")).unwrap();
    fs::copy(logs[1], here.join("copies/0001-7.csv")).unwrap();
    let words = ["copies/0001-7.csv", logs[1], "would count twice"];
    let [to_read @ .., _] = &how;
    refused(here, &[&["fit"][..], &logs, &["copies/0001-7.csv"], to_read].concat(), &words);
    refused(here, &[&["fit"][..], &logs, &logs[..1], to_read].concat(), &[logs[0], "would count twice"]);
    let asked = [&["fit"][..], &logs, &how].concat();
    let (code, answer, errors) = run(here, &asked);
    assert_eq!(code, 0, "{answer}{errors}");
    let found: Value = serde_json::from_str(&answer).unwrap();
    assert_eq!(found["unseen"]["improves"], true, "{found}");
    let numbers = found["parameters"].as_array().unwrap();
    let of = |name: &str| numbers.iter().find(|number| number["name"] == name).unwrap();
    assert_eq!(of("bandwidth")["identifiable"], true, "{found}");
    assert_eq!(
        (&of("bandwidth")["interval_tried"], &found["intervals_never_tried_with"]),
        (&true.into(), &Value::Null)
    );
    // How often intervals hold is asked of many draws, in the library; one set of logs tells how near the values are.
    for (name, truth, within) in
        [("bandwidth", 0.8, 0.05), ("latency_s", 0.08, 0.1), ("drag_quadratic_n_s2_m2", 0.1, 0.15)]
    {
        let value = of(name)["value"].as_f64().unwrap();
        assert!((value - truth).abs() <= within * truth, "{name}: {found}");
    }
    // Nothing was at its limit.
    assert_eq!(of("thrust_to_weight")["identifiable"], false);
    // What is written is a robot.
    let (code, _, errors) = run(
        here,
        &[
            "generate",
            "mine.toml",
            "--out",
            "again",
            "--set",
            "generate.search.method=\"uniform\"",
            "--set",
            "generate.search.cases=1",
            "--set",
            "generate.search.waypoints=60",
        ],
    );
    assert_eq!(code, 0, "{errors}");

    // What is wrong is told with both numbers.
    fs::write(here.join("other.csv"), "x_m,y_m,z_m\n1,1,1\n2,2,2\n3,3,3\n").unwrap();
    let robot = ["--robot", "flightgoggles", "--out", "x.toml"];
    refused(
        here,
        &[&["fit", logs[0], "--mission", "other.csv"][..], &robot].concat(),
        &["m from waypoint 0 at (1.00, 1.00, 1.00) m"],
    );
    refused(here, &[&["fit", logs[0], "--campaign", "plan"][..], &robot].concat(), &["give more logs"]);
    refused(here, &[&["fit", logs[0]][..], &robot].concat(), &["--mission"]);
    refused(here, &[&["fit", "--campaign", "plan"][..], &robot].concat(), &["LOGS"]);
    fs::write(here.join("0000-0.csv"), "t,x_m,y_m,z_m\n0,8,8,10\n0.1,8,8,10\n0.2,8,8,10\n").unwrap();
    refused(
        here,
        &[&["fit", "0000-0.csv", "--campaign", "plan"][..], &robot].concat(),
        &["0.2 s of motion, at least 5 s"],
    );
    fs::write(here.join("broken.toml"), "kind = \"quadrotor\"\nname = \"x\"\nrotors = []\n").unwrap();
    refused(here, &["fit", logs[0], "--campaign", "plan", "--robot", "broken.toml", "--out", "x.toml"], &["mass_kg"]);
}
