//! `hairpin steer`: controls, speeds, directions and wheels by flags and columns, and what is written of them.

use std::fs;
use std::path::Path;

use assert_cmd::Command;
use serde_json::Value;

/// A car: front wheels steered by 35° at most, 1 m/s² at most, wheels that roll at 12 rad/s at most.
const CAR: &str = "kind = \"rover\"\nname = \"car\"\nsteering = \"front\"\n\
    suspension = { kind = \"four-wheel\", wheel_radius_m = 0.1, front_m = [0.8, 0.3, 0.0], rear_m = [0.0, 0.3, 0.0] }\n\
    limits = { curvature_1_m = 2.0, acceleration_m_s2 = 1.0 }\n\
    wheels = { steer_limit_deg = 35, speed_rad_s = 12 }\n";

/// Runs in `folder`; exit code, stdout, stderr.
fn run(folder: &Path, arguments: &[&str], log: &str) -> (i32, String, String) {
    let mut command = Command::cargo_bin("hairpin").expect("the binary is built with its tests");
    let output = command.current_dir(folder).env("RUST_LOG", log).args(arguments).output().unwrap();
    let text = |bytes| String::from_utf8(bytes).expect("UTF-8");
    (output.status.code().expect("no signal"), text(output.stdout), text(output.stderr))
}

fn object(folder: &Path, arguments: &[&str]) -> (i32, Value) {
    let (code, out, error) = run(folder, &[&["steer"], arguments, &["--json"]].concat(), "warn");
    (code, serde_json::from_str(&out).unwrap_or_else(|_| panic!("{arguments:?}: {out}{error}")))
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value}"))
}

/// A table of numbers by column; empty cells are no numbers.
fn table(path: &Path) -> (Vec<String>, Vec<Vec<f64>>) {
    let text = fs::read_to_string(path).unwrap();
    let mut lines = text.lines();
    let names = lines.next().unwrap().split(',').map(str::to_owned).collect();
    let rows = lines.map(|line| line.split(',').map(|cell| cell.parse().unwrap_or(f64::NAN)).collect());
    (names, rows.collect())
}

#[test]
fn every_control_answers_by_its_name() {
    let folder = tempfile::tempdir().unwrap();
    for control in ["cubic", "quintic", "time-polynomial", "knots", "velocity-polynomial"] {
        let asked = ["generic", "--to", "5,1.5,0.6,0.2", "--control", control, "--v0", "0.4", "--vf", "1"];
        let (code, answer) = object(folder.path(), &asked);
        assert!(code == 0 && answer["status"] == "ok" && answer["control"] == control, "{answer}");
        assert!(answer["profile"]["kind"] == "ramp" && number(&answer["profile"]["end_m_s"]) == 1.0, "{answer}");
        let error = &answer["errors"];
        assert!(
            number(&error["x_m"]).hypot(number(&error["y_m"])) < 1e-3 && number(&error["curvature_1_m"]).abs() < 1e-3
        );
    }
    let (_, knots) = object(folder.path(), &["generic", "--to", "5,1.5,0.6", "--control", "knots"]);
    assert_eq!(knots["parameters"]["curvature_at_knots"].as_array().unwrap().len(), 8);
    // Without a curvature to end with, velocities leave it as it comes; given, it is met.
    let (_, free) = object(folder.path(), &["generic", "--to", "5,1.5,0.6", "--control", "velocity-polynomial"]);
    let (_, met) = object(folder.path(), &["generic", "--to", "5,1.5,0.6,0", "--control", "velocity-polynomial"]);
    assert!(free["status"] == "ok" && met["status"] == "ok" && free["segments"] != met["segments"], "{free}");
    // What a control cannot choose it names, with the excess.
    let (code, arc) = object(folder.path(), &["generic", "--to", "4,1,0.9", "--control", "arc"]);
    assert_eq!((code, arc["limit"].as_str()), (3, Some("yaw_rad")), "{arc}");
    let (code, turns) = object(folder.path(), &["generic", "--to", "-2,1,0.9", "--control", "turn-drive-turn"]);
    assert!(code == 0 && turns["segments"][0]["kind"] == "turn", "{turns}");
    let (code, out, error) = run(folder.path(), &["steer", "generic", "--to", "1,0,0", "--control", "spline"], "warn");
    assert!(code == 2 && out.is_empty() && error.contains("velocity-polynomial"), "{error}");
}

