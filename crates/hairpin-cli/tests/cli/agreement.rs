//! What one command writes every other one reads: random valid scenarios of each kind of robot, up to the ends of what
//! keys may have, through all commands. The seed of what fails is printed; `HAIRPIN_AGREEMENT_SEED` begins with
//! another.

use std::fs;
use std::path::Path;
use std::time::{Duration, Instant};

use crate::commands::{json, run};
use serde_json::Value;

/// Numbers that a seed draws, one after the other.
struct Draws {
    state: u64,
}

impl Draws {
    /// 0 … 1.
    fn unit(&mut self) -> f64 {
        // SplitMix64.
        self.state = self.state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut mixed = self.state;
        mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((mixed ^ (mixed >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Every order of magnitude is as likely.
    fn size(&mut self, least: f64, most: f64) -> f64 {
        let drawn = least * (most / least).powf(self.unit());
        (drawn * 1e6).round() / 1e6
    }

    fn between(&mut self, least: f64, most: f64) -> f64 {
        ((least + (most - least) * self.unit()) * 1e3).round() / 1e3
    }

    fn one<T: Copy>(&mut self, of: &[T]) -> T {
        of[(self.unit() * of.len() as f64) as usize]
    }
}

/// A cage from a room to ten kilometres; limits so narrow that most runs violate them, or none at all.
fn flight(draws: &mut Draws) -> String {
    let (robot, size) = (draws.one(&["flightgoggles", "anafi", "crazyflie"]), draws.size(8.0, 10_000.0));
    // Both ends a few metres apart, anywhere.
    let low = draws.between(0.3, 0.6) * size;
    let high = low + draws.between(1.0, 3.0);
    let reach = draws.one(&["witness", "witness", "none"]);
    let limit = draws.size(1e-3, 0.5);
    let timing = if reach == "witness" { "leg_time_s = [0.5, 50.0]" } else { "step_s = 1.0" };
    let controller = draws.one(&["minimum-snap", "geometric", "stable-waypoint"]);
    let spec = draws.one(&["[spec]\ndeviation = { max_m = LIMIT }", "[spec]\ndeviation = { max_m = LIMIT }", ""]);
    let none = if spec.is_empty() { "spec = \"none\"\n" } else { "" };
    let origin =
        draws.one(&["", "origin = { lat_deg = 47.5, lon_deg = 19.0, alt_amsl_m = 104, x_axis_heading_deg = 73.5 }\n"]);
    format!(
        "hairpin = 1\nrobot = \"{robot}\"\nseed = {}\n{none}[world]\nsize_m = [{size:?}, {size:?}, {size:?}]\n{origin}\
         [task]\nstart_m = [{low:?}, {low:?}, {low:?}]\nend_m = [{high:?}, {low:?}, {low:?}]\nlength = 2\n\
         [generate]\nreach = \"{reach}\"\ntiming = {{ {timing} }}\nsearch = {{ method = \"beam\", waypoints = 20, cases = 1, graphs = 6 }}\n\
         [execute]\ncontroller = \"{controller}\"\nrepeat = 1\ntime_limit_s = 60\n{}\n",
        (draws.unit() * 1e9) as u64,
        spec.replace("LIMIT", &format!("{limit:?}"))
    )
}

/// Flat ground of any size, vehicles from toys to trucks, as fast as they may be.
fn drive(draws: &mut Draws) -> String {
    let speed = draws.size(0.5, 100.0);
    let kind = draws.one(&["car", "differential-drive", "rover"]);
    // A vehicle is driven on a few of its own sizes.
    let scale = draws.size(0.2, 10.0);
    let robot = match kind {
        "car" => format!(
            "robot = {{ kind = \"car\", name = \"any car\", wheelbase_m = {scale:?}, speed_m_s = {speed:?}, limits = {{ steering_deg = 40, \
             steering_rate_deg_s = 9000, speed_m_s = {speed:?}, acceleration_m_s2 = 900 }} }}"
        ),
        "rover" => "robot = \"generic\"".to_owned(),
        _ => "robot = \"differential-drive\"".to_owned(),
    };
    let limits = match kind {
        "car" => format!("limits = {{ speed_m_s = {speed:?} }}"),
        _ => "limits = {}".to_owned(),
    };
    let turns =
        if kind == "car" { "[\"forward\"]" } else { draws.one(&["[\"forward\"]", "[\"forward\", \"reverse\"]"]) };
    let leg = if kind == "car" { 8.0 * scale } else { 4.0 };
    let size = 12.0 * leg * draws.one(&[1.0, 4.0]);
    let control = draws.one(&["stanley", "pure-pursuit"]);
    let profile = if kind == "rover" { "constant" } else { draws.one(&["constant", "trapezoid"]) };
    let (limit, length) = (draws.size(1e-4, 0.05).max(1e-3), draws.one(&[2, 3]));
    format!(
        "hairpin = 1\n{robot}\nseed = {}\n[world]\nterrain = {{ generator = \"flat\", size_m = {size:?}, cell_m = {:?} }}\n\
         [task]\nstart = {{ x_m = {:?}, y_m = {:?}, yaw_deg = {:?} }}\nlength = {length}\nleg_m = [{:?}, {:?}]\n\
         [generate]\nmanoeuvres = {turns}\nheadings = 2\nspeed = {{ profile = \"{profile}\" }}\n{limits}\n\
         search = {{ method = \"beam\", score = \"curvature-change\", waypoints = 20, cases = 1, graphs = 4 }}\n\
         [execute]\ncontroller = \"{control}\"\nrepeat = 1\n[spec]\nlimits = {{ path_deviation_m = {limit:?} }}\n",
        (draws.unit() * 1e9) as u64,
        size / 100.0,
        0.5 * size,
        0.5 * size,
        draws.between(-180.0, 180.0),
        0.5 * leg,
        1.5 * leg,
    )
}

/// The same on a map whose coordinates are those of the Earth.
fn far_drive(here: &Path, draws: &mut Draws) -> String {
    let (x, y) = (draws.between(3e5, 7e5), draws.between(0.0, 9e6));
    let row = "1 ".repeat(60);
    let map = format!(
        "ncols 60\nnrows 60\nxllcorner {x}\nyllcorner {y}\ncellsize 0.5\nNODATA_value -9999\n{}",
        format!("{row}\n").repeat(60)
    );
    fs::write(here.join("utm.asc"), map).unwrap();
    format!(
        "hairpin = 1\nrobot = \"rocky8\"\nseed = {}\n[world]\nterrain = {{ file = \"utm.asc\" }}\n\
         [task]\nstart = {{ x_m = {:?}, y_m = {:?}, yaw_deg = 10 }}\nlength = 3\nleg_m = [2, 5]\n[generate]\n\
         search = {{ waypoints = 16, cases = 1, graphs = 4 }}\n[execute]\ncontroller = \"stanley\"\n\
         [spec]\nlimits = {{ path_deviation_m = {:?} }}\n",
        (draws.unit() * 1e9) as u64,
        x + 15.0,
        y + 15.0,
        draws.size(1e-5, 1e-3),
    )
}

fn arm(draws: &mut Draws) -> String {
    let (robot, far) = draws.one(&[("irb120", 1.0), ("irb1200", 1.5)]);
    let mode = draws.one(&["joint", "cartesian"]);
    let (speed, zone) = (draws.one(&["v5", "v100", "v1000"]), draws.one(&["fine", "z1", "z10"]));
    let kind = if mode == "joint" { draws.one(&["kind = \"joint\", ", ""]) } else { "" };
    let point = |draws: &mut Draws| {
        let mut at = |least: f64, most: f64| draws.between(far * least, far * most);
        format!("[{:?}, {:?}, {:?}]", at(250.0, 400.0), at(-150.0, 150.0), at(250.0, 450.0))
    };
    let points: Vec<String> = (0..4).map(|_| point(draws)).collect();
    let spec = draws.one(&[
        "[spec]\npath = { max_mm = LIMIT }",
        "[spec]\npath = { max_mm = LIMIT }\narrival = { max_late_ms = 0.01 }",
        "",
    ]);
    let none = if spec.is_empty() { "spec = \"none\"\n" } else { "" };
    let limit = draws.size(1e-3, 1.0);
    // Declared in programs, or there on the controller.
    let declared = draws.one(&[true, false]);
    format!(
        "hairpin = 1\nrobot = \"{robot}\"\nseed = {}\n{none}[world]\n\
         tool = {{ name = \"tGrip\", declare = {declared}, tcp_mm = [0, 0, 60], radius_mm = 20 }}\n\
         wobj = {{ name = \"wTable\", declare = {declared}, uframe_mm = [20, 10, 0] }}\n\
         [task]\npoints = [{}]\n[generate]\nmode = \"{mode}\"\nmoves = {{ {kind}speeds = [\"{speed}\"], zones = [\"{zone}\"] }}\n\
         search = {{ programs = 1 }}\n[execute]\nrepeat = 1\n{}\n",
        (draws.unit() * 1e9) as u64,
        points.join(", "),
        spec.replace("LIMIT", &format!("{limit:?}"))
    )
}

/// Waters from a basin to a hundred kilometres, crossed slowly.
fn boat(draws: &mut Draws) -> String {
    let size = draws.size(30.0, 100_000.0);
    let (low, high) = (0.45 * size, 0.55 * size);
    // CyberShip II is a model of a metre: at some centimetres a second.
    let leg = 0.1 * size;
    let times = format!("[{:?}, {:?}]", (leg / 1.0).min(9e4), (leg / 0.02).clamp(60.0, 1e5));
    format!(
        "hairpin = 1\nrobot = \"cybership-ii\"\nseed = {}\n[world]\nsize_m = [{size:?}, {size:?}]\n[task]\nstart_m = [{low:?}, {low:?}]\n\
         end_m = [{high:?}, {high:?}]\nlength = 2\n[generate]\nleg_time_s = {times}\n\
         search = {{ method = \"beam\", waypoints = 30, cases = 1, graphs = 6 }}\n\
         [execute]\nrepeat = 1\ntime_limit_s = {:?}\n[spec]\ndeviation = {{ max_m = {:?} }}\n",
        (draws.unit() * 1e9) as u64,
        draws.size(20.0, 400.0),
        draws.size(1e-4, 0.1),
    )
}

/// Runs, and holds that it is no wrong input and no mistake of ours: what it says otherwise is its own business.
fn read(here: &Path, seed: u64, scenario: &str, arguments: &[&str]) -> i32 {
    let (code, out, error) = run(here, arguments);
    let told = || format!("seed {seed}: {arguments:?} gave {code}\n{out}{error}\n{scenario}");
    assert!(![2, 70, 101].contains(&code), "{}", told());
    assert!(!error.contains("hairpin's own"), "{}", told());
    code
}

/// All commands that read what others write, on a scenario of kind number `kind`. Whether there was a case.
fn agree(kind: usize, seed: u64) -> bool {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let mut draws = Draws { state: seed };
    let scenario = match kind {
        0 => flight(&mut draws),
        1 => drive(&mut draws),
        2 => far_drive(here, &mut draws),
        3 => arm(&mut draws),
        _ => boat(&mut draws),
    };
    fs::write(here.join("s.toml"), &scenario).unwrap();
    let read = |arguments: &[&str]| read(here, seed, &scenario, arguments);
    read(&["stress", "s.toml", "--out", "a"]);
    read(&["explain", "a/scenario.toml", "--graphs", "1", "--time-limit", "1"]);
    // What is kept is a scenario like any other.
    read(&["generate", "a/scenario.toml", "--out", "b", "--time-limit", "2"]);
    if !here.join("a/waypoints.parquet").is_file() || json(here, &["judge", "a"])["counts"]["cases"] == 0 {
        return false;
    }
    read(&["execute", "a"]);
    read(&["judge", "a"]);
    read(&["verify", "a"]);
    read(&["report", "a"]);
    read(&["compare", "a", "a"]);
    read(&["select", "a", "--cases", "1", "--out", "one"]);
    read(&["judge", "one"]);
    let formats = match kind {
        3 => "rapid,urscript,krl,joint-trajectory,csv,tum",
        0 if scenario.contains("origin") => "waypoints,geodetic,csv,tum",
        _ => "waypoints,csv,tum",
    };
    read(&["export", "a", "--to", formats]);
    let judged = json(here, &["judge", "a"]);
    if kind != 3 {
        read(&["execute", "one", "--missions", "a/export"]);
        read(&["judge", "one"]);
    } else {
        let module = json(here, &["export", "a", "--to", "rapid"]);
        for file in module["files"].as_array().unwrap().iter().filter_map(Value::as_str) {
            if file.ends_with(".mod") {
                read(&["import", file, "--check", "--cell", "a/scenario.toml"]);
            }
        }
        read(&["import", "a/export/0000.mod"]);
    }
    if judged["counts"]["fail"] == 1 {
        read(&["replay", "a/repro/0000.json"]);
        read(&["shrink", "a", "--case", "0", "--budget", "3"]);
        let shrunk = "a/repro/0000-shrunk.json";
        if here.join(shrunk).is_file() {
            read(&["replay", shrunk]);
        }
        // With what was saved run first.
        read(&["stress", "s.toml", "--out", "a", "--force"]);
        read(&["execute", "a", "--repro", "a/repro"]);
    }
    true
}

#[test]
fn what_one_command_writes_every_other_one_reads() {
    let first = std::env::var("HAIRPIN_AGREEMENT_SEED").ok().and_then(|seed| seed.parse().ok()).unwrap_or(1);
    let (begun, most) = (Instant::now(), Duration::from_secs(12));
    let mut met = [0; 5];
    for round in 0..8 {
        for (kind, met) in met.iter_mut().enumerate() {
            // Every kind has one at least; how many more depends on the machine.
            if begun.elapsed() < most || (*met == 0 && round < 3) {
                *met += usize::from(agree(kind, first + 5 * round + kind as u64));
            }
        }
    }
    assert!(met.iter().all(|met| *met > 0), "scenarios without any case, from seed {first}: {met:?}");
}

#[test]
fn a_fast_car_is_read_back() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let sedan = "kind = \"car\"\nname = \"mid-size sedan\"\nwheelbase_m = 2.58\nlength_m = 4.5\nwidth_m = 1.61\nspeed_m_s = 15.0\n\
                 [limits]\nsteering_deg = 61.0\nsteering_rate_deg_s = 22.9\nspeed_m_s = 50.8\nacceleration_m_s2 = 11.5\n";
    fs::write(here.join("sedan.toml"), sedan).unwrap();
    let scenario = "hairpin = 1\nrobot = \"sedan.toml\"\nseed = 2\n[world]\nterrain = { generator = \"flat\", size_m = 600, cell_m = 4.0 }\n\
                    [task]\nstart = { x_m = 300, y_m = 300, yaw_deg = 0 }\nlength = 5\nleg_m = [40, 120]\n[generate]\nreach = \"witness\"\n\
                    manoeuvres = [\"forward\"]\nheadings = 4\nspeed = { profile = \"trapezoid\" }\n\
                    limits = { speed_m_s = 15, curvature_1_m = 0.15, curvature_rate_1_m2 = 0.05 }\n\
                    search = { method = \"beam\", score = \"curvature-change\", waypoints = 24, cases = 2 }\n\
                    [execute]\ncontroller = \"stanley\"\nrepeat = 1\n[spec]\nlimits = { path_deviation_m = 0.001 }\n";
    fs::write(here.join("fast.toml"), scenario).unwrap();
    assert_eq!(json(here, &["stress", "fast.toml", "--out", "a"])["counts"]["fail"], 2);
    assert!(json(here, &["replay", "a/repro/0000.json"])["reproduces"] == true);
    assert_eq!(json(here, &["execute", "a"])["exit_code"], 0);
    let repro = fs::read_to_string(here.join("a/repro/0000.json")).unwrap();
    let edited = repro.replacen("\"turn_rate\": 150", "\"turn_rate\": 1500", 1);
    assert_ne!(repro, edited, "{repro}");
    fs::write(here.join("edited.json"), edited).unwrap();
    let (code, _, error) = run(here, &["replay", "edited.json"]);
    assert!(code == 2 && error.contains("drive.turn_rate = 1500") && error.contains("≤ 1000"), "{error}");
}
