//! The wheels of a vehicle: which ones steer, and what they may do.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::error::{RoverError, within};
use super::suspension::Suspension;

/// Which wheels steer, and so how a vehicle turns.
///
/// With `Skid` no wheel steers and turning is scrubbing; the effective track, wider than the wheels', stands for that.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Steering {
    /// The foremost and the rearmost wheels (double Ackermann).
    #[default]
    Corner,
    /// The foremost wheels (Ackermann); what is commanded is the motion of the body's point between the others.
    Front,
    /// Every wheel, so that the vehicle can crab.
    AllWheel,
    /// None: the wheels of both sides turn at different speeds.
    Skid,
}

/// What the wheels may do; what is not given does not bind.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct WheelsDescription {
    /// Largest steer angle to either side.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub steer_limit_deg: Option<f64>,
    /// Largest rate of a steer angle while driving.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub steer_rate_deg_s: Option<f64>,
    /// Largest speed of rotation.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub speed_rad_s: Option<f64>,
    /// Largest change of it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub acceleration_rad_s2: Option<f64>,
    /// Largest torque of each wheel's motor about its axle, pushing or braking; all wheels are driven. Needs `mass_kg`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub torque_n_m: Option<f64>,
    /// Track that a skidding vehicle seems to have: more than the wheels' own, since they slip; theirs if not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub effective_track_m: Option<f64>,
}

/// How the wheels move the body, and their bounds; infinite where there is none.
///
/// Bounds are the same for every wheel. Torque needs the vehicle's weight.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wheels {
    /// Which ones steer.
    pub steering: Steering,
    /// Largest |steer angle|, rad.
    pub steer: f64,
    /// Largest rate of a steer angle, rad/s.
    pub steer_rate: f64,
    /// Largest |rolling speed|, rad/s.
    pub speed: f64,
    /// Largest change of rolling speed, rad/s².
    pub acceleration: f64,
    /// Largest |torque| of each, N·m.
    pub torque: f64,
    /// Track of skidding vehicles, m.
    pub effective_track: f64,
}

impl Default for Wheels {
    /// Corners steer, nothing binds.
    fn default() -> Self {
        let free = f64::INFINITY;
        let steering = Steering::default();
        let (steer, steer_rate, speed, acceleration, torque) = (free, free, free, free, free);
        Self { steering, steer, steer_rate, speed, acceleration, torque, effective_track: 0.0 }
    }
}

impl Wheels {
    /// Checked numbers.
    ///
    /// Without wheels the effective track is 0 unless given.
    pub(super) fn build(
        steering: Steering,
        given: &WheelsDescription,
        suspension: &Suspension,
    ) -> Result<Self, RoverError> {
        let most = |key: &str, value: Option<f64>, low: f64, high: f64| {
            value.map_or(Ok(f64::INFINITY), |value| within(key, value, low, high))
        };
        let (places, count, _) = suspension.wheels(&[0.0; 3]);
        let track = 2.0 * places[..count].iter().map(|w| w.y.abs()).sum::<f64>() / count.max(1) as f64;
        let effective = match given.effective_track_m {
            Some(track) => within("wheels.effective_track_m", track, 1e-3, 100.0)?,
            None => track,
        };
        Ok(Self {
            steering,
            steer: most("wheels.steer_limit_deg", given.steer_limit_deg, 0.1, 180.0)?.to_radians(),
            steer_rate: most("wheels.steer_rate_deg_s", given.steer_rate_deg_s, 1e-3, 1e5)?.to_radians(),
            speed: most("wheels.speed_rad_s", given.speed_rad_s, 1e-4, 1e5)?,
            acceleration: most("wheels.acceleration_rad_s2", given.acceleration_rad_s2, 1e-4, 1e7)?,
            torque: most("wheels.torque_n_m", given.torque_n_m, 1e-6, 1e7)?,
            effective_track: effective,
        })
    }

    /// Whether how the wheels move is bounded, whatever they push with.
    pub fn are_held(&self) -> bool {
        [self.steer, self.steer_rate, self.speed, self.acceleration].iter().any(|bound| bound.is_finite())
    }

    /// Whether any bound is finite.
    pub fn bounded(&self) -> bool {
        let bounds = [self.steer, self.steer_rate, self.speed, self.acceleration, self.torque];
        bounds.iter().any(|bound| bound.is_finite())
    }
}
