//! From a set point with velocity and acceleration to a thrust: P on position, PID on velocity, and what gives way.
//!
//! ```text
//! v* = v_s + K_p (p_s − p)                   cut horizontally in v_s first, so that corrections are kept
//! a* = a_s + K_v (v* − v) + ∫ K_i (v* − v) dt − K_d v̇_f
//! tilt from (a*_x, a*_y, g), at most 45°;    f_z = a*_z + g, at least 0.12 of all thrust along the body
//! f_z ≤ √(f_max² − min(f_xy, margin)²),      then f_xy ≤ √(f_max² − f_z²)
//! ```
//!
//! All in thrust per mass. v̇_f is behind a low-pass of 5 Hz. The horizontal integral is led back while the thrust
//! gives less than was asked (tracking anti-windup: Rundqwist, 1990), the vertical one waits while its limit binds.

use nalgebra::{Vector2, Vector3};

use super::parameters as px4;
use crate::math::jerk_limit::JerkLimited;
use crate::math::power::square;
use crate::robot::quadrotor::Quadrotor;
use crate::simulation::command::FlightState;

/// Gains by axis, all three.
const POSITION: Vector3<f64> = Vector3::new(px4::MPC_XY_P, px4::MPC_XY_P, px4::MPC_Z_P);
const VELOCITY_P: Vector3<f64> = Vector3::new(px4::MPC_XY_VEL_P_ACC, px4::MPC_XY_VEL_P_ACC, px4::MPC_Z_VEL_P_ACC);
const VELOCITY_I: Vector3<f64> = Vector3::new(px4::MPC_XY_VEL_I_ACC, px4::MPC_XY_VEL_I_ACC, px4::MPC_Z_VEL_I_ACC);
const VELOCITY_D: Vector3<f64> = Vector3::new(px4::MPC_XY_VEL_D_ACC, px4::MPC_XY_VEL_D_ACC, px4::MPC_Z_VEL_D_ACC);
/// How fast saturation leads the integral back: 2 over the proportional gain.
///
/// s; divided by the bandwidth, as the gain grows with it.
const LED_BACK: f64 = 2.0 / px4::MPC_XY_VEL_P_ACC;

/// Position and velocity control with its memory.
#[derive(Debug, Clone)]
pub(super) struct Tracking {
    gravity: f64,
    /// Thrust per mass, m/s²: all there is.
    all: f64,
    /// 1 at 45°.
    tan_tilt: f64,
    /// How many times as fast as by the parameters the loops are.
    ///
    /// b scales K_p and K_v, b² K_i; K_d stays, as it is of the velocity's own course.
    bandwidth: f64,
    /// m/s², world frame; the vertical part within ± g.
    integral: Vector3<f64>,
    /// Of the turn before; without one nothing is differentiated.
    velocity: Option<Vector3<f64>>,
    /// v̇_f, m/s².
    acceleration: Vector3<f64>,
}

impl Tracking {
    /// At rest.
    pub(super) fn new(robot: &Quadrotor, bandwidth: f64) -> Self {
        Self {
            gravity: robot.gravity,
            all: robot.max_thrust() / robot.mass,
            tan_tilt: libm::tan(px4::MPC_TILTMAX_AIR),
            bandwidth,
            integral: Vector3::zeros(),
            velocity: None,
            acceleration: Vector3::zeros(),
        }
    }

    /// Thrust per mass, m/s², world frame, for the next `dt` s.
    ///
    /// O(1). The integral is led on after the thrust is known, with what the limits left of the error.
    pub(super) fn thrust(&mut self, dt: f64, now: &FlightState, point: &JerkLimited) -> Vector3<f64> {
        let b = self.bandwidth;
        let correction = (POSITION * b).component_mul(&(point.position - now.position));
        let level = cut_in_second(&correction.xy(), &point.velocity.xy(), px4::MPC_XY_VEL_MAX);
        let climb = (point.velocity.z + correction.z).clamp(-px4::VEL_MAX_DN, px4::MPC_Z_VEL_MAX_UP);
        let mut error = Vector3::new(level.x, level.y, climb) - now.velocity;
        if let Some(before) = self.velocity.replace(now.velocity) {
            let corner = dt * std::f64::consts::TAU * px4::MPC_VELD_LP;
            self.acceleration += ((now.velocity - before) / dt - self.acceleration) * (corner / (1.0 + corner));
        }
        let wanted = point.acceleration + (VELOCITY_P * b).component_mul(&error) + self.integral
            - VELOCITY_D.component_mul(&self.acceleration);
        let force = self.limit(&wanted, &mut error);
        self.integral += (VELOCITY_I * (b * b)).component_mul(&error) * dt;
        self.integral.z = self.integral.z.clamp(-self.gravity, self.gravity);
        force
    }

