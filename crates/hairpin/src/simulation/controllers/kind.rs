//! Which of our controllers flies, and its settings.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::curve::SegmentTimes;
use super::{crazyflie_goto, px4_mission};
use crate::robot::quadrotor::Quadrotor;
use crate::simulation::controller::Acceptance;

/// The eight controllers.
///
/// | word | commands | knows |
/// | --- | --- | --- |
/// | `unstable-waypoint`, `stable-waypoint`, `anafi` | a velocity towards the waypoint | the next waypoint |
/// | `fixed-velocity` | a velocity of one size | the next waypoint |
/// | `crazyflie-goto` | tilt and thrust towards a moving point | the next waypoint |
/// | `px4-mission` | tilt and thrust towards a moving point | the next two waypoints |
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
    /// A jerk-limited set point that looks two waypoints ahead, and a cascade that follows it, as PX4 flies missions.
    Px4Mission,
    /// A polynomial to each waypoint, from rest to rest, and a PID that follows it, as the Crazyflie's high-level
    /// commander flies `go_to`.
    CrazyflieGoto,
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
            ControllerKind::Px4Mission => "px4-mission",
            ControllerKind::CrazyflieGoto => "crazyflie-goto",
        }
    }

    /// Where its gains come from, for reports: "flown by … with …".
    pub fn gains(self) -> &'static str {
        match self {
            Self::Px4Mission => "the default parameters of PX4 v1.16",
            Self::CrazyflieGoto => "the default gains of crazyflie-firmware 2026.08",
            _ => "hairpin's own gains, fixed by step responses",
        }
    }

    /// Where it takes a waypoint for reached.
    ///
    /// The radius is the run's.
    pub fn acceptance(self) -> Acceptance {
        match self {
            Self::Px4Mission => Acceptance::Cylinder { height: px4_mission::ACCEPTANCE_HEIGHT },
            _ => Acceptance::Sphere,
        }
    }

    /// Horizontal speed of every mission, where that is its own and not the plan's, m/s.
    pub fn cruise(self) -> Option<f64> {
        (self == Self::Px4Mission).then_some(px4_mission::CRUISE)
    }

    /// Whether it looks beyond the next waypoint; the others know of one at a time.
    ///
    /// Those cannot be flown leg by leg ([`Airborne`](crate::simulation::Airborne)).
    pub fn plans_ahead(self) -> bool {
        matches!(self, Self::MinimumSnap | Self::Geometric | Self::Px4Mission)
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
    /// Mean speed of `CrazyflieGoto`, m/s; a tenth of the robot's top speed if not given.
    pub goto_speed: Option<f64>,
    /// How much faster than its own the loops of position and velocity are: gains of 1/s times this, of 1/s² times its
    /// square, the same motion in another time where nothing limits it.
    pub bandwidth: f64,
}

impl ControllerSettings {
    /// The time that a straight leg of `length` m takes where the controller has a pace of its own, whatever the robot
    /// could do, s; 0 where it flies as fast as it can.
    pub fn own_pace(&self, robot: &Quadrotor, length: f64) -> f64 {
        match self.kind {
            ControllerKind::CrazyflieGoto => length / crazyflie_goto::mean_speed(robot, self.goto_speed),
            _ => 0.0,
        }
    }
}

impl Default for ControllerSettings {
    fn default() -> Self {
        Self {
            kind: ControllerKind::StableWaypoint,
            fixed_velocity: 2.0,
            segment_times: SegmentTimes::default(),
            goto_speed: None,
            bandwidth: 1.0,
        }
    }
}
