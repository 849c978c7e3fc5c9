//! What the rims of two driven wheels leave a vehicle at a speed.
//!
//! A wheel h = b/2 beside the middle goes at v (1 ± κ h), and its rim speeds up by v̇ (1 ± κ h) ± h v² κ′.

use crate::math::power::square;

/// Two wheels on one axle, each with a speed of its own.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rims {
    /// Distance b of the wheels, m.
    pub track: f64,
    /// Largest speed of a rim, m/s.
    pub speed: f64,
    /// Largest acceleration of a rim, m/s².
    pub acceleration: f64,
}

impl Rims {
    /// Share of a wheel's speed that drives may be commanded at: a wheel at its limit leaves nothing to turn with.
    pub const MOST_SHARE: f64 = 0.99;

    /// The largest |κ| that the outer wheel can go at `speed` (m/s), 1/m: 2 (v_w − v)/(b v); 0 beyond its own.
    ///
    /// `speed` > 0; at 0 it is infinite, for the vehicle may turn in place.
    pub fn curvature(&self, speed: f64) -> f64 {
        (2.0 * (self.speed - speed) / (self.track * speed)).max(0.0)
    }

    /// The largest |v| on `curvature` (1/m) that the outer wheel can go at, m/s: v_w/(1 + |κ| b/2).
    pub fn most_speed(&self, curvature: f64) -> f64 {
        self.speed / self.outer(curvature)
    }

    /// The largest |κ′| at `speed` (m/s) beside `acceleration` (m/s²) on `curvature` (1/m), 1/m²:
    /// 2 (a_w − v̇ (1 + κ b/2))/(b v²).
    ///
    /// 0 where the acceleration takes all that the outer rim has. Infinite at rest.
    pub fn curvature_rate(&self, speed: f64, acceleration: f64, curvature: f64) -> f64 {
        let left = self.acceleration - acceleration * self.outer(curvature);
        (2.0 * left / (self.track * square(speed))).max(0.0)
    }

    /// The acceleration along the way, m/s², that takes half of the outer rim's on `curvature` (1/m): the other half is
    /// left to steering.
    pub fn even_acceleration(&self, curvature: f64) -> f64 {
        0.5 * self.acceleration / self.outer(curvature)
    }

    /// The acceleration along the way, m/s², that leaves the outer rim a tenth to steer with on `curvature` (1/m).
    pub fn most_acceleration(&self, curvature: f64) -> f64 {
        0.9 * self.acceleration / self.outer(curvature)
    }

    /// Speed of the outer wheel by that of the middle: 1 + κ b/2.
    fn outer(&self, curvature: f64) -> f64 {
        1.0 + 0.5 * self.track * curvature.abs()
    }
}
