//! `hairpin steer --terrain`: drives on elevation maps, and what stands in their way.

use std::fs;
use std::path::Path;

use assert_cmd::Command;
use serde_json::Value;

fn run(folder: &Path, arguments: &[&str]) -> (i32, String, String) {
    let mut command = Command::cargo_bin("hairpin").expect("the binary is built with its tests");
    let output = command.current_dir(folder).args(arguments).output().unwrap();
    let text = |bytes| String::from_utf8(bytes).expect("UTF-8");
    (output.status.code().expect("no signal"), text(output.stdout), text(output.stderr))
}

/// Rolling ground of 20 m by 20 m around the origin, cells of 0.1 m, as an ESRI grid; `height` may spoil it.
fn hills(folder: &Path, height: impl Fn(f64, f64) -> f64) {
    let mut grid = "ncols 200\nnrows 200\nxllcorner -10\nyllcorner -10\ncellsize 0.1\nNODATA_value -9999\n".to_owned();
    for row in (0..200).rev() {
        for column in 0..200 {
            let at = |i: i32| -9.95 + 0.1 * f64::from(i);
            grid.push_str(&format!("{:.5} ", height(at(column), at(row))));
        }
        grid.push('\n');
    }
    fs::write(folder.join("hills.asc"), grid).unwrap();
}

fn rolling(x: f64, y: f64) -> f64 {
    0.25 * (0.9 * x).sin() * (0.7 * y + 0.3).cos()
}

fn steer(folder: &Path, rover: &str, more: &[&str]) -> (i32, Value) {
    let (code, out, error) = run(folder, &[&["steer", rover, "--terrain", "hills.asc", "--json"], more].concat());
    (code, serde_json::from_str(&out).unwrap_or_else(|wrong| panic!("{wrong}: {out}{error}")))
}

#[test]
fn rovers_that_rest_on_their_wheels_meet_goals_on_rolling_ground() {
    let folder = tempfile::tempdir().unwrap();
    hills(folder.path(), rolling);
    for rover in ["rocky8", "rocky7", "open-source-rover", "sojourner-like", "four-wheel"] {
        for goal in ["4,1,0.5", "3,-2,-1", "5,0.5,0.2"] {
            let (code, answer) = steer(folder.path(), rover, &["--from", "-3,-2,0.3", "--to", goal]);
            assert_eq!((code, &answer["status"]), (0, &Value::from("ok")), "{rover} to {goal}: {answer}");
            let error = |name: &str| answer["errors"][name].as_f64().unwrap().abs();
            assert!(error("x_m").hypot(error("y_m")) < 0.01 && error("yaw_rad") < 0.01, "{answer}");
            assert!(answer["max_curvature_1_m"].as_f64().unwrap() <= 1.5, "{answer}");
            // Strides of 10 cm at most, and an honest sum of what they leave out.
            assert!(answer["replay_steps"].as_u64() >= Some(30), "{answer}");
            assert!(answer["replay_left_out_m"].as_f64().unwrap() <= 1e-4, "{answer}");
        }
    }
    // The ground is longer than the plane: the same goal takes other controls.
    let (_, flat, _) = run(folder.path(), &["steer", "rocky8", "--from", "-3,-2,0.3", "--to", "4,1,0.5", "--json"]);
    let flat: Value = serde_json::from_str(&flat).unwrap();
    let (_, ground) = steer(folder.path(), "rocky8", &["--from", "-3,-2,0.3", "--to", "4,1,0.5"]);
    assert!(ground["length_m"].as_f64() > flat["length_m"].as_f64(), "{ground} {flat}");
}

