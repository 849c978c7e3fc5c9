//! Position to velocity to acceleration to attitude: the cascade that all controllers but the geometric one share.
//!
//! ```text
//! v* = clip(K_p (p* − p), v_max)            e = v* − v
//! a* = K_v e + ∫ K_i e dt − K_d v̇_f         f = limit(a* + g e₃)        demand: thrust f, yaw 0
//! ```
//!
//! v̇_f is the measured velocity's derivative behind a low-pass of 50 ms. Gains ask for accelerations, not forces.

use nalgebra::Vector3;

use crate::robot::quadrotor::Quadrotor;
use crate::simulation::command::{Demand, FlightCommand, FlightState};
use crate::simulation::controller::{Controller, Fault, Reference};

/// Gains and limits of a cascade, per axis x, y, z. They ask for accelerations, so they hold for any mass.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Gains {
    /// Velocity per position error, 1/s.
    pub position: Vector3<f64>,
    /// Acceleration per velocity error, 1/s.
    pub velocity_p: Vector3<f64>,
    /// Per integral of the velocity error, 1/s².
    pub velocity_i: Vector3<f64>,
    /// Per derivative of the velocity error.
    pub velocity_d: Vector3<f64>,
    /// Whether the integral grows on while the force is at its limit: windup, the classical mistake.
    pub winds_up: bool,
    /// Largest speed asked for, m/s.
    pub max_speed: f64,
    /// Largest tilt asked for, rad.
    pub max_tilt: f64,
}

/// The cascade with its memory.
///
/// `max_speed` is the gains' or the robot's, whichever is less.
#[derive(Debug, Clone)]
pub(crate) struct Cascade {
    gains: Gains,
    envelope: Envelope,
    integral: Vector3<f64>,
    velocity: Option<Vector3<f64>>,
    derivative: Vector3<f64>,
}

/// Time constant of the filter on the derivative, s.
const DERIVATIVE_FILTER: f64 = 0.05;

impl Cascade {
    /// A cascade at rest.
    pub(crate) fn new(robot: &Quadrotor, gains: Gains) -> Self {
        let gains = Gains { max_speed: gains.max_speed.min(robot.max_speed), ..gains };
        Self {
            gains,
            envelope: Envelope::new(robot, gains.max_tilt),
            integral: Vector3::zeros(),
            velocity: None,
            derivative: Vector3::zeros(),
        }
    }

    /// The same with loops that are so many times as fast: in time t/b a gain of 1/s is b of them, one of 1/s² b².
    pub(crate) fn with_bandwidth(mut self, b: f64) -> Self {
        self.gains.position *= b;
        self.gains.velocity_p *= b;
        self.gains.velocity_i *= b * b;
        self
    }

    /// Forgets what was flown.
    pub(crate) fn restart(&mut self) {
        (self.integral, self.velocity, self.derivative) = (Vector3::zeros(), None, Vector3::zeros());
    }

    /// Velocity towards a position error of `error` m, its direction kept by the speed limit.
    pub(crate) fn approach(&self, error: &Vector3<f64>) -> Vector3<f64> {
        let wanted = self.gains.position.component_mul(error);
        let speed = wanted.norm();
        if speed > self.gains.max_speed { wanted * (self.gains.max_speed / speed) } else { wanted }
    }

    /// The demand that brings the measured velocity to `wanted` (m/s) within the envelope; the integral stops where
    /// the envelope binds, unless it winds up.
    ///
    /// One turn of `dt` s. The first one after a restart has no derivative.
    pub(crate) fn follow(&mut self, dt: f64, state: &FlightState, wanted: &Vector3<f64>) -> Demand {
        let g = &self.gains;
        let error = wanted - state.velocity;
        // The derivative is the measurement's: a waypoint that is switched must not kick.
        if let Some(before) = self.velocity.replace(state.velocity) {
            let slope = (before - state.velocity) / dt;
            self.derivative += (slope - self.derivative) * (dt / (DERIVATIVE_FILTER + dt));
        }
        let integral = self.integral + g.velocity_i.component_mul(&error) * dt;
        let acceleration = g.velocity_p.component_mul(&error) + integral + g.velocity_d.component_mul(&self.derivative);
        let (force, within) = self.envelope.limit(&acceleration);
        if within || g.winds_up {
            self.integral = integral;
        }
        Demand::along(force)
    }
}

impl Controller<Quadrotor> for Cascade {
    fn control(&mut self, dt: f64, now: &FlightState, to: &Reference<Quadrotor>) -> Result<FlightCommand, Fault> {
        let wanted = self.approach(&(to.target() - now.position));
        Ok(FlightCommand::Force(self.follow(dt, now, &wanted)))
    }
}

/// What force an outer loop may ask for: a tilt limit and a share of the robot's own thrust.
///
/// Per mass, m/s², so that it belongs to a robot.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Envelope {
    gravity: f64,
    tan_tilt: f64,
    least: f64,
    most: f64,
}

impl Envelope {
    /// Vertical force from 0.3 of the weight to 85 % of the rotors' thrust: the rest is left for moments.
    pub(crate) fn new(robot: &Quadrotor, max_tilt: f64) -> Self {
        let most = 0.85 * robot.max_thrust() / robot.mass;
        // The authors' clip at 20 N for 1 kg, near enough twice the weight, also tames bodies with enormous thrust.
        let most = most.min(2.04 * robot.gravity);
        let least = (0.3 * robot.gravity).min(most);
        Self { gravity: robot.gravity, tan_tilt: libm::tan(max_tilt), least, most }
    }

    /// Thrust per mass for an acceleration (m/s²), height before the plane, and whether it was given in full.
    ///
    /// f_z = clamp(a_z + g, least, most), |f_xy| ≤ min(f_z tan(tilt), √(most² − f_z²)).
    pub(crate) fn limit(&self, acceleration: &Vector3<f64>) -> (Vector3<f64>, bool) {
        let wanted = acceleration.z + self.gravity;
        let up = wanted.min(self.most).max(self.least);
        let horizontal = (acceleration.x * acceleration.x + acceleration.y * acceleration.y).sqrt();
        let room = (up * self.tan_tilt).min((self.most * self.most - up * up).max(0.0).sqrt());
        let scale = if horizontal > room { room / horizontal } else { 1.0 };
        let force = Vector3::new(acceleration.x * scale, acceleration.y * scale, up);
        (force, scale == 1.0 && up == wanted)
    }
}