#[test]
fn speeds_are_limits_like_the_others() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("car.toml"), CAR).unwrap();
    let car = |more: &[&str]| object(folder.path(), &[&["car.toml", "--to", "4,0.5,0.1"], more].concat());
    let (code, hard) = car(&["--v0", "0.2", "--vf", "3"]);
    assert_eq!((code, hard["limit"].as_str()), (3, Some("acceleration")), "{hard}");
    // (vf² − v0²) / 2L − 1, L the drive's own.
    let expected = 8.96 / (2.0 * number(&hard["length_m"])) - 1.0;
    assert!((number(&hard["excess"]) - expected).abs() < 1e-9, "{hard}");
    let (code, fast) = car(&["--v0", "1.5", "--vf", "1.5"]);
    assert_eq!((code, fast["limit"].as_str()), (3, Some("wheel_speed")), "{fast}");
    let (code, rest) = car(&["--v0", "0", "--vf", "0"]);
    assert!(
        code == 0 && rest["profile"]["kind"] == "trapezoid" && number(&rest["profile"]["end_m_s"]) == 0.0,
        "{rest}"
    );
    assert!(number(&rest["profile"]["max_acceleration_m_s2"]) <= 1.0 + 1e-9, "{rest}");
    let (code, out, error) =
        run(folder.path(), &["steer", "car.toml", "--to", "4,0,0", "--cruise", "1", "--v0", "2"], "warn");
    assert!(code == 2 && out.is_empty() && error.contains("v0"), "{error}");
    // Columns go before flags, and one row's speeds are its own.
    fs::write(folder.path().join("q.csv"), "id,x,y,yaw,k0,kf,v0,vf\na,4,0.5,0.1,0,0,0.2,3\nb,4,0.5,0.1,0,0,0.2,0.6\n")
        .unwrap();
    let (code, out, error) = run(folder.path(), &["steer", "car.toml", "--queries", "q.csv"], "warn");
    let rows: Vec<Vec<&str>> = out.lines().skip(1).map(|line| line.split(',').collect()).collect();
    assert!(
        code == 0 && rows[0][4] == "infeasible" && rows[0][20] == "acceleration" && rows[1][4] == "ok",
        "{out}{error}"
    );
}

#[test]
fn joints_forbid_what_ackermanns_cars_cannot() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("car.toml"), CAR).unwrap();
    let (code, turn) = object(folder.path(), &["car.toml", "--to", "0,0,1", "--control", "turn-drive-turn"]);
    assert_eq!((code, turn["limit"].as_str()), (3, Some("steer_angle")), "{turn}");
    // About the middle of its rear axle the front wheels would stand at atan(0.8 / 0.3).
    assert!((number(&turn["excess"]) - ((0.8f64 / 0.3).atan() - 35f64.to_radians())).abs() < 1e-9, "{turn}");
    // Drives keep within the joints where curvature alone would allow more.
    let (code, bent) = object(folder.path(), &["car.toml", "--to", "2,2,1.5707963267948966", "--v0", "0.5"]);
    assert!(code == 0 && number(&bent["wheels"]["max_steer_deg"]) <= 35.0 + 1e-6, "{bent}");
    assert_eq!(bent["wheels"]["names"][1], "front_right");
}

#[test]
fn paths_and_wheels_are_written_in_time() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    let asked = [
        "steer",
        "rocky8",
        "--from",
        "10,5,0.6",
        "--to",
        "14,7,0.5",
        "--v0",
        "0.1",
        "--vf",
        "0.3",
        "--direction",
        "0.2",
        "--direction-end",
        "-0.1",
        "--path",
        "p.csv",
        "--wheels",
        "w.csv",
        "--time-step-s",
        "0.05",
    ];
    let (code, out, error) = run(path, &asked, "warn");
    assert!(code == 0 && error.is_empty(), "{out}{error}");
    let (names, rows) = table(&path.join("p.csv"));
    assert_eq!(
        names.join(","),
        "t_s,s_m,x_m,y_m,z_m,roll_rad,pitch_rad,yaw_rad,curvature_1_m,v_m_s,direction_rad,tilt_rad,clearance_m,tip_over_margin_rad,\
         joint_rocker_rad,joint_left_bogie_rad,joint_right_bogie_rad"
    );
    let (first, last) = (&rows[0], rows.last().unwrap());
    for (row, expected) in [(first, [10.0, 5.0, 0.6, 0.1, 0.2]), (last, [14.0, 7.0, 0.5, 0.3, -0.1])] {
        let found = [row[2], row[3], row[7], row[9], row[10]];
        assert!(found.iter().zip(expected).all(|(found, expected)| (found - expected).abs() < 0.002), "{found:?}");
    }
    assert!(rows.windows(2).all(|pair| pair[1][0] > pair[0][0] && pair[1][0] - pair[0][0] < 0.0501));
    // Rows are consistent with each other: the speed is what the places say, and the clearance that of level ground.
    for pair in rows.windows(2).take(rows.len() - 2) {
        let went = (pair[1][2] - pair[0][2]).hypot(pair[1][3] - pair[0][3]);
        assert!((went - 0.05 * 0.5 * (pair[0][9] + pair[1][9])).abs() < 1e-3, "{pair:?}");
    }
    let (names, wheels) = table(&path.join("w.csv"));
    assert!(names.len() == 5 + 12 && names[5] == "left_rocker_steer_deg" && names[6] == "left_rocker_speed_rad_s");
    assert!(wheels.len() == rows.len() && (wheels[0][0], wheels[0][2]) == (0.0, 10.0));
    // Six wheels roll in the mean as far as the body goes.
    let middle = &wheels[wheels.len() / 2];
    let mean = (0..6).map(|i| middle[6 + 2 * i]).sum::<f64>() / 6.0;
    let speed = rows[rows.len() / 2][9];
    assert!((mean * 0.13 - speed).abs() < 0.1 * speed, "{mean} {speed}");
    let (code, _, error) = run(path, &["steer", "generic", "--to", "3,1,0", "--wheels", "w.csv"], "warn");
    assert!(code == 2 && error.contains("no wheels"), "{error}");
}

