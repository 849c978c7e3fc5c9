//! `fixed-velocity`: one speed, shared over the axes by the direction to the waypoint, until the last one is reached.
//!
//! v* = speed · (p* − p)/|p* − p| until the last waypoint was reached, then K_p (p* − p). It never brakes for a
//! waypoint, so that corners are cut by as much as the velocity loop takes.

use nalgebra::Vector3;

use super::cascade::{Cascade, Gains};
use crate::robot::quadrotor::Quadrotor;
use crate::simulation::command::{FlightCommand, FlightState};
use crate::simulation::controller::{Controller, Fault, Reference};

/// Fixed by `tests/library/step_responses.rs`.
const GAINS: Gains = Gains {
    position: Vector3::new(0.9, 0.9, 0.9),
    velocity_p: Vector3::new(2.5, 2.5, 3.0),
    velocity_i: Vector3::new(0.1, 0.1, 0.3),
    velocity_d: Vector3::new(0.05, 0.05, 0.05),
    winds_up: false,
    max_speed: f64::INFINITY,
    max_tilt: 0.5,
};

/// See the file's first line.
#[derive(Debug, Clone)]
pub(crate) struct FixedVelocity {
    cascade: Cascade,
    speed: f64,
}

impl FixedVelocity {
    /// Flies at `speed` m/s, or the robot's top speed if that is less.
    pub(crate) fn new(robot: &Quadrotor, speed: f64, bandwidth: f64) -> Self {
        let cascade = Cascade::new(robot, Gains { max_speed: speed, ..GAINS }).with_bandwidth(bandwidth);
        Self { cascade, speed: speed.min(robot.max_speed) }
    }
}

impl Controller<Quadrotor> for FixedVelocity {
    fn control(&mut self, dt: f64, now: &FlightState, to: &Reference<Quadrotor>) -> Result<FlightCommand, Fault> {
        let error = to.target() - now.position;
        let wanted = if to.holds() {
            self.cascade.approach(&error)
        } else {
            error.try_normalize(1e-6).unwrap_or(Vector3::zeros()) * self.speed
        };
        Ok(FlightCommand::Force(self.cascade.follow(dt, now, &wanted)))
    }
}