#[test]
fn files_of_queries_are_answered_on_the_map_the_same_on_any_number_of_threads() {
    let folder = tempfile::tempdir().unwrap();
    hills(folder.path(), rolling);
    let queries = "id,sx,sy,syaw,x,y,yaw,k0,kf\na,-3,-2,0.3,3,1,0.5,0,0\nb,8,0,0,6,0,0,0,0\nc,0,0,1,-1,1,2,0.2,-0.1\nd,0,0,x,1,1,1,0,0\n";
    fs::write(folder.path().join("q.csv"), queries).unwrap();
    let table = |threads: &str| {
        let arguments =
            ["steer", "rocky8", "--terrain", "hills.asc", "--queries", "q.csv", "--reversals", "--threads", threads];
        let (code, out, error) = run(folder.path(), &arguments);
        assert_eq!(code, 0, "{error}");
        let cells: Vec<Vec<String>> = out.lines().map(|line| line.split(',').map(str::to_owned).collect()).collect();
        let time = cells[0].iter().position(|name| name == "time_us").unwrap();
        cells
            .into_iter()
            .map(|mut row| {
                row.remove(time);
                row
            })
            .collect::<Vec<_>>()
    };
    let (one, two) = (table("1"), table("2"));
    assert_eq!(one, two);
    let status = |id: &str| one.iter().find(|row| row[0] == id).map(|row| row[4].clone()).unwrap();
    assert_eq!(["a", "b", "c", "d"].map(status), ["ok", "infeasible", "ok", "invalid"]);
}

#[test]
fn what_stands_in_the_way_is_named() {
    let folder = tempfile::tempdir().unwrap();
    hills(folder.path(), |x, y| if (x - 1.0).abs() < 0.3 { -9999.0 } else { rolling(x, y) });
    let ahead = ["--from", "-2,0,0", "--to", "4,0,0"];
    let (code, out, error) = run(folder.path(), &[&["steer", "rocky8", "--terrain", "hills.asc"][..], &ahead].concat());
    assert!(code == 2 && out.is_empty() && error.contains("cells without data, the first in row"), "{error}");
    let (code, answer) = steer(folder.path(), "rocky8", &[&ahead[..], &["--no-data", "keep-out"]].concat());
    assert_eq!((code, &answer["limit"]), (3, &Value::from("no_data")), "{answer}");
    let (code, answer) = steer(folder.path(), "rocky8", &[&ahead[..], &["--no-data", "fill"]].concat());
    assert_eq!((code, &answer["status"]), (0, &Value::from("ok")), "{answer}");
    let (code, answer) = steer(folder.path(), "rocky8", &["--from", "8,5,0", "--to", "14,5,0", "--no-data", "fill"]);
    assert_eq!((code, &answer["limit"]), (3, &Value::from("map_edge")), "{answer}");
    // The goal lies 4 m beyond; the wheels meet the edge before, and up to there it is a drive.
    assert!((answer["excess"].as_f64().unwrap() - 4.0).abs() < 0.11, "{answer}");
    let [stop, before] =
        ["standstill", "goal_on_the_way"].map(|key| ["x", "y"].map(|axis| answer[key][axis].as_f64().expect(key)));
    assert!(stop[0] > 9.0 && stop[0] < 10.0 && before[0] > 8.5 && before[0] < stop[0], "{answer}");
    let before =
        format!("{},{},{},{}", before[0], before[1], answer["goal_on_the_way"]["yaw"], answer["goal_on_the_way"]["kf"]);
    let (code, answer) = steer(folder.path(), "rocky8", &["--from", "8,5,0", "--to", &before, "--no-data", "fill"]);
    assert_eq!((code, &answer["status"]), (0, &Value::from("ok")), "{answer}");
    // A wall of 60°, over the tilt that is allowed.
    hills(folder.path(), |x, _| 1.7 * x.clamp(0.0, 3.0));
    let (code, answer) = steer(folder.path(), "rocky8", &["--from", "-3,0,0", "--to", "2,0,0"]);
    assert_eq!((code, &answer["limit"]), (3, &Value::from("tilt_rad")), "{answer}");
    assert!(answer["excess"].as_f64().unwrap() > 0.1, "{answer}");
}

