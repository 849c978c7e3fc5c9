//! A quadrotor as a file has it: units in the names, what is missing derived and marked `estimated`.
//!
//! Keys that are left out are derived in the order in which they can be: kf and the largest rotor speed from each other
//! and the thrust to weight; km and the body's radius from the layout; drag from the top speed or the discs; top speed
//! from thrust and drag. A key that is given is never changed.

use std::collections::BTreeMap;

use nalgebra::{Matrix4, Vector3, Vector4};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use thiserror::Error;

use super::{Quadrotor, Rotor, derived};
use crate::math::power::square;
use crate::robot::battery::{Battery, BatteryDescription};
use crate::robot::estimated::{EstimatedNumber, OWN_NUMBERS, estimated_keys};

/// One rotor of a robot file.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RotorDescription {
    /// Forward of the centre of mass, m.
    pub x_m: f64,
    /// Left of the centre of mass, m.
    pub y_m: f64,
    /// +1: turns clockwise seen from above; -1: counter-clockwise.
    pub spin: f64,
}

/// A quadrotor's file. Needed: `mass_kg`, `rotors`, and either `thrust_coefficient_n_s2` with `rotor_speed_rad_s` or
/// `thrust_to_weight`. Whatever else is missing is derived, and named in the result's `estimated`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct QuadrotorDescription {
    /// Always `quadrotor`.
    pub kind: QuadrotorKind,
    /// Name in reports.
    pub name: String,
    /// Where the numbers come from.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub source: String,
    /// What must be said wherever the robot is named ("a stand-in for ...").
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub caveat: String,
    /// Mass, kg.
    pub mass_kg: f64,
    /// Four rotors; any layout.
    pub rotors: Vec<RotorDescription>,
    /// Ixx, Iyy, Izz.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub inertia_kg_m2: Option<[f64; 3]>,
    /// kf, N/(rad/s)^2.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub thrust_coefficient_n_s2: Option<f64>,
    /// km, N m/(rad/s)^2.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub moment_coefficient_n_m_s2: Option<f64>,
    /// Smallest and largest rotor speed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rotor_speed_rad_s: Option<[f64; 2]>,
    /// Largest total thrust over weight; instead of `thrust_coefficient_n_s2`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub thrust_to_weight: Option<f64>,
    /// First-order rotor lag; 0: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rotor_time_constant_s: Option<f64>,
    /// Drag force -c v.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub drag_linear_n_s_m: Option<f64>,
    /// Drag force -c |v| v.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub drag_quadratic_n_s2_m2: Option<f64>,
    /// Aerodynamic moment -c |w| w.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub aerodynamic_moment_n_m_s2: Option<f64>,
    /// Force noise, power spectral density per axis.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub force_noise_n2_s: Option<f64>,
    /// Moment noise, power spectral density per axis.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub moment_noise_n2_m2_s: Option<f64>,
    /// Top speed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub max_speed_m_s: Option<f64>,
    /// Radius of the ball that holds the whole body.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub clearance_radius_m: Option<f64>,
    /// Gravity; 9.81 if not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gravity_m_s2: Option<f64>,
    /// How long it flies on a charge.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub battery: Option<BatteryDescription>,
    /// Keys of this file whose numbers were estimated from logs.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub estimated: BTreeMap<String, EstimatedNumber>,
}

/// The `kind` of a quadrotor's file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum QuadrotorKind {
    /// Four rotors on a rigid body.
    Quadrotor,
}

/// Why a file's numbers are no quadrotor.
#[derive(Debug, Clone, PartialEq, Error)]
#[error("{field} = {value}: must be {bound}")]
pub struct QuadrotorError {
    /// Key of the robot file, such as `rotors[1].spin`.
    pub field: String,
    /// The offending value.
    pub value: String,
    /// What it must be.
    pub bound: String,
}

impl QuadrotorError {
    fn new(field: &str, value: impl ToString, bound: impl Into<String>) -> Self {
        Self { field: field.into(), value: value.to_string(), bound: bound.into() }
    }
}

