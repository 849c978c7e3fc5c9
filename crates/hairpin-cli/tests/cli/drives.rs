//! Whole campaigns of drives through the binary: rovers on a map, a car and a differential drive on flat ground.

use std::fs;
use std::path::Path;

use crate::commands::{assert_same, json, refused, run};
use hairpin_formats::folder::CampaignFolder;
use serde_json::Value;

/// A small campaign of a rover: forward drives over generated ground.
const SMALL: [&str; 13] = [
    "rover",
    "--set",
    "task.length=4",
    "--set",
    "generate.manoeuvres=[\"forward\"]",
    "--set",
    "generate.search={ score = \"slope+slip\", waypoints = 24, cases = 2 }",
    "--set",
    "execute.controller=\"pure-pursuit\"",
    "--set",
    "execute.repeat=2",
    "--set",
    "world.terrain={ generator = \"craters\", size_m = 60, cell_m = 0.2 }",
];

fn small<'a>(command: &'a str, more: &[&'a str]) -> Vec<&'a str> {
    [&[command], &SMALL[..], more].concat()
}

#[test]
fn a_rovers_campaign_is_driven_judged_proven_and_driven_again() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let lax = ["--set", "spec.limits={ path_deviation_m = 5.0 }", "--out", "a"];
    let object = json(at, &small("stress", &lax));
    assert_eq!(object["exit_code"], 0, "{object}");
    assert_eq!((&object["counts"]["cases"], &object["counts"]["pass"]), (&Value::from(2), &Value::from(2)));
    assert_eq!(object["frame"]["relative_to"], "map origin");
    assert_eq!(object["worst"]["evidence"], "witnessed");
    let keys: Vec<&str> =
        object["influences"].as_array().unwrap().iter().filter_map(|found| found["key"].as_str()).collect();
    assert!(keys.contains(&"robot.slip_at_20_deg"), "{keys:?}");
    let verified = json(at, &["verify", "a"]);
    assert_eq!((&verified["checked"], &verified["failed"]), (&Value::from(2), &Value::from(0)), "{verified}");
    assert!(verified["worst"]["end_error_m"].as_f64().unwrap() < 0.01);
    let report = fs::read_to_string(at.join("a/report.html")).unwrap();
    assert!(report.contains("\"relief\":{") && report.contains("data:image/png") && report.contains("tip-over margin"));

    // A limit that nobody keeps; the violation is driven again to the bit.
    let strict = json(at, &["judge", "a", "--set", "spec.limits.path_deviation_m=0.0001"]);
    assert_eq!(strict["exit_code"], 1, "{strict}");
    let again = json(at, &["replay", "a/repro/0000.json"]);
    assert_eq!((&again["exit_code"], &again["reproduces"]), (&Value::from(1), &Value::from(true)), "{again}");
    // More segments than a leg of ours can have, as an edited file may: refused, with the place and the bound.
    let mut long: Value = serde_json::from_slice(&fs::read(at.join("a/repro/0000.json")).unwrap()).unwrap();
    let segments = long["drive"]["legs"][1]["segments"].as_array_mut().unwrap();
    segments.resize(41, segments[0].clone());
    fs::write(at.join("long.json"), long.to_string()).unwrap();
    refused(at, &["replay", "long.json"], &["long.json", "drive.legs[1] has 41 segments", "40 at most"]);
    let (code, out, _) = run(at, &["export", "a", "--to", "waypoints,csv,tum"]);
    assert_eq!(code, 0, "{out}");
    assert_eq!(fs::read_to_string(at.join("a/export/0000.csv")).unwrap().lines().count(), 5);
}

