//! What is claimed, as plain numbers: a chain of legs through waypoints.

/// One leg: p_axis(τ) = Σ c_i τ^i, τ ∈ [0, duration], m, world frame, yaw 0.
///
/// τ runs from 0 at the leg's own start.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Leg {
    /// Duration, s.
    pub duration: f64,
    /// `coefficients[axis][i]`, m/s^i.
    pub coefficients: [[f64; 8]; 3],
}

/// A flight: leg k joins waypoints k and k + 1, level and without angular rates at both, at rest at start and end.
///
/// `waypoints` has one entry more than `legs`; anything else is a finding of [`verify`](super::verify), as are numbers
/// that are none.
///
/// ```
/// use hairpin::verification::{Body, Claim, Leg, RotorPlace, Tolerances, verify};
///
/// // A quadrotor that climbs 1 m in 2 s, rest to rest: c₄ … c₇ of the polynomial of degree 7.
/// let rotor = |x, y, spin| RotorPlace { x, y, spin };
/// let body = Body {
///     mass: 1.0,
///     gravity: 9.81,
///     inertia: [0.0049, 0.0049, 0.0069],
///     rotors: [rotor(0.08, 0.08, 1.0), rotor(-0.08, 0.08, -1.0), rotor(-0.08, -0.08, 1.0), rotor(0.08, -0.08, -1.0)],
///     thrust_coefficient: 1.91e-6,
///     moment_coefficient: 2.6e-7,
///     rotor_speed: (0.0, 2200.0),
///     drag_linear: 0.0,
///     drag_quadratic: 0.1,
///     aerodynamic_moment: 0.003,
///     rotor_time_constant: 0.02,
/// };
/// let climb = [0.0, 0.0, 0.0, 0.0, 35.0 / 16.0, -84.0 / 32.0, 70.0 / 64.0, -20.0 / 128.0];
/// let legs = [Leg { duration: 2.0, coefficients: [[0.0; 8], [0.0; 8], climb] }];
/// let waypoints = [[0.0, 0.0, 0.0], [0.0, 0.0, 1.0]];
/// let claim = Claim { waypoints: &waypoints, legs: &legs };
/// assert!(verify(&body, &claim, &Tolerances::default()).ok());
///
/// let mut wrong = legs;
/// wrong[0].coefficients[2][4] *= 1.01;
/// assert!(!verify(&body, &Claim { waypoints: &waypoints, legs: &wrong }, &Tolerances::default()).ok());
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Claim<'a> {
    /// Waypoints, m.
    pub waypoints: &'a [[f64; 3]],
    /// Legs in flight order.
    pub legs: &'a [Leg],
}

impl Leg {
    /// The Taylor coefficients of the position at τ: p(τ + h) = Σ_k out\[axis\]\[k\] h^k up to order 4, by repeated
    /// synthetic division.
    pub(super) fn taylor(&self, tau: f64) -> [[f64; 5]; 3] {
        self.coefficients.map(|mut c| {
            let mut taylor = [0.0; 5];
            for (k, out) in taylor.iter_mut().enumerate() {
                for i in (k..7).rev() {
                    c[i] += tau * c[i + 1];
                }
                *out = c[k];
            }
            taylor
        })
    }

    /// Whether the numbers can be a leg's at all.
    pub(super) fn is_finite(&self) -> bool {
        self.duration > 0.0 && self.duration.is_finite() && self.coefficients.iter().flatten().all(|c| c.is_finite())
    }
}
