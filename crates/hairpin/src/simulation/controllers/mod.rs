//! Controllers: each turns the measured state and where to go into a force, an attitude and rates for the inner loops.

mod anafi;
mod cascade;
mod curve;
mod fixed_velocity;
mod geometric;
mod minimum_snap;
mod stable_waypoint;
mod unstable_waypoint;

use nalgebra::{Matrix3, Point3, Vector3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::robot::quadrotor::Quadrotor;
use crate::simulation::SimulationError;
use crate::trajectory::Profile;

use cascade::Cascade;
use curve::Curve;

/// What an outer loop asks of the inner loops until its next turn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Demand {
    /// Thrust per mass, world frame, m/s²: (0, 0, g) hovers.
    pub force: Vector3<f64>,
    /// `world_from_body` wanted, a unit quaternion (w, x, y, z).
    pub attitude: [f64; 4],
    /// Body rates fed forward, rad/s.
    pub rates: Vector3<f64>,
    /// Angular acceleration fed forward, body frame, rad/s².
    pub angular_acceleration: Vector3<f64>,
}

impl Demand {
    /// Thrust along `force` (m/s², with an upward part), yaw 0: the body's y axis is normal to the world's x axis.
    pub(crate) fn along(force: Vector3<f64>) -> Self {
        let attitude = quaternion(&level_heading(&force));
        Self { force, attitude, rates: Vector3::zeros(), angular_acceleration: Vector3::zeros() }
    }
}

/// The columns x, y, z of the attitude whose z lies along `force` and whose yaw is 0; level where that is undefined.
fn level_heading(force: &Vector3<f64>) -> Matrix3<f64> {
    let axes = || {
        let z = force.try_normalize(1e-9)?;
        let y = z.cross(&Vector3::x()).try_normalize(1e-9)?;
        Some(Matrix3::from_columns(&[y.cross(&z), y, z]))
    };
    axes().unwrap_or_else(Matrix3::identity)
}

/// (w, x, y, z) of a rotation matrix, by the largest of the four components (Shepperd 1978).
fn quaternion(r: &Matrix3<f64>) -> [f64; 4] {
    let squares = [
        1.0 + r.m11 + r.m22 + r.m33,
        1.0 + r.m11 - r.m22 - r.m33,
        1.0 - r.m11 + r.m22 - r.m33,
        1.0 - r.m11 - r.m22 + r.m33,
    ];
    let largest = (1..4).fold(0, |best, i| if squares[i] > squares[best] { i } else { best });
    let root = squares[largest].sqrt();
    let k = 0.5 / root;
    let (wx, wy, wz) = ((r.m32 - r.m23) * k, (r.m13 - r.m31) * k, (r.m21 - r.m12) * k);
    let (xy, xz, yz) = ((r.m21 + r.m12) * k, (r.m13 + r.m31) * k, (r.m32 + r.m23) * k);
    let own = 0.5 * root;
    [[own, wx, wy, wz], [wx, own, xy, xz], [wy, xy, own, yz], [wz, xz, yz, own]][largest]
}

/// What a controller is told at its turn.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Measured {
    /// Position, m.
    pub position: Vector3<f64>,
    /// Velocity, m/s, world frame.
    pub velocity: Vector3<f64>,
    /// The waypoint to go to, m.
    pub target: Vector3<f64>,
    /// Whether every waypoint was reached: the target is to be held.
    pub hold: bool,
}

/// Where a controller with a timed reference stands in it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Schedule {
    /// Leg of the reference.
    pub leg: usize,
    /// Whether the reference has come to its end.
    pub over: bool,
}

/// An outer loop. It runs every [`Controller::PERIOD`] seconds.
pub(crate) trait Controller {
    /// Time between two turns, s.
    const PERIOD: f64 = 0.01;
    /// The demand until the next turn, `dt` s from now.
    fn control(&mut self, dt: f64, measured: &Measured) -> Demand;
    /// Where the reference stands, for controllers that follow a timed one; `None`: waypoint by waypoint.
    fn schedule(&self) -> Option<Schedule> {
        None
    }
}

