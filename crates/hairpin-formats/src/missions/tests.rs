//! Files written by hand by the rules of their formats, placed by closed forms, and what is wrong with others.

use std::path::Path;

use hairpin::campaign::Scenario;
use hairpin::campaign::bounds::FARTHEST_M;
use nalgebra::Point3;
use proptest::prelude::*;

use super::{Frame, Mission, read, read_all};
use crate::qgc::{read_plan, read_wpl};
use crate::scenario::setup_for;

const PLAN: &str = include_str!("../../tests/fixtures/missions/cage.plan");
const WPL: &str = include_str!("../../tests/fixtures/missions/cage.waypoints");

fn scenario(origin: bool) -> Scenario {
    let world = ("world".to_owned(), "{ size_m = [90, 90, 90] }".to_owned());
    let sets = if origin { Vec::new() } else { vec![world] };
    let setup = setup_for("quadrotor", &sets).expect("shipped");
    assert_eq!(setup.scenario.origin().is_some(), origin);
    setup.scenario.clone()
}

fn mission(text: &str, name: &str, origin: bool) -> Result<Mission, String> {
    let place = tempfile::tempdir().expect("a folder of our own");
    let path = place.path().join(name);
    std::fs::write(&path, text).expect("a file of our own");
    let told = |error: super::MissionError| error.to_string().replace(&place.path().display().to_string(), "");
    read(&path, &scenario(origin), FARTHEST_M).map_err(told)
}

/// East and north of home in metres, by the radii of curvature of WGS 84 at its latitude.
fn enu(lat: f64, lon: f64, up: f64) -> Point3<f64> {
    let [lat0, lon0] = [38.033553_f64, -78.5079772];
    let (a, e2) = (6_378_137.0, 0.006_694_379_990_14);
    let w = 1.0 - e2 * lat0.to_radians().sin().powi(2);
    let (meridian, normal) = (a * (1.0 - e2) / w.powf(1.5) + 180.0, a / w.sqrt() + 180.0);
    let north = (lat - lat0).to_radians() * meridian;
    let east = (lon - lon0).to_radians() * normal * lat0.to_radians().cos();
    Point3::new(east, north, up)
}

#[test]
fn a_plan_is_east_north_up_about_its_home_where_the_world_is_nowhere() {
    let read = mission(PLAN, "cage.plan", false).unwrap();
    assert!(matches!(read.frame, Frame::Home(home) if home.alt_amsl_m == 180.0), "{:?}", read.frame);
    let expected = [enu(38.0336, -78.5079, 5.0), enu(38.03364, -78.50784, 6.0), enu(38.03368, -78.5079, 8.0)];
    assert_eq!(read.waypoints.len(), 3);
    for (found, expected) in read.waypoints.iter().zip(&expected) {
        // The tangent plane lies 1.6e-5 m above the ground 14 m away; radii of curvature are good to a fraction of
        // that.
        assert!((found - expected).norm() < 1e-3, "{found} {expected}");
    }
    assert_eq!(read.sources, ["item 1", "item 3", "item 5"]);
    assert_eq!(read.speeds, [Some(3.0), Some(3.0)]);
    assert!(read.stops.is_empty() && read.uncertain.is_empty() && read.rounded);
    let notes = read.notes.join("; ");
    assert!(notes.contains("item 4 (command 203, camera shutter) is passed over"), "{notes}");
    assert!(notes.contains("takes off to 5.00 m above home") && notes.contains("descent"), "{notes}");
    assert!(matches!(&read.fences[..], [fence] if fence.keeps_in), "{:?}", read.fences);
}

/// The same mission as the list of items that both ground stations make of it.
#[test]
fn both_formats_say_the_same() {
    let (plan, wpl) = (mission(PLAN, "a.plan", true).unwrap(), mission(WPL, "a.waypoints", true).unwrap());
    assert_eq!(plan.frame, Frame::Placed);
    assert_eq!((&plan.waypoints, &plan.speeds), (&wpl.waypoints, &wpl.speeds));
    // The cage's x heads 73.5°: along x is east sin 73.5° + north cos 73.5°.
    let (sin, cos) = 73.5_f64.to_radians().sin_cos();
    let there = enu(38.03364, -78.50784, 6.0);
    let along = Point3::new(there.x * sin + there.y * cos, there.y * sin - there.x * cos, 6.0);
    assert!((plan.waypoints[1] - along).norm() < 1e-3, "{} {along}", plan.waypoints[1]);
    // By its first signs, whatever it is called.
    assert_eq!(mission(WPL, "list.mission", true).unwrap().waypoints, wpl.waypoints);
    assert_eq!(mission(PLAN, "list.mission", true).unwrap().waypoints, wpl.waypoints);
}

