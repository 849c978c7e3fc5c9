//! What the rims of two driven wheels leave a vehicle at a speed, and what its steering does.
//!
//! A wheel h = b/2 beside the middle goes at v (1 ± κ h), and its rim speeds up by v̇ (1 ± κ h) ± h v² κ′.

use super::suspension::Suspension;
use super::{Limits, Rover};
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
    pub fn curvature(&self, speed: f64) -> f64 {
        (2.0 * (self.speed - speed) / (self.track * speed)).max(0.0)
    }

    /// The largest |κ′| at `speed` (m/s) beside `acceleration` (m/s²) on `curvature` (1/m), 1/m²:
    /// 2 (a_w − v̇ (1 + κ b/2))/(b v²).
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

impl Rover {
    /// Its limits where it goes at `speed` (m/s) and changes that by `acceleration` (m/s²) at most: never more than at
    /// its default speed.
    ///
    /// What depends on the speed are the curvatures of vehicles without a suspension: the outer rim of a differential
    /// drive keeps its limits ([`Rims`]), the steering of a car its rate, |κ′| ≤ δ̇/(L v).
    pub fn limits_at(&self, speed: f64, acceleration: f64) -> Limits {
        let mut limits = self.limits;
        let response = &self.response;
        if let Some(rims) = &self.rims {
            limits.curvature = limits.curvature.min(rims.curvature(speed));
            let rate = rims.curvature_rate(speed, acceleration, limits.curvature);
            limits.curvature_rate = limits.curvature_rate.min(rate);
        } else if self.suspension == Suspension::Level && response.steering_rate.is_finite() {
            let rate = response.steering_rate / (response.steered_axle * speed);
            limits.curvature_rate = limits.curvature_rate.min(rate);
        }
        limits
    }

    /// How hard plans change its speed where it goes at `speed` (m/s) at most, m/s²: its own acceleration; of rims half
    /// of theirs on the sharpest bend at that speed.
    pub fn planned_acceleration(&self, speed: f64) -> f64 {
        match &self.rims {
            Some(rims) => rims.even_acceleration(self.limits.curvature.min(rims.curvature(speed))),
            None => self.limits.acceleration,
        }
    }

    /// The hardest change of speed that plans may be asked for at `speed` (m/s), m/s²: its own acceleration; of rims
    /// what leaves a tenth to steer with.
    pub fn most_planned_acceleration(&self, speed: f64) -> f64 {
        match &self.rims {
            Some(rims) => rims.most_acceleration(self.limits.curvature.min(rims.curvature(speed))),
            None => self.limits.acceleration,
        }
    }
}
