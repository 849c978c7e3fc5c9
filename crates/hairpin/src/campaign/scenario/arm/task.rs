//! `[task]`: the cloud of points that programs go through.

use std::sync::Arc;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// `[task]`.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ArmTask {
    /// A CSV file (x_mm, y_mm, z_mm, and if wanted q1 … q4 and cf1, cf4, cf6, cfx), a RAPID module whose robtargets are
    /// the points, a list of x, y, z in mm, or `{ count = N }`: drawn within the arm's reach.
    pub points: PointsSource,
    /// Frame of the points, and the orientation of those that have none.
    #[serde(default)]
    pub points_in: PointsIn,
    /// Joint angles that every program starts and ends at.
    #[serde(default = "home")]
    pub home_deg: [f64; 6],
    /// SHA-256 of the points' file, as resolved scenarios have it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub checksum: Option<String>,
    /// The points of a file, once it was read.
    #[serde(skip)]
    pub cloud: Option<Arc<[CloudPoint]>>,
    /// The file as it was read: a campaign keeps its own copy.
    #[serde(skip)]
    pub bytes: Option<Arc<[u8]>>,
}

impl PartialEq for ArmTask {
    /// Compares the keys: two reads of one file are one cloud.
    fn eq(&self, other: &Self) -> bool {
        self.points == other.points
            && self.points_in == other.points_in
            && self.home_deg == other.home_deg
            && self.checksum == other.checksum
    }
}

impl ArmTask {
    /// How many points there are; 0 before a file was read.
    pub fn count(&self) -> u64 {
        match &self.points {
            PointsSource::File(_) => self.cloud.as_ref().map_or(0, |cloud| cloud.len() as u64),
            PointsSource::List(list) => list.len() as u64,
            PointsSource::Drawn(drawn) => drawn.count,
        }
    }
}

/// Where shipped arms are said to wait: the forearm level, the tool tilted away from the wrist's singularity.
fn home() -> [f64; 6] {
    [0.0, 0.0, 0.0, 0.0, 30.0, 0.0]
}

/// Where the points come from.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum PointsSource {
    /// A file.
    File(String),
    /// The points themselves, mm.
    List(Vec<[f64; 3]>),
    /// Drawn.
    Drawn(DrawnPoints),
}

/// `points = { count, seed }`: uniform in the part of the reach that the tool gets to.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DrawnPoints {
    /// How many.
    pub count: u64,
    /// Seed of the draws; the scenario's if not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub seed: Option<u64>,
}

/// One point as it was given.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CloudPoint {
    /// x, y, z, mm, in the frame of the points.
    pub mm: [f64; 3],
    /// Orientation, scalar first; that of the scenario where there is none.
    pub q1_q4: Option<[f64; 4]>,
    /// cf1, cf4, cf6, cfx; any where there are none.
    pub configuration: Option<[i32; 4]>,
}

/// `points_in = { frame, q1_q4_default }`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct PointsIn {
    /// base | wobj | world.
    pub frame: PointsFrame,
    /// Orientation of points that have none, scalar first; tool down if not given.
    pub q1_q4_default: [f64; 4],
}

impl Default for PointsIn {
    fn default() -> Self {
        Self { frame: PointsFrame::default(), q1_q4_default: [0.0, 0.0, 1.0, 0.0] }
    }
}

/// Frames of points.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum PointsFrame {
    /// The arm's base.
    #[default]
    Base,
    /// The work object.
    Wobj,
    /// The world that the base stands in.
    World,
}