#[test]
fn speeds_holds_and_endings_are_kept() {
    let with = |from: &str, to: &str| mission(&WPL.replacen(from, to, 1), "a.waypoints", false).unwrap();
    // A hold at the waypoint between the ends; one at the last ends the mission anyway.
    let held = with("3\t0\t3\t16\t0\t", "3\t0\t3\t16\t2.5\t");
    assert!(matches!(held.stops[..], [stop] if stop.waypoint == 1 && stop.hold_s == 2.5), "{:?}", held.stops);
    let without = with("4\t0\t3\t16\t0\t", "4\t0\t3\t16\t2.5\t");
    assert!(without.stops.is_empty() && without.hold() == 0.0 && without.hold().is_sign_positive());
    // 19: loiter for a time; a pause at an item that does not go on lasts until somebody says so.
    assert_eq!(with("3\t0\t3\t16\t0\t", "3\t0\t3\t19\t7\t").stops[0].hold_s, 7.0);
    let waits = with("38.03364000\t-78.50784000\t6.000000\t1", "38.03364000\t-78.50784000\t6.000000\t0");
    assert_eq!(waits.stops[0].hold_s, f64::INFINITY);
    // −2 is the vehicle's own speed again, −1 leaves it.
    assert_eq!(with("178\t1\t3\t", "178\t1\t-2\t").speeds, [None, None]);
    assert_eq!(with("178\t1\t3\t", "178\t0\t4.5\t").speeds, [Some(4.5), Some(4.5)]);
    assert!(with("178\t1\t3\t", "178\t2\t3\t").uncertain[0].words.contains("climbs"));
    // Above sea level: 180 m is home's.
    let amsl = with(
        "3\t0\t3\t16\t0\t1\t0\t0\t38.03364000\t-78.50784000\t6",
        "3\t0\t0\t16\t0\t1\t0\t0\t38.03364000\t-78.50784000\t186",
    );
    assert!((amsl.waypoints[1].z - 6.0).abs() < 1e-4, "{}", amsl.waypoints[1]);
    // Landing elsewhere is flown to at the altitude before it.
    let lands = with("21\t0\t0\t0\t0\t38.03368000", "21\t0\t0\t0\t0\t38.03375000");
    assert_eq!(lands.waypoints.len(), 4);
    assert!(
        (lands.waypoints[3].z - 8.0).abs() < 1e-3 && lands.notes.iter().any(|note| note.contains("lands elsewhere"))
    );
    // What comes after the way home is not followed.
    let ended = |to: &str| with("5\t0\t3\t21\t", to);
    assert!(ended("5\t0\t3\t20\t").uncertain.is_empty());
    let more = WPL.replacen("3\t0\t3\t16\t", "3\t0\t3\t17\t", 1);
    let error = mission(&more, "a.waypoints", false).unwrap();
    assert_eq!((error.waypoints.len(), error.uncertain.len(), error.uncertain[0].waypoint), (2, 2, 1));
}

#[test]
fn speeds_that_wait_or_are_relative_and_places_passed_beside_are_not_followed() {
    let open = |from: &str, to: &str| {
        assert!(PLAN.contains(from), "{from}");
        mission(&PLAN.replacen(from, to, 1), "a.plan", false).unwrap().uncertain
    };
    let speed = "{ \"type\": \"SimpleItem\", \"command\": 178,";
    let waits = |command: u64| {
        let item = "\"frame\": 2, \"autoContinue\": true, \"params\": [5, 0, 0, 0, 0, 0, 0] },";
        open(speed, &format!("{{ \"type\": \"SimpleItem\", \"command\": {command}, {item} {speed}"))
    };
    for command in [112, 114, 115] {
        let found = waits(command);
        assert!(found.len() == 1 && found[0].words.contains("the condition of item 2"), "{command}: {found:?}");
    }
    // What is not motion may wait; and the next place ends it.
    assert!(waits(203).is_empty() && open("\"command\": 203", "\"command\": 112").is_empty());
    assert!(open("[1, 3, -1, 0, 0,", "[1, 3, -1, 1, 0,")[0].words.contains("relative to the one before"));
    let beside = open("[0, 1, 0, null, 38.03364", "[0, 1, -4, null, 38.03364");
    assert!(beside[0].waypoint == 1 && beside[0].words.contains("passes 4 m beside its place"), "{beside:?}");
    let error = mission(&PLAN.replacen("[1, 3, -1, 0, 0,", "[1, 3, -1, 2, 0,", 1), "a.plan", false).unwrap_err();
    assert!(error.contains("params[3] of command 178: 2, must be 0"), "{error}");
}

