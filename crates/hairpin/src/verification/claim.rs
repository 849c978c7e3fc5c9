//! What is claimed, as plain numbers: a chain of legs through waypoints.

/// One leg: p_axis(τ) = Σ c_i τ^i, τ ∈ [0, duration], m, world frame, yaw 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Leg {
    /// Duration, s.
    pub duration: f64,
    /// `coefficients[axis][i]`, m/s^i.
    pub coefficients: [[f64; 8]; 3],
}

/// A flight: leg k joins waypoints k and k + 1, level and without angular rates at both, at rest at start and end.
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
