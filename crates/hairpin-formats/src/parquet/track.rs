//! `trajectories/` and `executions/`: poses in time with their channels,
//! `case,run,t_s,leg,x_m,y_m,z_m,qw,qx,qy,qz,vx_m_s,vy_m_s,vz_m_s,…`, world frame, quaternion w first.
//!
//! Of what was measured at its full rate only the rows are written where it bends; between them positions and
//! velocities follow the cubic (Hermite), everything else the line, within the tolerances that stand in the file's
//! metadata.

use std::collections::BTreeSet;
use std::io;
use std::path::Path;
use std::sync::Arc;

use arrow_array::types::{Float32Type, Float64Type};
use arrow_array::{ArrayRef, Float64Array, Int64Array, StringArray};
use hairpin::campaign::CaseNumber;
use hairpin::trajectory::between::period;
use hairpin::trajectory::{Channel, Tolerances, Track, bends};
use nalgebra::{Isometry3, Quaternion, Translation3, UnitQuaternion};

use super::piece::Piece;
use super::table::{CASE, Columns, RUN, Table, TableError};
use crate::channels::{LEG, VELOCITY, in_order};

const POSE: [&str; 7] = ["x_m", "y_m", "z_m", "qw", "qx", "qy", "qz"];
/// A quaternion rewritten in single precision is off by 1e-7; one that is off by more than this is another thing.
const NORM_TOLERANCE: f64 = 1e-3;

/// How far the motion between rows is from what was left out, at most.
pub(super) const TOLERANCES: Tolerances = Tolerances { position: 1e-4, attitude: 1e-3, share: 0.01 };
/// The same less what rounding takes of it.
const WITHIN: Tolerances = Tolerances { position: 9e-5, attitude: 0.93e-3, share: 0.0087 };
/// Steps of positions, m, of quaternions, and of velocities, m/s: powers of two, so that the last bytes are zeros.
const STEP: f64 = 1.0 / 131_072.0;
const ATTITUDE_STEP: f64 = 1.0 / 16_384.0;
const VELOCITY_STEP: f64 = 1.0 / 16_384.0;
/// Steps in what every other channel may be off.
const STEPS: f64 = 4.0;

/// A planned motion, the rows where it bends.
///
/// # Errors
/// There is no room for it.
pub fn planned(case: CaseNumber, track: &Track) -> io::Result<Piece> {
    thinned((case, None), track, &BTreeSet::new())
}

/// A planned motion of which the rows where it bends are known, and the time between its samples, s.
///
/// # Errors
/// There is no room for it.
pub fn planned_rows(case: CaseNumber, (rows, period): (&Track, f64)) -> io::Result<Piece> {
    Piece::thinned(rounded(columns((case, None), rows)), Some(period))
}

/// The motion of a run, or a plan, the rows where it bends and those in `marked`.
pub(super) fn thinned(key: (CaseNumber, Option<usize>), track: &Track, marked: &BTreeSet<usize>) -> io::Result<Piece> {
    let Some(period) = period(track) else { return Piece::of(columns(key, track)) };
    Piece::thinned(rounded(columns(key, &track.picked(&bends(track, marked, &WITHIN)))), Some(period))
}

/// Times as they are, everything else in steps; in single precision but for positions, which may lie anywhere in the
/// world, and for columns whose numbers would be infinite in it.
fn rounded(columns: Columns) -> Columns {
    let in_steps = |value: f64, step: f64| if step > 0.0 { (value / step).round() * step } else { value };
    columns.map_numbers(|name, values| match name {
        "t_s" => Arc::new(values.clone()),
        _ if POSE[..3].contains(&name) => Arc::new(values.unary::<_, Float64Type>(|value| in_steps(value, STEP))),
        _ => {
            let step = match name {
                _ if POSE.contains(&name) => ATTITUDE_STEP,
                _ if VELOCITY.contains(&name) => VELOCITY_STEP,
                _ => step_of(values.values()),
            };
            if values.values().iter().any(|value| value.abs() > f64::from(f32::MAX)) {
                return Arc::new(values.clone());
            }
            Arc::new(values.unary::<_, Float32Type>(|value| in_steps(value, step) as f32))
        }
    })
}