/// 100 kg of which rolling takes a tenth: 100 N at a steady speed, shared by four wheels of 0.1 m.
#[test]
fn torques_are_told_of_vehicles_that_weigh_and_hold_them() {
    let folder = tempfile::tempdir().unwrap();
    let heavy = |wheels: &str| {
        format!(
            "kind = \"rover\"\nname = \"heavy\"\nmass_kg = 80\nload_kg = 20\n\
             forces = {{ gravity_m_s2 = 10.0, rolling_resistance = 0.1 }}\n\
             suspension = {{ kind = \"four-wheel\", wheel_radius_m = 0.1, front_m = [0.3, 0.25, -0.05], rear_m = [-0.3, 0.25, -0.05] }}\n\
             limits = {{ curvature_1_m = 1.0 }}\n[wheels]\n{wheels}"
        )
    };
    fs::write(folder.path().join("free.toml"), heavy("")).unwrap();
    fs::write(folder.path().join("weak.toml"), heavy("torque_n_m = 2.0")).unwrap();
    let (code, free) = object(folder.path(), &["free.toml", "--to", "4,1,0.3", "--v0", "0.5", "--path", "p.csv"]);
    let forces = &free["forces"];
    assert!(code == 0 && forces["wheel_torque_limit_n_m"].is_null(), "{free}");
    for (key, expected) in [("mass_kg", 100.0), ("max_traction_n", 100.0), ("max_wheel_torque_n_m", 2.5)] {
        assert!((number(&forces[key]) - expected).abs() < 1e-6, "{key}: {forces}");
    }
    let (names, rows) = table(&folder.path().join("p.csv"));
    assert_eq!(names[names.len() - 2..], ["traction_n", "wheel_torque_n_m"]);
    assert!(rows.iter().all(|row| (row[names.len() - 1] - 2.5).abs() < 1e-6));
    assert!((number(&free["body"]["min_tip_over_margin_deg"]) - rows[0][13].to_degrees()).abs() < 1e-6, "{free}");
    let (code, weak) = object(folder.path(), &["weak.toml", "--to", "4,1,0.3", "--v0", "0.5"]);
    assert_eq!((code, weak["limit"].as_str()), (3, Some("wheel_torque")), "{weak}");
    assert!((number(&weak["excess"]) - 0.5).abs() < 1e-6 && number(&weak["forces"]["at_m"]) >= 0.0, "{weak}");
    // From rest the same wheels also speed up: 0.1 m/s² are 10 N more.
    let (code, rising) =
        object(folder.path(), &["free.toml", "--to", "4,0,0", "--v0", "0", "--vf", "0", "--acceleration", "0.1"]);
    assert!(code == 0 && (number(&rising["forces"]["max_traction_n"]) - 110.0).abs() < 1e-6, "{rising}");
}

#[test]
fn debugging_shows_iterations_and_changes_no_answer() {
    let folder = tempfile::tempdir().unwrap();
    let asked = ["steer", "generic", "--to", "5,1.5,0.6", "--control", "knots"];
    let (_, quiet, nothing) = run(folder.path(), &asked, "warn");
    let (_, told, steps) = run(folder.path(), &asked, "debug");
    let drive =
        |text: &str| text.lines().take_while(|line| !line.starts_with("ok")).map(str::to_owned).collect::<Vec<_>>();
    assert!(nothing.is_empty() && steps.contains("start 0, step 1") && drive(&quiet) == drive(&told), "{steps}");
    let (_, _, steps) = run(folder.path(), &["steer", "generic", "--to", "5,1.5,0.6"], "debug");
    assert!(steps.contains("steps at most"), "{steps}");
}