#[test]
fn holes_of_a_map_are_driven_around_as_places_to_keep_out_of_are() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    hills(at, |x, y| if (x - 1.0).hypot(y) < 0.3 || y > 5.0 { -9999.0 } else { rolling(x, y) });
    let keep_out = |more: &[&str]| steer(at, "rocky8", &[&["--no-data", "keep-out"], more].concat());
    let (code, answer) = keep_out(&["--from", "-4,0,0", "--to", "6,0,0", "--path", "path.csv"]);
    assert_eq!((code, &answer["status"]), (0, &Value::from("ok")), "{answer}");
    let error = |name: &str| answer["errors"][name].as_f64().unwrap().abs();
    assert!(error("x_m").hypot(error("y_m")) < 0.01 && error("yaw_rad") < 0.01, "{answer}");
    assert!((10.0..12.0).contains(&answer["length_m"].as_f64().unwrap()), "{answer}");
    let path = fs::read_to_string(at.join("path.csv")).unwrap();
    let mut lines = path.lines();
    let names: Vec<&str> = lines.next().unwrap().split(',').collect();
    let [x, y] = ["x_m", "y_m"].map(|name| names.iter().position(|known| *known == name).unwrap());
    let (mut rows, mut aside) = (0, 0.0_f64);
    for line in lines {
        let cells: Vec<f64> = line.split(',').map(|cell| cell.parse().unwrap_or(f64::NAN)).collect();
        // Heights take two cells beyond the middle of one.
        assert!((cells[x] - 1.0).hypot(cells[y]) > 0.3 + 0.2 && cells[y] < 4.8, "{line}");
        aside = if cells[y].abs() > aside.abs() { cells[y] } else { aside };
        rows += 1;
    }
    assert!(rows > 100, "{rows} rows");
    // Around a place of the user's as well, which stays one.
    let circle = format!("1,{aside},0.3");
    let (code, both) = keep_out(&["--from", "-4,0,0", "--to", "6,0,0", "--keep-out-circle", &circle]);
    assert_eq!((code, &both["status"]), (0, &Value::from("ok")), "{both}");
    assert!(both["segments"] != answer["segments"], "{both}");
    // No way leads into what has no data.
    let (code, none) = keep_out(&["--from", "-4,0,0", "--to", "1,7,1.5"]);
    assert_eq!((code, &none["limit"]), (3, &Value::from("no_data")), "{none}");
    fs::write(at.join("q.csv"), "id,sx,sy,syaw,x,y,yaw,k0,kf\na,-4,0,0,10,0,0,0,0\nb,-4,0,0,5,7,1.5,0,0\n").unwrap();
    let arguments = ["--terrain", "hills.asc", "--no-data", "keep-out", "--queries", "q.csv"];
    let (code, out, error) = run(at, &[&["steer", "rocky8"], &arguments[..]].concat());
    assert_eq!(code, 0, "{error}");
    let rows: Vec<Vec<&str>> = out.lines().map(|row| row.split(',').collect()).collect();
    let status = |id: &str| rows.iter().find(|row| row[0] == id).map(|row| row[4]);
    assert_eq!(["a", "b"].map(status), [Some("ok"), Some("infeasible")], "{out}");
}

#[test]
fn maps_that_are_none_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let refused = |arguments: &[&str], said: &str| {
        let all = [&["steer", "rocky8", "--to", "2,0,0"], arguments].concat();
        let (code, out, error) = run(folder.path(), &all);
        assert!(code == 2 && out.is_empty() && error.contains(said), "{arguments:?}: {code} {error}");
    };
    refused(&["--terrain", "nothing.tif"], "nothing.tif");
    refused(&["--terrain", "."], ".: ");
    fs::write(folder.path().join("a.tif"), b"garbage").unwrap();
    refused(&["--terrain", "a.tif"], "no readable GeoTIFF");
    fs::write(folder.path().join("a.raw"), [0; 32]).unwrap();
    refused(&["--terrain", "a.raw"], "cell_m: the file does not say it");
    refused(&["--terrain", "a.raw", "--terrain-cell-m", "0.1"], "height_m: the file does not say it");
    refused(&["--terrain", "a.raw", "--terrain-height-m", "1,nan"], "two finite numbers");
    refused(&["--no-data", "fill"], "--terrain");
}

