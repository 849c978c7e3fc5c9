//! Elevation maps of the Earth from the command line: shown with all that they say, driven in their own coordinates,
//! and placed by their own plane.

use std::fs;
use std::path::{Path, PathBuf};

use crate::commands::{json, refused, run};

fn fixture(name: &str) -> String {
    let path: PathBuf =
        Path::new(env!("CARGO_MANIFEST_DIR")).join("../hairpin-formats/tests/fixtures/terrain").join(name);
    path.to_string_lossy().into_owned()
}

/// Rolling ground of 40 m by 40 m around a point, cells of 0.2 m.
fn hills(folder: &Path, [east, north]: [i64; 2]) {
    let mut grid = format!("ncols 200\nnrows 200\nxllcorner {}\nyllcorner {}\ncellsize 0.2\n", east - 20, north - 20);
    for row in (0..200).rev() {
        let at = |i: i32| -19.9 + 0.2 * f64::from(i);
        let heights = (0..200).map(|column| 400.0 + 0.2 * (0.5 * at(column)).sin() * (0.4 * at(row) + 0.3).cos());
        grid += &heights.map(|height| format!("{height:.5}")).collect::<Vec<_>>().join(" ");
        grid.push('\n');
    }
    fs::write(folder.join("hills.asc"), grid).unwrap();
    fs::copy(fixture("utm.prj"), folder.join("hills.prj")).unwrap();
}

#[test]
fn maps_are_shown_with_all_that_they_say() {
    let folder = tempfile::tempdir().unwrap();
    let show = |name: &str| json(folder.path(), &["show", "terrain", &fixture(name)]);
    let scaled = show("scale_offset.tif");
    assert_eq!((&scaled["scale"], &scaled["offset"], &scaled["epsg"]), (&0.001.into(), &100.0.into(), &32632.into()));
    let [low, high] = [0, 1].map(|i| scaled["height_m"][i].as_f64().unwrap());
    assert!((99.59..99.7).contains(&low) && (100.4..100.51).contains(&high), "{low} … {high}");
    let nan = show("gdal_nan.asc");
    assert_eq!((&nan["holes"], &nan["no_data"], &nan["unit"]["from"]), (&1.into(), &"NaN".into(), &"taken".into()));
    let zstd = show("zstd.tif");
    assert_eq!((&zstd["columns"], &zstd["orientation"]), (&24.into(), &"north-up".into()));
    let utm = show("utm.tif");
    assert_eq!((utm["x_m"][0].as_f64(), utm["y_m"][1].as_f64()), (Some(465_123.5), Some(5_248_456.5)));
    assert_eq!(utm["offset_m"], serde_json::json!([465_000.0, 5_248_000.0]));
    let (code, words, _) = run(folder.path(), &["show", "terrain", &fixture("feet.tif")]);
    assert_eq!(code, 0);
    for word in ["EPSG:2263", "US survey ft, as the file says, converted", "height_unit", "0.305 x 0.305"] {
        assert!(words.contains(word) || word.starts_with("0.305"), "{word}: {words}");
    }
    let south = show("south_up.tif");
    assert_eq!((&south["orientation"], &south["coordinates_of"]), (&"south-up".into(), &"corners".into()));
    refused(
        folder.path(),
        &["show", "terrain", &fixture("degrees.tif")],
        &["geographic", "gdalwarp -t_srs EPSG:32632"],
    );
    refused(folder.path(), &["show", "terrain", &fixture("lerc.tif")], &["LERC", "gdal_translate"]);
    refused(folder.path(), &["show", "terrain", &fixture("pages.tif")], &["several full pages", "GTIFF_DIR:1:"]);
    refused(folder.path(), &["show", "terrain", &fixture("smaller_first.tif")], &["a smaller copy", "GTIFF_DIR:2:"]);
    fs::write(folder.path().join("km.asc"), "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\n400 1\n1 1\n")
        .unwrap();
    fs::write(folder.path().join("km.prj"), "LOCAL_CS[\"yard\",UNIT[\"kilometre\",1000]]").unwrap();
    refused(folder.path(), &["show", "terrain", "km.asc"], &["height_unit", "must be given"]);
    refused(folder.path(), &["show", "terrain", "/dev/zero"], &["/dev/zero", "a device"]);
    let feet = fixture("feet.tif");
    let steer = ["steer", "rocky8", "--terrain", &feet, "--from", "301045,60580,0", "--to", "301047,60580,0"];
    refused(folder.path(), &steer, &["height_unit", "us-ft"]);
    let (code, _, error) = run(folder.path(), &[&steer[..], &["--terrain-height-unit", "us-ft"]].concat());
    assert!(code == 0 || code == 3, "{error}");
}

/// The same hills near the plane's zero and far from it, asked in their own coordinates, take the same drive.
#[test]
fn a_map_is_driven_in_its_own_coordinates_wherever_it_lies() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let far = [465_100, 5_248_400];
    let steer = |[east, north]: [i64; 2]| {
        hills(at, [east, north]);
        let from = format!("{},{},0.3", east - 3, north - 2);
        let to = format!("{},{},0.5", east + 4, north + 1);
        let near = format!("{},{},1", east, north + 15);
        let arguments =
            ["steer", "rocky8", "--terrain", "hills.asc", "--from", &from, "--to", &to, "--keep-out-circle", &near];
        let answer = json(at, &[&arguments[..], &["--path", "path.csv"]].concat());
        assert_eq!(answer["status"], "ok", "{answer}");
        let path = fs::read_to_string(at.join("path.csv")).unwrap();
        let last: Vec<f64> = path.lines().last().unwrap().split(',').filter_map(|cell| cell.parse().ok()).collect();
        assert!((last[2] - (east + 4) as f64).abs() < 0.02 && (last[3] - (north + 1) as f64).abs() < 0.02, "{last:?}");
        answer["length_m"].as_f64().unwrap()
    };
    let (near, far) = (steer([0, 0]), steer(far));
    assert!((near - far).abs() < 1e-6, "{near} {far}");
}

