//! JUnit, TUM, CSV and waypoint files as other programs read them.

use std::fs;

use crate::out_campaign::{campaign, executor_failed, failed, passed, planned};
use hairpin::campaign::bounds::FARTHEST_M;
use hairpin_formats::placement::Placement;
use hairpin_formats::scenario::setup_for;
use hairpin_formats::{csv, geodetic, junit, missions, tum, waypoints};
use nalgebra::Point3;

fn suite() -> junit::Suite {
    junit::Suite {
        name: "anafi <cage>".into(),
        asked: 5,
        missing: "not found in 40 graphs".into(),
        inconclusive: None,
        properties: vec![("seed".into(), "10".into()), ("verdict".into(), "FAIL 1/5: worst 0.65 m > 0.50 m".into())],
        regressions: Default::default(),
        saved: Vec::new(),
        again: Default::default(),
    }
}

#[test]
fn what_is_worse_than_a_baseline_fails_within_spec() {
    let worse = vec!["p1→p2 +41 ms (band ±6 ms) against 7.14".to_owned()];
    let suite = junit::Suite { regressions: [(passed().case, worse)].into(), ..suite() };
    let text = junit::text(&suite, &[passed()]);
    assert!(text.contains("<failure message=\"p1→p2 +41 ms (band ±6 ms) against 7.14\" type=\"Regression\""), "{text}");
}

#[test]
fn junit_is_what_build_servers_take() {
    insta::assert_snapshot!(junit::text(&suite(), &[passed(), failed(), executor_failed()]));
}

#[test]
fn junit_has_one_test_per_case_asked_for() {
    let text = junit::text(&suite(), &[passed(), failed(), executor_failed()]);
    assert_eq!(text.matches("<testcase ").count(), 5);
    assert!(text.chars().all(|c| c == '\n' || !c.is_control()));
    assert_eq!(junit::text(&junit::Suite { asked: 3, ..suite() }, &[]).matches("<skipped").count(), 3);
    // Saved cases are tests of their own, beside as many as before.
    let saved = vec![("0117".to_owned(), passed()), ("mine-1".to_owned(), passed())];
    let text = junit::text(&junit::Suite { saved, ..suite() }, &[passed()]);
    let (own, others) = text.split_once("<testsuite name=\"saved cases\" tests=\"2\"").unwrap();
    assert!(
        others.contains("name=\"0117\"") && others.contains("name=\"mine-1\"") && !own.contains("mine-1"),
        "{text}"
    );
}

#[test]
fn tum_lines_are_eight_numbers_and_rise() {
    let case = &campaign().cases[0];
    let place = tempfile::tempdir().unwrap();
    let track = planned(case);
    tum::write_pair(place.path(), "0000", &track, &track).unwrap();
    let text = fs::read_to_string(place.path().join("0000.exec.tum")).unwrap();
    assert_eq!(text, fs::read_to_string(place.path().join("0000.ref.tum")).unwrap());
    let mut before = f64::NEG_INFINITY;
    for (line, (time, pose)) in text.lines().zip(track.times().iter().zip(track.poses())) {
        let numbers: Vec<f64> = line.split(' ').map(|number| number.parse().unwrap()).collect();
        let (p, q) = (pose.translation.vector, pose.rotation);
        assert_eq!(numbers, [*time, p.x, p.y, p.z, q.i, q.j, q.k, q.w]);
        assert!(numbers[0] > before);
        before = numbers[0];
    }
    assert_eq!(text.lines().count(), track.len());
}

#[test]
fn csv_has_its_header_first_and_t_first() {
    let track = planned(&campaign().cases[0]);
    let text = csv::text(&track);
    let header = "t,x_m,y_m,z_m,qw,qx,qy,qz,leg,vx_m_s,vy_m_s,vz_m_s,rotor1_rad_s,rotor2_rad_s,rotor3_rad_s,rotor4_rad_s,saturated";
    assert_eq!(text.lines().next(), Some(header));
    let row: Vec<f64> = text.lines().nth(18).unwrap().split(',').map(|cell| cell.parse().unwrap()).collect();
    assert_eq!((row.len(), row[0], row[1]), (17, track.times()[17], track.position(17).x));
}

