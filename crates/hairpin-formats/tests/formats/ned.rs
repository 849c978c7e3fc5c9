//! Files in north, east, down: where on Earth their poses come to, and what is refused of them.

use hairpin::campaign::Scenario;
use hairpin::campaign::scenario::{DriveScenario, Origin};
use hairpin_formats::frames::Cage;
use hairpin_formats::geodetic;
use hairpin_formats::home::Home;
use hairpin_formats::placement::Placement;
use hairpin_formats::scenario::{Report, setup_for};
use nalgebra::Point3;

fn flat(world: &str, start: &str, sets: &[(&str, &str)]) -> Result<Scenario, Report> {
    let world = format!("{{ terrain = {{ generator = \"flat\", size_m = 60, cell_m = 0.5 }}, {world} }}");
    let given = [("world", world.as_str()), ("task.start", start)];
    let sets: Vec<_> = given.iter().chain(sets).map(|(key, value)| (key.to_string(), value.to_string())).collect();
    setup_for("rover", &sets).map(|setup| setup.scenario)
}

fn origin(heading: f64) -> String {
    format!("origin = {{ lat_deg = 47.4, lon_deg = 8.5, alt_amsl_m = 488.0, x_axis_heading_deg = {heading:?} }}")
}

fn drive(scenario: &Scenario) -> &DriveScenario {
    scenario.own::<DriveScenario>().expect("a scenario of drives")
}

/// The start's row of `geodetic.csv`, and its heading, ° from north, clockwise.
fn exported(scenario: &Scenario) -> (Vec<f64>, f64) {
    let world = Placement::of(scenario).unwrap().unwrap();
    let start = drive(scenario).task.start;
    let point = Point3::new(start.x_m, start.y_m, 0.0);
    let text = geodetic::text(&world, &[point]).unwrap();
    let row = text.lines().nth(1).unwrap().split(',').map(|cell| cell.parse().unwrap()).collect();
    let heading = Home::new(&world, &point).unwrap().heading(start.yaw_deg.to_radians());
    (row, heading.to_degrees())
}

/// `a` ≡ `b`, °.
fn same_angle(a: f64, b: f64) -> bool {
    let apart = (a - b).rem_euclid(360.0);
    apart.min(360.0 - apart) < 1e-3
}

/// 40 m north and 20 m east of the origin with the nose 10° east of north: north 40 cos h − 20 sin h, east
/// 40 sin h + 20 cos h, heading h + 10° where the file's x heads h.
#[test]
fn poses_lie_on_earth_where_the_file_says() {
    let start = "{ x_m = 40.0, y_m = 20.0, yaw_deg = 10.0, curvature_1_m = 0.1 }";
    for heading in [0.0, 73.5, 270.0, 300.0, 360.0] {
        let ned = flat(&format!("frame = \"ned\", {}", origin(heading)), start, &[]).unwrap();
        let (row, yaw) = exported(&ned);
        let (sin, cos) = f64::to_radians(heading).sin_cos();
        let (north, east) = (40.0 * cos - 20.0 * sin, 40.0 * sin + 20.0 * cos);
        let enu = Cage::new(&Origin { lat_deg: 47.4, lon_deg: 8.5, alt_amsl_m: 488.0, x_axis_heading_deg: 90.0 });
        let place = enu.geodetic(&Point3::new(east, north, 0.0));
        assert!((row[0] - place.lat_deg).abs() < 1e-9 && (row[1] - place.lon_deg).abs() < 1e-9, "{heading}: {row:?}");
        assert!(same_angle(yaw, heading + 10.0), "{heading}: {yaw}");
        let resolved = drive(&ned).world.origin.unwrap().x_axis_heading_deg;
        assert!(same_angle(resolved, heading + 90.0) && (0.0..=360.0).contains(&resolved), "{heading}: {resolved}");
        // Resolved it is in enu, and its twin there has the axes of that.
        let twin = "{ x_m = 20.0, y_m = 40.0, yaw_deg = 80.0, curvature_1_m = -0.1 }";
        let twin = flat(&origin(resolved), twin, &[]).unwrap();
        let (of_twin, twins_yaw) = exported(&twin);
        assert!(of_twin == row && same_angle(twins_yaw, yaw), "{heading}: {of_twin:?} {row:?}");
        assert_eq!(drive(&twin).task.start.curvature_1_m, drive(&ned).task.start.curvature_1_m);
    }
}

#[test]
fn what_is_wrong_in_them_is_told_as_they_have_it() {
    let start = "{ x_m = 40.0, y_m = 20.0 }";
    for heading in [-10.0, 370.0] {
        let told = flat(&format!("frame = \"ned\", {}", origin(heading)), start, &[]).unwrap_err().to_string();
        assert!(told.contains("x_axis_heading_deg") && told.contains(&format!("{heading}")), "{told}");
    }
    let rock = "frame = \"ned\", keep_out = [{ circle = { center_m = [10.0, 12.0], radius_m = 0.5 } }]";
    let vary = |key: &str, low: &str, high: &str| format!("{{ \"{key}\" = {{ uniform = [{low}, {high}] }} }}");
    for key in ["task.start.x_m", "task.start.yaw_deg", "task.start.curvature_1_m"] {
        let told = flat(rock, start, &[("vary", &vary(key, "0.0", "0.1"))]).unwrap_err().to_string();
        assert!(told.contains(key) && told.contains("enu"), "{told}");
    }
    let center = vary("world.keep_out[0].circle.center_m", "[10.0, 12.0]", "[10.0, 13.0]");
    assert!(flat(rock, start, &[("vary", &center)]).unwrap_err().to_string().contains("keep_out"));
    // What has no axes may be drawn.
    for key in ["world.keep_out[0].circle.radius_m", "execute.latency_s"] {
        let read = flat(rock, start, &[("vary", &vary(key, "0.1", "0.5"))]);
        assert!(read.is_ok(), "{key}: {}", read.unwrap_err());
    }
}
