//! A boat as a file has it: units in the names, coefficients as they are published, what is missing derived and named.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use thiserror::Error;

use super::hull::{Boat, Thrust};
use super::model::{Damping, Inertia};

/// The `kind` of a boat's file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum BoatKind {
    /// A hull with thrusters for surge, sway and yaw.
    Boat,
}

/// A boat's file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BoatDescription {
    /// Always `boat`.
    pub kind: BoatKind,
    /// Name in reports.
    pub name: String,
    /// Where the numbers come from.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub source: String,
    /// What must be said wherever the robot is named.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub caveat: String,
    /// Keys of this file whose numbers no source gives.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub estimated: Vec<String>,
    /// Mass m.
    pub mass_kg: f64,
    /// I_z about the body's origin.
    pub yaw_inertia_kg_m2: f64,
    /// x_g: how far forward of the body's origin the centre of gravity lies.
    #[serde(default)]
    pub centre_of_gravity_m: f64,
    /// Length over all.
    pub length_m: f64,
    /// Beam.
    pub beam_m: f64,
    /// Radius of the disc about the body's origin that holds the hull; half the diagonal if not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub radius_m: Option<f64>,
    /// Speed where none is given; half of the top speed if not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub speed_m_s: Option<f64>,
    /// Added mass and damping.
    pub hydrodynamics: Hydrodynamics,
    /// What the thrusters give together.
    pub thrust: ThrustDescription,
}

/// Added mass and damping: the derivatives of the field with their published signs, `y_rv` for Y_{|r|v}. What is left
/// out is 0.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Hydrodynamics {
    /// Added mass in surge.
    pub x_du_kg: f64,
    /// Added mass in sway.
    pub y_dv_kg: f64,
    /// Added mass of sway by yaw, and of yaw by sway.
    pub y_dr_kg_m: f64,
    /// Added inertia in yaw.
    pub n_dr_kg_m2: f64,
    /// Surge, linear.
    pub x_u_kg_s: f64,
    /// Surge, quadratic.
    pub x_uu_kg_m: f64,
    /// Surge, cubic.
    pub x_uuu_kg_s_m2: f64,
    /// Sway by sway.
    pub y_v_kg_s: f64,
    /// Sway by sway, quadratic.
    pub y_vv_kg_m: f64,
    /// Sway by sway, per rate of turn.
    pub y_rv_kg: f64,
    /// Sway by yaw.
    pub y_r_kg_m_s: f64,
    /// Sway by yaw, per speed in sway.
    pub y_vr_kg: f64,
    /// Sway by yaw, quadratic.
    pub y_rr_kg_m: f64,
    /// Yaw by sway.
    pub n_v_kg_m_s: f64,
    /// Yaw by sway, quadratic.
    pub n_vv_kg: f64,
    /// Yaw by sway, per rate of turn.
    pub n_rv_kg_m: f64,
    /// Yaw by yaw.
    pub n_r_kg_m2_s: f64,
    /// Yaw by yaw, per speed in sway.
    pub n_vr_kg_m: f64,
    /// Yaw by yaw, quadratic.
    pub n_rr_kg_m2: f64,
}

/// What the thrusters give together.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ThrustDescription {
    /// Largest force ahead.
    pub ahead_n: f64,
    /// Largest force astern; that ahead if not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub astern_n: Option<f64>,
    /// Largest force to either side.
    pub sway_n: f64,
    /// Largest moment to either side.
    pub yaw_n_m: f64,
    /// First-order lag; 0: none.
    #[serde(default)]
    pub time_constant_s: f64,
}

/// Why a file's numbers are no boat.
#[derive(Debug, Clone, PartialEq, Error)]
#[error("{field} = {value}: must be {bound}")]
pub struct BoatError {
    /// Key of the robot file, such as `thrust.sway_n`.
    pub field: String,
    /// The offending value.
    pub value: String,
    /// What it must be.
    pub bound: String,
}

fn wrong(field: &str, value: impl ToString, bound: impl Into<String>) -> BoatError {
    BoatError { field: field.into(), value: value.to_string(), bound: bound.into() }
}

fn within(key: &str, value: f64, low: f64, high: f64) -> Result<f64, BoatError> {
    if (low..=high).contains(&value) {
        Ok(value)
    } else {
        Err(wrong(key, value, format!("a number from {low} to {high}")))
    }
}

impl BoatDescription {
    /// Checks every number and builds the boat.
    ///
    /// # Errors
    /// The first key whose value is out of bounds, with the bound; masses that are no inertia; damping that drives.
    pub fn build(&self) -> Result<Boat, BoatError> {
        if self.name.trim().is_empty() {
            return Err(wrong("name", "\"\"", "a name for reports"));
        }
        let (inertia, damping) = (self.inertia()?, self.hydrodynamics.damping()?);
        let thrust = self.thrust.checked()?;
        let [length, beam] =
            [within("length_m", self.length_m, 0.01, 1e3)?, within("beam_m", self.beam_m, 0.01, self.length_m)?];
        let top_speed = top_speed(&damping, thrust.ahead);
        let radius = self.radius_m.unwrap_or(0.5 * libm::hypot(length, beam));
        let given =
            [("radius_m", self.radius_m), ("speed_m_s", self.speed_m_s), ("thrust.astern_n", self.thrust.astern_n)];
        let derived = given.iter().filter(|(_, value)| value.is_none()).map(|(key, _)| (*key).to_owned());
        Ok(Boat {
            name: self.name.clone(),
            caveat: self.caveat.clone(),
            source: self.source.clone(),
            inertia,
            damping,
            thrust,
            thrust_time_constant: within("thrust.time_constant_s", self.thrust.time_constant_s, 0.0, 1e3)?,
            radius: within("radius_m", radius, 0.5 * beam, 1e3)?,
            top_speed,
            default_speed: within("speed_m_s", self.speed_m_s.unwrap_or(0.5 * top_speed), 1e-3, top_speed)?,
            estimated: self.estimated.iter().cloned().chain(derived).collect(),
        })
    }

