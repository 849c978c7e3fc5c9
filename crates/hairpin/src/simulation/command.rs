//! What flies as its controllers see it: what is measured, and what the loops below them take.

use nalgebra::{Matrix3, Quaternion, UnitQuaternion, Vector3};

use super::controller::Controlled;
use crate::robot::quadrotor::Quadrotor;
use crate::trajectory::Profile;

/// What is measured of a flight: the plant's own state, exactly. World frame: z up.
///
/// No noise and no delay: what a controller makes of them is disturbed elsewhere.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FlightState {
    /// When, s.
    pub t: f64,
    /// Position, m, world frame.
    pub position: Vector3<f64>,
    /// Velocity, m/s, world frame.
    pub velocity: Vector3<f64>,
    /// `world_from_body`; the body's x axis points ahead, y to the left, z along the thrust. Of norm 1 within rounding.
    pub attitude: UnitQuaternion<f64>,
    /// Body rates p, q, r, rad/s.
    pub rates: Vector3<f64>,
}

/// What a controller asks of the inner loops until its next turn, as far as the rotors allow.
///
/// Every form ends in the rate loop, which has no bound of its own: what the rotors cannot do is given up by the mixer,
/// yaw first. The least thrust is 0.05 g in all of them, for without any there is no moment either.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum FlightCommand {
    /// Velocity, m/s, world frame, yaw 0, through the velocity loop of `stable-waypoint` and its tilt limit of 0.5 rad.
    Velocity(Vector3<f64>),
    /// Acceleration a, m/s², world frame, without drag: the thrust vector a + g e₃ at yaw 0.
    Acceleration(Vector3<f64>),
    /// A thrust vector with an attitude and feed-forward.
    Force(Demand),
    /// Attitude and collective thrust, N, along the body's z axis.
    Attitude {
        /// N.
        thrust: f64,
        /// `world_from_body`.
        attitude: UnitQuaternion<f64>,
    },
    /// Body rates and collective thrust, N, along the body's z axis; the attitude is the controller's own business.
    Rates {
        /// N.
        thrust: f64,
        /// p, q, r, rad/s.
        rates: Vector3<f64>,
    },
}

impl Controlled for Quadrotor {
    const DOES: &'static str = "it flies";
    const LOOPS: Option<&'static str> = Some("hairpin's inner loops");
    type State = FlightState;
    type Plan = Profile;
    type Command = FlightCommand;

    #[inline]
    fn is_finite(command: &FlightCommand) -> bool {
        let vector = |v: &Vector3<f64>| v.x.is_finite() & v.y.is_finite() & v.z.is_finite();
        let turned = |q: &UnitQuaternion<f64>| q.w.is_finite() & q.i.is_finite() & q.j.is_finite() & q.k.is_finite();
        match command {
            FlightCommand::Velocity(v) | FlightCommand::Acceleration(v) => vector(v),
            FlightCommand::Force(Demand { force, attitude, rates, angular_acceleration }) => {
                vector(force) & turned(attitude) & vector(rates) & vector(angular_acceleration)
            }
            FlightCommand::Attitude { thrust, attitude } => thrust.is_finite() & turned(attitude),
            FlightCommand::Rates { thrust, rates } => thrust.is_finite() & vector(rates),
        }
    }
}

/// A thrust vector, and the attitude that leads there: what outer loops ask for that mind both.
///
/// The part of the force along the thrust axis is given, so that a robot that is still turning does not push sideways.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Demand {
    /// Thrust per mass, world frame, m/s²: (0, 0, g) hovers.
    pub force: Vector3<f64>,
    /// `world_from_body` wanted.
    pub attitude: UnitQuaternion<f64>,
    /// Body rates fed forward, rad/s.
    pub rates: Vector3<f64>,
    /// Angular acceleration fed forward, body frame, rad/s².
    pub angular_acceleration: Vector3<f64>,
}

impl Demand {
    /// Thrust along `force` (m/s², with an upward part), yaw 0: the body's y axis is normal to the world's x axis.
    pub fn along(force: Vector3<f64>) -> Self {
        let attitude = attitude_of(&level_heading(&force));
        Self { force, attitude, rates: Vector3::zeros(), angular_acceleration: Vector3::zeros() }
    }
}

/// The columns x, y, z of the attitude whose z lies along `force` and whose yaw is 0; level without a force.
///
/// y = z × e_x/|z × e_x|, x = y × z; where z lies along ±e_x any y across it has yaw 0, and it is e_y, as it is of all
/// that lean a little less.
pub(super) fn level_heading(force: &Vector3<f64>) -> Matrix3<f64> {
    let axes = |z: Vector3<f64>| {
        let y = z.cross(&Vector3::x()).try_normalize(1e-9).unwrap_or_else(Vector3::y);
        Matrix3::from_columns(&[y.cross(&z), y, z])
    };
    force.try_normalize(1e-9).map_or_else(Matrix3::identity, axes)
}

/// A rotation matrix as a quaternion, by the largest of its four components (Shepperd 1978).
pub(super) fn attitude_of(r: &Matrix3<f64>) -> UnitQuaternion<f64> {
    let squares = [
        1.0 + r.m11 + r.m22 + r.m33,
        1.0 + r.m11 - r.m22 - r.m33,
        1.0 - r.m11 + r.m22 - r.m33,
        1.0 - r.m11 - r.m22 + r.m33,
    ];
    let largest = (1..4).fold(0, |best, i| if squares[i] > squares[best] { i } else { best });
    let root = squares[largest].sqrt();
    let k = 0.5 / root;
    let (wx, wy, wz) = ((r.m32 - r.m23) * k, (r.m13 - r.m31) * k, (r.m21 - r.m12) * k);
    let (xy, xz, yz) = ((r.m21 + r.m12) * k, (r.m13 + r.m31) * k, (r.m32 + r.m23) * k);
    let own = 0.5 * root;
    let [w, x, y, z] = [[own, wx, wy, wz], [wx, own, xy, xz], [wy, xy, own, yz], [wz, xz, yz, own]][largest];
    UnitQuaternion::new_unchecked(Quaternion::new(w, x, y, z))
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;

    /// Also along the axis that headings are told from, where a force would be no other than hovering.
    #[test]
    fn thrust_goes_along_the_force() {
        let tiny = 1e-10;
        for force in [[5.0, 0.0, 0.0], [-5.0, 0.0, 0.0], [1e10, 0.0, 9.8], [1.0, tiny, 0.0], [0.0, 3.0, 4.0]] {
            let force = Vector3::from(force);
            let Demand { attitude, .. } = Demand::along(force);
            assert!((attitude * Vector3::z() - force.normalize()).norm() < 1e-8, "{force}");
            assert!((attitude.norm() - 1.0).abs() < 1e-9, "{force}");
        }
        assert_eq!(level_heading(&Vector3::zeros()), Matrix3::identity());
        // What leans a little less turns the same way.
        let near = level_heading(&Vector3::new(1.0, 0.0, 1e-6)) - level_heading(&Vector3::x());
        assert!(near.norm() < 1e-5, "{near}");
    }
}
