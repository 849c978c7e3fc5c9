//! A state that a leg begins or ends in.

use nalgebra::{Point3, Vector3};

/// A waypoint state: position, velocity, and the acceleration and jerk with which the robot is level there.
///
/// Value and three derivatives at both ends fix a polynomial of degree 7 in each axis. Snap is not zero there, so rotor
/// speeds jump at waypoints: rotor lag is outside the claim.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LegEnd {
    /// m, world frame.
    pub position: Point3<f64>,
    /// m/s.
    pub velocity: Vector3<f64>,
    /// −D(v)/m, m/s².
    pub acceleration: Vector3<f64>,
    /// −(∂D/∂v) a/m, m/s³.
    pub jerk: Vector3<f64>,
    /// Second time derivative of the drag there, N/s².
    ///
    /// World frame; kept so that rotor speeds at the end need no second look at the drag.
    pub(super) drag_second: Vector3<f64>,
}