    /// The thrust for an acceleration, as far as there is one, and what of `error` (m/s) the integral may learn from.
    ///
    /// In this order: tilt, least thrust, then height before way. The answer's norm lies in [0.12, 1] of all thrust,
    /// its horizontal part within tan 45° of its vertical one.
    fn limit(&self, wanted: &Vector3<f64>, error: &mut Vector3<f64>) -> Vector3<f64> {
        let (least, most) = (px4::MPC_THR_MIN * self.all, px4::MPC_THR_MAX * self.all);
        // The tilt is that of level flight: what climbs or sinks does not tilt more or less for it.
        let asked = wanted.xy() / self.gravity;
        let tilt = asked * (self.tan_tilt / asked.norm().max(self.tan_tilt));
        let along = (1.0 + tilt.norm_squared()).sqrt();
        let up = (wanted.z + self.gravity).max(least / along);
        if (up * along <= least && error.z < 0.0) || (up >= most && error.z > 0.0) {
            error.z = 0.0;
        }
        let level = tilt * up;
        let kept = level.norm().min(px4::MPC_THR_XY_MARG * self.all);
        let up = up.min((square(most) - square(kept)).sqrt());
        let room = (square(most) - square(up)).max(0.0).sqrt();
        let level = level * (room / level.norm().max(room).max(f64::MIN_POSITIVE));
        if wanted.xy().norm_squared() > level.norm_squared() {
            let missing = (wanted.xy() - level) * (LED_BACK / self.bandwidth);
            error.x -= missing.x;
            error.y -= missing.y;
        }
        Vector3::new(level.x, level.y, up)
    }
}

/// a + b, cut to `most` by shortening b; a alone, cut, where that does not suffice.
///
/// The larger root of |a + s u|² = most², O(1).
fn cut_in_second(a: &Vector2<f64>, b: &Vector2<f64>, most: f64) -> Vector2<f64> {
    let sum = a + b;
    if sum.norm() <= most {
        return sum;
    }
    if a.norm() >= most {
        return a * (most / a.norm());
    }
    // |a + s u| = most along the direction u of b, s > 0.
    let u = b.normalize();
    let m = u.dot(a);
    a + u * ((m * m + square(most) - a.norm_squared()).sqrt() - m)
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;
    use crate::simulation::tests::{flightgoggles, shipped};
    use nalgebra::UnitQuaternion;

    fn at(position: Vector3<f64>, velocity: Vector3<f64>) -> FlightState {
        FlightState { t: 0.0, position, velocity, attitude: UnitQuaternion::identity(), rates: Vector3::zeros() }
    }

    #[test]
    fn on_its_set_point_it_hovers_and_follows_what_is_fed_forward() {
        for robot in shipped() {
            let mut tracking = Tracking::new(&robot, 1.0);
            let here = Vector3::new(1.0, 2.0, 3.0);
            let force = tracking.thrust(0.01, &at(here, Vector3::zeros()), &JerkLimited::at_rest(here));
            assert_eq!(force, Vector3::z() * robot.gravity, "{}", robot.name);
            let v = Vector3::new(2.0, -1.0, 0.5);
            let moving = JerkLimited { position: here, velocity: v, acceleration: Vector3::new(0.3, 0.2, 0.0) };
            let force = Tracking::new(&robot, 1.0).thrust(0.01, &at(here, v), &moving);
            assert!((force - Vector3::new(0.3, 0.2, robot.gravity)).norm() < 1e-12, "{}: {force}", robot.name);
        }
    }

    /// Asked for anything: the tilt, the least and the most thrust hold, and the vertical comes before the horizontal.
    #[test]
    fn what_cannot_be_had_is_given_up_in_order() {
        let robot = flightgoggles();
        let tracking = Tracking::new(&robot, 1.0);
        let all = robot.max_thrust() / robot.mass;
        for x in [0.0, 1.0, 9.0, 30.0, 200.0] {
            for z in [-60.0, -9.0, 0.0, 5.0, 20.0, 80.0] {
                let mut error = Vector3::new(1.0, 0.0, z);
                let force = tracking.limit(&Vector3::new(x, 0.0, z), &mut error);
                let told = format!("asked {x} {z}: {force}");
                assert!(force.norm() <= all * (1.0 + 1e-12) && force.norm() >= 0.12 * all * (1.0 - 1e-12), "{told}");
                assert!(force.x >= 0.0 && force.x <= force.z * (1.0 + 1e-12), "{told}");
                let up = z + robot.gravity;
                if (0.12 * all..0.95 * all).contains(&up) {
                    assert!((force.z - up).abs() < 1e-12, "height is kept: {told}");
                }
                // Nothing is learnt of what the thrust cannot give.
                assert!(error.z == z || error.z == 0.0, "{told}");
                assert!(x <= force.x * (1.0 + 1e-12) || error.x < 1.0, "{told}");
            }
        }
    }

    #[test]
    fn a_cut_leaves_the_correction() {
        let (a, b) = (Vector2::new(3.0, 0.0), Vector2::new(0.0, 20.0));
        let cut = cut_in_second(&a, &b, 5.0);
        assert!((cut - Vector2::new(3.0, 4.0)).norm() < 1e-12, "{cut}");
        assert_eq!(cut_in_second(&(a * 4.0), &b, 5.0), Vector2::new(5.0, 0.0));
        assert_eq!(cut_in_second(&a, &(b * 0.1), 5.0), Vector2::new(3.0, 2.0));
    }
}