#[test]
fn no_time_gives_the_start_value_of_the_plane() {
    let folder = tempfile::tempdir().unwrap();
    hills(folder.path(), rolling);
    let (code, answer) = steer(folder.path(), "rocky8", &["--to", "4,1,0.5", "--time-limit-ms", "0"]);
    assert_eq!((code, &answer["status"]), (5, &Value::from("time_limit")), "{answer}");
    assert!(answer["segments"].as_array().is_some_and(|segments| !segments.is_empty()), "{answer}");
}

#[test]
fn show_terrain_tells_what_was_understood() {
    let folder = tempfile::tempdir().unwrap();
    hills(folder.path(), |x, y| if x < -9.9 && y > 9.9 { 7.0 } else { rolling(x, y).clamp(-0.2, 0.2) });
    let (code, out, error) = run(folder.path(), &["show", "terrain", "hills.asc"]);
    assert_eq!(code, 0, "{error}");
    for said in [
        "200 x 200 cells of 0.1 x 0.1 m",
        "-9.950 .. 9.950 m",
        "-0.200 .. 7.000 m, 0 cells",
        "7.000 m at (-9.950, 9.950)",
    ] {
        assert!(out.contains(said), "{said}: {out}");
    }
    let (_, out, _) = run(folder.path(), &["show", "terrain", "hills.asc", "--json"]);
    let object: Value = serde_json::from_str(&out).unwrap();
    assert_eq!((&object["columns"], &object["north_west"]["height_m"]), (&Value::from(200), &Value::from(7.0)));
    let (code, out, error) = run(folder.path(), &["show", "terrain", "nothing.tif"]);
    assert!(code == 2 && out.is_empty() && error.contains("nothing.tif"), "{error}");
}

#[test]
fn places_to_keep_out_of_are_gone_around_on_the_plane_and_on_the_ground() {
    let folder = tempfile::tempdir().unwrap();
    hills(folder.path(), rolling);
    let rock = "keep_out = [{ name = \"rock\", circle = { center_m = [0.5, -0.6], radius_m = 0.4 } }]\n";
    fs::write(folder.path().join("rocks.toml"), rock).unwrap();
    let there = ["--from", "-3,-2,0.3", "--to", "4,1,0.5"];
    for ground in [&["--terrain", "hills.asc"][..], &[]] {
        let ask = |more: &[&str]| {
            let (code, out, error) =
                run(folder.path(), &[&["steer", "rocky8", "--json"], ground, &there[..], more].concat());
            (code, serde_json::from_str::<Value>(&out).unwrap_or_else(|wrong| panic!("{wrong}: {out}{error}")))
        };
        let (_, plain) = ask(&[]);
        let (code, around) = ask(&["--keep-out", "rocks.toml"]);
        assert_eq!((code, &around["status"]), (0, &Value::from("ok")), "{around}");
        assert!(around["segments"] != plain["segments"], "the rock is not in the way: {plain}");
        assert!(around["length_m"].as_f64() > plain["length_m"].as_f64(), "{around} {plain}");
        // The same place as a flag is the same place. Other families go around it as well, or say that they cannot.
        let (_, flag) = ask(&["--keep-out-circle", "0.5,-0.6,0.4"]);
        assert_eq!(flag["segments"], around["segments"]);
        for control in ["knots", "time-polynomial", "velocity-polynomial"] {
            let (code, other) = ask(&["--keep-out", "rocks.toml", "--control", control]);
            assert_eq!((code, &other["status"], &other["control"]), (0, &"ok".into(), &control.into()), "{other}");
        }
        let (code, cubic) = ask(&["--keep-out", "rocks.toml", "--control", "cubic"]);
        assert_eq!((code, &cubic["limit"]), (3, &Value::from("keep_out")), "{cubic}");
        assert_eq!(cubic["keep_out"]["spare_parameters"], 0, "{cubic}");
        // A goal beside the rock is within reach of the wheels.
        let to = [&there[..2], &["--to", "1.2,-0.4,0.3", "--keep-out", "rocks.toml"]].concat();
        let (code, out, _) = run(folder.path(), &[&["steer", "rocky8", "--json"], ground, &to[..]].concat());
        let near: Value = serde_json::from_str(&out).unwrap();
        assert_eq!(
            (code, &near["limit"], &near["keep_out"]["place"]),
            (3, &"keep_out".into(), &"rock".into()),
            "{near}"
        );
        let depth = near["excess"].as_f64().unwrap();
        assert!(depth > 0.1 && depth < 1.5, "{near}");
        // The nearest goal that is none of that is answered.
        let part =
            |key: &str| near["nearest_goal"][key].as_f64().unwrap_or_else(|| panic!("{key}: {near}")).to_string();
        let nearest = ["x", "y", "yaw", "kf"].map(part).join(",");
        let to = [&there[..2], &["--to", &nearest, "--keep-out", "rocks.toml"]].concat();
        let (code, out, _) = run(folder.path(), &[&["steer", "rocky8", "--json"], ground, &to[..]].concat());
        assert_eq!(code, 0, "{nearest}: {out}");
    }
    let (code, out, _) =
        run(folder.path(), &["steer", "rocky8", "--from", "-3,-2,0", "--to", "0.5,-0.5,0", "--keep-out", "rocks.toml"]);
    assert!(code == 3 && out.contains("keep_out exceeded by") && out.contains("m (rock, after "), "{out}");
    assert!(out.contains("nearest goal that one arc leads to: --to "), "{out}");
    fs::write(folder.path().join("wrong.toml"), "keep_out = [{ name = \"rock\" }]\n").unwrap();
    for (file, told) in [("wrong.toml", "exactly one of circle, polygon"), ("none.toml", "none.toml")] {
        let (code, _, error) = run(folder.path(), &["steer", "rocky8", "--to", "2,0,0", "--keep-out", file]);
        assert!(code == 2 && error.contains(told), "{code} {error}");
    }
}