impl QuadrotorDescription {
    /// Checks every number, derives what is missing, and builds the robot.
    ///
    /// Noise and aerodynamic moment that are not given are zero. Everything else that is not given is derived (the
    /// models are documented in `derived.rs`) and its key listed in [`Quadrotor::estimated`]. From `mass_kg`, `rotors`,
    /// `thrust_to_weight` and `max_speed_m_s` alone comes a robot that flies.
    ///
    /// ```text
    /// thrust to weight  = 4 kf w_max² / (m g)
    /// given twice       : must agree within 1 %
    /// hover             : every rotor's share of the weight within its limits
    /// ```
    ///
    /// # Errors
    /// The first key whose value is out of bounds, with the bound: not finite, absurd in magnitude, a layout that
    /// cannot make roll, pitch and yaw, less thrust than weight, a robot that cannot hover level, a ball around the
    /// body that does not hold its rotors' hubs.
    pub fn build(&self) -> Result<Quadrotor, QuadrotorError> {
        if self.name.trim().is_empty() {
            return Err(QuadrotorError::new("name", "\"\"", "a name for reports"));
        }
        let mut estimated = self.estimates()?;
        let mass = within("mass_kg", self.mass_kg, 1e-4, 1e4)?;
        let gravity = self.gravity_m_s2.map_or(Ok(9.81), |g| within("gravity_m_s2", g, 0.01, 1000.0))?;
        let rotors = self.layout()?;
        let weight = mass * gravity;
        let (thrust_coefficient, rotor_speed) = self.thrust(weight, &mut estimated)?;
        let mut derive = |given: Option<f64>, key: &str, low: f64, high: f64, model: &dyn Fn() -> f64| {
            let value = given.unwrap_or_else(|| {
                estimated.push(key.to_string());
                model()
            });
            within(key, value, low, high)
        };
        let moment_coefficient =
            derive(self.moment_coefficient_n_m_s2, "moment_coefficient_n_m_s2", 1e-20, 1e2, &|| {
                derived::moment_coefficient(thrust_coefficient, &rotors)
            })?;
        let rotor_time_constant =
            derive(self.rotor_time_constant_s, "rotor_time_constant_s", 0.0, 10.0, &|| derived::ROTOR_TIME_CONSTANT)?;
        let clearance_radius = derive(self.clearance_radius_m, "clearance_radius_m", 1e-4, 1e2, &|| {
            derived::arm(&rotors) + derived::rotor_radius(&rotors)
        })?;
        holds_the_rotors(clearance_radius, &rotors)?;
        let most = 4.0 * thrust_coefficient * square(rotor_speed.1);
        let drag_linear = optional("drag_linear_n_s_m", self.drag_linear_n_s_m, 1e3)?;
        let given_drag = self.drag_quadratic_n_s2_m2.or(self.drag_linear_n_s_m.map(|_| 0.0));
        if let Some(speed) = self.max_speed_m_s {
            within("max_speed_m_s", speed, 0.01, 1000.0)?;
        }
        let drag_quadratic = derive(given_drag, "drag_quadratic_n_s2_m2", 0.0, 1e3, &|| match self.max_speed_m_s {
            Some(speed) => derived::drag_from_top_speed(most, weight, speed),
            None => derived::drag_from_discs(&rotors),
        })?;
        let max_speed = derive(self.max_speed_m_s, "max_speed_m_s", 0.01, 1000.0, &|| {
            derived::top_speed(most, weight, drag_linear, drag_quadratic)
        })?;
        let robot = Quadrotor {
            name: self.name.clone(),
            mass,
            inertia: self.moments_of_inertia(mass, &rotors, &mut estimated)?,
            rotors,
            thrust_coefficient,
            moment_coefficient,
            rotor_speed,
            rotor_time_constant,
            drag_linear,
            drag_quadratic,
            aerodynamic_moment: optional("aerodynamic_moment_n_m_s2", self.aerodynamic_moment_n_m_s2, 1e3)?,
            force_noise: optional("force_noise_n2_s", self.force_noise_n2_s, 1e3)?,
            moment_noise: optional("moment_noise_n2_m2_s", self.moment_noise_n2_m2_s, 1e3)?,
            max_speed,
            clearance_radius,
            gravity,
            estimated,
            caveat: self.caveat.clone(),
        };
        check_hover(&robot)?;
        self.battery()?;
        Ok(robot)
    }

