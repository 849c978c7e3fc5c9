//! `geometric`: SE(3) tracking of a timed reference, what a modern stack flies.
//!
//! Lee, Leok, McClamroch, "Geometric tracking control of a quadrotor UAV on SE(3)" (CDC 2010); Mellinger, Kumar,
//! "Minimum snap trajectory generation and control for quadrotors" (ICRA 2011). The reference's acceleration gives
//! the force, its jerk the rates, its snap the angular accelerations, all with the robot's drag in still air.
//!
//! ```text
//! f* = a_r + g e₃ + D(v_r)/m + sat(k_p (p_r − p) + k_v (v_r − v), g)      R* : z along f*, yaw 0
//! ω_ff, ω̇_ff from f_r, ḟ_r, f̈_r of the reference alone
//! ```

use nalgebra::{Matrix3, Vector3};

use super::curve::{Curve, NOT_RESET, Pace, Sample, SegmentTimes};
use crate::robot::quadrotor::Quadrotor;
use crate::simulation::command::{Demand, FlightCommand, FlightState, attitude_of, level_heading};
use crate::simulation::controller::{Controller, Fault, Reference, Schedule};

/// Acceleration per position error, 1/s², and per velocity error, 1/s. Fixed by `tests/library/step_responses.rs`.
const POSITION: f64 = 6.0;
const VELOCITY: f64 = 4.0;
/// Largest correction of the acceleration, in g: a tracker far from its reference must not throw itself over.
const MAX_CORRECTION: f64 = 1.0;

/// Time between two turns, s.
const PERIOD: f64 = 0.004;

/// See the file's first line.
///
/// Its clock runs with time, not with the robot: who is late falls behind, and is judged for it.
#[derive(Debug, Clone)]
pub(crate) struct Geometric {
    pace: Pace,
    curve: Option<Curve>,
    gravity: f64,
    /// Drag over mass, linear and quadratic.
    drag: (f64, f64),
    most: f64,
    /// Per position and velocity error, 1/s² and 1/s.
    gains: (f64, f64),
}

impl Geometric {
    /// Tracks the planned profile, or a curve with leg times by `rule` where there is none.
    pub(crate) fn new(robot: &Quadrotor, rule: SegmentTimes, bandwidth: f64) -> Self {
        Self {
            pace: Pace::new(robot, rule),
            curve: None,
            gravity: robot.gravity,
            drag: (robot.drag_linear / robot.mass, robot.drag_quadratic / robot.mass),
            most: robot.max_thrust() / robot.mass,
            gains: (POSITION * bandwidth * bandwidth, VELOCITY * bandwidth),
        }
    }
}

impl Controller<Quadrotor> for Geometric {
    fn period(&self) -> Option<f64> {
        Some(PERIOD)
    }

    fn reset(&mut self, reference: &Reference<Quadrotor>) -> Result<(), Fault> {
        self.curve = Some(match reference.plan.and_then(Curve::new) {
            Some(curve) => curve,
            None => Curve::through(reference.waypoints, &self.pace)?,
        });
        Ok(())
    }

    fn control(&mut self, dt: f64, now: &FlightState, _to: &Reference<Quadrotor>) -> Result<FlightCommand, Fault> {
        let curve = self.curve.as_mut().ok_or(NOT_RESET)?;
        let sample = curve.sample();
        curve.advance(dt);
        let [force, slope, curvature] = thrust_and_derivatives(&sample, self.gravity, self.drag);
        let (position, velocity) = self.gains;
        let error = (sample[0] - now.position) * position + (sample[1] - now.velocity) * velocity;
        let correction = error * (MAX_CORRECTION * self.gravity / error.norm().max(MAX_CORRECTION * self.gravity));
        let mut wanted = force + correction;
        // Below the horizon the attitude would turn over: keep some thrust up, and no more than there is.
        wanted.z = wanted.z.max(0.2 * self.gravity);
        wanted *= (self.most / wanted.norm()).min(1.0);
        let attitude = attitude_of(&level_heading(&wanted));
        let (rates, angular_acceleration) = body_rates(&force, &slope, &curvature, &level_heading(&force));
        Ok(FlightCommand::Force(Demand { force: wanted, attitude, rates, angular_acceleration }))
    }

    fn schedule(&self) -> Option<Schedule> {
        self.curve.as_ref().map(Curve::schedule)
    }
}

