//! The Crazyflie firmware's default position controller: P(I) on position, PI on velocity, to tilt and thrust.
//!
//! ```text
//! v*  = clip(2 e, v_max) horizontally,   clip(2 e + 0.5 ∫e dt, v_max) vertically          e = p_s − p, each axis
//! pitch, −roll = clip(25 (v* − v) + 1 ∫(v* − v) dt, 20)°                                  of x and y, yaw 0
//! u   = clip(25 (v*_z − v_z) + 15 ∫(v*_z − v_z) dt, 32.767),    thrust = 36 000 + 1000 u  of 65 535, from 20 000 on
//! ```
//!
//! Gains and limits: `platform_defaults_cf2.h` of crazyflie-firmware 2026.08, whose controller 1 (PID) this is. Its
//! thrust is a share of what the motors can do, and 36 000 is what hovers: so thrust here is the weight times 0.56 to
//! 1.82, which holds for any mass. The set point's velocity and acceleration are not used, as there.

use nalgebra::{Quaternion, UnitQuaternion, Vector3};

use crate::simulation::command::{FlightCommand, FlightState};

/// Velocity per position error, 1/s, and per integral of the vertical one, 1/s².
const POSITION: f64 = 2.0;
const HEIGHT_I: f64 = 0.5;
/// Tilt per velocity error, °/(m/s), and per integral of it, °/m.
const TILT_P: f64 = 25.0;
const TILT_I: f64 = 1.0;
/// Thousands of thrust units per vertical velocity error and per integral of it.
const THRUST_P: f64 = 25.0;
const THRUST_I: f64 = 15.0;
/// Largest tilt, °.
const MAX_TILT: f64 = 20.0;
/// Thrust units: in hover, the least and the most, all that there are.
const HOVER: f64 = 36_000.0;
const LEAST: f64 = 20_000.0;
const MOST: f64 = 65_535.0;
/// Largest correction of the thrust, thousands of units.
const MAX_CORRECTION: f64 = 32.767;

/// The controller with its memory.
#[derive(Debug, Clone)]
pub(super) struct Pid {
    /// N.
    weight: f64,
    /// Largest velocity asked for on each axis, m/s.
    max_velocity: f64,
    /// How many times as fast as the firmware's the loops are.
    bandwidth: f64,
    height: f64,
    velocity: Vector3<f64>,
}

impl Pid {
    /// For a robot of `weight` N that is asked for at most `max_velocity` m/s on each axis.
    pub(super) fn new(weight: f64, max_velocity: f64, bandwidth: f64) -> Self {
        Self { weight, max_velocity, bandwidth, height: 0.0, velocity: Vector3::zeros() }
    }

    /// One turn towards the set point `to`, m.
    pub(super) fn follow(&mut self, dt: f64, now: &FlightState, to: &Vector3<f64>) -> FlightCommand {
        let error = to - now.position;
        self.height += error.z * dt;
        let b = self.bandwidth;
        let asked = error * (POSITION * b) + Vector3::z() * (HEIGHT_I * b * b * self.height);
        let wanted = asked.map(|v| v.clamp(-self.max_velocity, self.max_velocity));
        let error = wanted - now.velocity;
        self.velocity += error * dt;
        let tilt = |axis: usize| {
            let degrees: f64 = TILT_P * b * error[axis] + TILT_I * b * b * self.velocity[axis];
            degrees.clamp(-MAX_TILT, MAX_TILT).to_radians()
        };
        let up = THRUST_P * b * error.z + THRUST_I * b * b * self.velocity.z;
        let units = HOVER + 1000.0 * up.clamp(-MAX_CORRECTION, MAX_CORRECTION);
        let thrust = self.weight * (units.clamp(LEAST, MOST) / HOVER);
        FlightCommand::Attitude { thrust, attitude: tilted(tilt(0), -tilt(1)) }
    }
}

/// Ry(pitch) Rx(roll), rad, yaw 0.
fn tilted(pitch: f64, roll: f64) -> UnitQuaternion<f64> {
    let (sp, cp) = libm::sincos(0.5 * pitch);
    let (sr, cr) = libm::sincos(0.5 * roll);
    UnitQuaternion::new_unchecked(Quaternion::new(cp * cr, cp * sr, sp * cr, -sp * sr))
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;

    fn asked(pid: &mut Pid, position: [f64; 3], velocity: [f64; 3], to: [f64; 3]) -> (f64, UnitQuaternion<f64>) {
        let now = FlightState {
            t: 0.0,
            position: position.into(),
            velocity: velocity.into(),
            attitude: UnitQuaternion::identity(),
            rates: Vector3::zeros(),
        };
        match pid.follow(0.01, &now, &to.into()) {
            FlightCommand::Attitude { thrust, attitude } => (thrust, attitude),
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn on_the_set_point_it_hovers() {
        let (thrust, attitude) = asked(&mut Pid::new(0.3, 1.1, 1.0), [1.0; 3], [0.0; 3], [1.0; 3]);
        assert_eq!((thrust, attitude), (0.3, UnitQuaternion::identity()));
    }

    /// Ahead is pitch up to 20°, to the left roll to the left; the axis of the thrust leans where it is to go.
    #[test]
    fn tilt_and_thrust_are_the_closed_forms_within_their_limits() {
        for (to, velocity, degrees) in [(0.1, 0.0, 25.0 * 0.2), (5.0, 1.0, 25.0 * 0.1), (5.0, 0.0, 20.0)] {
            let ahead = asked(&mut Pid::new(1.0, 1.1, 1.0), [0.0; 3], [velocity, 0.0, 0.0], [to, 0.0, 0.0]).1;
            let left = asked(&mut Pid::new(1.0, 1.1, 1.0), [0.0; 3], [0.0, velocity, 0.0], [0.0, to, 0.0]).1;
            let up = |q: UnitQuaternion<f64>| q * Vector3::z();
            // The integral of one turn adds less than 0.03°.
            let sine = f64::to_radians(degrees).sin();
            assert!((up(ahead).x - sine).abs() < 5e-4 && up(ahead).y == 0.0, "{to}: {:?}", up(ahead));
            assert!((up(left).y - sine).abs() < 5e-4 && up(left).x == 0.0, "{to}: {:?}", up(left));
        }
        for (climb, sink, units) in [(0.2, 0.0, 36.0 + 25.0 * 0.4), (9.0, 0.0, 36.0 + 25.0 * 1.1), (0.0, 9.0, 20.0)] {
            let thrust = asked(&mut Pid::new(1.0, 1.1, 1.0), [0.0, 0.0, sink], [0.0; 3], [0.0, 0.0, climb]).0;
            assert!((thrust - units / 36.0).abs() < 0.01, "{climb} {sink}: {thrust}");
        }
    }

    #[test]
    fn both_tilts_at_once_are_roll_before_pitch() {
        let attitude = tilted(0.3, -0.2);
        let expected = UnitQuaternion::from_euler_angles(-0.2, 0.3, 0.0);
        assert!(attitude.angle_to(&expected) < 1e-12);
    }
}
