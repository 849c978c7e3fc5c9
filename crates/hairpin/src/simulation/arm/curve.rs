//! The shape of one move, sharp corners and all: joints in step, a straight line, an arc of a circle.

use std::f64::consts::PI;

use nalgebra::{Isometry3, Point3, Translation3, UnitQuaternion, Vector3};

use crate::math::rotation::{from_rotation_vector, rotation_vector};
use crate::robot::arm::Joints;
use crate::trajectory::program::Arc;

/// A turn of 1 rad counts as much as this many metres, where a zone is cut and along which the path's parameter runs:
/// the ratio of a zone's radius to its turn in common controllers, 10 mm to 1.5°.
pub(super) const METRES_PER_RADIAN: f64 = 0.01 / (1.5 * PI / 180.0);

/// One move over its share u, 0 … 1.
#[derive(Debug, Clone)]
pub(super) enum Curve {
    /// All joints in step.
    Joints {
        /// At 0.
        from: Joints,
        /// At 1.
        to: Joints,
    },
    /// The tool's point and orientation, `base_from_tcp`.
    Tool(ToolCurve),
}

/// R(u) = R₀ exp(u·turn); p(u) along a line or a circle.
#[derive(Debug, Clone)]
pub(super) struct ToolCurve {
    from: Isometry3<f64>,
    turn: Vector3<f64>,
    way: Way,
    /// Length of the way of the tool's point, m.
    pub(super) length: f64,
}

#[derive(Debug, Clone)]
enum Way {
    Line(Vector3<f64>),
    Circle(Arc),
}

impl ToolCurve {
    /// p(u) = p₀ + u (p₁ − p₀), the turn about one axis from R₀ to R₁ the shorter way.
    pub(super) fn line(from: Isometry3<f64>, to: &Isometry3<f64>) -> Self {
        let shift = to.translation.vector - from.translation.vector;
        let turn = rotation_vector(&(from.rotation.inverse() * to.rotation));
        Self { from, turn, length: shift.norm(), way: Way::Line(shift) }
    }

    /// The arc from `from` through `via` to `to`; `None` where the three are in line or coincide.
    pub(super) fn arc(from: Isometry3<f64>, via: &Point3<f64>, to: &Isometry3<f64>) -> Option<Self> {
        let start = Point3::from(from.translation.vector);
        let arc = Arc::through(&start, via, &Point3::from(to.translation.vector))?;
        let turn = rotation_vector(&(from.rotation.inverse() * to.rotation));
        Some(Self { from, turn, length: arc.length(), way: Way::Circle(arc) })
    }

    /// Angle of the turn, rad.
    pub(super) fn turned(&self) -> f64 {
        self.turn.norm()
    }

    /// Angle of the arc, rad; 0 of a line.
    pub(super) fn bent(&self) -> f64 {
        match &self.way {
            Way::Line(_) => 0.0,
            Way::Circle(arc) => arc.angle,
        }
    }

    /// Without a turn the orientation itself, to the bit.
    fn rotation(&self, u: f64) -> UnitQuaternion<f64> {
        if self.turn == Vector3::zeros() {
            self.from.rotation
        } else {
            self.from.rotation * from_rotation_vector(&(self.turn * u))
        }
    }

    /// `base_from_tcp` at the share `u`.
    pub(super) fn at(&self, u: f64) -> Isometry3<f64> {
        let place = match &self.way {
            Way::Line(shift) => self.from.translation.vector + shift * u,
            Way::Circle(arc) => arc.point(u).coords,
        };
        Isometry3::from_parts(Translation3::from(place), self.rotation(u))
    }

    /// `base_from_tcp` where this move's share `u` and the next move's share `v` add up about their common corner: with
    /// u = 1 − f(1 − w)², v = g w² a parabola between two lines.
    ///
    /// ```text
    /// p = p₁(u) + p₂(v) − C,   R = R₁(u) R_C⁻¹ R₂(v)
    /// ```
    ///
    /// C and R_C are where the next move begins. At w = 0 it is this move's pose, at w = 1 the next one's.
    pub(super) fn blend(&self, u: f64, next: &Self, v: f64) -> Isometry3<f64> {
        let (a, b) = (self.at(u), next.at(v));
        let place = a.translation.vector + b.translation.vector - next.from.translation.vector;
        Isometry3::from_parts(Translation3::from(place), a.rotation * next.from.rotation.inverse() * b.rotation)
    }
}

/// Joints at the share `u` between two stands.
pub(super) fn between(from: &Joints, to: &Joints, u: f64) -> Joints {
    std::array::from_fn(|k| from[k] + u * (to[k] - from[k]))
}

/// The largest difference of an angle, rad.
pub(super) fn largest_turn(from: &Joints, to: &Joints) -> f64 {
    from.iter().zip(to).map(|(a, b)| (b - a).abs()).fold(0.0, f64::max)
}
