//! `generate.environment`: what is searched beside the waypoints.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// `generate.environment`: for `in-loop`; what is found is part of the case.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct EnvironmentSection {
    /// A constant wind of at most this speed.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub wind_m_s: Option<f64>,
    /// One discrete gust of at most this speed, on top of it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub gust_m_s: Option<f64>,
    /// How long the gust takes.
    pub gust_s: f64,
    /// Obstacles that leave the plan clear, placed where the flight leaves it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub obstacles: Option<PlacedSection>,
}

impl Default for EnvironmentSection {
    fn default() -> Self {
        Self { wind_m_s: None, gust_m_s: None, gust_s: 2.0, obstacles: None }
    }
}

/// `obstacles = { count, radius_m }` for balls, `{ count, size_m }` for boxes.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PlacedSection {
    /// How many.
    pub count: u64,
    /// Radius of each, if they are balls.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub radius_m: Option<f64>,
    /// Edge lengths of each, if they are boxes.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub size_m: Option<[f64; 3]>,
}
