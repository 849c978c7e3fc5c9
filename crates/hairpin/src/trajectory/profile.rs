//! The control witness of a flight as plain numbers: one 7th-order polynomial per leg and axis.
//!
//! For a multirotor position (and yaw) is a flat output: with p(t) in C⁴ and yaw 0 the thrust, the attitude, the rates
//! and the rotor speeds follow in closed form (Mellinger and Kumar, ICRA 2011), so that these coefficients are the
//! controls. That they keep the robot's limits is not said here; `feasibility` claims it and `verification` proves it.

use nalgebra::{Point3, Vector3};

/// One leg: p_axis(τ) = Σ c_i τ^i, τ ∈ [0, duration], position in m in the world frame, yaw 0.
///
/// Low orders first: 24 numbers and a duration are a leg.
#[derive(Debug, Clone, PartialEq)]
pub struct ProfileLeg {
    /// Duration T in s, > 0.
    pub duration: f64,
    /// `coefficients[axis][i]` in m/s^i; axes x, y, z.
    pub coefficients: [[f64; 8]; 3],
}

/// A whole flight, leg after leg, from t = 0.
///
/// ```
/// use hairpin::math::polynomial::septic;
/// use hairpin::trajectory::{Profile, ProfileLeg};
///
/// let climb = septic(&[0.0; 4], &[2.0, 0.0, 0.0, 0.0], 2.0); // 2 m up in 2 s, rest to rest
/// let leg = ProfileLeg { duration: 2.0, coefficients: [[0.0; 8], [0.0; 8], climb] };
/// let flight = Profile { legs: vec![leg.clone(), leg] };
/// let (number, tau) = flight.locate(3.0).expect("it has legs");
/// assert_eq!((number, tau), (1, 1.0));
/// assert!((flight.legs[number].position(tau).z - 1.0).abs() < 1e-12);
/// ```
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Profile {
    /// The legs in flight order.
    pub legs: Vec<ProfileLeg>,
}

impl ProfileLeg {
    /// The `order`-th time derivative of the position at τ (order 0: the position itself), by Horner's rule.
    ///
    /// m/s^order. Σ_{i ≥ order} i!/(i − order)! c_i τ^(i − order); zero from order 8 on.
    pub fn derivative(&self, tau: f64, order: usize) -> Vector3<f64> {
        Vector3::from_fn(|axis, _| {
            let mut value = 0.0;
            for i in (order..8).rev() {
                let falling: f64 = (0..order).map(|k| (i - k) as f64).product();
                value = value * tau + self.coefficients[axis][i] * falling;
            }
            value
        })
    }

    /// Position at τ, m.
    pub fn position(&self, tau: f64) -> Point3<f64> {
        Point3::from(self.derivative(tau, 0))
    }
}

impl Profile {
    /// Total duration in s.
    pub fn duration(&self) -> f64 {
        self.legs.iter().map(|leg| leg.duration).sum()
    }

    /// The leg flown at `t` and the time since it began; t is clamped to the flight. `None` for an empty profile.
    ///
    /// At a joint the later leg, with τ = 0.
    pub fn locate(&self, t: f64) -> Option<(usize, f64)> {
        let mut start = 0.0;
        let last = self.legs.len().checked_sub(1)?;
        for (index, leg) in self.legs.iter().enumerate() {
            if t < start + leg.duration || index == last {
                return Some((index, (t - start).clamp(0.0, leg.duration)));
            }
            start += leg.duration;
        }
        None
    }

    /// The leg flown at `t`, and place (m), velocity (m/s) and acceleration (m/s²) there; from the end on it is at
    /// rest. `None` for an empty profile.
    pub fn motion(&self, t: f64) -> Option<(usize, [Vector3<f64>; 3])> {
        let (leg, tau) = self.locate(t)?;
        let moving = if t >= self.duration() { 0.0 } else { 1.0 };
        let d = |order: usize| self.legs[leg].derivative(tau, order);
        Some((leg, [d(0), d(1) * moving, d(2) * moving]))
    }
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;

    #[test]
    fn derivatives_are_those_of_the_polynomial() {
        let mut leg = ProfileLeg { duration: 2.0, coefficients: [[0.0; 8]; 3] };
        leg.coefficients[0] = [1.0, -2.0, 0.5, 0.25, -0.1, 0.3, 0.01, -0.02];
        for order in 0..4 {
            let h = 1e-5;
            let numeric = (leg.derivative(1.3 + h, order) - leg.derivative(1.3 - h, order)) / (2.0 * h);
            assert!((numeric - leg.derivative(1.3, order + 1)).norm() < 1e-6);
        }
    }
}
