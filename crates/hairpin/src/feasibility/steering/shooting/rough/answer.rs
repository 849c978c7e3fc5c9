//! What the solver on the ground is given beside its task, and what it answers.

use super::cost::GroundCost;
use super::miss::miss;
use super::outcome::{Blocked, Prediction};
use crate::feasibility::steering::shooting::Precision;
use crate::trajectory::drive::{Planar, SegmentList};

/// Share of the precision that will do where the aim is out of reach.
pub(super) const ENOUGH: f64 = 0.8;

/// How long and how exactly to look.
///
/// Counts of predictions bound the time: each integrates the whole drive on the map.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// Predictions for flat goals, at most; commands that are bent on from there take more, up to 16 for each of five
    /// starts.
    ///
    /// Cheaper commands and finer confirmations come on top as well.
    pub iterations: u32,
    /// When a goal counts as met; the search aims at a fifth of it, so that a finer integration agrees.
    pub precision: Precision,
    /// What to make small along the motion once it meets its goal.
    pub cost: GroundCost,
    /// Share of each step of the flat goal that is taken, in (0, 1].
    pub step_scale: f64,
}

impl Default for Settings {
    fn default() -> Self {
        Self { iterations: 30, precision: Precision::default(), cost: GroundCost::Any, step_scale: 1.0 }
    }
}

impl Settings {
    /// Whether `end` is as near to `goal` as answers are, with room for a finer integration's difference.
    ///
    /// Position, heading and curvature each within 0.8 of its precision.
    pub fn met(&self, goal: &Planar, end: &Planar) -> bool {
        miss(goal, end, &self.precision).residual <= ENOUGH
    }
}

/// How an answer ended.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Status {
    /// The predicted end meets the goal.
    Ok,
    /// The flat solver found no controls for the goal.
    Unreachable,
    /// The ground does not let the motion pass.
    Blocked(Blocked),
    /// The predictions did not come to the goal.
    NotConverged {
        /// What is left of (x, y) in m, ψ in rad, κ in 1/m, the largest in units of its precision.
        residual: f64,
    },
}

/// What was found.
///
/// `Ok` is the prediction's own word; the drive counts once a replay agrees.
#[derive(Debug, Clone, PartialEq)]
pub struct Answer {
    /// How it ended.
    pub status: Status,
    /// The best commands, whatever the status; empty if there are none.
    pub segments: SegmentList,
    /// Their predicted motion.
    pub prediction: Option<Prediction>,
    /// Predictions that were made.
    pub iterations: u32,
}

impl Answer {
    pub(super) const NONE: Self =
        Self { status: Status::Unreachable, segments: SegmentList::EMPTY, prediction: None, iterations: 0 };

    /// Less is better.
    ///
    /// Arrived, then nearest in units of the precision, then blocked, then without any commands.
    pub(super) fn rank(&self) -> f64 {
        match self.status {
            Status::Ok => -1.0,
            Status::NotConverged { residual } => residual,
            Status::Blocked(_) => f64::MAX,
            Status::Unreachable => f64::INFINITY,
        }
    }
}
