//! `[spec]`: what is within spec.

use std::sync::Arc;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::campaign::arm::Baseline;

/// `[spec]`: what is not given is not judged.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct ArmSpec {
    /// Deviation from the programmed path.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub path: Option<PathLimit>,
    /// Arrival at the points.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub arrival: Option<ArrivalLimit>,
    /// Against an earlier recording.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub regression: Option<RegressionLimit>,
    /// Share of programs that may violate the limits above; without it a single one fails.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub violation_share: Option<f64>,
    /// Confidence of the share's interval.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub confidence: Option<f64>,
}

/// `path = { max_mm, from }`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PathLimit {
    /// Largest distance of the tool's point from the path.
    pub max_mm: f64,
    /// blended: the zoned path that was programmed; sharp: the polyline through the points.
    #[serde(default)]
    pub from: PathFrom,
}

/// What the deviation of an arm is measured from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum PathFrom {
    /// The path with its zones.
    #[default]
    Blended,
    /// The path through the points.
    Sharp,
}

/// `arrival = { max_late_ms }`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ArrivalLimit {
    /// Latest arrival at a point after its planned time.
    pub max_late_ms: f64,
}

/// `regression = { baseline, band_sigma }`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RegressionLimit {
    /// The folder of an earlier release's campaign, which was judged, or its `moves.json` or `baseline.json`; relative
    /// to the scenario file. The folder's name is the release's.
    pub baseline: String,
    /// Half the width of the band, in the baseline's own standard deviations.
    #[serde(default = "three")]
    pub band_sigma: f64,
    /// SHA-256 of the copy in the campaign's folder, as resolved scenarios have it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub checksum: Option<String>,
    /// What the earlier releases did, once it was read.
    #[serde(skip)]
    pub read: Option<Arc<Baseline>>,
    /// The file as a campaign keeps it.
    #[serde(skip)]
    pub bytes: Option<Arc<[u8]>>,
}

fn three() -> f64 {
    3.0
}