#[test]
fn costs_are_lowered_on_the_ground_and_told() {
    let folder = tempfile::tempdir().unwrap();
    hills(folder.path(), rolling);
    let there = ["--from", "-3,-2,0.3", "--to", "4,1,0.5"];
    for name in ["curvature", "rate", "tilt", "energy"] {
        let (code, cheap) = steer(folder.path(), "rocky8", &[&there[..], &["--cost", name]].concat());
        assert_eq!((code, &cheap["status"], &cheap["cost"]["name"]), (0, &"ok".into(), &name.into()), "{cheap}");
        assert!(cheap["cost"]["value"].as_f64().unwrap() > 0.0, "{cheap}");
    }
    let (_, plain) = steer(folder.path(), "rocky8", &there);
    let (_, tilt) = steer(folder.path(), "rocky8", &[&there[..], &["--cost", "tilt"]].concat());
    assert!(plain.get("cost").is_none() && tilt["segments"] != plain["segments"], "{tilt}");
}

#[test]
fn exact_kinematics_take_other_controls_to_the_same_goal() {
    let folder = tempfile::tempdir().unwrap();
    hills(folder.path(), rolling);
    let asked = |more: &[&str]| {
        let (code, answer) =
            steer(folder.path(), "rocky8", &[&["--from", "-3,-2,0.3", "--to", "4,1,0.5"], more].concat());
        assert_eq!((code, &answer["status"]), (0, &Value::from("ok")), "{answer}");
        let error = |name: &str| answer["errors"][name].as_f64().unwrap().abs();
        assert!(error("x_m").hypot(error("y_m")) < 0.01 && error("yaw_rad") < 0.01, "{answer}");
        answer["segments"].clone()
    };
    let exact = asked(&["--kinematics", "exact"]);
    assert!(!exact.is_null() && asked(&[]) == asked(&["--kinematics", "source"]) && asked(&[]) != exact, "{exact}");
    for (more, said) in [
        (["--terrain", "hills.asc", "--kinematics", "exakt"].as_slice(), "[possible values: source, exact]"),
        (&["--kinematics", "exact"], "--terrain"),
    ] {
        let (code, _, error) = run(folder.path(), &[&["steer", "rocky8", "--to", "2,0,0"], more].concat());
        assert!(code == 2 && error.contains(said), "{code}: {error}");
    }
}
