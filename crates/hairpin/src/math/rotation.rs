//! Attitude as a scalar-first unit quaternion in a state's slice, and as roll, pitch, yaw at the doors.
//!
//! ```text
//! world_from_body = R(q) = Rz(ψ) Ry(θ) Rx(φ)        body x forward, y left, z up (REP-103)
//! φ > 0: left side up      θ > 0: nose down      ψ > 0: turned left
//! q̇ = ½ q ⊗ (0, ω)         ω in the body frame, rad/s
//! ```
//!
//! q and −q are one attitude; nothing here prefers a sign. Quaternions are w first everywhere inside (Hamilton's
//! product); doors that have w last convert there. Source: Diebel, "Representing Attitude: Euler Angles, Unit
//! Quaternions, and Rotation Vectors" (Stanford, 2006).

use nalgebra::{Quaternion, UnitQuaternion, Vector3};

/// `world_from_body` from the components (w, x, y, z), which are normalised; all zero counts as level.
///
/// Slices longer than four are a state's: what follows is ignored.
pub fn unit_quaternion(q: &[f64]) -> UnitQuaternion<f64> {
    UnitQuaternion::try_new(Quaternion::new(q[0], q[1], q[2], q[3]), 1e-150).unwrap_or_else(UnitQuaternion::identity)
}

/// Scales the components (w, x, y, z) to norm 1 in place; what cannot be scaled (zero, not finite) is left alone.
///
/// Taken after each integration step: the norm is an invariant of q̇ = ½ q ⊗ (0, ω) that Runge-Kutta keeps to its own
/// order only.
pub fn renormalize(q: &mut [f64]) {
    let norm = q[..4].iter().map(|c| c * c).sum::<f64>().sqrt();
    if norm > 0.0 && norm.is_finite() {
        for component in &mut q[..4] {
            *component /= norm;
        }
    }
}

/// q' = ½ q ⊗ (0, ω): time derivative of the components (w, x, y, z) under body rates ω, rad/s.
///
/// Linear in q and in ω. Four components with one constraint: the rate is tangent to the unit sphere, q·q̇ = 0.
pub fn quaternion_rate(q: &[f64], rates: &Vector3<f64>) -> [f64; 4] {
    let (w, x, y, z) = (q[0], q[1], q[2], q[3]);
    let (p, q_, r) = (0.5 * rates.x, 0.5 * rates.y, 0.5 * rates.z);
    [-x * p - y * q_ - z * r, w * p + y * r - z * q_, w * q_ + z * p - x * r, w * r + x * q_ - y * p]
}

/// The body's z axis in the world, R(q) e₃, for a unit quaternion (w, x, y, z).
///
/// The direction of a multirotor's thrust: (cosφ sinθ cosψ + sinφ sinψ, cosφ sinθ sinψ − sinφ cosψ, cosφ cosθ).
pub fn body_z(q: &[f64]) -> Vector3<f64> {
    let (w, x, y, z) = (q[0], q[1], q[2], q[3]);
    Vector3::new(2.0 * (x * z + w * y), 2.0 * (y * z - w * x), 1.0 - 2.0 * (x * x + y * y))
}

/// (w, x, y, z) of roll φ, pitch θ, yaw ψ (rad): R = Rz(ψ) Ry(θ) Rx(φ).
///
/// ```
/// use hairpin::math::rotation::{euler_from_quaternion, quaternion_from_euler, unit_quaternion};
/// use nalgebra::Vector3;
///
/// // Pitch is positive nose down: the body's x axis dips.
/// let q = quaternion_from_euler(0.0, 0.2, 0.5);
/// assert!((unit_quaternion(&q) * Vector3::x()).z < 0.0);
/// let [roll, pitch, yaw] = euler_from_quaternion(&q);
/// assert!(roll.abs() < 1e-12 && (pitch - 0.2).abs() < 1e-12 && (yaw - 0.5).abs() < 1e-12);
/// ```
pub fn quaternion_from_euler(roll: f64, pitch: f64, yaw: f64) -> [f64; 4] {
    let (sr, cr) = libm::sincos(0.5 * roll);
    let (sp, cp) = libm::sincos(0.5 * pitch);
    let (sy, cy) = libm::sincos(0.5 * yaw);
    [cr * cp * cy + sr * sp * sy, sr * cp * cy - cr * sp * sy, cr * sp * cy + sr * cp * sy, cr * cp * sy - sr * sp * cy]
}

