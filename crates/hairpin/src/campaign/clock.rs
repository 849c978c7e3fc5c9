//! The clock of a plan: its times, and which leg is due.

use std::borrow::Cow;

use super::Case;

/// A time of a plan.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Moment {
    /// s.
    pub(super) t: f64,
    /// The leg that is due: one that begins at `t`, and beyond the end the last.
    pub(super) leg: usize,
    /// Since the leg began, s: at least 0, and at most what it takes.
    pub(super) tau: f64,
}

/// The times from 0 to the end of legs that take `leg_times` (s, positive) at `rate` (Hz), the end included; none
/// without legs.
///
/// The last interval may be shorter than 1 / `rate`, and is left out below 1 ns.
pub(super) fn moments(leg_times: &[f64], rate: f64) -> Vec<Moment> {
    if leg_times.is_empty() {
        return Vec::new();
    }
    let duration: f64 = leg_times.iter().sum();
    let count = (duration * rate).floor() as usize;
    let at_rate = (0..=count).map(|k| k as f64 / rate);
    let end = Some(duration).filter(|end| end - count as f64 / rate > 1e-9);
    let (mut leg, mut begins) = (0, 0.0);
    let moment = |t: f64| {
        while leg + 1 < leg_times.len() && t >= begins + leg_times[leg] {
            begins += leg_times[leg];
            leg += 1;
        }
        Moment { t, leg, tau: (t - begins).clamp(0.0, leg_times[leg]) }
    };
    at_rate.chain(end).map(moment).collect()
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_moment_has_its_leg_and_the_end_is_one() {
        let found = moments(&[0.2, 0.1, 0.25], 10.0);
        // 0.2 + 0.1 is more than 0.3.
        assert_eq!(found.iter().map(|moment| moment.leg).collect::<Vec<_>>(), [0, 0, 1, 1, 2, 2, 2]);
        let end = found[6];
        assert!((end.t - 0.55).abs() < 1e-12 && (end.tau - 0.25).abs() < 1e-12, "{end:?}");
        assert_eq!(moments(&[], 10.0), []);
    }
}
