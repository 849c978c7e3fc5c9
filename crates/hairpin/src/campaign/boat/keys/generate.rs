//! `[task]` and `[generate]`: what is to be sailed, and how trajectories are searched for.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::campaign::scenario::{EXECUTED, SearchSection};

/// `[task]`: at rest at both ends.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BoatTask {
    /// First waypoint.
    pub start_m: [f64; 2],
    /// Last waypoint.
    pub end_m: [f64; 2],
    /// Waypoints, start and end included.
    pub length: u64,
}

/// `[generate]`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct BoatGenerate {
    /// Smallest and largest leg time; the shortest feasible of a ladder between them is taken.
    pub leg_time_s: [f64; 2],
    /// Velocities per waypoint.
    pub velocities: u64,
    /// The search.
    pub search: SearchSection,
    /// Name of a score, executed, learned:MODEL, or python:FILE.
    pub score: String,
    /// Limits beside the boat's own.
    pub limits: BoatLimitsSection,
}

/// The score that boats have beside those of all: a corner that is entered and left fast, the more the farther it leads
/// across the current.
pub(in crate::campaign::boat) const ACROSS_CURRENT: &str = "across-current";

impl Default for BoatGenerate {
    fn default() -> Self {
        Self {
            leg_time_s: [10.0, 80.0],
            velocities: 4,
            search: SearchSection::default(),
            score: Self::BY_HAND.into(),
            limits: BoatLimitsSection::default(),
        }
    }
}

impl BoatGenerate {
    /// The score of a scenario that gives none, and of what is executed only in part.
    pub const BY_HAND: &str = ACROSS_CURRENT;

    /// The name of the score that single legs have.
    pub(in crate::campaign::boat) fn score_of_legs(&self) -> &str {
        if self.score == EXECUTED { Self::BY_HAND } else { &self.score }
    }
}

/// `generate.limits`: none is in force that is not given.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct BoatLimitsSection {
    /// Largest speed over ground.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub max_speed_m_s: Option<f64>,
    /// Share of the thrusters' limits that plans use; all if not given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub thrust_share: Option<f64>,
    /// Largest planned duration of a trajectory.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub max_time_s: Option<f64>,
}