    /// How long it flies on a charge; `None` where the file does not say.
    ///
    /// # Errors
    /// The key that is out of bounds, with the bound.
    pub fn battery(&self) -> Result<Option<Battery>, QuadrotorError> {
        let built = self.battery.map(|battery| battery.build()).transpose();
        built.map_err(|(key, value, bound)| QuadrotorError::new(key, value, bound))
    }

    /// The keys whose numbers the file has and calls estimated.
    fn estimates(&self) -> Result<Vec<String>, QuadrotorError> {
        let given = [
            ("mass_kg", true),
            ("inertia_kg_m2", self.inertia_kg_m2.is_some()),
            ("thrust_coefficient_n_s2", self.thrust_coefficient_n_s2.is_some()),
            ("moment_coefficient_n_m_s2", self.moment_coefficient_n_m_s2.is_some()),
            ("rotor_speed_rad_s", self.rotor_speed_rad_s.is_some()),
            ("thrust_to_weight", self.thrust_to_weight.is_some()),
            ("rotor_time_constant_s", self.rotor_time_constant_s.is_some()),
            ("drag_linear_n_s_m", self.drag_linear_n_s_m.is_some()),
            ("drag_quadratic_n_s2_m2", self.drag_quadratic_n_s2_m2.is_some()),
            ("aerodynamic_moment_n_m_s2", self.aerodynamic_moment_n_m_s2.is_some()),
            ("max_speed_m_s", self.max_speed_m_s.is_some()),
        ];
        let keys = estimated_keys(&self.estimated, &given);
        let keys = keys.map_err(|key| QuadrotorError::new("estimated", key, OWN_NUMBERS))?;
        Ok(keys.into_iter().map(str::to_owned).collect())
    }

    /// The four rotors, regular: thrust, roll, pitch and yaw can be had independently.
    fn layout(&self) -> Result<[Rotor; 4], QuadrotorError> {
        let given: &[RotorDescription; 4] =
            self.rotors.as_slice().try_into().map_err(|_| {
                QuadrotorError::new("rotors", format!("{} rotors", self.rotors.len()), "exactly 4 rotors")
            })?;
        for (i, rotor) in given.iter().enumerate() {
            within(&format!("rotors[{i}].x_m"), rotor.x_m, -100.0, 100.0)?;
            within(&format!("rotors[{i}].y_m"), rotor.y_m, -100.0, 100.0)?;
            if rotor.spin.abs() != 1.0 {
                let bound = "1 (clockwise seen from above) or -1 (counter-clockwise)";
                return Err(QuadrotorError::new(&format!("rotors[{i}].spin"), rotor.spin, bound));
            }
        }
        let rotors = given.map(|rotor| Rotor { x: rotor.x_m, y: rotor.y_m, spin: rotor.spin });
        let arm = derived::arm(&rotors).max(1e-12);
        let shape = Matrix4::from_fn(|row, i| match row {
            0 => 1.0,
            1 => rotors[i].y / arm,
            2 => rotors[i].x / arm,
            _ => rotors[i].spin,
        });
        if arm < 1e-3 || shape.determinant().abs() < 1e-3 {
            let places = rotors.map(|rotor| format!("({}, {}, {:+})", rotor.x, rotor.y, rotor.spin)).join(", ");
            let bound = "a layout that can make thrust, roll, pitch and yaw independently: arms of 1 mm or more, \
                         not all in one line, two rotors clockwise and two counter-clockwise on opposite diagonals";
            return Err(QuadrotorError::new("rotors", places, bound));
        }
        Ok(rotors)
    }