/// f = a + g e₃ + D(v)/m with D/m = (c₁ + c₂‖v‖) v, and its first two time derivatives.
///
/// m/s², m/s³, m/s⁴. At rest quadratic drag and its derivatives count as none.
fn thrust_and_derivatives(sample: &Sample, gravity: f64, (linear, quadratic): (f64, f64)) -> [Vector3<f64>; 3] {
    let [_, v, a, j, s] = sample;
    let mut force = a + Vector3::z() * gravity + v * linear;
    let (mut slope, mut curvature) = (j + a * linear, s + j * linear);
    let speed = v.norm();
    if quadratic > 0.0 && speed > 1e-6 {
        let rate = v.dot(a) / speed;
        let second = (a.norm_squared() + v.dot(j) - rate * rate) / speed;
        force += v * (quadratic * speed);
        slope += (a * speed + v * rate) * quadratic;
        curvature += (j * speed + a * (2.0 * rate) + v * second) * quadratic;
    }
    [force, slope, curvature]
}

/// Body rates and angular acceleration of an attitude whose z axis follows f and whose yaw stays 0.
fn body_rates(
    force: &Vector3<f64>,
    slope: &Vector3<f64>,
    curvature: &Vector3<f64>,
    axes: &Matrix3<f64>,
) -> (Vector3<f64>, Vector3<f64>) {
    let norm = force.norm();
    let (x, y, z) = (axes.column(0), axes.column(1), axes.column(2));
    // Free fall and a vertical body x axis have no rates to feed forward.
    if norm < 1.0 || x.x.abs() < 0.1 {
        return (Vector3::zeros(), Vector3::zeros());
    }
    // ż = (ḟ − z ḟ_z)/‖f‖ and z̈ by differentiating once more.
    let along = slope.dot(&z);
    let z_dot = (slope - z * along) / norm;
    let along_dot = curvature.dot(&z) + slope.dot(&z_dot);
    let z_ddot = (curvature - z_dot * (2.0 * along) - z * along_dot) / norm;
    // ż = ω × z; yaw 0 means ẏ·e₁ = 0, so r (x·e₁) = p (z·e₁).
    let (p, q) = (-z_dot.dot(&y), z_dot.dot(&x));
    let r = p * z.x / x.x;
    let w = x * p + y * q + z * r;
    let rest = z_ddot - w.cross(&z_dot);
    let (p_dot, q_dot) = (-rest.dot(&y), rest.dot(&x));
    let r_dot = (p_dot * z.x + p * z_dot.x + r * q * z.x) / x.x;
    (Vector3::new(p, q, r), Vector3::new(p_dot, q_dot, r_dot))
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;
    use crate::trajectory::ProfileLeg;

    /// Rates and angular accelerations against differences of the attitudes along a curve.
    #[test]
    fn feed_forward_is_the_derivative_of_the_attitude() {
        let mut leg = ProfileLeg { duration: 2.0, coefficients: [[0.0; 8]; 3] };
        leg.coefficients[0] = [0.0, 1.0, 2.0, -1.0, 0.4, 0.1, 0.0, 0.0];
        leg.coefficients[1] = [0.0, -2.0, 0.5, 0.8, -0.6, 0.0, 0.05, 0.0];
        leg.coefficients[2] = [0.0, 0.5, 1.0, 0.3, 0.2, -0.1, 0.0, 0.01];
        let at = |t: f64| {
            let sample = [0, 1, 2, 3, 4].map(|order| leg.derivative(t, order));
            let [f, df, ddf] = thrust_and_derivatives(&sample, 9.81, (0.05, 0.1));
            let axes = level_heading(&f);
            (axes, body_rates(&f, &df, &ddf, &axes))
        };
        for i in 1..19 {
            let (t, h) = (0.1 * i as f64, 1e-5);
            let ((before, (w0, _)), (axes, (w, dw)), (after, (w1, _))) = (at(t - h), at(t), at(t + h));
            let spin = axes.transpose() * (after - before) / (2.0 * h);
            let numeric = Vector3::new(spin.m32, spin.m13, spin.m21);
            assert!((numeric - w).norm() < 1e-6, "t = {t}: {numeric} {w}");
            assert!(((w1 - w0) / (2.0 * h) - dw).norm() < 1e-5, "t = {t}: {dw}");
        }
    }
}