/// Roll φ ∈ (−π, π], pitch θ ∈ [−π/2, π/2], yaw ψ ∈ (−π, π] of a unit quaternion (w, x, y, z), rad.
///
/// At θ = ±π/2 only φ ∓ ψ is determined: there (|sin θ| > 1 − 1e-12) roll is set to 0 and yaw takes it all, so
/// that the angles always stand for the same attitude.
///
/// Inverse of [`quaternion_from_euler`] up to the quaternion's sign, and up to the gimbal's choice at the poles.
pub fn euler_from_quaternion(q: &[f64]) -> [f64; 3] {
    let (w, x, y, z) = (q[0], q[1], q[2], q[3]);
    let sin_pitch = (2.0 * (w * y - z * x)).clamp(-1.0, 1.0);
    if sin_pitch.abs() > 1.0 - 1e-12 {
        // R(q) with φ = 0: R₀₁ = −sin ψ, R₁₁ = cos ψ.
        let yaw = libm::atan2(2.0 * (w * z - x * y), 1.0 - 2.0 * (x * x + z * z));
        return [0.0, std::f64::consts::FRAC_PI_2.copysign(sin_pitch), yaw];
    }
    let roll = libm::atan2(2.0 * (w * x + y * z), 1.0 - 2.0 * (x * x + y * y));
    let yaw = libm::atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z));
    // sin θ loses half the digits near the pole; its complement from R₀₀, R₁₀ does not.
    let cos_pitch = libm::hypot(1.0 - 2.0 * (y * y + z * z), 2.0 * (w * z + x * y));
    [roll, libm::atan2(sin_pitch, cos_pitch), yaw]
}

/// The angle between two vectors, rad in [0, π]: atan2(|a × b|, a · b), exact also where they are nearly parallel. 0 if
/// either has no length.
///
/// arccos of the normalised product would lose half of the digits near 0 and π.
pub fn angle_between(a: &Vector3<f64>, b: &Vector3<f64>) -> f64 {
    libm::atan2(a.cross(b).norm(), a.dot(b))
}

/// The turn by |`turn`| rad about `turn`.
///
/// The exponential map: q = (cos ½|v|, sin ½|v| · v/|v|), rad; the zero vector is no turn.
pub fn from_rotation_vector(turn: &Vector3<f64>) -> UnitQuaternion<f64> {
    let angle = turn.norm();
    let (sin, cos) = libm::sincos(0.5 * angle);
    let axis = turn * if angle > 0.0 { sin / angle } else { 0.5 };
    unit_quaternion(&[cos, axis.x, axis.y, axis.z])
}

/// The turn as a vector of at most π rad along its axis: the reverse of [`from_rotation_vector`].
///
/// The logarithm: of the two turns that are one attitude the shorter. At exactly π rad either axis is right, and the
/// one with the quaternion's own sign is taken.
pub fn rotation_vector(q: &UnitQuaternion<f64>) -> Vector3<f64> {
    let axis = if q.w < 0.0 { -q.imag() } else { q.imag() };
    let sin = axis.norm();
    if sin > 0.0 { axis * (2.0 * libm::atan2(sin, q.w.abs()) / sin) } else { Vector3::zeros() }
}

