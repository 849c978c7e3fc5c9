//! Files for the user's autopilot: what they hold, what preflight refuses, and the card of the day.

use std::fs;
use std::path::Path;

use crate::commands::run;
use serde_json::Value;

const ORIGIN: &str = "world.origin={lat_deg=47.3977,lon_deg=8.5456,alt_amsl_m=488.0,x_axis_heading_deg=73.5}";
const MINIMAL: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/executors/minimal_executor.py");

fn demo(folder: &Path, verb: &str, more: &[&str]) {
    let small = [verb, "demo-quadrotor", "--out", "a", "--set", ORIGIN, "--set", "execute.repeat=1"];
    let (code, out, error) = run(folder, &[&small[..], more].concat());
    assert!([0, 1].contains(&code), "{out}{error}");
}

fn json_of(path: &Path) -> Value {
    serde_json::from_str(&fs::read_to_string(path).unwrap()).unwrap()
}

#[test]
fn a_case_is_a_mission_set_points_and_polynomials() {
    let place = tempfile::tempdir().unwrap();
    demo(place.path(), "generate", &["--set", "generate.search.cases=1"]);
    let (code, out, error) = run(place.path(), &["export", "a", "--to", "plan,wpl,setpoints,poly4d"]);
    assert_eq!(code, 0, "{out}{error}");
    for words in ["not executed, so no excursion is predicted", "its stress, are lost", "keep the timing"] {
        assert!(out.contains(words), "{words}: {out}");
    }
    let export = place.path().join("a/export");
    let plan = json_of(&export.join("0000.plan"));
    let commands: Vec<u64> =
        plan["mission"]["items"].as_array().unwrap().iter().map(|item| item["command"].as_u64().unwrap()).collect();
    assert_eq!((commands.first(), commands.last()), (Some(&22), Some(&21)));
    assert!(commands.contains(&178) && plan["hairpin"]["way"].as_str().unwrap().contains("PX4 plans its own way"));
    assert!(plan["hairpin"].get("accepted_excursion").is_none());
    // The same items in both files.
    let rows = fs::read_to_string(export.join("0000.waypoints")).unwrap();
    let own: Vec<u64> = rows.lines().skip(2).map(|row| row.split('\t').nth(3).unwrap().parse().unwrap()).collect();
    assert_eq!(own, commands);
    let parameters = fs::read_to_string(export.join("0000.params")).unwrap();
    for name in ["GF_ACTION", "GF_MAX_VER_DIST", "NAV_ACC_RAD", "RTL_RETURN_ALT", "RTL_CONE_ANG"] {
        assert!(parameters.contains(&format!("1\t1\t{name}\t")), "{name}");
    }
    // It begins at rest 3 m above home, and its nose is where the cage's x is.
    let setpoints = fs::read_to_string(export.join("0000.setpoints.csv")).unwrap();
    let first: Vec<f64> = setpoints.lines().nth(1).unwrap().split(',').map(|cell| cell.parse().unwrap()).collect();
    assert!((first[3] + 3.0).abs() < 1e-3 && first[1].abs() < 1e-3 && (first[10] - 73.5_f64.to_radians()).abs() < 1e-4);
    assert!(first[4..7].iter().all(|v| v.abs() < 1e-6), "{first:?}");
    assert!(export.join("0000.poly4d.bin").is_file() && json_of(&export.join("0000.poly4d.json"))["size"].is_string());
    let (code, ..) = run(place.path(), &["export", "a", "--to", "plan", "--autopilot", "ardupilot"]);
    assert!(code == 0 && json_of(&export.join("0000.plan"))["mission"]["firmwareType"] == 3);
    assert!(fs::read_to_string(export.join("0000.params")).unwrap().contains("\tFENCE_ALT_MAX\t"));
}