    /// kf and the limits of the rotor speed, from whichever of kf, limits and thrust to weight are given.
    fn thrust(&self, weight: f64, estimated: &mut Vec<String>) -> Result<(f64, (f64, f64)), QuadrotorError> {
        let (kf, limits, ratio) = (self.thrust_coefficient_n_s2, self.rotor_speed_rad_s, self.thrust_to_weight);
        if let Some(kf) = kf {
            within("thrust_coefficient_n_s2", kf, 1e-14, 1e2)?;
        }
        if let Some([min, max]) = limits {
            within("rotor_speed_rad_s[1]", max, 1e-2, 1e5)?;
            if !(min >= 0.0 && min < max) {
                return Err(QuadrotorError::new("rotor_speed_rad_s[0]", min, format!("at least 0 and below {max}")));
            }
        }
        if let Some(ratio) = ratio
            && !(ratio > 1.0 && ratio <= 200.0)
        {
            let bound = "above 1 (with less thrust than weight it cannot hover) and at most 200";
            return Err(QuadrotorError::new("thrust_to_weight", ratio, bound));
        }
        let (kf, limits) = match (kf, limits, ratio) {
            (Some(kf), Some(limits), None) => (kf, limits),
            (Some(kf), Some(limits), Some(ratio)) => {
                let actual = 4.0 * kf * square(limits[1]) / weight;
                if (actual - ratio).abs() > 0.01 * ratio {
                    let bound =
                        format!("{actual:.3}, as thrust_coefficient_n_s2 and rotor_speed_rad_s say, or left out");
                    return Err(QuadrotorError::new("thrust_to_weight", ratio, bound));
                }
                (kf, limits)
            }
            (Some(kf), None, Some(ratio)) => {
                estimated.push("rotor_speed_rad_s".into());
                (kf, [0.0, (ratio * weight / (4.0 * kf)).sqrt()])
            }
            (None, Some(limits), Some(ratio)) => {
                estimated.push("thrust_coefficient_n_s2".into());
                (ratio * weight / (4.0 * square(limits[1])), limits)
            }
            (None, None, Some(ratio)) => {
                estimated.extend(["thrust_coefficient_n_s2".into(), "rotor_speed_rad_s".into()]);
                (ratio * weight / (4.0 * square(derived::ROTOR_SPEED)), [0.0, derived::ROTOR_SPEED])
            }
            (Some(_), None, None) => {
                let bound = "given with thrust_coefficient_n_s2, or thrust_to_weight in its place";
                return Err(QuadrotorError::new("rotor_speed_rad_s", "nothing", bound));
            }
            (None, _, None) => {
                let bound = "given, or thrust_coefficient_n_s2 with rotor_speed_rad_s";
                return Err(QuadrotorError::new("thrust_to_weight", "nothing", bound));
            }
        };
        let most = 4.0 * kf * square(limits[1]);
        if most <= weight {
            let key =
                if self.thrust_coefficient_n_s2.is_some() { "thrust_coefficient_n_s2" } else { "thrust_to_weight" };
            let bound = format!("more: {most:.3} N of thrust at most do not lift {weight:.3} N of weight");
            return Err(QuadrotorError::new(key, kf, bound));
        }
        Ok((kf, (limits[0], limits[1])))
    }

    /// Moments of inertia that a rigid body can have (a tenth is allowed for errors of measurement).
    fn moments_of_inertia(
        &self,
        mass: f64,
        rotors: &[Rotor; 4],
        estimated: &mut Vec<String>,
    ) -> Result<Vector3<f64>, QuadrotorError> {
        let Some(given) = self.inertia_kg_m2 else {
            estimated.push("inertia_kg_m2".into());
            return Ok(derived::inertia(mass, rotors));
        };
        for (axis, value) in given.iter().enumerate() {
            within(&format!("inertia_kg_m2[{axis}]"), *value, 1e-12, 1e6)?;
        }
        let sum: f64 = given.iter().sum();
        if let Some(axis) = (0..3).find(|axis| given[*axis] > 1.1 * (sum - given[*axis])) {
            let bound = format!("at most the sum of the other two, {}, as for every rigid body", sum - given[axis]);
            return Err(QuadrotorError::new(&format!("inertia_kg_m2[{axis}]"), given[axis], bound));
        }
        Ok(Vector3::from(given))
    }
}

