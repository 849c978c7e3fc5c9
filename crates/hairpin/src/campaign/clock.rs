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
    let stamps = Stamps::of(leg_times, rate);
    stamps.due(leg_times, 0..stamps.len())
}

/// Those of the [`moments`] between which the leg changes, the first and the last.
///
/// O(legs): those between are not looked at.
pub(super) fn changes(leg_times: &[f64], rate: f64) -> Vec<Moment> {
    let stamps = Stamps::of(leg_times, rate);
    let Some(last) = stamps.len().checked_sub(1) else { return Vec::new() };
    let mut rows = vec![0, last];
    let mut begins = 0.0;
    for time in &leg_times[..leg_times.len() - 1] {
        begins += time;
        let first = stamps.first_from(begins);
        if first <= last {
            rows.extend([first.saturating_sub(1), first]);
        }
    }
    rows.sort_unstable();
    rows.dedup();
    stamps.due(leg_times, rows.into_iter())
}

/// Even stamps, and the end.
struct Stamps {
    rate: f64,
    /// How many are even, from 0 s on.
    even: usize,
    /// The end where it is another, s.
    end: Option<f64>,
}

impl Stamps {
    fn of(leg_times: &[f64], rate: f64) -> Self {
        if leg_times.is_empty() {
            return Self { rate, even: 0, end: None };
        }
        let duration: f64 = leg_times.iter().sum();
        let count = (duration * rate).floor() as usize;
        let end = Some(duration).filter(|end| end - count as f64 / rate > 1e-9);
        Self { rate, even: count + 1, end }
    }

    fn len(&self) -> usize {
        self.even + usize::from(self.end.is_some())
    }

    /// Stamp number `row`, s.
    fn at(&self, row: usize) -> f64 {
        self.end.filter(|_| row >= self.even).unwrap_or(row as f64 / self.rate)
    }

    /// The number of the first that is `t` (s) or later.
    fn first_from(&self, t: f64) -> usize {
        let mut row = ((t * self.rate) as usize).min(self.len());
        while row > 0 && self.at(row - 1) >= t {
            row -= 1;
        }
        while row < self.len() && self.at(row) < t {
            row += 1;
        }
        row
    }

    /// What is due at the stamps with these numbers, which rise.
    fn due(&self, leg_times: &[f64], rows: impl Iterator<Item = usize>) -> Vec<Moment> {
        let (mut leg, mut begins) = (0, 0.0);
        let moment = |row: usize| {
            let t = self.at(row);
            while leg + 1 < leg_times.len() && t >= begins + leg_times[leg] {
                begins += leg_times[leg];
                leg += 1;
            }
            Moment { t, leg, tau: (t - begins).clamp(0.0, leg_times[leg]) }
        };
        rows.map(moment).collect()
    }
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

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;
    use crate::math::random::{stream, unit};

    #[test]
    fn every_moment_has_its_leg_and_the_end_is_one() {
        let found = moments(&[0.2, 0.1, 0.25], 10.0);
        // 0.2 + 0.1 is more than 0.3.
        assert_eq!(found.iter().map(|moment| moment.leg).collect::<Vec<_>>(), [0, 0, 1, 1, 2, 2, 2]);
        let end = found[6];
        assert!((end.t - 0.55).abs() < 1e-12 && (end.tau - 0.25).abs() < 1e-12, "{end:?}");
        assert_eq!((moments(&[], 10.0), changes(&[], 10.0)), (vec![], vec![]));
    }

    /// Legs that begin at a stamp, between two, and several between the same two; one that is over before the second.
    #[test]
    fn changes_are_found_without_the_moments_between() {
        let mut random = stream(7);
        for legs in 1..40 {
            let time = |_| if unit(&mut random) < 0.3 { 0.1 } else { 0.004 + 3.0 * unit(&mut random).powi(4) };
            let leg_times: Vec<f64> = (0..legs).map(time).collect();
            let all = moments(&leg_times, 10.0);
            let differs = |row: usize| all.get(row).zip(all.get(row + 1)).is_some_and(|(a, b)| a.leg != b.leg);
            let kept = |row: usize| row == 0 || row + 1 == all.len() || differs(row) || differs(row - 1);
            let expected: Vec<Moment> = (0..all.len()).filter(|row| kept(*row)).map(|row| all[row]).collect();
            assert_eq!(changes(&leg_times, 10.0), expected, "{leg_times:?}");
        }
        assert_eq!(changes(&[0.05], 10.0).len(), 2);
    }
}
