//! Limits of a vehicle at the speed that it is driven at: what its driven wheels and its steering leave it there.

use super::{Limits, Rover};

impl Rover {
    /// Its limits where it goes at `speed` (m/s) and changes that by `acceleration` (m/s²) at most: never more than at
    /// its default speed.
    ///
    /// What depends on the speed are the curvatures of vehicles without a suspension: the outer rim of a differential
    /// drive keeps its limits ([`Rims`](super::Rims)), the steering of a car its rate, |κ′| ≤ δ̇/(L v).
    ///
    /// `speed` > 0. Tilt, joints, speed and acceleration are as they are; slower than the default speed nothing is
    /// gained by a car.
    pub fn limits_at(&self, speed: f64, acceleration: f64) -> Limits {
        let mut limits = self.limits;
        if let Some(rims) = &self.rims {
            limits.curvature = limits.curvature.min(rims.curvature(speed));
            let rate = rims.curvature_rate(speed, acceleration, limits.curvature);
            limits.curvature_rate = limits.curvature_rate.min(rate);
        } else if self.steers_at_its_limit() {
            limits.curvature_rate *= (self.default_speed / speed).min(1.0);
        }
        limits
    }

    /// Whether its bound of κ′ is what its steering does at its default speed, as a car's is.
    ///
    /// To 10⁻⁹ of it, and only with a finite rate.
    fn steers_at_its_limit(&self) -> bool {
        let rate = self.response.steering_rate / (self.response.steered_axle * self.default_speed);
        (self.limits.curvature_rate - rate).abs() <= 1e-9 * rate && rate.is_finite()
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
