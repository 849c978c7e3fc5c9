//! What sails as its controllers see it: what is measured, and the forces that the thrusters are asked for.

use nalgebra::{Vector2, Vector3};

use crate::robot::boat::Boat;
use crate::simulation::controller::Controlled;
use crate::trajectory::Profile;

/// What is measured of a boat: the plant's own state, with noise where the run asks for it. World frame: x east, y
/// north; body frame: x ahead, y to port.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BoatState {
    /// When, s.
    pub t: f64,
    /// Position of the body's origin, m, world frame.
    pub position: Vector2<f64>,
    /// ψ, rad, from east to north, not wrapped.
    pub heading: f64,
    /// u, v, r over ground: m/s ahead and to port, rad/s.
    pub velocity: Vector3<f64>,
    /// The same through the water.
    pub through_water: Vector3<f64>,
}

impl BoatState {
    /// Velocity over ground, m/s, world frame.
    pub fn over_ground(&self) -> Vector2<f64> {
        turned(&Vector2::new(self.velocity.x, self.velocity.y), self.heading)
    }
}

/// `v` (body frame) in the world of a body that heads for `heading`.
pub(super) fn turned(v: &Vector2<f64>, heading: f64) -> Vector2<f64> {
    let (sin, cos) = libm::sincos(heading);
    Vector2::new(cos * v.x - sin * v.y, sin * v.x + cos * v.y)
}

/// What a controller asks of the thrusters until its next turn; they give it with their lag, as far as they can.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct BoatCommand {
    /// X, N, ahead.
    pub surge: f64,
    /// Y, N, to port.
    pub sway: f64,
    /// N, N·m, to port.
    pub yaw: f64,
}

impl Controlled for Boat {
    const DOES: &'static str = "it sails";

    type State = BoatState;
    /// x, y and, in place of z, ψ.
    type Plan = Profile;
    type Command = BoatCommand;

    fn is_finite(command: &BoatCommand) -> bool {
        let BoatCommand { surge, sway, yaw } = *command;
        [surge, sway, yaw].iter().all(|number| number.is_finite())
    }
}

impl From<Vector3<f64>> for BoatCommand {
    /// Of (X, Y, N).
    fn from(tau: Vector3<f64>) -> Self {
        Self { surge: tau.x, sway: tau.y, yaw: tau.z }
    }
}
