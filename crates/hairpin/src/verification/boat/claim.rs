//! What is claimed of a boat, as plain numbers.

use crate::verification::place::FlatPlace;

/// One leg: q(τ) = Σ c_i τ^i for x, y (m, world frame) and ψ (rad), τ ∈ [0, duration].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BoatLeg {
    /// Duration, s.
    pub duration: f64,
    /// `coefficients[axis][i]`, m/s^i and rad/s^i.
    pub coefficients: [[f64; 8]; 3],
}

impl BoatLeg {
    /// Whether the numbers can be a leg's at all.
    pub(super) fn is_finite(&self) -> bool {
        self.duration > 0.0 && self.duration.is_finite() && self.coefficients.iter().flatten().all(|c| c.is_finite())
    }

    /// The Taylor coefficients at τ up to order 3.
    pub(super) fn taylor(&self, tau: f64) -> [[f64; 4]; 3] {
        self.coefficients.map(|mut c| {
            for k in 0..4 {
                for i in (k..7).rev() {
                    c[i] += tau * c[i + 1];
                }
            }
            [c[0], c[1], c[2], c[3]]
        })
    }
}

/// The boat's numbers, in the letters of the field with their published signs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BoatHull {
    /// m11, m22, m23 = m32, m33 with added mass: kg, kg, kg·m, kg·m².
    pub mass: [f64; 4],
    /// X_u, X_{|u|u}, X_{uuu}.
    pub surge: [f64; 3],
    /// Y_v, Y_{|v|v}, Y_{|r|v}.
    pub sway_by_sway: [f64; 3],
    /// Y_r, Y_{|v|r}, Y_{|r|r}.
    pub sway_by_yaw: [f64; 3],
    /// N_v, N_{|v|v}, N_{|r|v}.
    pub yaw_by_sway: [f64; 3],
    /// N_r, N_{|v|r}, N_{|r|r}.
    pub yaw_by_yaw: [f64; 3],
    /// Least and largest X, Y, N: N, N, N·m.
    pub forces: [[f64; 2]; 3],
    /// Lag of the thrusters, s.
    pub time_constant: f64,
    /// Radius of its disc, m.
    pub radius: f64,
}

impl BoatHull {
    /// Whether the masses are an inertia and every number is finite.
    pub(super) fn is_physical(&self) -> bool {
        let [a, b, c, d] = self.mass;
        let rows = [self.surge, self.sway_by_sway, self.sway_by_yaw, self.yaw_by_sway, self.yaw_by_yaw];
        let finite = rows.iter().flatten().chain(self.forces.iter().flatten()).all(|x| x.is_finite());
        a > 0.0 && b > 0.0 && b * d - c * c > 0.0 && finite && self.time_constant >= 0.0 && self.radius >= 0.0
    }
}

/// A trip: leg k joins waypoints k and k + 1; it begins and ends at rest over ground.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BoatClaim<'a> {
    /// Waypoints, x and y, m.
    pub waypoints: &'a [[f64; 2]],
    /// Legs in order.
    pub legs: &'a [BoatLeg],
    /// Velocity of the water, m/s, east and north.
    pub current: [f64; 2],
    /// Largest speed over ground, m/s; infinite: no cap.
    pub max_speed: f64,
    /// Least and largest x and y, m.
    pub waters: ([f64; 2], [f64; 2]),
    /// Where it keeps out of.
    pub places: &'a [FlatPlace],
}
