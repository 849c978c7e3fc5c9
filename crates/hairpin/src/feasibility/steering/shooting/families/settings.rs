//! Choices of the shooting.

use crate::feasibility::steering::shooting::Precision;
use crate::feasibility::steering::shooting::flat::Cost;

/// How long and how exactly to look.
///
/// Counts, no time: the same answer on every machine.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// The errors within which the goal counts as met; the descents go on to a thousandth of it.
    ///
    /// Of a solve within `Choices` the single arc's takes its place.
    pub precision: Precision,
    /// Steps of each descent at most.
    ///
    /// The last few that make the goal exact come on top.
    pub iterations: u32,
    /// Start values at most.
    pub starts: u32,
    /// Share of each step that is taken at first, in (0, 1].
    pub step_scale: f64,
    /// What the parameters that a family has to spare make small, its goal kept exactly.
    pub cost: Cost,
}

impl Default for Settings {
    /// 1 cm, 0.01 rad, 0.01 1/m; 60 steps from up to 24 starts; whole steps.
    fn default() -> Self {
        Self { precision: Precision::default(), iterations: 60, starts: 24, step_scale: 1.0, cost: Cost::Any }
    }
}