/// The six controllers.
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
    pub fn plans_ahead(self) -> bool {
        matches!(self, Self::MinimumSnap | Self::Geometric)
    }
}

/// Leg times of the minimum-snap reference.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum SegmentTimes {
    /// By the square root of the leg's length.
    #[default]
    SqrtLength,
    /// By the leg's length, for the same total time.
    Length,
}

/// Which controller flies, and its settings.
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

/// The controller of a run. One `match` per turn of the outer loop, no allocation, and it can be copied in mid-flight.
#[derive(Debug, Clone)]
pub(crate) enum Pilot {
    /// Either of the two waypoint cascades.
    Waypoint(Cascade),
    /// See [`ControllerKind::FixedVelocity`].
    FixedVelocity(fixed_velocity::FixedVelocity),
    /// See [`ControllerKind::MinimumSnap`].
    MinimumSnap(minimum_snap::MinimumSnap),
    /// See [`ControllerKind::Geometric`].
    Geometric(geometric::Geometric),
    /// See [`ControllerKind::Anafi`].
    Anafi(anafi::Anafi),
}

impl Pilot {
    /// Builds the controller for a robot and a course.
    ///
    /// # Errors
    /// A fixed velocity that is not positive; waypoints without a minimum-snap curve through them.
    pub(crate) fn new(
        settings: &ControllerSettings,
        robot: &Quadrotor,
        waypoints: &[Point3<f64>],
        profile: Option<&Profile>,
    ) -> Result<Self, SimulationError> {
        Ok(match settings.kind {
            ControllerKind::UnstableWaypoint => Pilot::Waypoint(unstable_waypoint::cascade(robot)),
            ControllerKind::StableWaypoint => Pilot::Waypoint(stable_waypoint::cascade(robot)),
            ControllerKind::FixedVelocity => {
                let speed = settings.fixed_velocity;
                if !(speed.is_finite() && speed > 0.0) {
                    return Err(SimulationError::new("fixed_velocity", speed.to_string(), "finite and > 0 m/s"));
                }
                Pilot::FixedVelocity(fixed_velocity::FixedVelocity::new(robot, speed))
            }
            ControllerKind::MinimumSnap => {
                let curve = Curve::through(robot, waypoints, settings.segment_times)?;
                Pilot::MinimumSnap(minimum_snap::MinimumSnap::new(robot, curve))
            }
            ControllerKind::Geometric => {
                let curve = match profile.and_then(Curve::new) {
                    Some(curve) => curve,
                    None => Curve::through(robot, waypoints, settings.segment_times)?,
                };
                Pilot::Geometric(geometric::Geometric::new(robot, curve))
            }
            ControllerKind::Anafi => Pilot::Anafi(anafi::Anafi::new(robot)),
        })
    }

    /// Time between two turns, s.
    pub(crate) fn period(&self) -> f64 {
        match self {
            Pilot::Waypoint(_) => Cascade::PERIOD,
            Pilot::FixedVelocity(_) => fixed_velocity::FixedVelocity::PERIOD,
            Pilot::MinimumSnap(_) => minimum_snap::MinimumSnap::PERIOD,
            Pilot::Geometric(_) => geometric::Geometric::PERIOD,
            Pilot::Anafi(_) => anafi::Anafi::PERIOD,
        }
    }

    /// [`Controller::control`].
    pub(crate) fn control(&mut self, dt: f64, measured: &Measured) -> Demand {
        match self {
            Pilot::Waypoint(controller) => controller.control(dt, measured),
            Pilot::FixedVelocity(controller) => controller.control(dt, measured),
            Pilot::MinimumSnap(controller) => controller.control(dt, measured),
            Pilot::Geometric(controller) => controller.control(dt, measured),
            Pilot::Anafi(controller) => controller.control(dt, measured),
        }
    }

    /// [`Controller::schedule`].
    pub(crate) fn schedule(&self) -> Option<Schedule> {
        match self {
            Pilot::MinimumSnap(controller) => controller.schedule(),
            Pilot::Geometric(controller) => controller.schedule(),
            _ => None,
        }
    }
}
