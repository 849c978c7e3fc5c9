use hairpin::campaign::scenario::Origin;
use nalgebra::Point3;
use serde_json::Value as Json;

use super::mission::{Autopilot, Mission, Step, Vehicle};
use super::parameters::{self, Parameter, Value};
use super::{plan, wpl};
use crate::frames::Geodetic;
use crate::placement::Placement;

fn cage() -> Placement {
    Placement::by_origin(&Origin { lat_deg: 47.3977, lon_deg: 8.5456, alt_amsl_m: 488.0, x_axis_heading_deg: 73.5 })
}

const WAYPOINTS: [[f64; 3]; 3] = [[3.0, 4.0, 5.0], [17.25, 12.125, 8.5], [0.5, 30.0, 2.0]];

fn mission() -> Mission {
    let at = |[x, y, z]: [f64; 3]| cage().geodetic(&Point3::new(x, y, z)).unwrap();
    let home = at([3.0, 4.0, 0.0]);
    let waypoint = |p: [f64; 3]| Step::Waypoint { place: at(p), accept: 0.75, yaw: Some(73.5) };
    let mut steps = vec![Step::TakeOff { place: at(WAYPOINTS[0]), yaw: Some(73.5) }];
    steps.extend([waypoint(WAYPOINTS[0]), Step::Speed(4.25), waypoint(WAYPOINTS[1]), waypoint(WAYPOINTS[2])]);
    steps.push(Step::Land { place: home, yaw: None });
    Mission {
        autopilot: Autopilot::Px4,
        vehicle: Vehicle::Multirotor,
        home,
        steps,
        fence: [[0.0, 0.0], [40.0, 0.0], [40.0, 40.0], [0.0, 40.0]].map(|[x, y]| at([x, y, 0.0])).to_vec(),
        speed: Some(4.25),
        note: vec![("way", "\"PX4\" plans\nits own way".into())],
    }
}

/// The waypoints that a file's items stand for, about its home, in the cage.
fn back(home: &[f64], items: &[[f64; 3]]) -> Vec<Point3<f64>> {
    let place = |[lat_deg, lon_deg, height]: &[f64; 3]| {
        cage().from_geodetic(&Geodetic { lat_deg: *lat_deg, lon_deg: *lon_deg, alt_amsl_m: home[2] + height }).unwrap()
    };
    items.iter().map(place).collect()
}

fn are_the_waypoints(found: &[Point3<f64>]) {
    assert_eq!(found.len(), WAYPOINTS.len());
    for (found, [x, y, z]) in found.iter().zip(WAYPOINTS) {
        assert!((found - Point3::new(x, y, z)).norm() < 1e-3, "{found}");
    }
}

fn numbers(value: &Json) -> Vec<f64> {
    value.as_array().unwrap().iter().map(|number| number.as_f64().unwrap()).collect()
}