/// Level hover must be possible: every rotor's share of the weight within its limits.
fn check_hover(robot: &Quadrotor) -> Result<(), QuadrotorError> {
    let hover = Vector4::new(robot.mass * robot.gravity, 0.0, 0.0, 0.0);
    let (low, high) = (robot.rotor_speed.0, robot.rotor_speed.1);
    let limits = (robot.thrust_coefficient * low * low, robot.thrust_coefficient * high * high);
    let Some(thrusts) = robot.rotor_thrusts(&hover) else {
        let bound = "a layout that can make thrust, roll, pitch and yaw independently";
        return Err(QuadrotorError::new("rotors", "as given", bound));
    };
    match (0..4).find(|i| !(thrusts[*i] > limits.0 && thrusts[*i] < limits.1)) {
        None => Ok(()),
        Some(i) => {
            let value = format!("{:.4} N of rotor {i} in level hover", thrusts[i]);
            let bound = format!("between {:.4} N and {:.4} N, what a rotor can give", limits.0, limits.1);
            Err(QuadrotorError::new("rotors", value, bound))
        }
    }
}

/// The ball that holds the whole body holds the hubs of its rotors, whose discs reach farther still.
fn holds_the_rotors(radius: f64, rotors: &[Rotor; 4]) -> Result<(), QuadrotorError> {
    let arm = derived::arm(rotors);
    // A radius that was taken from the layout is the arm but for rounding.
    if radius >= arm * (1.0 - 1e-9) {
        return Ok(());
    }
    let bound = format!(
        "at least {arm:.4} m, how far the farthest rotor's hub is from the centre, and its disc beside that: nothing is \
         measured of what reaches out of the ball"
    );
    Err(QuadrotorError::new("clearance_radius_m", radius, bound))
}

/// `value` if it is a number in [low, high].
fn within(field: &str, value: f64, low: f64, high: f64) -> Result<f64, QuadrotorError> {
    if value >= low && value <= high {
        Ok(value)
    } else {
        Err(QuadrotorError::new(field, value, format!("a number from {low} to {high}")))
    }
}

