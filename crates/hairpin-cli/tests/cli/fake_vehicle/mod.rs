//! Vehicles that fly, drive and move exactly as hairpin's own simulation did, and log it as real ones do: PX4 as ULog,
//! robots with ROS 2 as bags. So what is known of the simulation is known of the log.

mod bag;
mod px4;
#[path = "../../../../hairpin-formats/src/logs/tests/write_bag.rs"]
#[allow(dead_code, reason = "the readers' own tests use the rest")]
mod write_bag;
#[path = "../../../../hairpin-formats/src/logs/tests/write_ulog.rs"]
#[allow(dead_code, reason = "the readers' own tests use the rest")]
mod write_ulog;

use std::fs;
use std::path::Path;

use hairpin::trajectory::Track;
use nalgebra::{Point3, UnitQuaternion, Vector3};
use serde_json::Value;

use crate::commands::json;

pub(crate) use bag::{joint_states, odometry};
pub(crate) use px4::{Happens, Px4};

/// A sample of what `export --to csv` wrote of a run.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Row {
    pub(crate) t: f64,
    pub(crate) p: Point3<f64>,
    pub(crate) q: UnitQuaternion<f64>,
    pub(crate) v: Vector3<f64>,
    pub(crate) leg: usize,
    pub(crate) joints: [f64; 6],
}

/// The run in the file at `path`.
pub(crate) fn rows(path: &Path) -> Vec<Row> {
    let text = fs::read_to_string(path).unwrap();
    let (header, lines) = text.split_once('\n').unwrap();
    let names: Vec<&str> = header.split(',').collect();
    let column = |name: &str| names.iter().position(|found| *found == name);
    let of = |line: &str| {
        let cells: Vec<f64> = line.split(',').map(|cell| cell.parse().unwrap_or(0.0)).collect();
        let at = |name: &str| column(name).map_or(0.0, |index| cells[index]);
        let quaternion = nalgebra::Quaternion::new(at("qw"), at("qx"), at("qy"), at("qz"));
        Row {
            t: at("t"),
            p: Point3::new(at("x_m"), at("y_m"), at("z_m")),
            q: UnitQuaternion::from_quaternion(quaternion),
            v: Vector3::new(at("vx_m_s"), at("vy_m_s"), at("vz_m_s")),
            leg: at("leg") as usize,
            joints: [1, 2, 3, 4, 5, 6].map(|joint| at(&format!("q{joint}_rad"))),
        }
    };
    lines.lines().map(of).collect()
}

/// Every `every`-th sample of a run.
pub(crate) fn rows_of(track: &Track, every: usize) -> Vec<Row> {
    let column = |name: &str| track.channel(name).unwrap_or_default();
    let at = |name: &str, i: usize| column(name).get(i).copied().unwrap_or(0.0);
    let row = |i: usize| Row {
        t: track.times()[i],
        p: track.position(i),
        q: track.poses()[i].rotation,
        v: Vector3::new(at("vx_m_s", i), at("vy_m_s", i), at("vz_m_s", i)),
        leg: at("leg", i) as usize,
        joints: [1, 2, 3, 4, 5, 6].map(|joint| at(&format!("q{joint}_rad"), i)),
    };
    (0..track.len()).step_by(every).map(row).collect()
}

/// The waypoints that `export --to waypoints` wrote.
pub(crate) fn waypoints(path: &Path) -> Vec<Point3<f64>> {
    let text = fs::read_to_string(path).unwrap();
    let numbers = |line: &str| line.split(',').map(|cell| cell.parse().unwrap()).collect::<Vec<f64>>();
    text.lines().skip(1).map(|line| Point3::from_slice(&numbers(line)[..3])).collect()
}

/// What `judge` says of a log of these bytes called `name`, against the campaign in `out`.
pub(crate) fn judged(here: &Path, name: &str, bytes: &[u8], more: &[&str]) -> Value {
    fs::write(here.join(name), bytes).unwrap();
    let arguments = [&["judge", name, "--campaign", "out"], more].concat();
    json(here, &arguments)["logs"][0].clone()
}

/// A number of an answer.
pub(crate) fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value}"))
}
