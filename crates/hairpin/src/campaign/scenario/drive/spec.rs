//! `[spec]`: what is within spec.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// `[spec]`.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct DriveSpec {
    /// What is not given is not judged.
    pub limits: SpecLimits,
}

/// `spec.limits`.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct SpecLimits {
    /// Largest distance from the planned path.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub path_deviation_m: Option<f64>,
    /// Smallest angle that is left before the vehicle tips over.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tip_over_margin_deg: Option<f64>,
    /// Smallest distance from places to keep out of of the circle about the robot's reference point that holds its
    /// outline.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub clearance_m: Option<f64>,
    /// Longest duration of a run.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub total_time_s: Option<f64>,
    /// Share of cases that may violate the limits above; without it a single one fails.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub violation_share: Option<f64>,
    /// Confidence of the share's interval.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub confidence: Option<f64>,
}