#[test]
fn what_leaves_the_margin_is_refused_and_accepted_by_name() {
    let place = tempfile::tempdir().unwrap();
    let head = "def fly(mission, speed=2.0, step=0.02):";
    let high = "say(type='pose', t_s=0, p_m=[3, 3, 3])\n    say(type='pose', t_s=1.5, p_m=[3, 3, 31])";
    let program = fs::read_to_string(MINIMAL)
        .unwrap()
        .replace(head, &format!("{head}\n    {high}\n    return say(type='end', reason='time')"));
    fs::write(place.path().join("high.py"), program).unwrap();
    demo(place.path(), "stress", &["--set", "generate.search.cases=1", "--executor", "python3 high.py"]);
    for to in ["plan", "wpl", "setpoints", "poly4d"] {
        let (code, out, error) = run(place.path(), &["export", "a", "--to", to]);
        assert!(code == 2 && out.is_empty(), "{to}: {out}{error}");
        for words in
            ["case 0000: run 0", "t = 1.50 s", "1.000 m beyond the ceiling", "2 m inside", "--accept-excursion"]
        {
            assert!(error.contains(words), "{words}: {error}");
        }
    }
    assert!(!place.path().join("a/export/0000.plan").exists());
    let (code, out, error) = run(place.path(), &["export", "a", "--to", "plan,wpl", "--accept-excursion"]);
    assert!(code == 0 && out.contains("accepted (--accept-excursion): case 0000: run 0"), "{out}{error}");
    let plan = json_of(&place.path().join("a/export/0000.plan"));
    assert!(plan["hairpin"]["accepted_excursion"].as_str().unwrap().contains("beyond the ceiling"));
    let beside = fs::read_to_string(place.path().join("a/export/0000.params")).unwrap();
    assert!(beside.contains("# accepted_excursion: case 0000"), "{beside}");
}

#[test]
fn a_day_has_a_page_a_flight_and_a_slow_first_run() {
    let place = tempfile::tempdir().unwrap();
    demo(place.path(), "stress", &["--set", "generate.search.cases=3"]);
    let (code, out, error) = run(place.path(), &["export", "a", "--flights", "2", "--accept-excursion"]);
    assert_eq!(code, 0, "{out}{error}");
    let page = fs::read_to_string(place.path().join("a/export/day-card.html")).unwrap();
    assert_eq!(page.matches("<section class=\"flight\"").count(), 2);
    assert!(page.contains("default-src 'none'") && !page.contains("<script") && !page.contains("http://"));
    for words in [
        "worst moment",
        "End the flight when",
        "slow: 30 %",
        "no safety certificate",
        "<svg class=\"views\"",
        "says nothing of its battery",
    ] {
        assert!(page.contains(words), "{words}");
    }
    let order = out.lines().find_map(|line| line.strip_prefix("in the order of the day: ")).unwrap();
    let first = order.split(", ").next().unwrap();
    let speed = |name: String| {
        let plan = json_of(&place.path().join("a/export").join(name));
        plan["mission"]["cruiseSpeed"].as_f64().unwrap()
    };
    assert_eq!(run(place.path(), &["export", "a", "--to", "plan", "--case", first, "--accept-excursion"]).0, 0);
    assert!((speed(format!("{first}_slow.plan")) / speed(format!("{first}.plan")) - 0.3).abs() < 0.01);
    let (code, _, error) = run(place.path(), &["export", "a", "--flights", "4"]);
    assert!(code == 2 && error.contains("--flights 4: must be at most"), "{error}");
    assert_eq!(run(place.path(), &["export", "a"]).0, 2, "nothing is asked for");
}

