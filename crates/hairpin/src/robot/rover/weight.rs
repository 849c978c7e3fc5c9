//! Mass, gravity and rolling resistance, checked.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::error::{RoverError, within, wrong};
use super::suspension::Suspension;

/// Mass, gravity and rolling resistance: what wheels carry and overcome.
///
/// Loads in `mass` are as rigid as the vehicle; the centre of mass stays where the file has it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Weight {
    /// Of the vehicle with its load, kg.
    pub mass: f64,
    /// m/s².
    pub gravity: f64,
    /// Share of the load on the wheels that rolling takes.
    pub rolling_resistance: f64,
}

/// What a vehicle weighs and overcomes, beside `mass_kg` and `load_kg`, which it needs.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ForcesDescription {
    /// 9.80665 m/s^2 if not given; 3.71 on Mars, 1.62 on the Moon.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gravity_m_s2: Option<f64>,
    /// Share of the load on the wheels that rolling takes; 0 if not given.
    #[serde(default)]
    pub rolling_resistance: f64,
}

/// Standard gravity, m/s².
pub(super) const GRAVITY: f64 = 9.806_65;

impl Weight {
    /// Checked numbers; `None` where neither `forces` nor a bound of the `torque` asks for them. `mass` is without the
    /// `load`, kg.
    pub(super) fn build(
        forces: Option<&ForcesDescription>,
        torque: Option<f64>,
        mass: Option<f64>,
        load: f64,
        suspension: &Suspension,
    ) -> Result<Option<Self>, RoverError> {
        let key = match (forces, torque) {
            (None, None) => return Ok(None),
            (Some(_), _) => "forces",
            (None, Some(_)) => "wheels.torque_n_m",
        };
        let given = forces.copied().unwrap_or_default();
        let Some(mass) = mass else { return Err(wrong(key, "given", "given with mass_kg")) };
        if *suspension == Suspension::Level {
            return Err(wrong(key, "given", "given with a suspension: a point has no wheels"));
        }
        let gravity = within("forces.gravity_m_s2", given.gravity_m_s2.unwrap_or(GRAVITY), 1e-3, 1e3)?;
        let rolling_resistance = within("forces.rolling_resistance", given.rolling_resistance, 0.0, 10.0)?;
        Ok(Some(Self { mass: mass + load, gravity, rolling_resistance }))
    }

    /// m g, N.
    pub fn newtons(&self) -> f64 {
        self.mass * self.gravity
    }
}