#[test]
fn radii_and_whose_it_is_are_kept() {
    let read = mission(PLAN, "a.plan", false).unwrap();
    assert_eq!(read.accept, [None, Some(1.0), Some(1.0)]);
    assert_eq!((read.whose.firmware, read.whose.vehicle), (Some(12), Some(2)));
    let list = mission(WPL, "a.waypoints", false).unwrap();
    assert_eq!((list.accept, list.whose), (read.accept, super::Whose::default()));
}

#[test]
fn what_a_plan_says_beyond_its_keys_is_told() {
    let read = |from: &str, to: &str| {
        assert!(PLAN.contains(from), "{from}");
        mission(&PLAN.replacen(from, to, 1), "a.plan", false).unwrap()
    };
    let beyond = |from: &str, to: &str| {
        let of = |note: &String| note.ends_with(" is no key of a plan: no loader reads it");
        read(from, to).notes.into_iter().filter(of).collect::<Vec<_>>()
    };
    assert!(beyond("\"geoFence\": {", "\"geoFence\": {").is_empty());
    let told = beyond("\"geoFence\": {", "\"geoFence\": { \"maxAltitude\": 5,");
    assert_eq!(told, ["geoFence.maxAltitude is no key of a plan: no loader reads it"]);
    let told = beyond("\"autoContinue\":", "\"maxSpeed\": 3, \"autoContinue\":");
    assert_eq!(told, ["mission.items[0].maxSpeed is no key of a plan: no loader reads it"]);
    // A throttle in place of a speed is sent.
    let open = read("[1, 3, -1", "[1, -1, 40").uncertain;
    assert!(open.len() == 1 && open[0].words.ends_with("sets a throttle of 40 %, which is not followed"), "{open:?}");
}

#[test]
fn a_fence_without_an_area_is_refused() {
    let flat = PLAN.replacen("[38.0339, -78.5076], [38.0339, -78.5082]", "[38.0334, -78.5079], [38.0334, -78.5078]", 1);
    assert!(flat != PLAN);
    let error = mission(&flat, "a.plan", false).unwrap_err();
    assert!(error.contains("fence 0 of its geoFence") && error.contains("lie in a line"), "{error}");
}

#[test]
fn columns_that_nobody_reads_are_named() {
    let text = "x_m,y_m,z_m,speed_m_s,Name,hold_s\n1,2,3,4,a,5\n4,5,6,7,b,8\n";
    let read = mission(text, "a.csv", false).unwrap();
    assert_eq!(read.notes, ["columns that are not read: Name"]);
    // Who asks for a speed does not mean any.
    let [open] = &read.uncertain[..] else { panic!("{:?}", read.uncertain) };
    assert_eq!((open.waypoint, open.words.as_str()), (0, "columns that are not followed: speed_m_s, hold_s"));
    let plain = mission("x_m,y_m,z_m\n1,2,3\n4,5,6\n", "a.csv", false).unwrap();
    assert!(plain.notes.is_empty() && plain.uncertain.is_empty());
}