/// Plans, runs and proofs of exact kinematics agree with each other, and with nothing else.
#[test]
fn exact_kinematics_go_through_the_campaign_and_are_told_from_the_sources() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let exact =
        ["--set", "generate.kinematics=\"exact\"", "--set", "spec.limits={ path_deviation_m = 5.0 }", "--out", "a"];
    let object = json(at, &small("stress", &exact));
    assert_eq!(object["exit_code"], 0, "{object}");
    let verified = json(at, &["verify", "a"]);
    assert_eq!((&verified["checked"], &verified["failed"]), (&Value::from(2), &Value::from(0)), "{verified}");
    assert!(fs::read_to_string(at.join("a/report.html")).unwrap().contains("Kinematics <code>exact</code>"));
    let resolved = fs::read_to_string(at.join("a/scenario.toml")).unwrap();
    assert!(resolved.contains("kinematics = \"exact\""), "{resolved}");
    fs::write(at.join("a/scenario.toml"), resolved.replace("kinematics = \"exact\"", "kinematics = \"source\""))
        .unwrap();
    let (code, out, error) = run(at, &["verify", "a", "--json"]);
    assert!(code == 1 && out.contains("end.position"), "{code}: {out}{error}");
    refused(at, &small("generate", &["--set", "generate.kinematics=\"exakt\""]), &["exakt", "source", "exact"]);
}

/// A simulator that drives every plan exactly, with or without heights; in eight poses a second.
const EXACT: &str = "import json, sys\n\
say = lambda **words: print(json.dumps(words), flush=True)\n\
for line in sys.stdin:\n    \
    heard = json.loads(line)\n    \
    if heard['type'] == 'hello':\n        \
        say(type='ready', protocol=1, name='exact')\n    \
    elif heard['type'] == 'mission':\n        \
        rows = [[one['t_s'], *one['p_m']] for one in heard['timed']]\n        \
        steps = [[a + (b - a) * k / 4 for a, b in zip(*two)] for two in zip(rows, rows[1:]) for k in range(4)]\n        \
        for t, x, y, z in steps + rows[-1:]:\n            \
            say(type='pose', t_s=t, p_m=[x, y, HEIGHT])\n        \
        say(type='end', reason='done')\n";

/// A planar simulator knows no heights, and none of the map's is a deviation from the plan.
#[test]
fn programs_of_drives_that_tell_no_heights_are_on_the_ground() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let told = "sent no heights of 2 of 2 runs (0 in all of their poses): they are those of the vehicle on the map's ground, with the \
                headings of its way";
    let mut worst = Vec::new();
    for (name, height, by_map) in [("solid", "z", 0), ("planar", "0.0", 2)] {
        fs::write(at.join(format!("{name}.py")), EXACT.replace("HEIGHT", height)).unwrap();
        let program = format!("python3 {name}.py");
        let more = ["--executor", &program, "--out", name, "--set", "execute.repeat=1"];
        let limits = ["--set", "spec.limits={ path_deviation_m = 0.1 }", "--set", "execute.baseline=0"];
        let drive: Vec<&str> = small("stress", &more).into_iter().chain(limits).collect();
        let pursued = drive.iter().position(|word| word.starts_with("execute.controller")).unwrap();
        let drive = [&drive[..pursued - 1], &drive[pursued + 1..]].concat();
        let object = json(at, &drive);
        assert_eq!(object["exit_code"], 0, "{object}");
        worst.push(object["worst"]["max_deviation_m"].as_f64().unwrap());
        let page = fs::read_to_string(at.join(name).join("report.html")).unwrap();
        assert_eq!(page.contains(told), by_map > 0, "{name}");
        assert_eq!(json(at, &["execute", name])["counts"]["heights_by_map"], by_map);
    }
    assert!((worst[0] - worst[1]).abs() < 0.01, "{worst:?}");
}

#[test]
fn results_depend_on_no_threads_and_parts_make_the_whole() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    run(at, &small("stress", &["--threads", "1", "--out", "one"]));
    run(at, &small("generate", &["--threads", "2", "--out", "two"]));
    run(at, &["execute", "two"]);
    run(at, &["judge", "two"]);
    assert_same(&at.join("one"), &at.join("two"));
}

