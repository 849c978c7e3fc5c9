//! Which of our controllers flies, and its settings.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::curve::SegmentTimes;

/// The six controllers.
///
/// | word | commands | knows |
/// | --- | --- | --- |
/// | `unstable-waypoint`, `stable-waypoint`, `anafi` | a velocity towards the waypoint | the next waypoint |
/// | `fixed-velocity` | a velocity of one size | the next waypoint |
/// | `minimum-snap` | a velocity towards a moving point | all waypoints |
/// | `geometric` | thrust, attitude, rates | the plan, or all waypoints |
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ControllerKind {
    /// A cascade of PIDs, poorly tuned on purpose.
    UnstableWaypoint,
    /// A cascade of PIDs, well tuned.
    StableWaypoint,
    /// A fixed speed towards the next waypoint.
    FixedVelocity,
    /// A minimum-snap polynomial through the waypoints, its moving point followed by the stable cascade.
    MinimumSnap,
    /// SE(3) tracking of the planned profile, or of a minimum-snap polynomial where there is none.
    Geometric,
    /// A waypoint controller with the Anafi's limits: a stand-in for its closed one.
    Anafi,
}

impl ControllerKind {
    /// The word in scenarios.
    pub fn word(self) -> &'static str {
        match self {
            ControllerKind::UnstableWaypoint => "unstable-waypoint",
            ControllerKind::StableWaypoint => "stable-waypoint",
            ControllerKind::FixedVelocity => "fixed-velocity",
            ControllerKind::MinimumSnap => "minimum-snap",
            ControllerKind::Geometric => "geometric",
            ControllerKind::Anafi => "anafi",
        }
    }

    /// Whether it plans over all waypoints before it flies; the others know of one at a time.
    ///
    /// Those cannot be flown leg by leg ([`Airborne`](crate::simulation::Airborne)).
    pub fn plans_ahead(self) -> bool {
        matches!(self, Self::MinimumSnap | Self::Geometric)
    }
}

/// Which controller flies, and its settings.
///
/// `Default` is `stable-waypoint`; settings of other controllers are not looked at.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ControllerSettings {
    /// The controller.
    pub kind: ControllerKind,
    /// Speed of `FixedVelocity`, m/s.
    pub fixed_velocity: f64,
    /// Leg times of minimum-snap references.
    pub segment_times: SegmentTimes,
}

impl Default for ControllerSettings {
    fn default() -> Self {
        Self { kind: ControllerKind::StableWaypoint, fixed_velocity: 2.0, segment_times: SegmentTimes::default() }
    }
}
