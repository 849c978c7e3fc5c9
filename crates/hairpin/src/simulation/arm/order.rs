//! The moves of a program, resolved: every target in base coordinates, every number in SI.

use nalgebra::{Isometry3, Point3};

use crate::robot::arm::{Configuration, Joints};
use crate::simulation::SimulationError;

/// Where a move goes and how.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Target {
    /// Joint angles, rad, all joints in step (MoveAbsJ).
    Joints(Joints),
    /// `base_from_tcp`, all joints in step (MoveJ). Without a configuration the nearest solution.
    Joint(Isometry3<f64>, Option<Configuration>),
    /// `base_from_tcp` along a straight line (MoveL). A configuration is what must be met at its end.
    Line(Isometry3<f64>, Option<Configuration>),
    /// `base_from_tcp` along the circle through a point in the base, m (MoveC).
    Arc(Point3<f64>, Isometry3<f64>, Option<Configuration>),
}

/// Programmed speeds; the slower one rules.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Speed {
    /// Of the tool's point, m/s; infinite: as fast as the arm can.
    pub tcp: f64,
    /// Of its orientation, rad/s.
    pub turn: f64,
}

/// How exactly the target is met.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Zone {
    /// The arm stops there.
    Fine,
    /// The path leaves the move this far (m) before its end, and joins the next as far behind its start; cut to half of
    /// each.
    Radius(f64),
}

/// One move.
///
/// Frames are multiplied out and names resolved: what is left is geometry in the base and numbers in SI.
#[derive(Debug, Clone, PartialEq)]
pub struct Order {
    /// What reports call it, such as `p17→p09`.
    pub name: String,
    /// Where to and how.
    pub target: Target,
    /// Programmed speeds.
    pub speed: Speed,
    /// What the move is to take, s, whatever the speed of the tool's point says.
    pub duration: Option<f64>,
    /// How exactly the target is met.
    pub zone: Zone,
    /// `flange_from_tcp`.
    pub tool: Isometry3<f64>,
}

impl Order {
    /// Positions, quaternions and angles are summed and the sum asked to be finite: one number that is none makes it
    /// none. Quaternions are taken as they are.
    ///
    /// # Errors
    /// Numbers that are not finite, speeds that are not above 0, a zone below 0.
    pub(super) fn check(&self) -> Result<(), SimulationError> {
        let error =
            |field, value: f64, bound| Err(SimulationError::new(field, format!("{value} ({})", self.name), bound));
        let duration = self.duration.unwrap_or(1.0);
        for (field, value) in [("speed.tcp", self.speed.tcp), ("speed.turn", self.speed.turn), ("duration", duration)] {
            // Infinite is as fast as the arm can.
            if value.is_nan() || value <= 0.0 {
                return error(field, value, "more than 0");
            }
        }
        if let Zone::Radius(radius) = self.zone
            && !(radius >= 0.0 && radius.is_finite())
        {
            return error("zone", radius, "at least 0 m");
        }
        let pose = |pose: &Isometry3<f64>| {
            let (p, q) = (pose.translation.vector, pose.rotation.coords);
            p.sum() + q.sum()
        };
        let sum = match &self.target {
            Target::Joints(q) => q.iter().sum(),
            Target::Joint(to, _) | Target::Line(to, _) => pose(to),
            Target::Arc(via, to, _) => via.coords.sum() + pose(to),
        } + pose(&self.tool);
        if sum.is_finite() { Ok(()) } else { error("target", sum, "finite numbers") }
    }
}