#[test]
fn a_map_is_kept_with_the_campaign_and_a_changed_one_refused() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    fs::write(at.join("yard.asc"), map(40, 0.5)).unwrap();
    let scenario = "hairpin = 1\nrobot = \"rocky8\"\nseed = 3\nspec = \"none\"\n[world]\nterrain = { file = \"yard.asc\" }\nframe = \"ned\"\n\
                    origin = { lat_deg = 0.0, lon_deg = 0.0, alt_amsl_m = 0.0, x_axis_heading_deg = 0.0 }\n\
                    keep_out = [{ name = \"rock\", circle = { center_m = [12.0, 8.0], radius_m = 0.5 } }]\n\
                    [task]\nstart = { x_m = 10.0, y_m = 9.0, yaw_deg = 90 }\nlength = 3\nleg_m = [2, 5]\n\
                    [generate]\nsearch = { waypoints = 16, cases = 1 }\n[execute]\ncontroller = \"stanley\"\n";
    fs::write(at.join("yard.toml"), scenario).unwrap();
    let object = json(at, &["stress", "yard.toml", "--out", "a"]);
    assert_eq!(object["exit_code"], 0, "{object}");
    // x north, y east became x east, y north; yaw 90° from north is east.
    let resolved = fs::read_to_string(at.join("a/scenario.toml")).unwrap();
    assert!(resolved.contains("x_m = 9.0") && resolved.contains("y_m = 10.0"), "{resolved}");
    assert!(resolved.contains("frame = \"enu\"") && resolved.contains("file = \"terrain.asc\""), "{resolved}");
    assert!(resolved.contains("x_axis_heading_deg = 90.0"), "{resolved}");
    // 10 m north and 9 m east where a degree is 110.574 km and 111.319 km.
    assert_eq!(run(at, &["export", "a", "--to", "geodetic"]).0, 0);
    let table = fs::read_to_string(at.join("a/export/0000.geodetic.csv")).unwrap();
    let start: Vec<f64> = table.lines().nth(1).unwrap().split(',').map(|cell| cell.parse().unwrap()).collect();
    assert!((start[0] * 110_574.0 - 10.0).abs() < 1e-3 && (start[1] * 111_319.5 - 9.0).abs() < 1e-3, "{table}");
    // The folder is enough.
    fs::remove_file(at.join("yard.asc")).unwrap();
    assert_eq!(json(at, &["verify", "a"])["failed"], 0);
    assert_eq!(json(at, &["judge", "a"])["exit_code"], 0);
    fs::write(at.join("a/terrain.asc"), map(40, 0.6)).unwrap();
    refused(at, &["judge", "a"], &["world.terrain.checksum", "another map"]);
}

#[test]
fn where_nothing_can_be_driven_the_reasons_are_told() {
    let folder = tempfile::tempdir().unwrap();
    let walls = "world.keep_out=[{ name = \"moat\", polygon = { points_m = [[28,28],[33,28],[33,33],[28,33],[28,29],[29,29],[29,32],[32,32],[32,29],[28,29]] } }]";
    let few = ["--set", walls, "--set", "generate.search.graphs=2", "--out", "a"];
    let (code, out, error) = run(folder.path(), &small("stress", &few));
    assert_eq!(code, 3, "{out}{error}");
    assert!(out.contains("NOTHING FEASIBLE") && out.contains("keep-out"), "{out}");
}

#[test]
fn cars_and_differential_drives_go_the_same_way() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    for (kind, step) in [("car", "2.0"), ("differential-drive", "10.0")] {
        assert_eq!(run(at, &["new", kind]).0, 0);
        let file = format!("{kind}.toml");
        let few = ["cases=2", "waypoints=24", "executions=12"].map(|set| format!("generate.search.{set}"));
        let few = few.each_ref().map(|set| ["--set", set]);
        let few = few.as_flattened();
        let lax = ["--set", "spec.limits={ path_deviation_m = 50.0 }", "--out", kind];
        let object = json(at, &[&["stress", &file][..], few, &lax].concat());
        // The missions are hard; whether a controller comes to their end is its own business.
        assert!([0, 1].contains(&object["exit_code"].as_i64().unwrap()), "{kind}: {object}");
        assert_eq!(object["counts"]["cases"], 2, "{kind}: {object}");
        assert_eq!(json(at, &["verify", kind])["failed"], 0, "{kind}");
        for (reach, evidence) in [("hull", "hull-feasible"), ("sphere", "unchecked"), ("none", "unchecked")] {
            let out = format!("{kind}-{reach}");
            let (set, step) = (format!("generate.reach=\"{reach}\""), format!("generate.step_s={step}"));
            let asked = ["--set", &set, "--set", &step, "--set", "task.length=3", "--out", &out];
            let object = json(at, &[&["generate", &file][..], few, &asked].concat());
            assert_eq!(object["exit_code"], 0, "{kind}, {reach}: {object}");
            let table = at.join(&out).join("results.parquet");
            assert!(fs::metadata(table).is_ok(), "{evidence}");
        }
    }
}

