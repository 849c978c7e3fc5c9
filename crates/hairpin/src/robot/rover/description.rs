//! A rover as a file has it: units in the names, what is missing derived and marked `estimated`.
//!
//! What binds is what is given: a limit that is left out is infinite, but for the change of curvature, without which no
//! path has a best shape. Geometry is that of the left side.

use std::collections::BTreeMap;

use nalgebra::Vector3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::body::{BellyDescription, Body};
use super::error::{RoverError, place, within, wrong};
use super::four_wheel::FourWheel;
use super::weight::{ForcesDescription, Weight};
use super::wheels::{Steering, Wheels, WheelsDescription};
use super::{Kinematics, Limits, MOST_SPEED, Response, RockerBogie, Rover, Slip, Suspension, Unplanned};
use crate::robot::estimated::{EstimatedNumber, OWN_NUMBERS, estimated_keys};

/// The `kind` of a rover's file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum RoverKind {
    /// Wheels on the ground.
    Rover,
}

/// A rover's file. Needed: `name` and `limits.curvature_1_m`; without `suspension` it is a point in the plane.
///
/// `load_kg` may be drawn from run to run while the plan knows the empty vehicle; `slip_…` are for the mass without it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RoverDescription {
    /// Always `rover`.
    pub kind: RoverKind,
    /// Name in reports.
    pub name: String,
    /// Where the numbers come from.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub source: String,
    /// What must be said wherever the robot is named ("a stand-in for ...").
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub caveat: String,
    /// Speed where none is given; 1 m/s if not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub speed_m_s: Option<f64>,
    /// How the body rests on its wheels.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub suspension: Option<SuspensionDescription>,
    /// Centre of mass of the vehicle in the body frame; over the middle of the wheels if not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub centre_of_mass_m: Option<[f64; 3]>,
    /// The underside; between the wheels if not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub belly: Option<BellyDescription>,
    /// Which wheels steer; those at the corners if not given.
    #[serde(default)]
    pub steering: Steering,
    /// What the wheels may do.
    #[serde(default)]
    pub wheels: WheelsDescription,
    /// What it may do.
    pub limits: LimitsDescription,
    /// How commands become motion.
    #[serde(default)]
    pub response: ResponseDescription,
    /// Share of the speed lost climbing 20 deg; 0 if not given.
    #[serde(default)]
    pub slip_at_20_deg: f64,
    /// Drift downhill across a slope of 20 deg, as a share of the speed; 0 if not given.
    #[serde(default)]
    pub side_slip_at_20_deg: f64,
    /// Mass without a load, which both slips are given for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mass_kg: Option<f64>,
    /// Mass of the load that it carries; 0 if not given. Slips grow with it.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub load_kg: f64,
    /// n: slips grow with (1 + load / mass)ⁿ; 1 if not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub slip_load_exponent: Option<f64>,
    /// What it weighs and overcomes; needs `mass_kg`. With it, or with `wheels.torque_n_m`, the wheels' torque is told.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub forces: Option<ForcesDescription>,
    /// Keys of this file whose numbers were estimated from logs.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub estimated: BTreeMap<String, EstimatedNumber>,
}

fn is_zero(value: &f64) -> bool {
    *value == 0.0
}

/// Geometry in the body frame: x forward, y left, z up, m; left side given, right side mirrored.
///
/// A rocker-bogie whose wheels leave the pose undetermined (in line, or at one place) is refused when it is built.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub enum SuspensionDescription {
    /// Four wheels on a rigid body.
    FourWheel {
        /// Radius of every wheel.
        wheel_radius_m: f64,
        /// Centre of the front left wheel.
        front_m: [f64; 3],
        /// Centre of the rear left wheel.
        rear_m: [f64; 3],
    },
    /// Six wheels; the rockers turn equal and opposite.
    RockerBogie {
        /// Radius of every wheel.
        wheel_radius_m: f64,
        /// The rocker's pivot on the body.
        pivot_m: [f64; 3],
        /// The rocker's own wheel, from the pivot.
        rocker_wheel_m: [f64; 3],
        /// The bogie's joint, from the pivot.
        bogie_joint_m: [f64; 3],
        /// The bogie's two wheels, from its joint.
        bogie_wheels_m: [[f64; 3]; 2],
    },
}

