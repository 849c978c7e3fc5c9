//! `anafi`: flies to a waypoint and brakes for it, within the Anafi's limits. A stand-in: the real one is closed.
//!
//! Its limits are chosen, not measured, in the range of small camera drones: 15 m/s horizontally, 4 m/s vertically, 35°
//! of tilt, and a constant deceleration that leaves half of the tilt in hand.
//!
//! v = clip(K_p e) · min(1, √(2 b |e|)/|v|, v_z,max/|v_z|), b = 3 m/s²: the speed from which constant braking just
//! stops at the waypoint; then the cascade's velocity loop.

use nalgebra::Vector3;

use super::cascade::{Cascade, Gains};
use crate::robot::quadrotor::Quadrotor;
use crate::simulation::command::{FlightCommand, FlightState};
use crate::simulation::controller::{Controller, Fault, Reference};

/// Fixed by `tests/library/step_responses.rs`.
const GAINS: Gains = Gains {
    position: Vector3::new(1.0, 1.0, 1.0),
    velocity_p: Vector3::new(2.5, 2.5, 3.0),
    velocity_i: Vector3::new(0.1, 0.1, 0.3),
    velocity_d: Vector3::new(0.05, 0.05, 0.05),
    winds_up: false,
    max_speed: 15.0,
    max_tilt: 0.61,
};
/// Largest climb and sink rate, m/s.
const MAX_VERTICAL_SPEED: f64 = 4.0;
/// Braking deceleration, m/s².
const BRAKING: f64 = 3.0;

/// See the file's first line.
#[derive(Debug, Clone)]
pub(crate) struct Anafi {
    cascade: Cascade,
}

impl Anafi {
    /// The controller for a robot, which may be slower than an Anafi.
    pub(crate) fn new(robot: &Quadrotor, bandwidth: f64) -> Self {
        Self { cascade: Cascade::new(robot, GAINS).with_bandwidth(bandwidth) }
    }
}

impl Controller<Quadrotor> for Anafi {
    fn control(&mut self, dt: f64, now: &FlightState, to: &Reference<Quadrotor>) -> Result<FlightCommand, Fault> {
        let error = to.target() - now.position;
        let wanted = self.cascade.approach(&error);
        let speed = wanted.norm();
        // v² = 2 b d: the speed from which the rest of the way suffices to stop.
        let stopping = (2.0 * BRAKING * error.norm()).sqrt();
        let vertical = wanted.z.abs();
        let scale = (stopping / speed.max(1e-9)).min(MAX_VERTICAL_SPEED / vertical.max(1e-9)).min(1.0);
        Ok(FlightCommand::Force(self.cascade.follow(dt, now, &(wanted * scale))))
    }
}
