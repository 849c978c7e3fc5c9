//! What a search asks of a score, leg by leg, and how legs add up to a trajectory.
//!
//! A search only ever adds a leg to something it has: that is all the interface. Larger is more stressful throughout.
//!
//! | trait | score of a leg depends on | searches |
//! | --- | --- | --- |
//! | [`Objective`] | all that was flown before it, as its memory has it | beam, uniform |
//! | [`Additive`] | itself and the leg before | exact too, with proof |
//!
//! Scores have no unit of their own: only their order counts, and under [`Aggregate::Sum`] their ratio.

use nalgebra::Point3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::feasibility::reach::LegFeatures;

/// A leg as a score sees it: the joint of waypoint `from` and waypoint `to`.
///
/// Units as in [`LegFeatures`]. The first leg of a trajectory is that with `from` = 0.
///
/// A view is made for each question and never kept; an objective that needs the leg before takes it from its memory.
#[derive(Debug, Clone, Copy)]
pub struct LegView<'a> {
    /// The graph, m: 0 the start, the last the end.
    pub candidates: &'a [Point3<f64>],
    /// Index of the leg's first waypoint.
    pub from: u32,
    /// Index of its second waypoint.
    pub to: u32,
    /// Planned duration, s.
    /// As the reach set says: the step of step-wise sets, the leg's own time of a witness. 0 to the sink of a free
    /// end.
    pub duration: f64,
    /// Speeds, turn, length, climb.
    pub features: LegFeatures,
}

/// What a leg scores by its turn α: plain + turning · (1 − |α − best|/best).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ByTurn {
    /// The turn that scores most, the same of all legs, rad.
    pub best: f64,
    /// What it scores whatever the turn.
    pub plain: f64,
    /// What it scores more at the best turn, ≥ 0.
    pub turning: f64,
}

impl ByTurn {
    /// The score at a turn, rad.
    #[inline]
    pub fn at(&self, turn: f64) -> f64 {
        self.plain + self.turning * (1.0 - (turn - self.best).abs() / self.best)
    }
}

/// A score, built up leg by leg. What it remembers of a partial trajectory travels with it, so that extending one
/// never starts again from its first waypoint. [`super::exact()`] takes those that are [`Additive`].
///
/// Any `Fn(&LegView) -> f64` is an objective without memory.
///
/// A pure function of memory and leg: the same partial trajectory has one score however it was come to. Scores that are
/// executed are a [`super::Growth`] instead.
///
/// Called about legs · length times by a dynamic program and once a child by the beam, so that a score costs
/// nanoseconds or is asked for many legs at once ([`Additive::own_and_left`]).
pub trait Objective {
    /// What is carried along a partial trajectory.
    type Memory: Clone;

    /// The memory of a trajectory that only stands at its start.
    fn start(&self) -> Self::Memory;

    /// The score of `leg` alone, flown after what `memory` remembers, and the memory after it. Larger is more
    /// stressful; NaN counts as −∞.
    fn extend(&self, memory: &Self::Memory, leg: &LegView<'_>) -> (f64, Self::Memory);
}

/// A score of which the best can be proven: a leg's is its own part and what the leg before left to it.
///
/// ```text
/// score of leg k = own(leg k) + left(leg k − 1),     left(leg 0) = 0
/// ```
///
/// Because of `left`, pairs of legs are within reach of a dynamic program over single legs: it carries two numbers a
/// node in place of a graph over pairs. Any polynomial of one leg's own features is additive, a product of two legs'
/// features is not.
///
/// [`Objective::extend`] must say the same: own(leg) plus what the memory has of the leg before.
pub trait Additive: Objective {
    /// What the leg scores whatever was flown before it.
    ///
    /// NaN counts as −∞.
    fn own(&self, leg: &LegView<'_>) -> f64;

    /// What it adds to the score of the leg after it.
    fn left(&self, leg: &LegView<'_>) -> f64 {
        let _ = leg;
        0.0
    }

    /// [`Self::own`] and [`Self::left`] of many legs.
    ///
    /// One pair \[own, left\] a leg, in their order; to be overridden by scores that are quicker about many, as those
    /// of another program are.
    ///
    /// As many entries as `legs`, bit for bit those of the single calls: a graph is scored by rows, and what is asked
    /// in which row is not promised.
    fn own_and_left(&self, legs: &[LegView<'_>]) -> Vec<[f64; 2]> {
        legs.iter().map(|leg| [self.own(leg), self.left(leg)]).collect()
    }

    /// [`Self::own`] by the turn of the leg, where it is such a function of it, and depends on how the leg is entered
    /// by nothing else; where it is, nothing may be left to the next leg.
    ///
    /// To the bit. Legs that share all but their turn are then scored together.
    fn by_turn(&self, leg: &LegView<'_>) -> Option<ByTurn> {
        let _ = leg;
        None
    }

    /// Whether no leg's score depends on its duration: legs that may be longer than is known then have their scores.
    fn is_timeless(&self) -> bool {
        false
    }

    /// Whether the last leg is one to the sink of a task without an end: nothing is left to it.
    fn has_sink(&self) -> bool {
        false
    }
}

impl<F: Fn(&LegView<'_>) -> f64> Additive for F {
    fn own(&self, leg: &LegView<'_>) -> f64 {
        self(leg)
    }
}

impl<F: Fn(&LegView<'_>) -> f64> Objective for F {
    type Memory = ();

    fn start(&self) {}

    fn extend(&self, (): &(), leg: &LegView<'_>) -> (f64, ()) {
        (self(leg), ())
    }
}

/// How the scores of legs become the score of a trajectory.
///
/// Associative, so that a dynamic program may add from either end; floating-point sums are taken in one order all the
/// same.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Aggregate {
    /// As in the paper.
    #[default]
    Sum,
    /// The worst leg: what the verdict asks for.
    Max,
}

impl Aggregate {
    /// The score of a trajectory without legs: neutral to [`Aggregate::add`].
    ///
    /// 0 of a sum, −∞ of a maximum.
    pub fn neutral(self) -> f64 {
        match self {
            Aggregate::Sum => 0.0,
            Aggregate::Max => f64::NEG_INFINITY,
        }
    }

    /// The score after one more leg (or after more legs that score `leg` together).
    ///
    /// −∞ + ∞ counts as −∞: a worthless leg makes a worthless trajectory, never a NaN that compares with nothing.
    ///
    /// ```
    /// use hairpin::search::Aggregate;
    ///
    /// let legs = [2.0, 5.0, 1.0];
    /// let total = |by: Aggregate| legs.iter().fold(by.neutral(), |total, leg| by.add(total, *leg));
    /// assert_eq!((total(Aggregate::Sum), total(Aggregate::Max)), (8.0, 5.0));
    /// ```
    pub fn add(self, total: f64, leg: f64) -> f64 {
        match self {
            Aggregate::Sum => {
                let sum = total + leg;
                if sum.is_nan() { f64::NEG_INFINITY } else { sum }
            }
            Aggregate::Max => total.max(leg),
        }
    }
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;

    #[test]
    fn nan_never_wins() {
        assert_eq!(Aggregate::Sum.add(1.0, f64::NAN), f64::NEG_INFINITY);
        assert_eq!(Aggregate::Max.add(1.0, f64::NAN), 1.0);
    }
}