#[test]
fn what_no_loader_takes_is_placed() {
    let told = |from: &str, to: &str| {
        assert!(PLAN.contains(from), "{from}");
        mission(&PLAN.replacen(from, to, 1), "a.plan", false).unwrap_err()
    };
    for (from, to, words) in [
        ("\"Plan\"", "\"plan\"", "/a.plan, fileType: \"plan\", must be \"Plan\""),
        ("\"version\": 1,\n  \"ground", "\"version\": 2,\n  \"ground", "/a.plan, version: 2, must be 1"),
        ("\"groundStation\": \"QGroundControl\",", "", "groundStation: nothing, must be given"),
        ("\"rallyPoints\"", "\"rally\"", "rallyPoints: nothing, must be given, as QGroundControl's loader demands"),
        ("\"circles\": [],", "", "geoFence.circles: nothing"),
        ("\"firmwareType\": 12,", "", "mission.firmwareType: nothing"),
        (
            "-78.5079772, 180]",
            "-78.5079772]",
            "mission.plannedHomePosition: [38.033553,-78.5079772], must be [latitude",
        ),
        ("\"autoContinue\": true", "\"autoContinue\": 1", "mission.items[0].autoContinue: 1, must be true or false"),
        ("\"frame\": 3", "\"frame\": 4", "mission.items[0].frame: 4 (local, east north up), must be 0"),
        ("\"frame\": 2", "\"frame\": 77", "mission.items[1].frame: 77, must be 0"),
        (
            "[0, 0, 0, null, 38.03360000",
            "[\"a\", 0, 0, null, 38.03360000",
            "mission.items[0].params[0]: \"a\", must be a number or null",
        ),
        (
            "[0, 0, 0, null, 38.03360000",
            "[0, 0, null, 38.03360000",
            "mission.items[0].params: 6 values, must be exactly 7",
        ),
        (
            "[0, 1, 0, null, 38.03364000",
            "[0, 1, 0, null, 98.03364000",
            "params[4] of command 16: 98.03364, must be a latitude",
        ),
        (
            "[0, 1, 0, null, 38.03364000, -78.50784000",
            "[0, 1, 0, null, 38.03364000, null",
            "params[5] of command 16: null",
        ),
        ("[0, 1, 0, null, 38.03364000", "[-1, 1, 0, null, 38.03364000", "params[0] of command 16: -1, must be a time"),
        ("[1, 3, -1, 0, 0, 0, 0]", "[1, -3, -1, 0, 0, 0, 0]", "params[1] of command 178: -3, must be a speed"),
        ("38.03368000, -78.50790000, 8]", "38.03364000, -78.50784000, 6]", "Altitude: 8, must be params[6], 6"),
        ("\"command\": 203", "\"command\": 177", "mission.items[3].command: 177 (jump), must be no jump"),
        (
            "\"polygon\": [[38.0334, -78.5082], ",
            "\"polygon\": [[38.0334], ",
            "geoFence.polygons[0].polygon[0]: [38.0334]",
        ),
    ] {
        let error = told(from, to);
        assert!(error.contains(words), "{from} -> {to}: {error}");
    }
    let cut = mission(&PLAN[..PLAN.len() / 2], "a.plan", false).unwrap_err();
    assert!(cut.contains("line ") && cut.contains("column "), "{cut}");
    let deep = mission(&"[".repeat(100_000), "a.plan", false).unwrap_err();
    assert!(deep.contains("recursion"), "{deep}");
    let far = mission(&PLAN.replacen("38.03364000", "39.03364000", 1), "a.plan", false).unwrap_err();
    assert!(far.contains("item 3: 111.") && far.contains("20 at most"), "{far}");
    // One place alone is no trajectory.
    let one = WPL.lines().take(3).collect::<Vec<_>>().join("\n");
    assert!(mission(&one, "a.waypoints", false).unwrap_err().contains("1 waypoints, must be at least 2"));
}

#[test]
fn a_wait_at_the_place_of_a_waypoint_is_its_hold() {
    let (head, tail) = WPL.split_once("\n4\t").unwrap();
    let again = head.lines().last().unwrap();
    let twice = |command: &str| {
        let again = again.replacen("3\t0\t3\t16\t0\t", command, 1);
        mission(&format!("{head}\n{again}\n5\t{}", tail.replacen("\n5\t", "\n6\t", 1)), "a.waypoints", false)
    };
    let plain = mission(WPL, "a.waypoints", false).unwrap();
    let waits = twice("4\t0\t3\t19\t7\t").unwrap();
    assert_eq!((&waits.waypoints, waits.stops[0].hold_s), (&plain.waypoints, 7.0));
    assert!(waits.notes.iter().any(|note| note == "item 4 is the place of item 3 again: it is held there"));
    // Without a hold nobody knows whether it comes to rest.
    let again = twice("4\t0\t3\t16\t0\t").unwrap();
    assert!(again.waypoints == plain.waypoints && again.stops.is_empty());
    let words = &again.uncertain[0].words;
    assert!(words.starts_with("item 4 is the place of item 3 again, without a hold"), "{words}");
}