/// A term that is absent when not given.
fn optional(field: &str, value: Option<f64>, high: f64) -> Result<f64, QuadrotorError> {
    value.map_or(Ok(0.0), |value| within(field, value, 0.0, high))
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;

    fn known() -> QuadrotorDescription {
        let rotor = |x_m, y_m, spin| RotorDescription { x_m, y_m, spin };
        let rotors = vec![rotor(0.1, 0.1, 1.0), rotor(-0.1, 0.1, -1.0), rotor(-0.1, -0.1, 1.0), rotor(0.1, -0.1, -1.0)];
        let text =
            r#"{"kind":"quadrotor","name":"mine","mass_kg":0.6,"rotors":[],"thrust_to_weight":2.5,"max_speed_m_s":12}"#;
        let mut description: QuadrotorDescription = serde_json::from_str(text).expect("valid");
        description.rotors = rotors;
        description
    }

    #[test]
    fn the_numbers_people_have_make_a_flyable_robot() {
        let robot = known().build().expect("flyable");
        let weight = 0.6 * 9.81;
        assert!((robot.max_thrust() / weight - 2.5).abs() < 1e-12);
        // At top speed the drag balances what full thrust leaves beside the weight.
        let pull = (robot.max_thrust().powi(2) - weight * weight).sqrt();
        assert!((robot.drag_quadratic * 144.0 - pull).abs() < 1e-9);
        assert!(robot.inertia.iter().all(|i| (1e-4..1e-1).contains(i)), "{}", robot.inertia);
        let mut keys = robot.estimated.clone();
        keys.sort();
        let expected = [
            "clearance_radius_m",
            "drag_quadratic_n_s2_m2",
            "inertia_kg_m2",
            "moment_coefficient_n_m_s2",
            "rotor_speed_rad_s",
            "rotor_time_constant_s",
            "thrust_coefficient_n_s2",
        ];
        assert_eq!(keys, expected);
        let mut without_speed = known();
        without_speed.max_speed_m_s = None;
        let robot = without_speed.build().expect("flyable");
        let drag = robot.drag_quadratic * robot.max_speed.powi(2);
        assert!((drag - pull).abs() < 1e-9 && robot.estimated.contains(&"max_speed_m_s".to_string()));
    }

    #[test]
    fn what_logs_told_is_called_estimated() {
        let mut description = known();
        let told = EstimatedNumber { interval: Some([2.3, 2.7]), from: "5 logs".into() };
        description.estimated.insert("thrust_to_weight".into(), told.clone());
        assert!(description.build().expect("flyable").estimated.contains(&"thrust_to_weight".to_owned()));
        description.estimated.insert("drag_linear_n_s_m".into(), told);
        let error = description.build().expect_err("no such number");
        assert_eq!((error.field.as_str(), error.value.as_str()), ("estimated", "drag_linear_n_s_m"));
    }

    #[test]
    fn every_bad_number_is_refused_by_its_key() {
        type Spoil = fn(&mut QuadrotorDescription);
        let cases: [(&str, Spoil); 21] = [
            ("clearance_radius_m", |d| d.clearance_radius_m = Some(0.14)),
            ("name", |d| d.name.clear()),
            ("mass_kg", |d| d.mass_kg = f64::NAN),
            ("mass_kg", |d| d.mass_kg = -1.0),
            ("mass_kg", |d| d.mass_kg = 1e9),
            ("rotors", |d| d.rotors.truncate(3)),
            ("rotors[2].spin", |d| d.rotors[2].spin = 0.5),
            ("rotors[1].x_m", |d| d.rotors[1].x_m = f64::INFINITY),
            ("rotors", |d| d.rotors.iter_mut().for_each(|r| r.y_m = 0.0)),
            ("rotors", |d| d.rotors.iter_mut().for_each(|r| r.spin = 1.0)),
            ("rotors", |d| d.rotors.iter_mut().for_each(|r| r.x_m += 0.3)),
            ("thrust_to_weight", |d| d.thrust_to_weight = Some(0.9)),
            ("thrust_to_weight", |d| d.thrust_to_weight = None),
            ("thrust_to_weight", |d| d.thrust_to_weight = Some(f64::NAN)),
            ("rotor_speed_rad_s[0]", |d| d.rotor_speed_rad_s = Some([800.0, 200.0])),
            ("rotor_speed_rad_s[1]", |d| d.rotor_speed_rad_s = Some([0.0, f64::NAN])),
            ("thrust_coefficient_n_s2", |d| d.thrust_coefficient_n_s2 = Some(-1e-6)),
            ("thrust_coefficient_n_s2", |d| {
                d.thrust_to_weight = None;
                d.thrust_coefficient_n_s2 = Some(1e-9);
                d.rotor_speed_rad_s = Some([0.0, 1000.0]);
            }),
            ("inertia_kg_m2[2]", |d| d.inertia_kg_m2 = Some([1e-3, 1e-3, 5e-3])),
            ("max_speed_m_s", |d| d.max_speed_m_s = Some(0.0)),
            ("drag_linear_n_s_m", |d| d.drag_linear_n_s_m = Some(-0.1)),
        ];
        for (field, spoil) in cases {
            let mut description = known();
            spoil(&mut description);
            let error = description.build().expect_err(field);
            assert_eq!(error.field, field, "{error}");
        }
    }
}
