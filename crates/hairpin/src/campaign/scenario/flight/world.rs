//! `[world]`: the space, its obstacles, its air, and where on Earth it stands.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// `[world]`: m, z up, origin at a floor corner of the cage.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct WorldSection {
    /// A shipped world (or world file) whose keys are taken where this table has none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub base: Option<String>,
    /// Edge lengths.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub size_m: Option<[f64; 3]>,
    /// Waypoints and predicted paths stay this far inside; 0 if not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub keep_in_margin_m: Option<f64>,
    /// Where on Earth the cage stands: used by every geodetic export.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub origin: Option<Origin>,
    /// Solids.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub obstacles: Vec<ObstacleSection>,
    /// Constant wind, velocity of the air.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub wind_m_s: Option<[f64; 3]>,
    /// Gusts on top of it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gusts: Option<Gusts>,
    /// One gust more, at a time of its own.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub discrete_gust: Option<DiscreteGustSection>,
}

/// Geodetic place and heading of the world frame.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Origin {
    /// Latitude of the origin, WGS 84.
    pub lat_deg: f64,
    /// Longitude of the origin.
    pub lon_deg: f64,
    /// Altitude of the origin above mean sea level.
    pub alt_amsl_m: f64,
    /// Compass heading of the x axis: 90: x is east.
    pub x_axis_heading_deg: f64,
}

/// Gusts: a first-order (Ornstein-Uhlenbeck) process per axis.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Gusts {
    /// Standard deviation per axis.
    pub std_m_s: f64,
    /// Correlation time.
    pub correlation_s: f64,
}

/// `discrete_gust = { velocity_m_s, start_s, duration_s }`: the air changes by velocity · (1 − cos 2π(t −
/// start)/duration)/2.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DiscreteGustSection {
    /// At its middle.
    pub velocity_m_s: [f64; 3],
    /// When it begins.
    pub start_s: f64,
    /// How long it takes.
    pub duration_s: f64,
}

/// One obstacle: exactly one of the shapes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ObstacleSection {
    /// Name in reports.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub name: String,
    /// An axis-aligned box.
    #[serde(default, rename = "box", skip_serializing_if = "Option::is_none")]
    pub cuboid: Option<BoxSection>,
    /// A ball.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sphere: Option<SphereSection>,
    /// All points within a radius of a segment.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub capsule: Option<CapsuleSection>,
    /// The convex hull of points.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub hull: Option<HullSection>,
    /// A closed triangle mesh.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mesh: Option<MeshSection>,
}

/// `box = { center_m, size_m }`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BoxSection {
    /// Centre.
    pub center_m: [f64; 3],
    /// Edge lengths.
    pub size_m: [f64; 3],
}

/// `sphere = { center_m, radius_m }`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SphereSection {
    /// Centre.
    pub center_m: [f64; 3],
    /// Radius.
    pub radius_m: f64,
}

/// `capsule = { a_m, b_m, radius_m }`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CapsuleSection {
    /// One end of the axis.
    pub a_m: [f64; 3],
    /// The other end.
    pub b_m: [f64; 3],
    /// Radius.
    pub radius_m: f64,
}

/// `hull = { points_m }`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct HullSection {
    /// At least four points that are not in one plane.
    pub points_m: Vec<[f64; 3]>,
}

/// `mesh = { vertices_m, triangles }` or `mesh = { file, scale }` (STL, OBJ or Collada, resolved into the former when
/// read).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MeshSection {
    /// An STL, OBJ or Collada file, relative to the scenario file.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
    /// How many m the file's unit is: 0.001 of one in mm; 1 if not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub scale: Option<f64>,
    /// Vertices.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub vertices_m: Vec<[f64; 3]>,
    /// Triangles as vertex indices from 0.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub triangles: Vec<[u32; 3]>,
}
