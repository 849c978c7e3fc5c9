//! How far the end of a motion is from its goal.

use std::f64::consts::TAU;

use nalgebra::Vector4;

use crate::feasibility::steering::shooting::query::Precision;
use crate::trajectory::drive::Planar;

/// What is missing at the end of a motion.
#[derive(Debug, Clone, Copy)]
pub(super) struct Miss {
    /// Goal less end in (x, y, ψ, κ); ψ in [−π, π].
    pub(super) error: Vector4<f64>,
    /// The largest of distance, |ψ| and |κ| in units of its precision; +∞ where one is no number.
    pub(super) residual: f64,
}

/// `end` held against `goal`.
///
/// x, y in the ground's own axes, m.
pub(super) fn miss(goal: &Planar, end: &Planar, precision: &Precision) -> Miss {
    let yaw = goal.yaw - end.yaw;
    let yaw = yaw - (yaw / TAU).round() * TAU;
    let error = Vector4::new(goal.x - end.x, goal.y - end.y, yaw, goal.curvature - end.curvature);
    let units = error.component_mul(&units(precision));
    let largest = libm::hypot(units[0], units[1]).max(units[2].abs()).max(units[3].abs());
    // `f64::max` passes over what is no number.
    let residual = if units.iter().any(|unit| unit.is_nan()) { f64::INFINITY } else { largest };
    Miss { error, residual }
}

/// What brings errors into units of the precision.
pub(super) fn units(precision: &Precision) -> Vector4<f64> {
    let position = 1.0 / precision.position;
    Vector4::new(position, position, 1.0 / precision.yaw, 1.0 / precision.curvature)
}
