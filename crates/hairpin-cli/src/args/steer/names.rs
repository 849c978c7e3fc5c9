//! Frames, families of controls and costs by name.

use clap::ValueEnum;
use hairpin::feasibility::steering::shooting::Control;
use hairpin::feasibility::steering::shooting::rough::GroundCost;
use hairpin::robot::rover::Kinematics;

/// Frames of poses.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum SteerFrame {
    /// East, north, up; yaw from east, counter-clockwise; left positive
    Enu,
    /// North, east, down; yaw from north, clockwise; right positive
    Ned,
}

/// Rates of the planar pose on the ground.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum SteerKinematics {
    /// Without what the suspension adds to the body's velocity: vz, roll and pitch rates
    Source,
    /// With it
    Exact,
}

impl From<SteerKinematics> for Kinematics {
    fn from(kinematics: SteerKinematics) -> Self {
        match kinematics {
            SteerKinematics::Source => Self::Source,
            SteerKinematics::Exact => Self::Exact,
        }
    }
}

/// Families of controls.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum SteerControl {
    /// Constant curvature; heading and curvature at the goal are as they come
    Arc,
    /// Turn in place, straight, turn in place
    TurnDriveTurn,
    /// A polynomial of arc length of third order
    Cubic,
    /// Of fifth order, or lines, arcs and clothoids where none does
    Quintic,
    /// A polynomial of time
    TimePolynomial,
    /// A natural cubic spline through eight knots
    Knots,
    /// Linear and angular velocity as polynomials of time; the curvature at the goal is free if not given
    VelocityPolynomial,
}

impl From<SteerControl> for Control {
    fn from(control: SteerControl) -> Self {
        match control {
            SteerControl::Arc => Self::Arc,
            SteerControl::TurnDriveTurn => Self::TurnDriveTurn,
            SteerControl::Cubic => Self::Cubic,
            SteerControl::Quintic => Self::Quintic,
            SteerControl::TimePolynomial => Self::TimePolynomial,
            SteerControl::Knots => Self::Knots,
            SteerControl::VelocityPolynomial => Self::VelocityPolynomial,
        }
    }
}

/// What may become small along a drive.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum SteerCost {
    /// Nothing: the first drive that meets the goal
    Any,
    /// The integral of the squared curvature
    Curvature,
    /// That of the squared change of curvature by arc length
    Rate,
    /// That of the squared angle between body and vertical
    Tilt,
    /// Metres lost to slip and drift
    Slip,
    /// Work per mass against slope and rolling
    Energy,
}

impl From<SteerCost> for GroundCost {
    fn from(cost: SteerCost) -> Self {
        match cost {
            SteerCost::Any => Self::Any,
            SteerCost::Curvature => Self::Curvature,
            SteerCost::Rate => Self::Rate,
            SteerCost::Tilt => Self::Tilt,
            SteerCost::Slip => Self::Slip,
            SteerCost::Energy => Self::Energy,
        }
    }
}