#[test]
fn a_plan_has_all_that_its_loader_wants() {
    let text = plan::text(&mission());
    let file: Json = serde_json::from_str(&text).unwrap();
    assert_eq!((&file["fileType"], &file["version"]), (&"Plan".into(), &1.into()));
    assert_eq!(file["hairpin"]["way"], "\"PX4\" plans\nits own way");
    let of = &file["mission"];
    assert_eq!((&of["version"], &of["firmwareType"], &of["vehicleType"]), (&2.into(), &12.into(), &2.into()));
    assert_eq!((&file["geoFence"]["version"], &file["rallyPoints"]["version"]), (&2.into(), &2.into()));
    assert_eq!(file["geoFence"]["polygons"][0]["polygon"].as_array().unwrap().len(), 4);
    let items = of["items"].as_array().unwrap();
    let commands: Vec<u64> = items.iter().map(|item| item["command"].as_u64().unwrap()).collect();
    assert_eq!(commands, [22, 16, 178, 16, 16, 21]);
    for (index, item) in items.iter().enumerate() {
        assert_eq!((&item["type"], &item["autoContinue"]), (&"SimpleItem".into(), &true.into()));
        assert_eq!(item["doJumpId"], index + 1);
        let params = item["params"].as_array().unwrap();
        assert!(params.len() == 7 && params.iter().all(|value| value.is_null() || value.is_number()));
        let keys = ["AltitudeMode", "Altitude", "AMSLAltAboveTerrain"].map(|key| item.get(key).is_some());
        assert!(keys == [true; 3] || keys == [false; 3]);
        assert_eq!(item["frame"], if item["command"] == 178 { 2 } else { 3 });
    }
    assert_eq!((&items[1]["params"][0], &items[1]["params"][1]), (&0.0.into(), &0.75.into()));
    assert!(items[5]["params"][3].is_null() && items[2]["params"][1] == 4.25);
    let home = numbers(&of["plannedHomePosition"]);
    let places = items.iter().filter(|item| item["command"] == 16);
    let places: Vec<[f64; 3]> = places.map(|item| [4, 5, 6].map(|i| item["params"][i].as_f64().unwrap())).collect();
    are_the_waypoints(&back(&home, &places));
    // Degrees have eight decimals or more.
    let degrees: Vec<&str> =
        text.split(['[', ',', ' ', ']']).filter(|word| word.starts_with("47.") || word.starts_with("8.54")).collect();
    assert!(degrees.len() > 15 && degrees.iter().all(|word| word.split('.').nth(1).unwrap().len() >= 8), "{degrees:?}");
}

#[test]
fn what_is_not_known_is_left_to_the_ground_station() {
    let bare = Mission {
        speed: None,
        fence: Vec::new(),
        vehicle: Vehicle::Ground,
        autopilot: Autopilot::ArduPilot,
        ..mission()
    };
    let file: Json = serde_json::from_str(&plan::text(&bare)).unwrap();
    assert!(file["mission"].get("cruiseSpeed").is_none());
    assert_eq!(file["geoFence"]["polygons"].as_array().unwrap().len(), 0);
    assert_eq!((&file["mission"]["firmwareType"], &file["mission"]["vehicleType"]), (&3.into(), &10.into()));
}

#[test]
fn a_waypoint_file_is_twelve_fields_a_row_and_begins_at_home() {
    let text = wpl::text(&mission());
    assert!(text.ends_with("\t1\n") && !text.contains('\r') && !text.contains("\n\n"));
    let mut lines = text.lines();
    assert_eq!(lines.next(), Some("QGC WPL 110"));
    let rows: Vec<Vec<f64>> =
        lines.map(|line| line.split('\t').map(|field| field.parse().unwrap()).collect()).collect();
    assert!(rows.iter().enumerate().all(|(index, row)| row.len() == 12 && row[0] == index as f64));
    assert!(rows[0].starts_with(&[0.0, 1.0, 0.0, 16.0]) && rows[1..].iter().all(|row| row[1] == 0.0));
    assert_eq!(rows[1..].iter().map(|row| row[3]).collect::<Vec<_>>(), [22.0, 16.0, 178.0, 16.0, 16.0, 21.0]);
    assert_eq!((rows[2][5], rows[3][5]), (0.75, 4.25));
    let places: Vec<[f64; 3]> =
        rows[1..].iter().filter(|row| row[3] == 16.0).map(|row| [row[8], row[9], row[10]]).collect();
    are_the_waypoints(&back(&rows[0][8..11], &places));
}

#[test]
fn parameters_are_rows_of_five() {
    let height = Parameter { name: "GF_MAX_VER_DIST", value: Value::Real(8.0), why: "a\nb".into() };
    let action = Parameter { name: "GF_ACTION", value: Value::Whole(2), why: "c".into() };
    let text = parameters::text(&["way: x\n1\t1\tY\t3\t9".into()], &[height, action]);
    let rows: Vec<&str> = text.lines().filter(|line| !line.starts_with('#')).collect();
    assert_eq!(rows, ["1\t1\tGF_MAX_VER_DIST\t8.000\t9", "1\t1\tGF_ACTION\t2\t6"]);
}
