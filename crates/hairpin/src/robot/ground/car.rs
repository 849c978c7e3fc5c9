//! A car as the kinematic bicycle: ẋ = v cosψ, ẏ = v sinψ, ψ̇ = v tan(δ)/L at the middle of the rear axle; the front
//! one is steered.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{GroundResponse, Named, estimates, named};
use crate::robot::estimated::EstimatedNumber;
use crate::robot::rover::{Belly, Limits, MOST_SPEED, Response, Rover, RoverError, within};

/// The `kind` of a car's file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum CarKind {
    /// One steered axle.
    Car,
}

/// A car's file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CarDescription {
    /// Always `car`.
    pub kind: CarKind,
    /// Name in reports.
    pub name: String,
    /// Where the numbers come from.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub source: String,
    /// What must be said wherever the robot is named.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub caveat: String,
    /// Distance of the axles.
    pub wheelbase_m: f64,
    /// Length over all, its middle over that of the axles; 1.6 times the distance of the axles if not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub length_m: Option<f64>,
    /// Width over all; 0.8 times the distance of the axles if not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub width_m: Option<f64>,
    /// Speed where none is given; a quarter of the largest if not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub speed_m_s: Option<f64>,
    /// What it may do.
    pub limits: CarLimits,
    /// How it follows its commands; at once and exactly if not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub response: Option<GroundResponse>,
    /// Keys of this file whose numbers were estimated from logs.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub estimated: BTreeMap<String, EstimatedNumber>,
}

/// Bounds of a car's motion, the same to both sides and in both gears.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CarLimits {
    /// Largest steering angle.
    pub steering_deg: f64,
    /// Largest rate of the steering angle.
    pub steering_rate_deg_s: f64,
    /// Largest speed.
    pub speed_m_s: f64,
    /// Largest acceleration and deceleration.
    pub acceleration_m_s2: f64,
}

/// A car's numbers, SI, all checked. Built by [`CarDescription::build`].
///
/// ```
/// use hairpin::robot::ground::{CarDescription, CarKind, CarLimits};
///
/// let limits = CarLimits { steering_deg: 30.0, steering_rate_deg_s: 30.0, speed_m_s: 8.0, acceleration_m_s2: 2.0 };
/// let car = CarDescription {
///     kind: CarKind::Car,
///     name: "shuttle".into(),
///     source: String::new(),
///     caveat: String::new(),
///     wheelbase_m: 2.5,
///     length_m: None,
///     width_m: None,
///     speed_m_s: Some(2.0),
///     limits,
///     response: None,
///     estimated: Default::default(),
/// }
/// .build()?;
/// let tightest = 1.0 / car.vehicle().limits.curvature;
/// assert!((tightest - 2.5 / 30f64.to_radians().tan()).abs() < 1e-12); // L / tan δ
/// assert_eq!(car.estimated, ["length_m", "width_m"]);
/// # Ok::<(), hairpin::robot::rover::RoverError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Car {
    /// Name, as in `data/robots`.
    pub name: String,
    /// What must be said wherever the robot is named; empty if nothing.
    pub caveat: String,
    /// Where the numbers come from.
    pub source: String,
    /// Distance L of the axles, m.
    pub wheelbase: f64,
    /// Length over all, m.
    pub length: f64,
    /// Width over all, m.
    pub width: f64,
    /// Largest |δ|, rad.
    pub steering: f64,
    /// Largest |δ̇|, rad/s.
    pub steering_rate: f64,
    /// Largest |v|, m/s.
    pub speed: f64,
    /// Largest |v̇|, m/s².
    pub acceleration: f64,
    /// Speed where none is given, m/s.
    pub default_speed: f64,
    /// How it follows its commands.
    ///
    /// Its axle is the wheelbase and its rate the steering's, so that κ = tan(δ)/L lags as δ does.
    pub response: Response,
    /// Names of the numbers that were derived here, not given, or estimated.
    pub estimated: Vec<&'static str>,
}

impl CarDescription {
    /// Checks every number and builds the car.
    ///
    /// # Errors
    /// The first key whose value is out of bounds, with the bound.
    pub fn build(&self) -> Result<Car, RoverError> {
        let limits = &self.limits;
        let speed = within("limits.speed_m_s", limits.speed_m_s, 1e-3, MOST_SPEED)?;
        let wheelbase = within("wheelbase_m", self.wheelbase_m, 1e-3, 100.0)?;
        let given = [("speed_m_s", self.speed_m_s), ("length_m", self.length_m), ("width_m", self.width_m)];
        let derived = given.iter().filter(|(_, value)| value.is_none()).map(|(key, _)| *key);
        let response = self.response.as_ref();
        let estimated = derived.chain(estimates(&self.estimated, response)?).collect();
        let steering_rate = within("limits.steering_rate_deg_s", limits.steering_rate_deg_s, 0.1, 1e4)?.to_radians();
        let wheels = Response { steering_rate, steered_axle: wheelbase, ..Response::default() };
        Ok(Car {
            name: named(&self.name)?,
            caveat: self.caveat.clone(),
            source: self.source.clone(),
            wheelbase,
            length: within("length_m", self.length_m.unwrap_or(1.6 * wheelbase), wheelbase, 1e3)?,
            width: within("width_m", self.width_m.unwrap_or(0.8 * wheelbase), 1e-3, 1e3)?,
            steering: within("limits.steering_deg", limits.steering_deg, 0.1, 85.0)?.to_radians(),
            steering_rate,
            speed,
            acceleration: within("limits.acceleration_m_s2", limits.acceleration_m_s2, 1e-3, 1e3)?,
            default_speed: within("speed_m_s", self.speed_m_s.unwrap_or(0.25 * speed), 1e-4, speed)?,
            response: GroundResponse::build(response, wheels)?,
            estimated,
        })
    }
}

impl Car {
    /// The car as the generator of drives steers it, at its default speed v: |κ| ≤ tan(δ)/L, |κ′| ≤ δ̇/(L v), which the
    /// steering keeps at every angle.
    ///
    /// dκ/ds = δ̇ (1 + tan²δ)/(L v) is least at δ = 0, so that the bound is kept at every angle. Speed is the default
    /// one: faster drives of the same path would steer faster, and have bounds of their own ([`Rover::limits_at`]).
    ///
    /// The body frame is at the middle of the rear axle: the outline reaches from −overhang to L + overhang along x.
    pub fn vehicle(&self) -> Rover {
        let limits = Limits {
            curvature: libm::tan(self.steering) / self.wheelbase,
            curvature_rate: self.steering_rate / (self.wheelbase * self.default_speed),
            speed: self.speed,
            acceleration: self.acceleration,
            tilt: f64::INFINITY,
            joint: f64::INFINITY,
            turns_in_place: false,
        };
        let Self { name, caveat, source, estimated, .. } = self;
        let overhang = 0.5 * (self.length - self.wheelbase);
        let outline =
            Belly { front: self.wheelbase + overhang, rear: -overhang, half_width: 0.5 * self.width, height: 0.0 };
        Named { name, caveat, source, estimated, outline, rims: None }.vehicle(
            limits,
            self.response,
            self.default_speed,
        )
    }
}
