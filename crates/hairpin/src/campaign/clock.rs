//! The clock of a plan: stamps, and which leg is due.

use std::borrow::Cow;

use super::Case;

/// Stamps from 0 to `duration` at `rate`, the end included.
///
/// s and Hz; the last interval may be shorter than 1 / `rate`, and is left out below 1 ns.
pub(super) fn stamps(duration: f64, rate: f64) -> Vec<f64> {
    let count = (duration * rate).floor() as usize;
    let mut times: Vec<f64> = (0..=count).map(|k| k as f64 / rate).collect();
    if duration - times[count] > 1e-9 {
        times.push(duration);
    }
    times
}

/// The leg at `t` and the time since it began.
///
/// 0 ≤ τ ≤ the leg's duration; a stamp at a waypoint belongs to the leg that begins there, beyond the end to the last
/// one.
///
/// Durations are positive; `t` below 0 belongs to the first leg.
pub(super) fn locate(leg_times: &[f64], t: f64) -> (usize, f64) {
    let mut start = 0.0;
    for (leg, duration) in leg_times.iter().enumerate() {
        if t < start + duration || leg + 1 == leg_times.len() {
            return (leg, (t - start).clamp(0.0, *duration));
        }
        start += duration;
    }
    (0, 0.0)
}

/// The case as it is timed; one without leg times (a mission made elsewhere) at `speed` (m/s) along its straight legs,
/// without a witness, those of no length in `least` (s).
pub(super) fn paced(case: &Case, speed: f64, least: f64) -> Cow<'_, Case> {
    if !case.leg_times.is_empty() {
        return Cow::Borrowed(case);
    }
    let leg_times = case.waypoints.windows(2).map(|leg| ((leg[1] - leg[0]).norm() / speed).max(least)).collect();
    Cow::Owned(Case { leg_times, witness: None, ..case.clone() })
}
