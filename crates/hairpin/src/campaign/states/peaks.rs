//! The largest that wheels do along a drive, held to their bounds.

use crate::robot::rover::Rover;

/// The largest that wheels do along a drive.
///
/// All ≥ 0, over all wheels of the vehicle; 0 for a vehicle without wheels.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct WheelPeaks {
    /// |steer angle|, rad.
    pub steer: f64,
    /// Its rate while driving, rad/s; where the vehicle stands its wheels may swing.
    pub steer_rate: f64,
    /// |rolling speed|, rad/s.
    pub speed: f64,
    /// Its change, rad/s², where speed is a function of time.
    pub acceleration: f64,
    /// |torque| of each, N·m, while driving.
    pub torque: f64,
}

impl WheelPeaks {
    /// The larger of both, one by one.
    pub(super) fn or(&self, other: &Self) -> Self {
        Self {
            steer: self.steer.max(other.steer),
            steer_rate: self.steer_rate.max(other.steer_rate),
            speed: self.speed.max(other.speed),
            acceleration: self.acceleration.max(other.acceleration),
            torque: self.torque.max(other.torque),
        }
    }

    /// The first bound of the vehicle's wheels that is exceeded, by its name and by how much, in rad, s and N·m.
    ///
    /// Steer angles first, then their rate, speed, acceleration, torque. A share of 10⁻⁶ above a bound is rounding; a
    /// number that is none breaks it.
    ///
    /// The excess is in the unit of its field. A bound of ∞ is never broken. `None`: all are kept.
    pub fn broken(&self, rover: &Rover) -> Option<(&'static str, f64)> {
        /// What sampling and rounding may add.
        const ROUNDING: f64 = 1e-6;
        let bounds = &rover.wheels;
        let found = [
            ("steer_angle", self.steer, bounds.steer),
            ("steer_rate", self.steer_rate, bounds.steer_rate),
            ("wheel_speed", self.speed, bounds.speed),
            ("wheel_acceleration", self.acceleration, bounds.acceleration),
            ("wheel_torque", self.torque, bounds.torque),
        ];
        let over = found.into_iter().find(|(_, value, bound)| value.is_nan() || *value > bound * (1.0 + ROUNDING));
        over.map(|(name, value, bound)| (name, value - bound))
    }
}
