//! A quadrotor as a file has it: units in the names, what is missing derived and marked `estimated`.

use nalgebra::Vector3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use thiserror::Error;

use super::{Quadrotor, Rotor};

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

impl QuadrotorDescription {
    /// Checks every number, derives what is missing, and builds the robot.
    ///
    /// # Errors
    /// The first key whose value is out of bounds, with the bound.
    pub fn build(&self) -> Result<Quadrotor, QuadrotorError> {
        let mut rotors = [Rotor { x: 0.0, y: 0.0, spin: 0.0 }; 4];
        for (rotor, given) in rotors.iter_mut().zip(&self.rotors) {
            *rotor = Rotor { x: given.x_m, y: given.y_m, spin: given.spin };
        }
        let inertia = self.inertia_kg_m2.unwrap_or([0.005; 3]);
        Ok(Quadrotor {
            name: self.name.clone(),
            mass: self.mass_kg,
            inertia: Vector3::from(inertia),
            rotors,
            thrust_coefficient: self.thrust_coefficient_n_s2.unwrap_or(1.91e-6),
            moment_coefficient: self.moment_coefficient_n_m_s2.unwrap_or(2.6e-7),
            rotor_speed: self.rotor_speed_rad_s.map_or((0.0, 2200.0), |[min, max]| (min, max)),
            rotor_time_constant: self.rotor_time_constant_s.unwrap_or(0.0),
            drag_linear: self.drag_linear_n_s_m.unwrap_or(0.0),
            drag_quadratic: self.drag_quadratic_n_s2_m2.unwrap_or(0.0),
            aerodynamic_moment: self.aerodynamic_moment_n_m_s2.unwrap_or(0.0),
            force_noise: self.force_noise_n2_s.unwrap_or(0.0),
            moment_noise: self.moment_noise_n2_m2_s.unwrap_or(0.0),
            max_speed: self.max_speed_m_s.unwrap_or(10.0),
            clearance_radius: self.clearance_radius_m.unwrap_or(0.25),
            gravity: self.gravity_m_s2.unwrap_or(9.81),
            estimated: Vec::new(),
            caveat: self.caveat.clone(),
        })
    }
}
