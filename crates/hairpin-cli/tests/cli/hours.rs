//! The guides that take an hour (docs/…-hour.md), command by command as they stand there: what a page writes into files
//! is written, what it runs is run, what it shows is held against what was said, and where its reader moves a real
//! robot, a fake one moves.

use std::fs;
use std::path::{Path, PathBuf};

use hairpin::campaign::{Case, Setup, execute_run};
use hairpin::math::random::{standard_normals, stream};
use hairpin_formats::folder::CampaignFolder;
use hairpin_formats::scenario::read_kept;
use nalgebra::{Point3, Vector3};
use serde_json::{Value, json};

use crate::fake_vehicle::{Px4, Row, joint_states, odometry, rows_of};
use crate::guides::run_line;

/// Where the reader's robot moves.
const MOVES: &str = "<!-- the vehicle moves -->";

/// Does what the page `name` says, and has `moves` do what its reader's robot does.
fn follow(name: &str, here: &Path, moves: &dyn Fn(&Path)) {
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs").join(name);
    let text = fs::read_to_string(page).unwrap();
    let (mut lines, mut said, mut moved) = (text.lines(), String::new(), false);
    while let Some(line) = lines.next() {
        if line == MOVES {
            moves(here);
            moved = true;
        }
        let Some(fence) = line.strip_prefix("```") else { continue };
        let block: Vec<&str> = lines.by_ref().take_while(|line| *line != "```").collect();
        match fence.split_once(' ').unwrap_or((fence, "")) {
            ("toml", file) => fs::write(here.join(file), block.join("\n") + "\n").unwrap(),
            ("sh", _) => block.iter().for_each(|command| said = run_line(name, here, command)),
            ("text", _) => block.iter().for_each(|shown| {
                let told = said.lines().any(|line| is_like(line.trim(), shown.trim()));
                assert!(told, "{name} shows\n{shown}\nbut it said\n{said}");
            }),
            other => panic!("{name}: a block of {other:?}"),
        }
    }
    assert!(moved, "{name} moves nothing");
}

/// Whether `line` is what a page shows, where `…` is anything.
fn is_like(line: &str, shown: &str) -> bool {
    let parts: Vec<&str> = shown.split('…').collect();
    let Some(mut rest) = line.strip_prefix(parts[0]) else { return false };
    for (index, part) in parts.iter().enumerate().skip(1) {
        if index + 1 == parts.len() {
            return rest.ends_with(part);
        }
        let Some(at) = rest.find(part) else { return false };
        rest = &rest[at + part.len()..];
    }
    rest.is_empty()
}

#[test]
fn pages_are_read_as_a_reader_does() {
    assert!(is_like("FAIL 1/2: 0.3 m > 0.2 m", "FAIL …: … m > 0.2 m") && is_like("a", "a") && is_like("ab", "a…"));
    assert!(!is_like("FAIL 1/2: 0.3 m > 0.25 m", "FAIL …: … m > 0.2 m") && !is_like("ab", "a") && !is_like("b", "a…"));
}

/// The real robot of the campaign in `out`: its setup with other numbers.
struct Real {
    setup: Setup,
    cases: Vec<Case>,
}

impl Real {
    fn of(out: &Path, numbers: &[(&str, Value)]) -> Self {
        let folder = CampaignFolder::open(out).unwrap();
        let setup = read_kept(&folder.read_scenario().unwrap(), "scenario.toml", out, &[]).ok().unwrap();
        let numbers: Vec<_> = numbers.iter().map(|(key, value)| ((*key).to_owned(), value.clone())).collect();
        Self { setup: setup.drawn(&numbers).unwrap(), cases: folder.read_cases().unwrap() }
    }

    /// How it moves on the case number `number` at its attempt `attempt`, every `every`-th sample.
    fn moves(&self, number: usize, (attempt, every): (u64, usize)) -> (Vec<Row>, Vec<Point3<f64>>) {
        let mut case = self.cases.iter().find(|case| case.number.0 == number).unwrap().clone();
        case.seed += attempt;
        let flight = execute_run(&self.setup, &case, 0).outcome.unwrap();
        (rows_of(&flight.track, every), case.waypoints)
    }
}

/// What an estimate is off by: `white` m from sample to sample, and a drift of `slow` m over half a second.
fn estimated(rows: &mut [Row], seed: u64, [white, slow]: [f64; 2]) {
    let mut random = stream(seed);
    let keep = (-(rows[1].t - rows[0].t) / 0.5).exp();
    let mut drift = Vector3::zeros();
    for row in rows {
        drift = drift * keep + Vector3::from(standard_normals::<3>(&mut random)) * (slow * (1.0 - keep * keep).sqrt());
        row.p += drift + Vector3::from(standard_normals::<3>(&mut random)) * white;
    }
}

fn logs(here: &Path, folder: &str) -> PathBuf {
    fs::create_dir(here.join(folder)).unwrap();
    here.join(folder)
}

#[test]
fn an_hour_of_a_px4_developer() {
    let folder = tempfile::tempdir().unwrap();
    follow("px4-hour.md", folder.path(), &|here| {
        let real = Real::of(
            &here.join("out"),
            &[
                ("execute.bandwidth", json!(0.6)),
                ("execute.latency_s", json!(0.12)),
                ("world.gusts", json!({ "std_m_s": 0.3, "correlation_s": 2.0 })),
                ("execute.noise", json!(true)),
            ],
        );
        let to = logs(here, "logs");
        for number in 0..3 {
            // At 50 Hz.
            let (mut rows, waypoints) = real.moves(number, (number as u64, 2));
            estimated(&mut rows, number as u64, [0.002, 0.01]);
            let origin = [47.3977, 8.5456, 488.0, 73.5];
            let px4 = Px4 { rows: &rows, waypoints: &waypoints, origin, accuracy: [0.02, 0.02], happens: &[] };
            fs::write(to.join(format!("log_{}.ulg", number + 1)), px4.ulog()).unwrap();
        }
    });
}

const DAYS: [&str; 3] = ["monday", "tuesday", "wednesday"];

#[test]
fn an_hour_with_a_rover() {
    let folder = tempfile::tempdir().unwrap();
    follow("rover-hour.md", folder.path(), &|here| {
        let real = Real::of(&here.join("out"), &[("execute.latency_s", json!(0.25))]);
        let to = logs(here, "bags");
        for (number, day) in DAYS.iter().enumerate() {
            let (mut rows, _) = real.moves(number, (number as u64, 1));
            estimated(&mut rows, number as u64, [0.001, 0.002]);
            fs::write(to.join(format!("{day}.mcap")), odometry(&rows, "map")).unwrap();
        }
    });
}

#[test]
fn an_hour_with_an_arm() {
    let folder = tempfile::tempdir().unwrap();
    follow("arm-hour.md", folder.path(), &|here| {
        let real = Real::of(&here.join("out"), &[("execute.servo_lag_s", json!(0.06))]);
        let to = logs(here, "bags");
        let names = ["base_yaw", "shoulder", "elbow", "forearm_roll", "wrist", "flange_roll"];
        for (number, day) in DAYS.iter().enumerate() {
            let (rows, _) = real.moves(number, (number as u64, 1));
            fs::write(to.join(format!("{day}.mcap")), joint_states(&rows, names, [2, 0, 1, 5, 4, 3])).unwrap();
        }
    });
}