#[test]
fn lists_of_items_are_exact() {
    for (from, to, words) in [
        ("QGC WPL 110\n", "QGC WPL 110 \n", "line 1: `QGC WPL 110 `"),
        ("QGC WPL 110\n", "\u{feff}QGC WPL 110\n", "line 1: `\\u{feff}QGC WPL 110`"),
        ("0\t1\t0\t16", "1\t1\t0\t16", "line 2, field 1 (index): `1`, must be 0, the home"),
        ("0\t1\t0\t16", "0\t1\t3\t16", "line 2, field 3 (frame): `3`, must be 0"),
        ("1\t0\t3\t22", "7\t0\t3\t22", "line 3, field 1 (index): `7`, must be 1: rows are counted from 0"),
        ("1\t0\t3\t22", "1\t2\t3\t22", "line 3, field 2 (current): `2`, must be 0 or 1"),
        ("3\t0\t3\t16\t0\t", "3\t0\t3\t16\t0 \t", "line 5, field 5 (param1): `0 `, must be a number"),
        ("3\t0\t3\t16\t0\t", "3\t0\t3\t16\tinf\t", "line 5, field 5 (param1): `inf`, must be a finite number"),
        ("3\t0\t3\t16\t0\t", "3\t0\t3\t16\t0\t0\t", "line 5: 13 fields, must be 12 fields between single tabs"),
        ("\n1\t0", "\n\n1\t0", "line 3: ``, must be no blank line"),
    ] {
        assert!(WPL.contains(from), "{from}");
        let error = mission(&WPL.replacen(from, to, 1), "a.waypoints", false).unwrap_err();
        assert!(error.contains(words), "{from:?} -> {to:?}: {error}");
    }
    assert!(
        mission(&format!("{WPL}\n"), "a.waypoints", false).unwrap_err().contains("line 8: ``, must be no blank line")
    );
    assert!(mission(&WPL[..WPL.len() - 1], "a.waypoints", false).is_ok());
}

#[test]
fn a_folder_has_missions_of_all_formats() {
    let place = tempfile::tempdir().expect("a folder of our own");
    let write = |name: &str, text: &str| std::fs::write(place.path().join(name), text).expect("a file of our own");
    write("b.plan", PLAN);
    write("b.waypoints", WPL);
    write("a.csv", "x_m,y_m,z_m\n1,2,3\n4,5,6\n");
    write("c.txt", WPL);
    write("notes.txt", "of the pilot");
    let names = |path: &Path| {
        let all = read_all(path, &scenario(false), FARTHEST_M).unwrap();
        all.into_iter().map(|mission| mission.name).collect::<Vec<_>>()
    };
    assert_eq!(names(place.path()), ["a", "b.plan", "b.waypoints", "c"]);
    assert_eq!(names(&place.path().join("b.plan")), ["b"]);
    // What a table has beside places is not followed, and that is told.
    write("a.csv", "x_m,y_m,z_m,name\n1,2,3,4\n4,5,6,4\n");
    let told = read(&place.path().join("a.csv"), &scenario(false), FARTHEST_M).unwrap().notes;
    assert_eq!(told, ["columns that are not read: name"]);
    // What is not there could be one.
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink("gone.txt", place.path().join("d.txt")).expect("a link of our own");
        let refused = read_all(place.path(), &scenario(false), FARTHEST_M).unwrap_err().to_string();
        assert!(refused.contains("d.txt"), "{refused}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn spoiled_files_are_answers(at in 0.0..1.0, byte in any::<u8>(), cut in 0.0..1.0, cuts in any::<bool>()) {
        for text in [PLAN, WPL] {
            let mut bytes = text.as_bytes().to_vec();
            let place = (at * bytes.len() as f64) as usize;
            bytes[place] = byte;
            if cuts {
                bytes.truncate((cut * bytes.len() as f64) as usize);
            }
            let text = String::from_utf8_lossy(&bytes);
            drop((read_plan::parse(&text), read_wpl::parse(&text)));
        }
    }
}

/// What `export` made of a mission for autopilots is that mission once more, and a user's own of the same name is not.
#[test]
fn what_export_wrote_of_one_mission_is_read_once() {
    let place = tempfile::tempdir().expect("a folder of our own");
    let export = place.path().join("export");
    std::fs::create_dir(&export).expect("a folder of our own");
    let write = |name: &str, text: &str| std::fs::write(export.join(name), text).expect("a file of our own");
    write("0000.csv", "x_m,y_m,z_m\n0,0,5\n9,0,5\n");
    for name in ["0000.plan", "0000_slow.plan", "0001.plan"] {
        write(name, PLAN);
    }
    write("0001.waypoints", WPL);
    let read = || -> Vec<String> {
        let all = read_all(&export, &scenario(false), FARTHEST_M).expect("missions");
        all.into_iter().map(|mission| mission.name).collect()
    };
    assert_eq!(read().len(), 5, "nothing says that they are ours: {:?}", read());
    let list = "export/CASE.csv\nexport/CASE.plan\nexport/CASE_slow.plan\nexport/CASE.waypoints\n";
    std::fs::write(place.path().join(".hairpin"), list).expect("a file of our own");
    assert_eq!(read(), ["0000", "0001"]);
}
