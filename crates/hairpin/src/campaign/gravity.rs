//! How bad a run was: the order in which the worst run of a case, and the worst case of a campaign, are looked for, and
//! in which cases are chosen by their stress and flown in a day.
//!
//! | of two | the graver |
//! | --- | --- |
//! | one violates something | that one |
//! | one crashed | that one |
//! | one ended short of its last waypoint | that one |
//! | both crashed, or neither broke a measured limit | the one with the larger deviation |
//! | else | the one that breaks a measured limit by the larger share of it |
//!
//! Where the deviation alone is limited that is the larger deviation; where others are as well, what is told as the
//! worst of a limit is the worst of it. Of runs that violate nothing what the first limit bounds may stand in the
//! deviation's place. What ended badly was cut off by that: its deviation says nothing of how gentle it was.

use std::cmp::Ordering;

use super::{CaseResult, Status};
use crate::judgement::{Measures, Violation};
use crate::trajectory::Ended;

/// Compared in the order of its fields.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Gravity {
    violates: bool,
    crashed: bool,
    /// Not done, whether that is limited or not.
    short: bool,
    /// The largest excess over a limit as a share of it; −∞ where that is not what decides.
    excess: f64,
    /// m, or the unit of what runs within spec are compared by.
    size: f64,
}

impl Gravity {
    /// Of a run with these violations that `ended` so; without a violation by `within`.
    pub(super) fn of((violations, ended): (&[Violation], &str), max_deviation: f64, within: f64) -> Self {
        let crashed = violations.iter().any(Violation::is_crash);
        let measured = violations.iter().filter(|one| !crashed && one.event().is_none());
        Self {
            violates: !violations.is_empty(),
            crashed,
            short: ended != Ended::Done.word() || violations.iter().any(Violation::is_unfinished),
            excess: measured.map(Violation::relative_excess).fold(f64::NEG_INFINITY, f64::max),
            size: if violations.is_empty() { within } else { max_deviation },
        }
    }

    /// Of a case's worst run, with the largest deviation of all; nothing measured is no deviation.
    pub(super) fn of_result(result: &CaseResult) -> Self {
        let measured = |measures: &Measures| measures.max_deviation;
        let max_deviation = result.measured().map_or(0.0, measured);
        Self::of((&result.violations, &result.ended), max_deviation, max_deviation)
    }

    /// Whether the run crashed, or ended short of its last waypoint.
    pub(super) fn ended_badly(&self) -> bool {
        self.crashed || self.short
    }

    /// Greater is graver.
    pub(super) fn against(&self, other: &Self) -> Ordering {
        let flags = |one: &Self| (one.violates, one.crashed, one.short);
        let flags = flags(self).cmp(&flags(other));
        flags.then(self.excess.total_cmp(&other.excess)).then(self.size.total_cmp(&other.size))
    }
}

impl PartialOrd for Gravity {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.against(other))
    }
}

/// Where a case stands among others by its worst run: what it was judged to be first, then by [`Gravity`].
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Standing {
    /// What executors could not run says nothing of the robot, and stands behind what passes.
    judged: u8,
    gravity: Gravity,
}

impl Standing {
    pub(super) fn of(result: &CaseResult) -> Self {
        let judged = match result.status {
            Status::Fail => 3,
            Status::Inconclusive => 2,
            Status::Pass | Status::Unjudged => 1,
            Status::ExecutorFailed => 0,
        };
        Self { judged, gravity: Gravity::of_result(result) }
    }

    /// As [`Gravity::ended_badly`].
    pub(super) fn ended_badly(&self) -> bool {
        self.gravity.ended_badly()
    }

    /// Greater is worse.
    pub(super) fn against(&self, other: &Self) -> Ordering {
        self.judged.cmp(&other.judged).then_with(|| self.gravity.against(&other.gravity))
    }
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;

    #[test]
    fn the_worst_of_a_limit_is_the_worst_of_it() {
        let one = |what: &str, value, limit| Violation {
            what: what.into(),
            value,
            limit,
            unit: String::new(),
            at: 0.0,
            leg: 0,
        };
        let of =
            |violations: &[Violation], max_deviation| Gravity::of((violations, "done"), max_deviation, max_deviation);
        // Rising: what takes long is compared by its time, whatever it deviates.
        let rising = [
            of(&[], 1.0),
            of(&[], 2.0),
            of(&[one("left-world", 4.0, 0.0)], 1.9),
            of(&[one("deviation", 2.1, 2.0)], 2.1),
            of(&[one("total-time", 30.0, 26.0), one("deviation", 2.2, 2.0)], 2.2),
            of(&[one("total-time", 33.0, 26.0)], 1.0),
            of(&[one("clearance", 0.1, 0.5)], 0.5),
            of(&[one("unfinished", 3.0, 9.0)], 1.0),
            of(&[one("unfinished", 3.0, 9.0), one("deviation", 3.0, 2.0)], 3.0),
            of(&[one("crash", 4.0, 0.0)], 0.5),
            of(&[one("crash", 2.0, 0.0), one("clearance", -0.1, 0.5)], 0.6),
        ];
        assert!(rising.windows(2).all(|pair| pair[0] < pair[1]), "{rising:?}");
        let within = |ended, size| Gravity::of((&[], ended), 1.0, size);
        assert!(within("done", 30.0) > within("done", 20.0), "within spec by what is limited");
        assert!(within("time", 20.0) > within("done", 30.0) && within("time", 20.0).ended_badly());
    }
}