/// Changing controls and speeds is changing a value: what is found is proven, or refused by name.
#[test]
fn every_family_of_controls_and_speeds_joins_legs() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let few = [
        "--set",
        "generate.search={ score = \"speed+reversals\", waypoints = 8, cases = 1 }",
        "--set",
        "task.length=3",
    ];
    let controls = ["arc", "turn-drive-turn", "cubic", "quintic", "time-polynomial", "knots", "velocity-polynomial"];
    for (index, control) in controls.into_iter().enumerate() {
        let control = format!("generate.control=\"{control}\"");
        let profile = format!("generate.speed.profile=\"{}\"", ["constant", "ramp", "trapezoid"][index % 3]);
        let asked = ["--set", &control, "--set", &profile, "--out", &control];
        let object = json(at, &[&["generate", "differential-drive"][..], &few, &asked].concat());
        assert_eq!(object["exit_code"], 0, "{control}: {object}");
        let verified = json(at, &["verify", &control]);
        assert_eq!((&verified["checked"], &verified["failed"]), (&Value::from(1), &Value::from(0)), "{verified}");
    }
    for control in ["arc", "turn-drive-turn"] {
        let control = format!("generate.control=\"{control}\"");
        refused(at, &["stress", "car", "--set", &control, "--out", "a"], &["generate.control", "turn-in-place"]);
    }
    let turn = "generate.manoeuvres=[\"forward\", \"turn-in-place\"]";
    refused(at, &["stress", "car", "--set", turn, "--out", "a"], &["generate.manoeuvres", "does not turn"]);
    refused(
        at,
        &["stress", "car", "--set", "generate.direction_deg=20", "--out", "a"],
        &["generate.direction_deg", "all-wheel"],
    );
}

/// Wheels that take any speed at once follow a plan that leaves its waypoints from rest, and take as long as it.
#[test]
fn rovers_without_a_bound_on_their_acceleration_drive_plans_that_rest() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let search = "generate.search={ score = \"slope+slip\", waypoints = 12, cases = 2 }";
    for profile in ["profile = \"trapezoid\"", "profile = \"ramp\", waypoint_m_s = [0.03, 0.06]"] {
        for controller in ["pure-pursuit", "predictive"] {
            let speed = format!("generate.speed={{ {profile}, acceleration_m_s2 = 0.02 }}");
            let controller = format!("execute.controller=\"{controller}\"");
            let set = |set| ["--set", set];
            let sets = [&speed, search, &controller, "task.length=3"].map(set);
            let flat = [
                "--set",
                "world.terrain={ generator = \"flat\", size_m = 60, cell_m = 0.2 }",
                "--force",
                "--out",
                "rest",
            ];
            json(at, &[&["stress", "rocky8"][..], sets.as_flattened(), &flat].concat());
            let kept = CampaignFolder::open(&at.join("rest")).unwrap();
            for (case, result) in kept.read_cases().unwrap().iter().zip(kept.read_results().unwrap()) {
                assert_eq!(result.ended, "done", "{speed} {controller}");
                let (took, planned) = (result.measures.unwrap().total_time, case.leg_times.iter().sum::<f64>());
                assert!((took / planned - 1.0).abs() < 0.05, "{speed} {controller}: {took} s, planned {planned} s");
            }
        }
    }
}

/// A ramp over a long leg at 7 mm/s takes more than a minute for its first two centimetres: the vehicle is not stuck.
#[test]
fn a_drive_that_is_planned_to_creep_is_not_stuck() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let sets = [
        "generate.speed={ profile = \"ramp\", acceleration_m_s2 = 0.02 }",
        "world.terrain={ generator = \"flat\", size_m = 60, cell_m = 0.1 }",
        "generate.manoeuvres=[\"forward\"]",
        "generate.search={ score = \"slope+slip\", waypoints = 25, cases = 1 }",
        "execute.controller=\"stanley\"",
        "task.length=3",
    ];
    let sets = sets.map(|set| ["--set", set]);
    json(at, &[&["stress", "sojourner-like"][..], sets.as_flattened(), &["--out", "slow"]].concat());
    let results = CampaignFolder::open(&at.join("slow")).unwrap().read_results().unwrap();
    assert_eq!(results[0].ended, "done");
}

