//! The ground's places as the flat solver sees them.

use nalgebra::Vector4;

use crate::feasibility::steering::shooting::{Goal, Query};
use crate::trajectory::drive::Planar;

/// The frame in which the flat solver works: the start's, turned into the direction of travel.
pub(super) struct Frame {
    pub(super) origin: Planar,
    pub(super) direction: f64,
}

impl Frame {
    /// `place` as the flat solver sees it; ψ is measured from the start's heading.
    ///
    /// (x, y, ψ, κ): m, m, rad (not wrapped), 1/m. ψ counts from the body's heading, x from the direction of travel, so
    /// that a crabbing body keeps its own ψ.
    pub(super) fn seen(&self, place: &Planar) -> Vector4<f64> {
        let (sin, cos) = libm::sincos(self.origin.yaw + self.direction);
        let (dx, dy) = (place.x - self.origin.x, place.y - self.origin.y);
        Vector4::new(cos * dx + sin * dy, cos * dy - sin * dx, place.yaw - self.origin.yaw, place.curvature)
    }

    /// An error of the ground's x and y in the axes of the frame.
    ///
    /// (m, m, rad, 1/m) in and out.
    pub(super) fn turned(&self, error: &Vector4<f64>) -> Vector4<f64> {
        let (sin, cos) = libm::sincos(self.origin.yaw + self.direction);
        Vector4::new(cos * error[0] + sin * error[1], cos * error[1] - sin * error[0], error[2], error[3])
    }
}

/// The flat solver's question for `goal` in its frame.
pub(super) fn question(from: &Planar, goal: &Vector4<f64>) -> Query {
    Query { start_curvature: from.curvature, goal: Goal { x: goal[0], y: goal[1], yaw: goal[2], curvature: goal[3] } }
}

/// `curvature` brought to ±`most`.
pub(super) fn within(curvature: f64, most: f64) -> f64 {
    curvature.min(most).max(-most)
}
