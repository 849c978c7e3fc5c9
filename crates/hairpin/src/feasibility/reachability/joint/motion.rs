//! The three moves: straight, in joints, on an arc.

use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3};

use super::circle::Circle;
use crate::math::rotation::{from_rotation_vector, rotation_vector};
use crate::robot::arm::{Joints, Sweep};

/// A move of the tool over s in [0, 1], in the base.
///
/// R(s) = R₀ exp(s · turn); p(s) along a line or a circle; joint moves q₀ + s (q₁ − q₀).
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Motion {
    /// The tool's point on a straight line, turning about one axis: MoveL.
    Linear {
        /// `base_from_tcp` at s = 0.
        start: Isometry3<f64>,
        /// How far the point moves, m.
        shift: Vector3<f64>,
        /// How it turns, in the tool's frame, rad.
        turn: Vector3<f64>,
    },
    /// Every joint in proportion: MoveJ and MoveAbsJ.
    Joint {
        /// Angles at s = 0, rad.
        start: Joints,
        /// Angles at s = 1, rad.
        end: Joints,
    },
    /// The tool's point on an arc, turning about one axis: MoveC.
    Circular {
        /// `base_from_tcp` at s = 0.
        start: Isometry3<f64>,
        /// Where the point goes.
        circle: Circle,
        /// How it turns, in the tool's frame, rad.
        turn: Vector3<f64>,
    },
}

impl Motion {
    /// The straight move between two poses `base_from_tcp`.
    ///
    /// The shorter of the two turns; of a half turn either.
    pub fn linear(start: &Isometry3<f64>, end: &Isometry3<f64>) -> Self {
        let shift = end.translation.vector - start.translation.vector;
        Self::Linear { start: *start, shift, turn: turn(&start.rotation, &end.rotation) }
    }

    /// The move on a circle; its end takes the orientation of `end`.
    ///
    /// The circle must begin at the start's point.
    pub fn circular(start: &Isometry3<f64>, circle: Circle, end: &UnitQuaternion<f64>) -> Self {
        Self::Circular { start: *start, circle, turn: turn(&start.rotation, end) }
    }

    /// `base_from_tcp` at `s`; `None` of joint moves, whose pose is the arm's business.
    pub fn pose(&self, s: f64) -> Option<Isometry3<f64>> {
        let (start, shift, turn) = match self {
            Self::Joint { .. } => return None,
            Self::Linear { start, shift, turn } => (start, shift * s, turn),
            Self::Circular { start, circle, turn } => (start, circle.at(s) - start.translation.vector, turn),
        };
        let rotation = start.rotation * from_rotation_vector(&(turn * s));
        Some(Isometry3::from_parts(Translation3::from(start.translation.vector + shift), rotation))
    }

    /// Length of the way of the tool's point, m, and angle, rad, both per unit of s; 0 of joint moves.
    ///
    /// Constant over the move, for both its translation and its rotation run evenly in s.
    pub fn sweep(&self, tcp: &Isometry3<f64>) -> Sweep {
        let (speed, turn) = match self {
            Self::Joint { .. } => (0.0, 0.0),
            Self::Linear { shift, turn, .. } => (shift.norm(), turn.norm()),
            Self::Circular { circle, turn, .. } => (circle.length(), turn.norm()),
        };
        Sweep { speed, turn, tcp: *tcp }
    }
}

/// Rotation vector in the frame of `from`, of at most π.
fn turn(from: &UnitQuaternion<f64>, to: &UnitQuaternion<f64>) -> Vector3<f64> {
    rotation_vector(&(from.inverse() * to))
}
