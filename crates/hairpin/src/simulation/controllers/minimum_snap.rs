//! `minimum-snap`: a point moves along the minimum-snap polynomial, and the waypoint cascade follows the point.

use nalgebra::Vector3;

use super::cascade::{Cascade, Gains};
use super::curve::Curve;
use super::{Controller, Demand, Measured, Schedule};
use crate::robot::quadrotor::Quadrotor;

/// Fixed by `tests/step_responses.rs`.
const GAINS: Gains = Gains {
    position: Vector3::new(1.0, 1.0, 1.0),
    velocity_p: Vector3::new(3.0, 3.0, 3.5),
    velocity_i: Vector3::new(0.0, 0.0, 0.3),
    velocity_d: Vector3::new(0.0, 0.0, 0.0),
    winds_up: false,
    max_speed: f64::INFINITY,
    max_tilt: 0.8,
};

/// The point waits while it is farther ahead than this, m (the paper's authors' set point advances inside 3 m).
const LEASH: f64 = 3.0;

/// See the file's first line. The point's velocity is fed forward to the velocity loop.
#[derive(Debug, Clone)]
pub(crate) struct MinimumSnap {
    cascade: Cascade,
    curve: Curve,
}

impl MinimumSnap {
    /// Follows `curve` from its start.
    pub(crate) fn new(robot: &Quadrotor, curve: Curve) -> Self {
        Self { cascade: Cascade::new(robot, GAINS), curve }
    }
}

impl Controller for MinimumSnap {
    fn control(&mut self, dt: f64, measured: &Measured) -> Demand {
        let [position, velocity, ..] = self.curve.sample();
        let error = position - measured.position;
        let waits = error.norm() >= LEASH;
        if !waits {
            self.curve.advance(dt);
        }
        let moving = if waits { Vector3::zeros() } else { velocity };
        let wanted = self.cascade.approach(&error) + moving;
        self.cascade.follow(dt, measured, &wanted)
    }

    fn schedule(&self) -> Option<Schedule> {
        Some(self.curve.schedule())
    }
}
