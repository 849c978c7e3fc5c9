//! The published program's integration, for comparison only: one explicit Euler step of the Euler-angle equations.
//!
//! Nothing of hairpin's own claims rests on this file: it exists so that the paper's numbers can be reproduced beside
//! an integration that converges.

use nalgebra::{Vector3, Vector4};

use super::Quadrotor;
use super::model::EulerState;

/// One step of `step` s of the 12-state equations under constant rotor speeds, in the order of the paper's program:
/// rates, attitude, velocity, position, each from the values already updated.
///
/// No drag. With steps of 1 s the angles run through many turns and alias; that is what the program does. It is
/// singular at θ = ±90° like the equations (finite there in floating point, and meaningless).
///
/// Source: Hildebrandt et al., Feasible and Stressful Trajectory Generation for Mobile Robots, ISSTA 2020, eqs. 1-4.
///
/// `state` and result are 12-states; `speeds` in rad/s in the order of [`Quadrotor::rotors`]; `step` in s. Quadratic
/// drag, rotor lag and the aerodynamic moment are left out.
pub fn single_step(robot: &Quadrotor, state: &EulerState, speeds: &Vector4<f64>, step: f64) -> EulerState {
    let u = robot.wrench(speeds);
    let mut next = *state;
    let (p, q, r) = (state[9], state[10], state[11]);
    let rates = Vector3::new(p, q, r) + angular_acceleration(robot, &u, p, q, r) * step;
    let (roll, pitch) = (state[3], state[4]);
    let turning = euler_rates(roll, pitch, &rates);
    let (roll, pitch, yaw) = (roll + turning.x * step, pitch + turning.y * step, state[5] + turning.z * step);
    let velocity = Vector3::new(state[6], state[7], state[8])
        + (thrust_direction(roll, pitch, yaw) * (u[0] / robot.mass) - Vector3::z() * robot.gravity) * step;
    for i in 0..3 {
        next[i] += velocity[i] * step;
        next[3 + i] = [roll, pitch, yaw][i];
        next[6 + i] = velocity[i];
        next[9 + i] = rates[i];
    }
    next
}

/// (ṗ, q̇, ṙ), rad/s².
///
/// ṗ = (u₂ − (Izz − Iyy) q r)/Ixx and cyclically (the paper's eq. 2, with signs as in Euler's equations).
pub fn angular_acceleration(robot: &Quadrotor, u: &Vector4<f64>, p: f64, q: f64, r: f64) -> Vector3<f64> {
    let inertia = robot.inertia;
    Vector3::new(
        (u[1] - (inertia.z - inertia.y) * q * r) / inertia.x,
        (u[2] - (inertia.x - inertia.z) * p * r) / inertia.y,
        (u[3] - (inertia.y - inertia.x) * p * q) / inertia.z,
    )
}

/// (φ̇, θ̇, ψ̇), rad/s, of body rates; infinite or meaningless at θ = ±90°.
///
/// φ̇ = p + (q sinφ + r cosφ) tanθ, θ̇ = q cosφ − r sinφ, ψ̇ = (q sinφ + r cosφ)/cosθ.
pub fn euler_rates(roll: f64, pitch: f64, rates: &Vector3<f64>) -> Vector3<f64> {
    let (sin, cos) = libm::sincos(roll);
    let yawing = rates.y * sin + rates.z * cos;
    Vector3::new(rates.x + yawing * libm::tan(pitch), rates.y * cos - rates.z * sin, yawing / libm::cos(pitch))
}

/// The body's z axis in the world, as the paper's velocity equations have it.
pub fn thrust_direction(roll: f64, pitch: f64, yaw: f64) -> Vector3<f64> {
    let ((sr, cr), (sp, cp), (sy, cy)) = (libm::sincos(roll), libm::sincos(pitch), libm::sincos(yaw));
    Vector3::new(cr * sp * cy + sr * sy, cr * sp * sy - sr * cy, cr * cp)
}
