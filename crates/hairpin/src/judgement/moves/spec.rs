//! Limits of moves, and which of them a recording violates.

use super::measure::Measured;
use crate::judgement::Violation;

/// What is within spec. A limit that is `None` is not judged; a target that is not reached always is.
///
/// Inside m and s; violations are told in mm and ms.
///
/// Both `None` judges nothing but whether targets are reached.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct MoveLimits {
    /// Largest distance from the path, m.
    pub path: Option<f64>,
    /// Latest arrival after the planned one, s.
    pub late: Option<f64>,
}

const MILLI: f64 = 1e3;

/// The violations of a recording in the order of its moves: `unreached`, `deviation` in mm, `arrival` in ms, the move
/// in `leg`. After the first target that is not reached the later ones are not told.
///
/// A value at its limit is within it. `limit` of an unreached target is the number of targets.
pub fn move_violations(measured: &Measured, limits: &MoveLimits) -> Vec<Violation> {
    let mut found = Vec::new();
    let violation = |what: &str, value: f64, limit: f64, unit: &str, at: f64, leg: usize| Violation {
        what: what.into(),
        value,
        limit,
        unit: unit.into(),
        at,
        leg,
    };
    for (index, one) in measured.moves.iter().enumerate() {
        if let (Some(deviation), Some(limit)) = (one.deviation, limits.path)
            && deviation > limit
        {
            found.push(violation("deviation", MILLI * deviation, MILLI * limit, "mm", one.deviation_at, index));
        }
        if let (Some(late), Some(limit)) = (one.late(), limits.late)
            && late > limit
        {
            let at = one.arrived.unwrap_or(one.planned);
            found.push(violation("arrival", MILLI * late, MILLI * limit, "ms", at, index));
        }
        if one.arrived.is_none() {
            let (value, limit) = (index as f64, measured.moves.len() as f64);
            found.push(violation("unreached", value, limit, "targets", one.planned, index));
            break;
        }
    }
    found
}

/// Of several runs the gravest violation, or the value that comes nearest to its limit: run, what, where, and its
/// limit.
///
/// By value over limit: the move that used up the largest share of what it may.
///
/// `None` where nothing is limited and all targets are reached. Of equals the first.
pub fn worst_of(runs: &[Measured], limits: &MoveLimits) -> Option<(usize, Violation)> {
    let mut worst: Option<(usize, Violation, f64)> = None;
    let mut offer = |run: usize, violation: Violation| {
        let share = if violation.what == "unreached" { f64::INFINITY } else { violation.value / violation.limit };
        if worst.as_ref().is_none_or(|(_, _, most)| share > *most) {
            worst = Some((run, violation, share));
        }
    };
    for (run, measured) in runs.iter().enumerate() {
        for (leg, one) in measured.moves.iter().enumerate() {
            let value = |what: &str, value: f64, limit: f64, unit: &str, at: f64| Violation {
                what: what.into(),
                value: MILLI * value,
                limit: MILLI * limit,
                unit: unit.into(),
                at,
                leg,
            };
            if let (Some(deviation), Some(limit)) = (one.deviation, limits.path) {
                offer(run, value("deviation", deviation, limit, "mm", one.deviation_at));
            }
            if let (Some(late), Some(limit)) = (one.late(), limits.late) {
                offer(run, value("arrival", late, limit, "ms", one.planned));
            }
        }
        let unreached = move_violations(measured, limits).into_iter().find(|violation| violation.what == "unreached");
        unreached.into_iter().for_each(|violation| offer(run, violation));
    }
    worst.map(|(run, violation, _)| (run, violation))
}
