//! Whether a log's joints are in the program's postures: where the tool is tells neither elbow, wrist nor whole turns,
//! and moves are proven clear in one posture alone.
//!
//! ```text
//! far(q) = min over the program's postures on the moves about q of max_k |q_k − program_k|        open where far > 20°
//! ```
//!
//! Times are not compared: lag, a late start and a slow arm leave a robot in postures of its program. Twenty degrees
//! are far more than tracking errors make of a joint, near a stretched wrist as well, and far less than another elbow,
//! another wrist or a turn.

use std::ops::Range;

use super::ArmSetup;
use super::hidden::recorded;
use super::plan::posed;
use crate::campaign::Case;
use crate::campaign::scenario::{Asked, Keys};
use crate::robot::arm::{AXES, Joints};
use crate::trajectory::{PlannedPath, Track};

/// So far an axis may stand from the program's posture, rad.
const ALLOWED: f64 = 20.0 * std::f64::consts::PI / 180.0;
/// Segments before and after the last one that are looked at first.
const BESIDE: usize = 4;

/// The program's posture that is nearest to a sample.
#[derive(Debug, Clone, Copy)]
struct Nearest {
    /// Largest turn of an axis between the two, rad.
    far: f64,
    /// That axis, from 0.
    axis: usize,
    /// Where the program has it, rad.
    programmed: f64,
    /// The segment of the path that it is on.
    segment: usize,
}

impl ArmSetup {
    /// `path` with the angles of its postures, `q1_rad` … `q6_rad`, where runs are recordings; as it is where they are
    /// not known, or nobody asks for them.
    pub(super) fn with_postures(&self, case: &Case, path: PlannedPath) -> PlannedPath {
        if self.scenario.execute.logs.is_none() {
            return path;
        }
        let track = path.track();
        let ways = (0..track.len().saturating_sub(1)).map(|i| track.way(i).copied()).collect();
        let posed = posed(self, case, track.clone()).along(ways);
        PlannedPath::new(posed, path.moves().to_vec())
    }

    /// Why a recording with joints shows nothing of what its program was proven for: the sample that is farthest from
    /// its postures, in words. `legs` are the moves of its samples. `None` where all are near, where the log tells no
    /// joints, and where nothing is asked for.
    pub(super) fn other_posture(&self, path: &PlannedPath, legs: &[usize], recording: &Track) -> Option<String> {
        if self.scenario.asked() != Asked::Limits {
            return None;
        }
        let (rows, log) = (recorded(path.track())?, recorded(recording)?);
        let ends: Vec<usize> = path.moves().iter().map(|one| one.end).collect();
        let last = rows.len().saturating_sub(1);
        // Alignment by places may be a move off where two meet.
        let about = |leg: usize| {
            let from = leg.checked_sub(2).map_or(0, |before| ends[before.min(ends.len() - 1)]);
            from..ends[(leg + 1).min(ends.len() - 1)].max(from + 1).min(last).max(from)
        };
        let (mut segment, mut worst): (usize, Option<(Nearest, usize)>) = (0, None);
        for (i, (q, leg)) in log.iter().zip(legs).enumerate() {
            let whole = about(*leg);
            let beside = segment.saturating_sub(BESIDE).max(whole.start)..(segment + BESIDE).min(whole.end);
            let found = nearest(&rows, beside, q).filter(|found| found.far <= ALLOWED);
            let Some(found) = found.or_else(|| nearest(&rows, whole, q)) else { continue };
            segment = found.segment;
            if found.far > ALLOWED && worst.is_none_or(|(most, _)| found.far > most.far) {
                worst = Some((found, i));
            }
        }
        let (found, i) = worst?;
        let [stands, programmed, allowed] = [log[i][found.axis], found.programmed, ALLOWED].map(f64::to_degrees);
        Some(format!(
            "axis {} stands at {stands:.1}° at t = {:.2} s, and the nearest posture of the program has it at {programmed:.1}° \
             ({allowed:.0}° are allowed for lag and tracking): another elbow, wrist or turn than the one that the program was \
             proven in",
            found.axis + 1,
            recording.times()[i]
        ))
    }
}

/// The posture on `segments` of the line through `rows` that is nearest to `q`.
///
/// On each segment the nearest by Σ Δq², of which the largest Δq counts; the first of equals.
fn nearest(rows: &[Joints], segments: Range<usize>, q: &Joints) -> Option<Nearest> {
    let one = |segment: usize| {
        let (a, b) = (rows.get(segment)?, rows.get(segment + 1)?);
        let along: Joints = std::array::from_fn(|k| b[k] - a[k]);
        let square: f64 = along.iter().map(|turn| turn * turn).sum();
        let on: f64 = (0..AXES).map(|k| along[k] * (q[k] - a[k])).sum();
        let share = if square > 0.0 { (on / square).clamp(0.0, 1.0) } else { 0.0 };
        let programmed: Joints = std::array::from_fn(|k| a[k] + share * along[k]);
        let apart = |k: usize| (q[k] - programmed[k]).abs();
        let axis = (0..AXES).reduce(|most, k| if apart(k) > apart(most) { k } else { most })?;
        Some(Nearest { far: apart(axis), axis, programmed: programmed[axis], segment })
    };
    segments.filter_map(one).reduce(|least, one| if one.far < least.far { one } else { least })
}