/// Bounds of the motion; what is not given does not bind.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LimitsDescription {
    /// Largest curvature of a path.
    pub curvature_1_m: f64,
    /// Largest change of curvature along a path; 1 1/m^2 if not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub curvature_rate_1_m2: Option<f64>,
    /// Largest speed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub speed_m_s: Option<f64>,
    /// Largest acceleration.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub acceleration_m_s2: Option<f64>,
    /// Largest angle of the body's z axis from the vertical.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tilt_deg: Option<f64>,
    /// Largest angle of rockers and bogies.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub joint_deg: Option<f64>,
    /// Whether it turns in place; true if not given. Cars do not.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub turns_in_place: Option<bool>,
}

/// Delays and lags; none if not given.
///
/// All but the steering's lag and rate are the act's: plans leave them out, and controllers meet them.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ResponseDescription {
    /// A command acts this much later.
    #[serde(default)]
    pub latency_s: f64,
    /// First-order lag of the steering.
    #[serde(default)]
    pub steering_time_constant_s: f64,
    /// Largest rate of the steering angle.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub steering_rate_deg_s: Option<f64>,
    /// Distance of the steered axle from the line through the turning centre; from the wheels if not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub steered_axle_m: Option<f64>,
    /// First-order lag of the speed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub speed_time_constant_s: Option<f64>,
    /// Way over the ground by that of the wheels, on any slope: wheels of another radius, or that slip; 1 if not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub speed_scale: Option<f64>,
    /// Curvature over the ground by that of the wheels: those that scrub turn less; 1 if not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub turn_scale: Option<f64>,
}

/// Largest |κ′| where a file gives none, 1/m².
const CURVATURE_RATE: f64 = 1.0;
/// Default speed, m/s.
const SPEED: f64 = 1.0;
/// Largest slip at 20°.
const MOST_SLIP: f64 = 0.95;

impl RoverDescription {
    /// Checks every number and builds the rover.
    ///
    /// # Errors
    /// The first key whose value is out of bounds, with the bound.
    pub fn build(&self) -> Result<Rover, RoverError> {
        if self.name.trim().is_empty() {
            return Err(wrong("name", "\"\"", "a name for reports"));
        }
        let mut estimated = self.estimates()?;
        let suspension = self.suspension()?;
        let limits = self.limits(&mut estimated)?;
        let response = self.response(&suspension, &mut estimated)?;
        let body = Body::build(&suspension, self.centre_of_mass_m.as_ref(), self.belly.as_ref(), &mut estimated)?;
        let default_speed = within("speed_m_s", self.speed_m_s.unwrap_or(SPEED), 1e-4, limits.speed.min(MOST_SPEED))?;
        let wheels = Wheels::build(self.steering, &self.wheels, &suspension)?;
        let (forces, torque) = (self.forces.as_ref(), self.wheels.torque_n_m);
        let weight = Weight::build(forces, torque, self.mass_kg, self.load_kg, &suspension)?;
        Ok(Rover {
            name: self.name.clone(),
            caveat: self.caveat.clone(),
            source: self.source.clone(),
            suspension,
            body,
            wheels,
            limits,
            response,
            rims: None,
            slip: self.slip()?,
            weight,
            kinematics: Kinematics::default(),
            default_speed,
            estimated,
        })
    }