    fn inertia(&self) -> Result<Inertia, BoatError> {
        let h = &self.hydrodynamics;
        let mass = within("mass_kg", self.mass_kg, 1e-3, 1e9)?;
        let middle =
            within("centre_of_gravity_m", self.centre_of_gravity_m, -self.length_m.abs(), self.length_m.abs())?;
        let inertia = Inertia {
            surge: mass - within("hydrodynamics.x_du_kg", h.x_du_kg, -1e9, 0.0)?,
            sway: mass - within("hydrodynamics.y_dv_kg", h.y_dv_kg, -1e9, 0.0)?,
            sway_yaw: mass * middle - within("hydrodynamics.y_dr_kg_m", h.y_dr_kg_m, -1e9, 1e9)?,
            yaw: within("yaw_inertia_kg_m2", self.yaw_inertia_kg_m2, 1e-6, 1e12)?
                - within("hydrodynamics.n_dr_kg_m2", h.n_dr_kg_m2, -1e12, 0.0)?,
        };
        if inertia.determinant() > 0.0 {
            return Ok(inertia);
        }
        let bound = format!("more than {}, for M to be an inertia", inertia.sway_yaw * inertia.sway_yaw / inertia.sway);
        Err(wrong("yaw_inertia_kg_m2", self.yaw_inertia_kg_m2, bound))
    }
}

impl Hydrodynamics {
    /// The derivatives, of which those of a motion by itself must take from it.
    fn damping(&self) -> Result<Damping, BoatError> {
        let opposing = [
            ("x_u_kg_s", self.x_u_kg_s),
            ("x_uu_kg_m", self.x_uu_kg_m),
            ("x_uuu_kg_s_m2", self.x_uuu_kg_s_m2),
            ("y_v_kg_s", self.y_v_kg_s),
            ("y_vv_kg_m", self.y_vv_kg_m),
            ("n_r_kg_m2_s", self.n_r_kg_m2_s),
            ("n_rr_kg_m2", self.n_rr_kg_m2),
        ];
        for (key, value) in opposing {
            within(&format!("hydrodynamics.{key}"), value, -1e9, 0.0)?;
        }
        let either = [
            ("y_rv_kg", self.y_rv_kg),
            ("y_r_kg_m_s", self.y_r_kg_m_s),
            ("y_vr_kg", self.y_vr_kg),
            ("y_rr_kg_m", self.y_rr_kg_m),
            ("n_v_kg_m_s", self.n_v_kg_m_s),
            ("n_vv_kg", self.n_vv_kg),
            ("n_rv_kg_m", self.n_rv_kg_m),
            ("n_vr_kg_m", self.n_vr_kg_m),
        ];
        for (key, value) in either {
            within(&format!("hydrodynamics.{key}"), value, -1e9, 1e9)?;
        }
        if self.x_u_kg_s == 0.0 && self.x_uu_kg_m == 0.0 && self.x_uuu_kg_s_m2 == 0.0 {
            return Err(wrong("hydrodynamics.x_u_kg_s", 0, "less than 0, or one of x_uu_kg_m and x_uuu_kg_s_m2"));
        }
        Ok(Damping {
            surge: [self.x_u_kg_s, self.x_uu_kg_m, self.x_uuu_kg_s_m2],
            sway_by_sway: [self.y_v_kg_s, self.y_vv_kg_m, self.y_rv_kg],
            sway_by_yaw: [self.y_r_kg_m_s, self.y_vr_kg, self.y_rr_kg_m],
            yaw_by_sway: [self.n_v_kg_m_s, self.n_vv_kg, self.n_rv_kg_m],
            yaw_by_yaw: [self.n_r_kg_m2_s, self.n_vr_kg_m, self.n_rr_kg_m2],
        })
    }
}

impl ThrustDescription {
    fn checked(&self) -> Result<Thrust, BoatError> {
        Ok(Thrust {
            ahead: within("thrust.ahead_n", self.ahead_n, 1e-6, 1e9)?,
            astern: within("thrust.astern_n", self.astern_n.unwrap_or(self.ahead_n), 1e-6, 1e9)?,
            sway: within("thrust.sway_n", self.sway_n, 1e-6, 1e9)?,
            yaw: within("thrust.yaw_n_m", self.yaw_n_m, 1e-6, 1e12)?,
        })
    }
}

/// Where resistance, which grows with the speed, is `thrust`: by bisection.
fn top_speed(damping: &Damping, thrust: f64) -> f64 {
    let mut high = 1.0;
    while damping.resistance(high) < thrust && high < 1e6 {
        high *= 2.0;
    }
    let mut low = 0.0;
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if damping.resistance(middle) < thrust { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}