/// Scores of straight legs have every term; an outline is kept clear of what is to be kept out of; a car stops for its
/// cusps.
#[test]
fn cars_shunt_and_every_reach_set_takes_every_score() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let few = [
        "--set",
        "generate.search.method=beam",
        "--set",
        "generate.search.cases=1",
        "--set",
        "generate.search.waypoints=20",
        "--set",
        "task.length=3",
    ];
    for reach in ["none", "sphere", "hull"] {
        let reach = format!("generate.reach=\"{reach}\"");
        let mut scores = Vec::new();
        for score in ["slope", "roll", "slip", "speed", "curvature-change", "reversals", "random", "speed+slip+roll"] {
            let score = format!("generate.search.score=\"{score}\"");
            let out = format!("{reach}-{score}");
            let map = "world.terrain={ generator = \"craters\", size_m = 60, cell_m = 0.5 }";
            let asked =
                ["--set", &reach, "--set", &score, "--set", "generate.step_s=60.0", "--set", map, "--out", &out];
            let object = json(at, &[&["generate", "rover"][..], &few, &asked].concat());
            assert_eq!(object["exit_code"], 0, "{out}: {object}");
            scores.push(fs::read(at.join(&out).join("results.parquet")).unwrap());
        }
        // Nothing of straight lines changes curvature or gear: those two are equal, and all others differ.
        let different = scores.iter().collect::<std::collections::BTreeSet<_>>().len();
        assert!(different >= scores.len() - 1, "{reach}: {different}");
    }
    let both = "generate.manoeuvres=[\"forward\", \"reverse\"]";
    let score = "generate.search.score=\"reversals\"";
    let lax = ["--set", both, "--set", score, "--set", "spec.limits={ clearance_m = 0.0 }", "--out", "car"];
    let object = json(at, &[&["stress", "car"][..], &few, &lax].concat());
    assert!([0, 1].contains(&object["exit_code"].as_i64().unwrap()), "{object}");
    let verified = json(at, &["verify", "car"]);
    assert_eq!((&verified["checked"], &verified["failed"]), (&Value::from(1), &Value::from(0)), "{verified}");
}

/// A rover that travels at angles to its body that turn along the way, with an acceleration and a lag of its own.
#[test]
fn a_rover_travels_crabwise_and_stops_for_its_turns() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let own = [
        "--set",
        "generate.direction_deg=[-10, 25]",
        "--set",
        "generate.manoeuvres=[\"forward\", \"reverse\", \"turn-in-place\"]",
        "--set",
        "robot.limits.acceleration_m_s2=0.05",
        "--set",
        "robot.mass_kg=60",
        "--set",
        "robot.forces={ gravity_m_s2 = 3.71, rolling_resistance = 0.05 }",
        "--set",
        "robot.wheels={ torque_n_m = 3 }",
        "--set",
        "execute.external_force_n=[5, -3, 0]",
        "--set",
        "robot.response.steering_time_constant_s=0.5",
        "--set",
        "spec.limits={ path_deviation_m = 5.0 }",
        "--set",
        "world.terrain={ generator = \"craters\", size_m = 60, cell_m = 0.2, relief_m = 0.3 }",
        "--set",
        "generate.search={ score = \"reversals+speed\", waypoints = 10, cases = 1 }",
        "--set",
        "task.length=3",
        "--out",
        "a",
    ];
    let object = json(at, &small("stress", &own));
    assert_eq!(object["exit_code"], 0, "{object}");
    let verified = json(at, &["verify", "a"]);
    assert_eq!((&verified["checked"], &verified["failed"]), (&Value::from(1), &Value::from(0)), "{verified}");
    let report = fs::read_to_string(at.join("a/report.html")).unwrap();
    assert!(report.contains("as trapezoids"), "the speeds of plans are told");
    assert!(report.contains("between -10° and 25° of the body"), "and the directions");
    assert!(report.contains("more than 3 N·m") && report.contains("(5, -3, 0) N"), "and the forces");
    json(at, &["export", "a", "--to", "csv"]);
    let run = fs::read_to_string(at.join("a/export/0000-0.csv")).unwrap();
    let names = run.lines().find(|line| line.contains("slip")).unwrap();
    assert!(names.contains("wheel_torque_n_m") && names.contains("travel_direction_rad"), "{names}");
}

