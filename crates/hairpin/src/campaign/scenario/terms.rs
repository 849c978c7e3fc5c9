//! What a run is judged by: the reference of its deviation, and the limits.

use super::DeviationFrom;
use crate::judgement::Limits;

/// The terms of a scenario's spec.
#[derive(Debug, Clone, Copy)]
pub struct Terms {
    /// The reference of the deviation.
    pub from: DeviationFrom,
    /// Inside this distance of the leg's own waypoints overshoot is judged instead, m.
    pub corner: f64,
    /// What is within spec.
    pub limits: Limits,
}