    /// The keys whose numbers the file has and calls estimated.
    fn estimates(&self) -> Result<Vec<&'static str>, RoverError> {
        let response = &self.response;
        let given = [
            ("slip_at_20_deg", true),
            ("side_slip_at_20_deg", true),
            ("response.latency_s", true),
            ("response.steering_time_constant_s", true),
            ("response.speed_time_constant_s", response.speed_time_constant_s.is_some()),
            ("response.speed_scale", response.speed_scale.is_some()),
            ("response.turn_scale", response.turn_scale.is_some()),
        ];
        estimated_keys(&self.estimated, &given).map_err(|key| wrong("estimated", key, OWN_NUMBERS))
    }

    /// The slip under the load: s₂₀ (1 + load / mass)ⁿ.
    fn slip(&self) -> Result<Slip, RoverError> {
        let exponent = within("slip_load_exponent", self.slip_load_exponent.unwrap_or(1.0), 0.0, 10.0)?;
        let load = within("load_kg", self.load_kg, 0.0, 1e6)?;
        let factor = match self.mass_kg {
            Some(mass) => libm::pow(1.0 + load / within("mass_kg", mass, 1e-3, 1e6)?, exponent),
            None if load > 0.0 => {
                return Err(wrong("load_kg", load.to_string(), "given with mass_kg, which slips are for"));
            }
            None => 1.0,
        };
        let loaded = |key: &str, unloaded: f64| {
            let slip = factor * within(key, unloaded, 0.0, MOST_SLIP)?;
            if slip <= MOST_SLIP {
                return Ok(slip);
            }
            let bound = format!("a load under which {key} is at most {MOST_SLIP}; it would be {slip:.3}");
            Err(wrong("load_kg", load.to_string(), &bound))
        };
        Ok(Slip {
            at_20_deg: loaded("slip_at_20_deg", self.slip_at_20_deg)?,
            side_at_20_deg: loaded("side_slip_at_20_deg", self.side_slip_at_20_deg)?,
        })
    }

    fn limits(&self, estimated: &mut Vec<&'static str>) -> Result<Limits, RoverError> {
        let given = &self.limits;
        let most = |key: &str, value: Option<f64>, low: f64, high: f64| {
            value.map_or(Ok(f64::INFINITY), |value| within(key, value, low, high))
        };
        if given.curvature_rate_1_m2.is_none() {
            estimated.push("limits.curvature_rate_1_m2");
        }
        let rate = given.curvature_rate_1_m2.unwrap_or(CURVATURE_RATE);
        Ok(Limits {
            curvature: within("limits.curvature_1_m", given.curvature_1_m, 1e-4, 1e3)?,
            curvature_rate: within("limits.curvature_rate_1_m2", rate, 1e-4, 1e6)?,
            speed: most("limits.speed_m_s", given.speed_m_s, 1e-4, MOST_SPEED)?,
            acceleration: most("limits.acceleration_m_s2", given.acceleration_m_s2, 1e-4, 1e3)?,
            tilt: most("limits.tilt_deg", given.tilt_deg, 0.0, 90.0)?.to_radians(),
            joint: most("limits.joint_deg", given.joint_deg, 0.0, 180.0)?.to_radians(),
            turns_in_place: given.turns_in_place.unwrap_or(true),
        })
    }

    fn response(&self, suspension: &Suspension, estimated: &mut Vec<&'static str>) -> Result<Response, RoverError> {
        let given = &self.response;
        // Turning about the middle of the wheels, as vehicles with all corners steered do.
        let half = suspension.wheelbase().map_or(Response::default().steered_axle, |base| 0.5 * base);
        let axle = given.steered_axle_m.unwrap_or(half);
        if given.steered_axle_m.is_none() {
            estimated.push("response.steered_axle_m");
        }
        let rate = match given.steering_rate_deg_s {
            Some(rate) => within("response.steering_rate_deg_s", rate, 1e-3, 1e4)?.to_radians(),
            None => f64::INFINITY,
        };
        let unplanned = Unplanned {
            speed_time_constant: given.speed_time_constant_s,
            speed_scale: given.speed_scale,
            turn_scale: given.turn_scale,
        };
        unplanned.build(Response {
            latency: within("response.latency_s", given.latency_s, 0.0, 60.0)?,
            steering_time_constant: within(
                "response.steering_time_constant_s",
                given.steering_time_constant_s,
                0.0,
                60.0,
            )?,
            steering_rate: rate,
            steered_axle: within("response.steered_axle_m", axle, 1e-3, 100.0)?,
            ..Response::default()
        })
    }

    fn suspension(&self) -> Result<Suspension, RoverError> {
        match &self.suspension {
            None => Ok(Suspension::Level),
            Some(SuspensionDescription::FourWheel { wheel_radius_m, front_m, rear_m }) => {
                let front = place("suspension.front_m", front_m)?;
                let rear = place("suspension.rear_m", rear_m)?;
                if front.x - rear.x < 1e-3 {
                    return Err(wrong("suspension.front_m", format!("{front_m:?}"), "ahead of rear_m by 1 mm or more"));
                }
                for (key, at) in [("suspension.front_m", &front), ("suspension.rear_m", &rear)] {
                    left(key, at)?;
                }
                let right = |v: Vector3<f64>| Vector3::new(v.x, -v.y, v.z);
                Ok(Suspension::FourWheel(FourWheel {
                    wheels: [front, right(front), rear, right(rear)],
                    wheel_radius: radius(*wheel_radius_m)?,
                }))
            }
            Some(SuspensionDescription::RockerBogie {
                wheel_radius_m,
                pivot_m,
                rocker_wheel_m,
                bogie_joint_m,
                bogie_wheels_m,
            }) => {
                let body = RockerBogie {
                    pivot: place("suspension.pivot_m", pivot_m)?,
                    rocker_wheel: place("suspension.rocker_wheel_m", rocker_wheel_m)?,
                    bogie_joint: place("suspension.bogie_joint_m", bogie_joint_m)?,
                    bogie_wheels: [
                        place("suspension.bogie_wheels_m[0]", &bogie_wheels_m[0])?,
                        place("suspension.bogie_wheels_m[1]", &bogie_wheels_m[1])?,
                    ],
                    wheel_radius: radius(*wheel_radius_m)?,
                };
                check_rocker_bogie(&body)?;
                Ok(Suspension::RockerBogie(body))
            }
        }
    }
}

