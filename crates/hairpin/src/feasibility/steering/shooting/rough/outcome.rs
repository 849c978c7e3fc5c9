//! What a motion prediction answers: what happened on the way, each moment of it, and why it ended early.

use thiserror::Error;

use crate::robot::rover::{Gradient, Settled, Unsettled};
use crate::trajectory::drive::Planar;

/// What happened on the way.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Prediction {
    /// Where it ended; the curvature is the steering's, not the command's.
    pub end: Planar,
    /// Largest angle of the body's z axis from the vertical, rad, and after how many metres.
    pub tilt: (f64, f64),
    /// Largest |rocker or bogie angle|, rad, and after how many metres.
    pub joint: (f64, f64),
    /// Largest difference between roll or pitch as they were foreseen from the step before and as they were found, rad:
    /// small on smooth ground, large where the body falls from one rest to another.
    ///
    /// Below 0.03 coarse steps are believed without being looked along again.
    pub surprise: f64,
    /// Settled poses that were solved.
    pub steps: u32,
}

/// Why a motion could not be followed to its end, and where.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[error("after {after_m:.2} m: {cause}")]
pub struct Blocked {
    /// Metres of commanded travel before.
    pub after_m: f64,
    /// What stopped it.
    pub cause: Cause,
}

/// What ends a prediction early.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum Cause {
    /// No ground, or no rest on it.
    #[error(transparent)]
    Unsettled(#[from] Unsettled),
    /// The body stands on end: pitch of 80° or more.
    #[error("the body stands on end")]
    Overturned,
}

/// One moment of a motion, as an observer gets it.
///
/// Enough for limits, keep-outs, costs and torque to be looked at without predicting again.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Driven {
    /// Metres of commanded travel so far.
    pub s: f64,
    /// Radians turned in place so far, whichever way.
    pub turned: f64,
    /// Metres driven, + forward, or radians turned in place, + to the left, of the step: half of it is done here.
    pub step: f64,
    /// Whether it is one of a turn in place.
    pub in_place: bool,
    /// Pose over the ground at the middle of a step.
    ///
    /// Its curvature is the steering's, 1/m.
    pub at: Planar,
    /// How the body stands.
    pub settled: Settled,
    /// How that changes with its place.
    pub gradient: Gradient,
}