#[test]
fn mistakes_are_told_with_their_place() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    for (set, words) in [
        ("task.start.x_m=1e4", &["task.start", "outside the map"][..]),
        ("task.leg_m=[6, 2]", &["task.leg_m", "rising"]),
        ("generate.search.score=\"bumps\"", &["generate.search.score", "slope"]),
        ("generate.limits.speed_m_s=-1", &["speed_m_s"]),
        ("generate.control=\"spiral\"", &["generate.control", "quintic"]),
        ("generate.speed.profile=\"ramp\"", &["generate.speed.acceleration_m_s2", "not bounded"]),
        ("generate.speed.waypoint_m_s=[0.01, 0.05]", &["generate.speed.waypoint_m_s", "constant"]),
        ("generate.direction_deg=400", &["generate.direction_deg", "180"]),
        ("generate.direction_deg=[30, -30]", &["generate.direction_deg", "rising"]),
        ("generate.direction_deg=[-30, 400]", &["generate.direction_deg[1]", "180"]),
        ("generate.direction_deg=\"left\"", &["generate.direction_deg", "an array of 2 numbers"]),
        ("generate={ reach = \"hull\", direction_deg = [0, 20] }", &["generate.direction_deg", "witness"]),
        ("execute.external_force_n=[1, 0, 0]", &["execute.external_force_n", "robot.forces"]),
        ("robot.wheels={ torque_n_m = 3 }", &["robot.wheels.torque_n_m", "mass_kg"]),
        ("world.terrain={ file = \"none.tif\" }", &["none.tif", "cannot be read"]),
        ("world.terrain={ generator = \"moon\" }", &["generator", "craters"]),
        ("world.keep_out=[{ name = \"x\" }]", &["world.keep_out[0]", "circle"]),
        ("robot.suspension.wheel_radius_m=-0.1", &["robot.suspension.wheel_radius_m"]),
        ("execute.controler=\"stanley\"", &["execute.controler", "controller"]),
    ] {
        // Of the ground as small as it may be, where it is not what is wrong.
        let ground = if set.starts_with("world.terrain") { set } else { SMALL[12] };
        refused(at, &["stress", "rover", "--set", ground, "--set", set, "--out", "a"], words);
    }
    refused(at, &["simulate", "rocky8", "--rotor-speeds", "x.csv"], &["rocky8", "rotors"]);
    assert!(fs::read_dir(at).unwrap().next().is_none(), "mistakes leave nothing behind");
}

/// A gentle hill as an ESRI ASCII grid of `cells` × `cells` cells of 0.5 m, `height` m high.
fn map(cells: usize, height: f64) -> String {
    let mut text =
        format!("ncols {cells}\nnrows {cells}\nxllcorner 0\nyllcorner 0\ncellsize 0.5\nNODATA_value -9999\n");
    for row in 0..cells {
        let line = (0..cells).map(|column| {
            let (x, y) = (column as f64 / cells as f64 - 0.5, row as f64 / cells as f64 - 0.5);
            format!("{:.4}", height * (-8.0 * (x * x + y * y)).exp())
        });
        text.push_str(&line.collect::<Vec<_>>().join(" "));
        text.push('\n');
    }
    text
}

#[test]
fn a_demo_needs_nothing_but_the_binary() {
    let folder = tempfile::tempdir().unwrap();
    let (code, out, error) = run(folder.path(), &["demo", "differential-drive", "--out", "d"]);
    assert!([0, 1].contains(&code), "{out}{error}");
    assert!(Path::new(&folder.path().join("d/report.html")).is_file());
}
