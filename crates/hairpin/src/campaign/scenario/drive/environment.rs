//! `generate.environment` of drives: what is searched beside the waypoints.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// `generate.environment`: for `in-loop`; what is found is part of the case.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct DriveEnvironmentSection {
    /// Round keep-outs that leave the plan clear, placed where the drive leaves it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub obstacles: Option<PlacedDiscsSection>,
    /// A steady horizontal force of at most this size at the vehicle's centre of mass, that the plan does not know.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub external_force_n: Option<f64>,
}

/// `obstacles = { count, radius_m }` of drives: discs.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PlacedDiscsSection {
    /// How many.
    pub count: u64,
    /// Radius of each.
    pub radius_m: f64,
}
