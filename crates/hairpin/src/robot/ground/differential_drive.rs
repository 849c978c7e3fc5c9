//! A differential drive: two wheels on one axle, each with a speed of its own. ẋ = v cosψ, ẏ = v sinψ, ψ̇ = ω at the
//! axle's middle.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{GroundResponse, Named, estimates, named};
use crate::robot::estimated::EstimatedNumber;
use crate::robot::rover::{Belly, Limits, MOST_SPEED, Response, Rims, Rover, RoverError, within};

/// The `kind` of a differential drive's file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum DifferentialDriveKind {
    /// Two driven wheels on one axle.
    DifferentialDrive,
}

/// A differential drive's file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DifferentialDriveDescription {
    /// Always `differential-drive`.
    pub kind: DifferentialDriveKind,
    /// Name in reports.
    pub name: String,
    /// Where the numbers come from.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub source: String,
    /// What must be said wherever the robot is named.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub caveat: String,
    /// Distance of the wheels.
    pub track_m: f64,
    /// Radius of the circle about the axle's middle that holds the robot; 0.8 times the distance of the wheels if not
    /// given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub radius_m: Option<f64>,
    /// Speed where none is given; half of the wheels' largest if not given, which leaves the other half to turning.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub speed_m_s: Option<f64>,
    /// What it may do.
    pub limits: DifferentialDriveLimits,
    /// How it follows its commands; at once and exactly if not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub response: Option<GroundResponse>,
    /// Keys of this file whose numbers were estimated from logs.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub estimated: BTreeMap<String, EstimatedNumber>,
}

/// Bounds of each wheel's rim, the same in both directions.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DifferentialDriveLimits {
    /// Largest speed of a wheel's rim.
    pub wheel_speed_m_s: f64,
    /// Largest acceleration of a wheel's rim.
    pub wheel_acceleration_m_s2: f64,
}

/// A differential drive's numbers, SI, all checked. Built by [`DifferentialDriveDescription::build`].
///
/// Body frame at the middle of the axle; castors are not modelled.
#[derive(Debug, Clone, PartialEq)]
pub struct DifferentialDrive {
    /// Name, as in `data/robots`.
    pub name: String,
    /// What must be said wherever the robot is named; empty if nothing.
    pub caveat: String,
    /// Where the numbers come from.
    pub source: String,
    /// Distance b of the wheels, m.
    pub track: f64,
    /// Radius of the circle about the axle's middle that holds it, m.
    pub radius: f64,
    /// Largest speed of a wheel's rim, m/s.
    pub wheel_speed: f64,
    /// Largest acceleration of a wheel's rim, m/s².
    pub wheel_acceleration: f64,
    /// Speed where none is given, m/s.
    pub default_speed: f64,
    /// How it follows its commands.
    pub response: Response,
    /// Names of the numbers that were derived here, not given, or estimated.
    pub estimated: Vec<&'static str>,
}

impl DifferentialDriveDescription {
    /// Checks every number and builds the differential drive.
    ///
    /// # Errors
    /// The first key whose value is out of bounds, with the bound.
    pub fn build(&self) -> Result<DifferentialDrive, RoverError> {
        let limits = &self.limits;
        let wheel_speed = within("limits.wheel_speed_m_s", limits.wheel_speed_m_s, 1e-3, MOST_SPEED)?;
        let speed = self.speed_m_s.unwrap_or(0.5 * wheel_speed);
        let track = within("track_m", self.track_m, 1e-3, 100.0)?;
        let given = [("speed_m_s", self.speed_m_s), ("radius_m", self.radius_m)];
        let response = self.response.as_ref();
        let derived = given.iter().filter(|(_, value)| value.is_none()).map(|(key, _)| *key);
        let wheels = Response { steered_axle: 0.5 * track, ..Response::default() };
        Ok(DifferentialDrive {
            name: named(&self.name)?,
            caveat: self.caveat.clone(),
            source: self.source.clone(),
            track,
            radius: within("radius_m", self.radius_m.unwrap_or(0.8 * track), 0.5 * track, 1e3)?,
            wheel_speed,
            wheel_acceleration: within("limits.wheel_acceleration_m_s2", limits.wheel_acceleration_m_s2, 1e-3, 1e3)?,
            // A wheel at its limit leaves nothing to turn with.
            default_speed: within("speed_m_s", speed, 1e-3 * wheel_speed, Rims::MOST_SHARE * wheel_speed)?,
            response: GroundResponse::build(response, wheels)?,
            estimated: derived.chain(estimates(&self.estimated, response)?).collect(),
        })
    }
}

impl DifferentialDrive {
    /// Largest rate of a turn in place, rad/s: 2 v_w / b.
    pub fn turn_rate(&self) -> f64 {
        2.0 * self.wheel_speed / self.track
    }

    /// The drive as the generator steers it, at its default speed v: the outer wheel keeps its limits, so that
    /// |κ| ≤ 2 (v_w − v)/(b v) and |κ′| ≤ 2 a_w/(b v²).
    ///
    /// From v ± ω b/2 within ±v_w with ω = κ v; and with v constant, v̇_r = ½ b v² κ′ within a_w. At other speeds, and
    /// where v changes, it has the bounds of [`Rover::limits_at`].
    pub fn vehicle(&self) -> Rover {
        let v = self.default_speed;
        let rims = Rims { track: self.track, speed: self.wheel_speed, acceleration: self.wheel_acceleration };
        let limits = Limits {
            curvature: rims.curvature(v),
            curvature_rate: rims.curvature_rate(v, 0.0, 0.0),
            speed: self.wheel_speed,
            acceleration: self.wheel_acceleration,
            tilt: f64::INFINITY,
            joint: f64::INFINITY,
            turns_in_place: true,
        };
        let Self { name, caveat, source, estimated, .. } = self;
        // The circle as the rectangle of no width that has its radius.
        let outline = Belly { front: self.radius, rear: -self.radius, ..Belly::default() };
        Named { name, caveat, source, estimated, outline, rims: Some(rims) }.vehicle(limits, self.response, v)
    }
}