/// The attitude at `share` (0 … 1) of the shortest turn from `a` to `b`.
///
/// a exp(share · log(a⁻¹ b)): constant angular velocity in the body frame; share 0 and 1 give the ends. Beyond them it
/// goes on turning.
pub fn between(a: &UnitQuaternion<f64>, b: &UnitQuaternion<f64>, share: f64) -> UnitQuaternion<f64> {
    a * from_rotation_vector(&(rotation_vector(&(a.inverse() * b)) * share))
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;
    use crate::math::random::{named_seed, stream};
    use rand::RngExt;
    use std::f64::consts::FRAC_PI_2;

    #[test]
    fn euler_angles_round_trip_also_at_the_poles() {
        let mut rng = stream(named_seed(1, "rotation", 0));
        for i in 0..2000 {
            let pitch = match i % 4 {
                0 => FRAC_PI_2,
                1 => -FRAC_PI_2,
                _ => rng.random_range(-FRAC_PI_2..FRAC_PI_2),
            };
            let q = quaternion_from_euler(rng.random_range(-3.0..3.0), pitch, rng.random_range(-3.0..3.0));
            let [roll, pitch, yaw] = euler_from_quaternion(&q);
            let back = quaternion_from_euler(roll, pitch, yaw);
            let angle = unit_quaternion(&q).angle_to(&unit_quaternion(&back));
            assert!(angle < 3e-6, "case {i}: {angle}");
        }
    }

    #[test]
    fn angles_and_rates_are_those_of_nalgebra() {
        let q = quaternion_from_euler(0.3, -0.7, 1.9);
        let theirs = UnitQuaternion::from_euler_angles(0.3, -0.7, 1.9);
        assert!(unit_quaternion(&q).angle_to(&theirs) < 1e-12);
        assert!((body_z(&q) - theirs * Vector3::z()).norm() < 1e-12);
        let (rates, h) = (Vector3::new(0.4, -1.1, 0.6), 1e-6);
        let turned = theirs * UnitQuaternion::from_scaled_axis(rates * h);
        let rate = quaternion_rate(&q, &rates);
        for (i, component) in [turned.w, turned.i, turned.j, turned.k].into_iter().enumerate() {
            assert!(((component - q[i]) / h - rate[i]).abs() < 1e-6);
        }
    }

    #[test]
    fn turns_and_vectors_are_those_of_nalgebra() {
        let mut rng = stream(named_seed(1, "rotation", 1));
        let mut vector = || Vector3::from_fn(|_, _| rng.random_range(-1.7..1.7f64));
        for i in 0..1000 {
            let (a, b) = (vector(), vector());
            assert!((angle_between(&a, &b) - a.angle(&b)).abs() < 1e-7, "{i}");
            let (p, q) = (from_rotation_vector(&a), from_rotation_vector(&b));
            assert!((p.into_inner() - UnitQuaternion::from_scaled_axis(a).into_inner()).norm() < 1e-14, "{i}");
            assert!((rotation_vector(&p) - p.scaled_axis()).norm() < 1e-14, "{i}");
            let share = i as f64 / 1000.0;
            assert!(between(&p, &q, share).angle_to(&p.slerp(&q, share)) < 1e-7, "{i}");
            assert!(between(&p, &q, 1.0).angle_to(&q) < 1e-7, "{i}");
        }
        let zero = Vector3::zeros();
        assert_eq!(
            (from_rotation_vector(&zero), rotation_vector(&UnitQuaternion::identity())),
            (UnitQuaternion::identity(), zero)
        );
        assert_eq!([angle_between(&Vector3::x(), &Vector3::x()), angle_between(&zero, &Vector3::x())], [0.0; 2]);
        assert_eq!(angle_between(&Vector3::x(), &-Vector3::x()), std::f64::consts::PI);
    }

    #[test]
    fn renormalising_leaves_nothing_but_direction() {
        let mut q = [2.0, 0.0, -2.0, 1.0];
        renormalize(&mut q);
        assert!((q.iter().map(|c| c * c).sum::<f64>() - 1.0).abs() < 1e-15 && q[0] > 0.0 && q[2] == -q[0]);
        let mut zero = [0.0; 4];
        renormalize(&mut zero);
        assert_eq!(zero, [0.0; 4]);
    }
}
