//! `[generate]`: how drives are searched for.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{DirectionDeg, DriveEnvironmentSection, DriveSearch};
use crate::feasibility::steering::shooting::Control;
use crate::robot::rover::Kinematics;

/// `[generate]`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct DriveGenerate {
    /// none | sphere | hull | witness.
    pub reach: GroundReach,
    /// Time step of the reach sets that have one: sphere, hull.
    pub step_s: f64,
    /// arc | turn-drive-turn | cubic | quintic | time-polynomial | knots | velocity-polynomial.
    pub control: ControlName,
    /// What the vehicle may do on a leg.
    pub manoeuvres: Vec<Manoeuvre>,
    /// How speed changes along the way.
    pub speed: SpeedSection,
    /// Direction of travel in the body, left positive: for vehicles that steer all wheels. `[least, greatest]`: each
    /// waypoint has one of its own, drawn evenly, and along a leg it turns evenly from one to the other.
    pub direction_deg: DirectionDeg,
    /// source | exact: without or with what the suspension adds to the body's velocity (vz, ωx, ωy); of plans, runs and
    /// proofs.
    pub kinematics: Kinematics,
    /// Headings per waypoint in the `witness` roadmap.
    pub headings: u64,
    /// Limits beside the robot's own.
    pub limits: DriveLimits,
    /// The boundary-value solver.
    pub solver: SolverSection,
    /// The search.
    pub search: DriveSearch,
    /// What of the environment is searched for stress, too.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub environment: Option<DriveEnvironmentSection>,
}

impl Default for DriveGenerate {
    fn default() -> Self {
        Self {
            reach: GroundReach::Witness,
            step_s: 5.0,
            control: ControlName::Quintic,
            manoeuvres: vec![Manoeuvre::Forward],
            speed: SpeedSection::default(),
            direction_deg: DirectionDeg::All(0.0),
            kinematics: Kinematics::Source,
            headings: 4,
            limits: DriveLimits::default(),
            solver: SolverSection::default(),
            search: DriveSearch::default(),
            environment: None,
        }
    }
}

/// The reach sets of ground vehicles.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum GroundReach {
    /// Every waypoint.
    None,
    /// A disc of radius top speed times step.
    Sphere,
    /// Convex hull of the end points of constant-input runs.
    Hull,
    /// Legs that the boundary-value solver solves within all limits.
    Witness,
}

impl GroundReach {
    /// The word in scenarios.
    pub fn word(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Sphere => "sphere",
            Self::Hull => "hull",
            Self::Witness => "witness",
        }
    }
}

/// Families of controls: how curvature may depend on the way, and what there is beside it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ControlName {
    /// Constant curvature, after a turn in place: the heading of an arc's end is as it comes.
    Arc,
    /// Straight, between turns in place.
    TurnDriveTurn,
    /// A polynomial of third order in arc length.
    Cubic,
    /// A polynomial of fifth order in arc length; where none keeps the bounds, clothoids, in both gears if they are
    /// allowed.
    #[default]
    Quintic,
    /// A polynomial of fifth order in time.
    TimePolynomial,
    /// A spline through knots.
    Knots,
    /// Linear and angular velocity as polynomials of time.
    VelocityPolynomial,
}

impl ControlName {
    /// The generator's own name for it.
    pub fn control(self) -> Control {
        match self {
            Self::Arc => Control::Arc,
            Self::TurnDriveTurn => Control::TurnDriveTurn,
            Self::Cubic => Control::Cubic,
            Self::Quintic => Control::Quintic,
            Self::TimePolynomial => Control::TimePolynomial,
            Self::Knots => Control::Knots,
            Self::VelocityPolynomial => Control::VelocityPolynomial,
        }
    }

    /// The word in scenarios.
    pub fn word(self) -> &'static str {
        self.control().name()
    }
}

/// `generate.speed`: how the commanded speed changes along the way. Without `constant`, drives begin and end at rest
/// and stop where the gear changes and for turns in place.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct SpeedSection {
    /// constant | ramp | trapezoid; if not given a trapezoid where the robot's acceleration is bounded, else constant.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub profile: Option<ProfileName>,
    /// Least and greatest speed at which waypoints are passed, each at its own; the commanded speed if not given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub waypoint_m_s: Option<[f64; 2]>,
    /// Acceleration and deceleration; the robot's own if not given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub acceleration_m_s2: Option<f64>,
}

/// How speed changes from waypoint to waypoint.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ProfileName {
    /// One speed all along, without time for stops.
    Constant,
    /// From one waypoint's speed to the next one's, evenly in time.
    Ramp,
    /// Up to the commanded speed between waypoints.
    Trapezoid,
}

/// What a vehicle may do on a leg.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Manoeuvre {
    /// Drive forward.
    Forward,
    /// Drive in reverse, and change gear on the way.
    Reverse,
    /// Turn in place.
    TurnInPlace,
}

/// `generate.limits`: beside those of the robot, whichever is smaller holds.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct DriveLimits {
    /// Largest curvature of the commands.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub curvature_1_m: Option<f64>,
    /// Largest change of curvature along the way.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub curvature_rate_1_m2: Option<f64>,
    /// Commanded speed; the robot's default speed if not given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub speed_m_s: Option<f64>,
    /// Largest angle of the body's z axis from the vertical.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tilt_deg: Option<f64>,
    /// Smallest height of the body's underside over the ground.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub belly_clearance_m: Option<f64>,
}

/// `generate.solver`: counts, no clock.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct SolverSection {
    /// Distance within which a waypoint counts as met.
    pub position_m: f64,
    /// Heading within which it does.
    pub yaw_rad: f64,
    /// Curvature within which it does.
    pub curvature_1_m: f64,
    /// Predictions per leg.
    pub iterations: u64,
    /// Ways around to start from, at most.
    pub starts: u64,
}

impl Default for SolverSection {
    fn default() -> Self {
        Self { position_m: 0.01, yaw_rad: 0.01, curvature_1_m: 0.01, iterations: 20, starts: 8 }
    }
}