/// The power of two that is a small part of what a channel may be off; 0 of one that does not change.
fn step_of(values: &[f64]) -> f64 {
    let (low, high) = values.iter().fold((f64::MAX, f64::MIN), |(low, high), v| (low.min(*v), high.max(*v)));
    let most = TOLERANCES.share * (high - low) / STEPS;
    // Its exponent alone.
    if most.is_normal() && most > 0.0 { f64::from_bits(most.to_bits() & (0x7ff << 52)) } else { 0.0 }
}

/// Reads a track: every further column of numbers becomes a channel.
///
/// # Errors
/// Missing columns, values that are not finite, times that do not rise, quaternions that are none.
pub fn read(path: &Path) -> Result<Track, TableError> {
    from_table(&Table::read(path)?)
}

/// All rows as they are.
pub(super) fn columns((case, run): (CaseNumber, Option<usize>), track: &Track) -> Columns {
    let mut columns = Columns::default();
    columns.push(CASE, Arc::new(StringArray::from(vec![case.to_string(); track.len()])));
    if let Some(run) = run {
        columns.push(RUN, Arc::new(Int64Array::from(vec![run as i64; track.len()])));
    }
    columns.push("t_s", number_column(track.times().iter().copied()));
    if let Some(legs) = track.channel(LEG) {
        columns.push(LEG, leg_column(legs));
    }
    for (i, name) in POSE.into_iter().enumerate() {
        columns.push(name, number_column(track.poses().iter().map(|pose| pose_value(pose, i))));
    }
    for channel in in_order(track).into_iter().filter(|channel| channel.name != LEG) {
        columns.push(channel.name.clone(), number_column(channel.values.iter().copied()));
    }
    columns
}

/// Every `period` s, where only the rows are in `table` that stand for such samples.
pub(crate) fn sampled(table: &Table, period: Option<f64>) -> Result<Track, TableError> {
    let track = from_table(table)?;
    Ok(match period {
        Some(period) => track.at_period(period),
        None => track,
    })
}

/// Whether the last row in `table` stands at `end`, s, as near as single precision has it; where no end is known any
/// row does.
pub(crate) fn ends_at(table: &Table, end: Option<f64>) -> Result<bool, TableError> {
    let last = table.numbers("t_s")?.last().copied();
    Ok(end.is_none_or(|end| last.is_some_and(|last| (last - end).abs() <= 1e-7 * end.abs())))
}

pub(crate) fn from_table(table: &Table) -> Result<Track, TableError> {
    let times = table.numbers("t_s")?;
    let pose = POSE.iter().map(|name| table.numbers(name)).collect::<Result<Vec<_>, _>>()?;
    let poses = (0..times.len()).map(|row| isometry(table, row, std::array::from_fn(|i| pose[i][row])));
    let poses = poses.collect::<Result<Vec<_>, _>>()?;
    let mut channels = Vec::new();
    for name in table.names() {
        let is_channel = ![CASE, RUN, "t_s"].contains(&name.as_str()) && !POSE.contains(&name.as_str());
        // What only other runs of the table have is empty.
        if is_channel && !table.is_text(&name) && !table.is_empty(&name) {
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

#[cfg(test)]
mod tests {
    use arrow_array::Array;
    use arrow_schema::DataType;

    use super::*;

    /// What single precision has no number for keeps its own.
    #[test]
    fn nothing_becomes_infinite() {
        let poses = vec![Isometry3::identity(); 3];
        let channel = |name: &str, most: f64| Channel { name: name.into(), values: vec![0.0, most, 1.0] };
        let track = Track::new(vec![0.0, 0.1, 0.2], poses, vec![channel("far", 1e200), channel("near", 2.0)]).unwrap();
        let batch = rounded(columns((CaseNumber(0), None), &track)).into_batch();
        let of = |name: &str| batch.column_by_name(name).unwrap().data_type().clone();
        assert_eq!((of("far"), of("near")), (DataType::Float64, DataType::Float32));
    }
}