#[test]
fn waypoints_come_back_and_mistakes_are_placed() {
    let place = tempfile::tempdir().unwrap();
    let path = place.path().join("0000.csv");
    let case = &campaign().cases[0];
    let scenario = &setup_for("demo-quadrotor", &[]).unwrap().scenario;
    waypoints::write(&path, &case.waypoints).unwrap();
    assert_eq!(waypoints::read(&path, scenario, FARTHEST_M).unwrap(), (case.waypoints.clone(), false));
    let [mission] = &missions::read_all(place.path(), scenario, FARTHEST_M).unwrap()[..] else { panic!("one mission") };
    assert_eq!((mission.name.as_str(), &mission.waypoints, mission.rounded), ("0000", &case.waypoints, false));

    let read = |text: &str| {
        fs::write(&path, text).unwrap();
        let read = waypoints::read(&path, scenario, FARTHEST_M).map(|(waypoints, _)| waypoints);
        read.map_err(|error| error.to_string().replace(&place.path().display().to_string(), ""))
    };
    let points = vec![Point3::new(1.0, 2.0, 3.0), Point3::new(4.0, 5.0, 6.5)];
    assert_eq!(read("\u{feff}z_m, x_m,note,y_m\r\n3,1,a,2\r\n\r\n6.5,4,b,5\r\n").unwrap(), points);
    for (text, message) in [
        (
            "x_m,y_m,z_m\n1,2,3\n4,5,six\n",
            "/0000.csv, line 3, column `z_m`: `six`, must be a finite number in m, 20000 at most either way",
        ),
        (
            "x_m,y_m,z_m\n1,2,3\n4,nan,6\n",
            "/0000.csv, line 3, column `y_m`: `nan`, must be a finite number in m, 20000 at most either way",
        ),
        ("x_m,y_m,z_m\n1,2,3\n4,5\n", "/0000.csv, line 3: 2 values, the header has 3"),
        (
            "x,y,z\n1,2,3\n",
            "/0000.csv, line 1: no column `x_m` in the header `x,y,z`; needed: x_m,y_m,z_m, or lat_deg,lon_deg,alt_amsl_m",
        ),
        ("", "/0000.csv, line 1: no column `x_m` in the header ``; needed: x_m,y_m,z_m, or lat_deg,lon_deg,alt_amsl_m"),
        (
            "{\"fileType\": \"Plan\", \"mission\": {}}",
            "/0000.csv: a ground station's mission, which `hairpin check` takes; here a table is needed: \
             x_m,y_m,z_m, or lat_deg,lon_deg,alt_amsl_m",
        ),
        ("x_m,y_m,z_m\n1,2,3\n", "/0000.csv: 1 waypoints, must be at least 2"),
        ("x_m,y_m,z_m\n1,2,3\n1,2,3\n", "/0000.csv, line 3: the waypoint of line 2 again"),
    ] {
        assert_eq!(read(text).unwrap_err(), message);
    }
    fs::remove_file(&path).unwrap();
    assert!(
        missions::read_all(place.path(), scenario, FARTHEST_M).unwrap_err().to_string().contains("no .csv file in it")
    );
}

#[test]
fn waypoints_in_degrees_come_back_within_their_rounding() {
    let place = tempfile::tempdir().unwrap();
    let case = &campaign().cases[0];
    let placed = |origin: &str| {
        let sets = [("world.origin".to_owned(), origin.to_owned())];
        setup_for("demo-quadrotor", &sets).unwrap().scenario.clone()
    };
    let scenario = placed("{ lat_deg = -47.3977, lon_deg = 179.9999, alt_amsl_m = 488.0, x_axis_heading_deg = 73.5 }");
    let world = Placement::of(&scenario).unwrap().unwrap();
    let text = geodetic::text(&world, &case.waypoints).unwrap();
    geodetic::write(&place.path().join("0000.geodetic.csv"), &text).unwrap();
    let [mission] = &missions::read_all(place.path(), &scenario, FARTHEST_M).unwrap()[..] else {
        panic!("one mission")
    };
    assert_eq!((mission.name.as_str(), mission.rounded, mission.waypoints.len()), ("0000", true, case.waypoints.len()));
    for (read, written) in mission.waypoints.iter().zip(&case.waypoints) {
        assert!((read - written).norm() < 2e-5, "{read} {written}");
    }
    // The same in metres goes first: nothing of it is rounded.
    waypoints::write(&place.path().join("0000.csv"), &case.waypoints).unwrap();
    let [mission] = &missions::read_all(place.path(), &scenario, FARTHEST_M).unwrap()[..] else {
        panic!("one mission")
    };
    assert_eq!((mission.rounded, &mission.waypoints), (false, &case.waypoints));
    let path = place.path().join("there.csv");
    let read = |text: &str, scenario: &_| {
        fs::write(&path, text).unwrap();
        waypoints::read(&path, scenario, FARTHEST_M)
            .unwrap_err()
            .to_string()
            .replace(&place.path().display().to_string(), "")
    };
    for (text, message) in [
        (
            "lat_deg,lon_deg,alt_amsl_m\n91,8,400\n",
            "/there.csv, line 2, column `lat_deg`: `91`, must be a latitude, from -90 to 90°",
        ),
        (
            "lat_deg,lon_deg,alt_amsl_m\n47,8,x\n",
            "/there.csv, line 2, column `alt_amsl_m`: `x`, must be an altitude within 20000 m of the sea",
        ),
        (
            "lat_deg,lon_deg,alt_m\n47,8,400\n",
            "/there.csv, line 1: no column `alt_amsl_m` in the header `lat_deg,lon_deg,alt_m`; needed: x_m,y_m,z_m, or lat_deg,lon_deg,alt_amsl_m",
        ),
    ] {
        assert_eq!(read(text, &scenario), message);
    }
    let far = read("lat_deg,lon_deg,alt_amsl_m\n47,8,400\n", &scenario);
    assert!(far.contains("line 2") && far.contains("km from the world's origin, 20 at most"), "{far}");
    let mut nowhere = scenario.clone();
    nowhere.put_section("world", serde_json::json!({ "size_m": [20.0, 20.0, 20.0] })).unwrap();
    let told = read("lat_deg,lon_deg,alt_amsl_m\n47,8,400\n", &nowhere);
    assert!(told.contains("in degrees") && told.contains("world.origin") && told.contains("epsg"), "{told}");
}
