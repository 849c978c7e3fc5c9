//! Which of our controllers sails, and its settings.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The controllers of boats.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum BoatControllerKind {
    /// An autopilot: integral line of sight to the leg that it is on, heading and speed held, drift taken off; it knows
    /// of one waypoint at a time.
    LineOfSight,
    /// Follows the timed plan in surge, sway and yaw by feedback linearisation.
    Tracking,
}

impl BoatControllerKind {
    /// The word in scenarios.
    pub fn word(self) -> &'static str {
        match self {
            Self::LineOfSight => "line-of-sight",
            Self::Tracking => "tracking",
        }
    }
}

/// Which controller sails, and its settings.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BoatController {
    /// The controller.
    pub kind: BoatControllerKind,
    /// Speed of `line-of-sight`, m/s; the boat's default where there is none.
    pub speed: Option<f64>,
}