/// Wheels that leave the pose undetermined are no suspension.
fn check_rocker_bogie(body: &RockerBogie) -> Result<(), RoverError> {
    let wheels = body.wheels(&[0.0; 3]);
    for (key, wheel) in ["rocker_wheel_m", "bogie_wheels_m[0]", "bogie_wheels_m[1]"].iter().zip(&wheels) {
        left(&format!("suspension.{key}"), wheel)?;
    }
    let [a, b] = body.bogie_wheels.map(|w| w.x);
    if a * b >= 0.0 || (a - b).abs() < 1e-3 {
        let bound = "one wheel ahead of the bogie's joint and one behind it";
        return Err(wrong("suspension.bogie_wheels_m", format!("x = {a} and {b}"), bound));
    }
    let (rocker, joint) = (body.rocker_wheel.x, body.bogie_joint.x);
    if rocker * joint >= 0.0 || (rocker - joint).abs() < 1e-3 {
        let bound = "on the other side of the pivot than the bogie's joint";
        return Err(wrong("suspension.rocker_wheel_m", format!("x = {rocker}, joint x = {joint}"), bound));
    }
    Ok(())
}

fn left(key: &str, at: &Vector3<f64>) -> Result<(), RoverError> {
    if at.y >= 1e-3 { Ok(()) } else { Err(wrong(key, at.y, "a wheel of the left side: y ≥ 0.001 m")) }
}

fn radius(value: f64) -> Result<f64, RoverError> {
    within("suspension.wheel_radius_m", value, 1e-4, 100.0)
}
