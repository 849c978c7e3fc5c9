//! The equations of a quadrotor: rotor mixing, the rigid body with a quaternion, and the 12-state interface.
//!
//! 13 numbers inside, 12 at the doors: Euler angles are singular at θ = ±90°, which sampled rotor speeds do reach,
//! quaternions nowhere.

use nalgebra::{Matrix4, SVector, Vector3, Vector4};

use super::Quadrotor;
use crate::math::rotation;

/// x, y, z, qw, qx, qy, qz (`world_from_body`), vx, vy, vz (world), p, q, r (body), SI units.
///
/// m, m/s, rad/s; |(qw, qx, qy, qz)| = 1 after each step.
pub type QuadrotorState = SVector<f64, 13>;

/// The interface form x, y, z, φ, θ, ψ, vx, vy, vz, p, q, r. Singular at θ = ±90°: there roll is given as 0.
///
/// m, rad, m/s (world), rad/s (body): the paper's order.
pub type EulerState = SVector<f64, 12>;

/// Level, at rest, at the origin.
pub fn level_rest() -> QuadrotorState {
    let mut state = QuadrotorState::zeros();
    state[3] = 1.0;
    state
}

/// The 12-state form of a state; see [`rotation::euler_from_quaternion`] for θ = ±90°.
pub fn to_euler_state(state: &QuadrotorState) -> EulerState {
    let angles = rotation::euler_from_quaternion(&state.as_slice()[3..7]);
    EulerState::from_fn(|i, _| match i {
        0..=2 => state[i],
        3..=5 => angles[i - 3],
        _ => state[i + 1],
    })
}

/// The quaternion form of a 12-state.
///
/// Inverse of [`to_euler_state`] except at the poles, where the attitude is the same and roll and yaw may differ.
pub fn from_euler_state(state: &EulerState) -> QuadrotorState {
    let q = rotation::quaternion_from_euler(state[3], state[4], state[5]);
    QuadrotorState::from_fn(|i, _| match i {
        0..=2 => state[i],
        3..=6 => q[i - 3],
        _ => state[i - 1],
    })
}

impl Quadrotor {
    /// M with (u1, u2, u3, u4) = M·(w1², …, w4²): total thrust N, roll, pitch, yaw moments N·m.
    ///
    /// Row by row: kf; kf·y_i; −kf·x_i; km·spin_i.
    ///
    /// Columns are rotors in the file's order. For the paper's plus layout with arm d: u₂ = d kf (w₂² − w₄²), u₃ = d kf
    /// (w₃² − w₁²), u₄ = km (w₁² − w₂² + w₃² − w₄²).
    pub fn mixing(&self) -> Matrix4<f64> {
        let (kf, km) = (self.thrust_coefficient, self.moment_coefficient);
        Matrix4::from_fn(|row, i| match row {
            0 => kf,
            1 => kf * self.rotors[i].y,
            2 => -kf * self.rotors[i].x,
            _ => km * self.rotors[i].spin,
        })
    }

    /// The inverse of [`Self::mixing`]: squared rotor speeds from (u1, …, u4). `None` for a layout that cannot make
    /// all four independently, which [`super::QuadrotorDescription::build`] refuses.
    ///
    /// Squared speeds may come out negative or beyond the limits: that the wrench cannot be had is for the caller to
    /// see.
    pub fn unmixing(&self) -> Option<Matrix4<f64>> {
        // Thrusts first, so that the matrix to invert is well scaled: columns (1, y, −x, spin·km/kf).
        let per_thrust = self.mixing() / self.thrust_coefficient;
        per_thrust.try_inverse().map(|inverse| inverse / self.thrust_coefficient)
    }

    /// (u1, u2, u3, u4) of rotor speeds w in rad/s.
    pub fn wrench(&self, speeds: &Vector4<f64>) -> Vector4<f64> {
        self.mixing() * speeds.component_mul(speeds)
    }

    /// Thrust of each rotor, N, that together make (u1, u2, u3, u4); limits are not applied. `None` as in
    /// [`Self::unmixing`].
    pub fn rotor_thrusts(&self, wrench: &Vector4<f64>) -> Option<Vector4<f64>> {
        self.unmixing().map(|inverse| inverse * wrench * self.thrust_coefficient)
    }

    /// Drag force on the body, N, in the frame of `air_velocity`: −c₁ v − c₂ |v| v of the velocity through the air.
    ///
    /// Isotropic: no difference between a body's broad and narrow side, no lift.
    pub fn drag_force(&self, air_velocity: &Vector3<f64>) -> Vector3<f64> {
        -(self.drag_linear + self.drag_quadratic * air_velocity.norm()) * air_velocity
    }

    /// x' of the rigid body under a total thrust u1 along body z, body moments (u2, u3, u4) and a further force in the
    /// world frame (drag, wind, noise), N.
    ///
    /// p' = v, q' = ½ q ⊗ (0, ω), m v' = R(q) e₃ u1 − m g e₃ + force, I ω' = moments − c|ω|ω − ω × I ω.
    ///
    /// Newton-Euler about the centre of mass. `state` as [`QuadrotorState`], `thrust` in N, `moments` in N·m in the
    /// body frame, `force` in N in the world frame; result per second.
    pub fn rigid_body(
        &self,
        state: &QuadrotorState,
        thrust: f64,
        moments: &Vector3<f64>,
        force: &Vector3<f64>,
    ) -> QuadrotorState {
        let q = &state.as_slice()[3..7];
        let rates = Vector3::new(state[10], state[11], state[12]);
        let mut acceleration = (rotation::body_z(q) * thrust + force) / self.mass;
        acceleration.z -= self.gravity;
        let momentum = self.inertia.component_mul(&rates);
        let moment = moments - rates * (self.aerodynamic_moment * rates.norm()) - rates.cross(&momentum);
        let turning = moment.component_div(&self.inertia);
        let attitude = rotation::quaternion_rate(q, &rates);
        let mut derivative = QuadrotorState::zeros();
        for i in 0..3 {
            derivative[i] = state[7 + i];
            derivative[7 + i] = acceleration[i];
            derivative[10 + i] = turning[i];
        }
        for i in 0..4 {
            derivative[3 + i] = attitude[i];
        }
        derivative
    }

    /// x' = f(x, u) of the rigid body with drag in still air; u are the rotor speeds, rad/s. Integrated by
    /// `rk4_step(|x| robot.derivative(x, &u), &x, h)` of [`crate::math::integrate`], with [`Self::normalize`] after
    /// each step.
    pub fn derivative(&self, state: &QuadrotorState, speeds: &Vector4<f64>) -> QuadrotorState {
        let u = self.wrench(speeds);
        let drag = self.drag_force(&Vector3::new(state[7], state[8], state[9]));
        self.rigid_body(state, u[0], &Vector3::new(u[1], u[2], u[3]), &drag)
    }

    /// Scales the quaternion to norm 1, which a step of an integrator leaves by its error.
    pub fn normalize(&self, state: &mut QuadrotorState) {
        rotation::renormalize(&mut state.as_mut_slice()[3..7]);
    }
}