#[test]
fn a_drive_is_a_mission_of_a_rover() {
    let place = tempfile::tempdir().unwrap();
    let ground = "world.terrain={ generator = \"craters\", size_m = 60, cell_m = 0.2 }";
    let few = "generate.search={ score = \"slope+slip\", waypoints = 24, cases = 1 }";
    let keys = ["--set", "task.length=4", "--set", "generate.manoeuvres=[\"forward\"]", "--set", few, "--set", ground];
    run(place.path(), &[&["generate", "rover", "--out", "r", "--set", ORIGIN], &keys[..]].concat());
    let (code, out, error) = run(place.path(), &["export", "r", "--to", "plan,setpoints"]);
    assert_eq!(code, 0, "{out}{error}");
    let plan = json_of(&place.path().join("r/export/0000.plan"));
    assert_eq!(plan["mission"]["vehicleType"], 10);
    let items = plan["mission"]["items"].as_array().unwrap();
    assert!(items.iter().all(|item| [16, 178].contains(&item["command"].as_u64().unwrap())));
    assert!(items.iter().filter(|item| item["command"] == 16).all(|item| item["params"][3].is_null()));
    assert!(items[0]["Altitude"].as_f64().unwrap().abs() < 1e-3, "home is the first waypoint");
    // The commanded speed, which is what limits bound: on rough ground the way is longer, and so faster, than its plan.
    let speeds: Vec<_> = items.iter().filter(|item| item["command"] == 178).map(|item| &item["params"][1]).collect();
    assert!(!speeds.is_empty() && speeds.iter().all(|speed| speed.as_f64().unwrap() <= 0.06), "{speeds:?}");
    let (_, out, error) = run(place.path(), &["check", "r/export/0000.plan", "--robot", "r/scenario.toml"]);
    assert!(!out.contains("are demanded"), "{out}{error}");
    // North and east, but for the digits.
    let table = fs::read_to_string(place.path().join("r/export/0000.setpoints.csv")).unwrap();
    for row in table.lines().skip(1) {
        let cells: Vec<f64> = row.split(',').map(|cell| cell.parse().unwrap()).collect();
        assert!(cells[4].hypot(cells[5]) <= 0.060_01, "{row}");
    }
    let (code, _, error) = run(place.path(), &["export", "r", "--to", "poly4d"]);
    assert!(code == 2 && error.contains("does not fly"), "{error}");
}

#[test]
fn a_mission_says_which_legs_go_backwards() {
    let place = tempfile::tempdir().unwrap();
    let few = "generate.search={ method = \"beam\", score = \"curvature-change\", waypoints = 24, cases = 1 }";
    let keys = ["--set", "task.length=3", "--set", "generate.manoeuvres=[\"reverse\"]", "--set", few];
    run(place.path(), &[&["generate", "car", "--out", "c", "--set", ORIGIN], &keys[..]].concat());
    let (code, out, error) = run(place.path(), &["export", "c", "--to", "plan,wpl", "--autopilot", "ardupilot"]);
    assert!(code == 0 && format!("{out}{error}").contains("0→1, 1→2 backwards"), "{out}{error}");
    let wpl = fs::read_to_string(place.path().join("c/export/0000.waypoints")).unwrap();
    let reverses = wpl.lines().filter(|line| line.split('\t').nth(3) == Some("194"));
    assert_eq!(reverses.count(), 2, "into reverse, and forwards again: {wpl}");
    // Its limit is 1.5 m/s, and where its legs join places jump by millimetres within one sample.
    let speeds = wpl.lines().filter(|line| line.split('\t').nth(3) == Some("178"));
    let speeds: Vec<f64> = speeds.map(|line| line.split('\t').nth(5).unwrap().parse().unwrap()).collect();
    assert!(!speeds.is_empty() && speeds.iter().all(|speed| *speed <= 1.5), "{speeds:?}");
    assert_eq!(run(place.path(), &["export", "c", "--to", "csv"]).0, 0);
    let table = fs::read_to_string(place.path().join("c/export/0000.planned.csv")).unwrap();
    let names: Vec<&str> = table.lines().next().unwrap().split(',').collect();
    let [vx, vy] = ["vx_m_s", "vy_m_s"].map(|name| names.iter().position(|other| *other == name).unwrap());
    for row in table.lines().skip(1) {
        let cells: Vec<f64> = row.split(',').map(|cell| cell.parse().unwrap()).collect();
        assert!(cells[vx].hypot(cells[vy]) <= 1.5 + 1e-6, "{row}");
    }
    let (_, out, error) = run(place.path(), &["export", "c", "--to", "plan"]);
    assert!(format!("{out}{error}").contains("missions of PX4 have no gear"), "{out}{error}");
}
