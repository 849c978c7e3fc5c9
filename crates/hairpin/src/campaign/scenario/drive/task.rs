//! `[task]`: what is to be driven.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// `[task]`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DriveTask {
    /// First waypoint.
    pub start: StartPose,
    /// Last waypoint; anywhere if not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub end_m: Option<[f64; 2]>,
    /// Waypoints, start and end included.
    pub length: u64,
    /// Shortest and longest distance between waypoints that follow each other.
    pub leg_m: [f64; 2],
}

/// `start = { x_m, y_m, yaw_deg, curvature_1_m }`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StartPose {
    /// In the map's own coordinates.
    pub x_m: f64,
    /// In the map's own coordinates.
    pub y_m: f64,
    /// Heading.
    #[serde(default)]
    pub yaw_deg: f64,
    /// How the wheels are turned.
    #[serde(default)]
    pub curvature_1_m: f64,
}