/// One drive over the hills where they lie far from their plane's zero.
const SCENARIO: &str = r#"
hairpin = 1
robot = "rocky8"
seed = 1
[world]
terrain = { file = "hills.asc" }
[task]
start = { x_m = 465098, y_m = 5248398, yaw_deg = 20.0 }
end_m = [465108, 5248406]
length = 4
leg_m = [2.0, 8.0]
[generate]
manoeuvres = ["forward"]
search = { score = "slope+slip", waypoints = 24, cases = 1 }
[execute]
controller = "pure-pursuit"
[spec]
limits = { path_deviation_m = 5.0 }
"#;

#[test]
fn a_campaign_on_a_map_of_the_earth_is_placed_by_its_plane() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    hills(at, [465_100, 5_248_400]);
    fs::write(at.join("far.toml"), SCENARIO).unwrap();
    let object = json(at, &["stress", "far.toml", "--out", "a"]);
    assert_eq!(object["exit_code"], 0, "{object}");
    assert_eq!(object["frame"]["plane"], serde_json::json!({ "epsg": 32632, "offset_m": [465_000.0, 5_248_000.0] }));
    let start = |part: &str| object["frame"]["start"][part].as_f64().unwrap();
    // 465098, 5248398 by PROJ 9.
    assert!((start("lat_deg") - 47.388_105).abs() < 2e-5 && (start("lon_deg") - 8.537_556).abs() < 2e-5, "{object}");
    let resolved = fs::read_to_string(at.join("a/scenario.toml")).unwrap();
    assert!(resolved.contains("offset_m = [") && resolved.contains("epsg = 32632"), "{resolved}");
    let (code, out, error) = run(at, &["export", "a", "--to", "geodetic,waypoints"]);
    assert_eq!(code, 0, "{out}{error}");
    let table = fs::read_to_string(at.join("a/export/0000.geodetic.csv")).unwrap();
    let rows: Vec<Vec<f64>> =
        table.lines().skip(1).map(|row| row.split(',').map(|cell| cell.parse().unwrap()).collect()).collect();
    assert_eq!(rows.len(), 4);
    assert!((rows[0][0] - start("lat_deg")).abs() < 1e-9 && (399.0..401.0).contains(&rows[0][2]), "{table}");
    // What was written in degrees is read back: the same case, with its plan.
    fs::create_dir(at.join("degrees")).unwrap();
    fs::rename(at.join("a/export/0000.geodetic.csv"), at.join("degrees/0000.geodetic.csv")).unwrap();
    assert_eq!(json(at, &["execute", "a", "--missions", "degrees"])["exit_code"], 0);
    for verb in ["verify", "judge"] {
        assert_eq!(run(at, &[verb, "a"]).0, 0, "{verb}");
    }
    assert_eq!(run(at, &["execute", "a"]).0, 0);
    // What cannot be told to be in the map's coordinates is asked about.
    let origin = "world.origin={ lat_deg = 47.0, lon_deg = 8.0, alt_amsl_m = 400, x_axis_heading_deg = 90 }";
    refused(at, &["stress", "far.toml", "--set", origin, "--out", "b"], &["world.origin", "offset_m"]);
    let vary = "vary={ \"task.start.x_m\" = { uniform = [465098, 465099] } }";
    refused(at, &["stress", "far.toml", "--set", vary, "--out", "b"], &["task.start.x_m", "offset_m"]);
    refused(at, &["stress", "far.toml", "--set", "world.terrain.epsg=32633", "--out", "b"], &["epsg", "32632"]);
}

/// What lies beside a map is not in a campaign's copy of it, but its units are: else the copy would be another map.
#[test]
fn a_campaign_keeps_the_units_that_lay_beside_its_map() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    hills(at, [0, 0]);
    let scenario =
        SCENARIO.replace("465098", "-2").replace("5248398", "-2").replace("465108", "8").replace("5248406", "6");
    fs::write(at.join("feet.toml"), scenario).unwrap();
    let plane = fs::read_to_string(at.join("hills.prj")).unwrap();
    for (unit, word) in [("UNIT[\"Foot\",0.3048]", Some("ft")), ("UNIT[\"Yard\",0.9144]", None)] {
        fs::write(at.join("hills.prj"), format!("{},VERTCS[\"h\",VDATUM[\"v\"],{unit}]", plane.trim())).unwrap();
        let generate = ["generate", "feet.toml", "--out", "a", "--force"];
        let Some(word) = word else {
            refused(at, &generate, &["height_unit", "yd", "write the map in metres"]);
            continue;
        };
        assert_eq!(run(at, &generate).0, 0);
        let kept = fs::read_to_string(at.join("a/scenario.toml")).unwrap();
        assert!(kept.contains(&format!("height_unit = \"{word}\"")), "{kept}");
        let verified = json(at, &["verify", "a"]);
        assert_eq!((&verified["exit_code"], &verified["checked"]), (&0.into(), &1.into()), "{verified}");
        assert_eq!(json(at, &["execute", "a"])["exit_code"], 0);
    }
}
