//! `[spec]`: what is within spec.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// `[spec]`: what is not given is not judged.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct SpecSection {
    /// Distance from the reference.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub deviation: Option<DeviationSpec>,
    /// Overshoot at waypoints.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub overshoot: Option<MaxMetres>,
    /// Distance to obstacles, the robot's radius subtracted.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub clearance: Option<MinMetres>,
    /// Acceleration.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub acceleration: Option<MaxAcceleration>,
    /// Duration of a run.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub total_time: Option<MaxSeconds>,
    /// Share of cases that may violate the limits above; without it a single one fails.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub violation_share: Option<f64>,
    /// Confidence of the share's interval.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub confidence: Option<f64>,
}

/// `deviation = { max_m, from, corner_m }`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DeviationSpec {
    /// The limit.
    pub max_m: f64,
    /// The reference.
    #[serde(default)]
    pub from: DeviationFrom,
    /// Inside this distance of the leg's own waypoints overshoot is judged instead.
    #[serde(default)]
    pub corner_m: f64,
}

/// The reference of the deviation.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum DeviationFrom {
    /// The straight leg being flown.
    #[default]
    Leg,
    /// The nearest of the previous and the current leg.
    NearestLeg,
    /// The planned path; of `minimum-snap` the curve that it makes of the waypoints.
    Path,
}

/// `{ max_m }`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MaxMetres {
    /// The limit.
    pub max_m: f64,
}

/// `{ min_m }`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MinMetres {
    /// The limit.
    pub min_m: f64,
}

/// `{ max_m_s2 }`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MaxAcceleration {
    /// The limit.
    pub max_m_s2: f64,
}

/// `{ max_s }`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MaxSeconds {
    /// The limit.
    pub max_s: f64,
}
