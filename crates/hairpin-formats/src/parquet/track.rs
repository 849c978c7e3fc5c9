//! `trajectories/CASE.parquet` and `executions/CASE-RUN.parquet`: poses in time with their channels,
//! `t_s,leg,x_m,y_m,z_m,qw,qx,qy,qz,vx_m_s,vy_m_s,vz_m_s,…`, world frame, quaternion w first.

use std::path::Path;
use std::sync::Arc;

use arrow_array::{ArrayRef, Float64Array, Int64Array};
use hairpin::trajectory::{Channel, Track};
use nalgebra::{Isometry3, Quaternion, Translation3, UnitQuaternion};

use super::table::{Columns, Table, TableError};
use crate::atomic::WriteError;

const POSE: [&str; 7] = ["x_m", "y_m", "z_m", "qw", "qx", "qy", "qz"];
/// Channels that stand right after the pose, whatever the track's order.
const VELOCITY: [&str; 3] = ["vx_m_s", "vy_m_s", "vz_m_s"];
/// A quaternion rewritten in single precision is off by 1e-7; one that is off by more than this is another thing.
const NORM_TOLERANCE: f64 = 1e-3;

/// Writes a planned track.
///
/// # Errors
/// The file cannot be written.
pub fn write(path: &Path, track: &Track) -> Result<(), WriteError> {
    columns(track).write(path, "trajectory")
}

/// Reads a track: every further column of numbers becomes a channel.
///
/// # Errors
/// Missing columns, values that are not finite, times that do not rise, quaternions that are none.
pub fn read(path: &Path) -> Result<Track, TableError> {
    from_table(&Table::read(path)?)
}

pub(super) fn columns(track: &Track) -> Columns {
    let mut columns = Columns::default();
    columns.push("t_s", number_column(track.times().iter().copied()));
    if let Some(legs) = track.channel("leg") {
        columns.push("leg", leg_column(legs));
    }
    for (i, name) in POSE.into_iter().enumerate() {
        columns.push(name, number_column(track.poses().iter().map(|pose| pose_value(pose, i))));
    }
    let (velocity, others): (Vec<_>, Vec<_>) =
        track.channels().iter().filter(|c| c.name != "leg").partition(|c| VELOCITY.contains(&c.name.as_str()));
    for channel in velocity.into_iter().chain(others) {
        columns.push(channel.name.clone(), number_column(channel.values.iter().copied()));
    }
    columns
}

pub(super) fn from_table(table: &Table) -> Result<Track, TableError> {
    let times = table.numbers("t_s")?;
    let pose = POSE.iter().map(|name| table.numbers(name)).collect::<Result<Vec<_>, _>>()?;
    let poses = (0..times.len()).map(|row| isometry(table, row, std::array::from_fn(|i| pose[i][row])));
    let poses = poses.collect::<Result<Vec<_>, _>>()?;
    let mut channels = Vec::new();
    for name in table.names() {
        if name != "t_s" && !POSE.contains(&name.as_str()) && !table.is_text(&name) {
            channels.push(Channel { values: table.numbers(&name)?, name });
        }
    }
    if let Some(row) = (1..times.len()).find(|&row| times[row] <= times[row - 1]) {
        return Err(table.refuse("t_s", row, times[row], format!("> {}, the stamp before it", times[row - 1])));
    }
    Ok(Track::new(times, poses, channels).expect("lengths, times and numbers were checked"))
}

fn pose_value(pose: &Isometry3<f64>, column: usize) -> f64 {
    let q = pose.rotation.quaternion();
    match column {
        0..3 => pose.translation.vector[column],
        3 => q.w,
        4 => q.i,
        5 => q.j,
        _ => q.k,
    }
}

fn isometry(table: &Table, row: usize, [x, y, z, qw, qx, qy, qz]: [f64; 7]) -> Result<Isometry3<f64>, TableError> {
    let q = Quaternion::new(qw, qx, qy, qz);
    // Infinite where squares overflow, and refused then as well.
    let off = (q.norm() - 1.0).abs();
    if off > NORM_TOLERANCE || off.is_nan() {
        return Err(table.refuse("qw", row, format!("({qw}, {qx}, {qy}, {qz})"), "a quaternion of norm 1"));
    }
    // Our own files come back to the bit; what lost precision on the way is made a rotation again.
    let rotation = if off < 1e-12 { UnitQuaternion::new_unchecked(q) } else { UnitQuaternion::new_normalize(q) };
    Ok(Isometry3::from_parts(Translation3::new(x, y, z), rotation))
}

fn number_column(values: impl Iterator<Item = f64>) -> ArrayRef {
    Arc::new(Float64Array::from_iter_values(values))
}

fn leg_column(legs: &[f64]) -> ArrayRef {
    if legs.iter().all(|leg| leg.fract() == 0.0 && leg.abs() < 9.0e15) {
        Arc::new(Int64Array::from_iter_values(legs.iter().map(|leg| *leg as i64)))
    } else {
        number_column(legs.iter().copied())
    }
}
