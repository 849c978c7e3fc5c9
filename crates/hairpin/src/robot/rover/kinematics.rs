//! How the ground gives way under a vehicle, and which rates its motion has.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How much the ground gives way, in proportion to the sine of the slope.
///
/// Pure shares of the speed at 20°. Under a load both have grown by (1 + load/mass)ⁿ before they arrive here.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Slip {
    /// Share of the speed that is lost climbing 20°; gained going down.
    ///
    /// 0 … 0.95 in files. On a climb γ the share is s₂₀ sin γ/sin 20°, linear in the sine and without a bound of its
    /// own.
    pub at_20_deg: f64,
    /// Drift downhill across a slope of 20°, as a share of the speed.
    pub side_at_20_deg: f64,
}

/// Which rates a commanded twist gives the planar pose. On planes, for bodies that stand level on level ground, they
/// are the same.
///
/// How far the two part is measured: 0.01 to 0.8 m after 2 to 7 m on cratered ground (docs/rover-generator.md).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Kinematics {
    /// Without what the suspension adds to the body's velocity: vz, ωx and ωy (Howard & Kelly 2007).
    #[default]
    Source,
    /// With all six: vz, ωx and ωy are what keeps the wheels on the ground.
    Exact,
}

impl Kinematics {
    /// The word in scenarios and on the command line.
    pub fn word(self) -> &'static str {
        match self {
            Self::Source => "source",
            Self::Exact => "exact",
        }
    }
}
