//! `[world]`: the ground, and where nothing may drive.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::keep_out::{KeepOutSection, keep_outs};
use crate::campaign::scenario::{Mistake, Origin};
use crate::world::terrain::KeepOuts;

/// `[world]`: m, z up, x east, y north, as the elevation map has them.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GroundSection {
    /// The ground.
    pub terrain: TerrainSection,
    /// Frame of the poses in this file: enu | ned (z down, yaw clockwise from north). Resolved scenarios are in enu,
    /// their origin's heading with them.
    #[serde(default)]
    pub frame: Frame,
    /// Where nothing may drive.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub keep_out: Vec<KeepOutSection>,
    /// Where on Earth the map's origin lies: used by geodetic exports. The x axis is that of `frame`: with a map whose
    /// y is north its heading is 90 in enu and 0 in ned.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub origin: Option<Origin>,
}

impl GroundSection {
    /// The places of `keep_out`.
    ///
    /// # Errors
    /// The key that is out of bounds.
    pub(in crate::campaign) fn keep_outs(&self) -> Result<KeepOuts, Mistake> {
        keep_outs(&self.keep_out).map_err(|mistake| Mistake { key: format!("world.{}", mistake.key), ..mistake })
    }
}

/// Frames of poses in scenario files.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Frame {
    /// x east, y north, yaw counter-clockwise from east.
    #[default]
    Enu,
    /// x north, y east, yaw clockwise from north.
    Ned,
}

/// `terrain = { file = … }` or `terrain = { generator = … }`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TerrainSection {
    /// GeoTIFF, ESRI ASCII grid, 16-bit PNG or raw raster, NumPy array; relative to the scenario file.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
    /// Cells without data: error | keep-out | fill.
    #[serde(default)]
    pub no_data: NoData,
    /// Edge of a cell: of generated ground, and where the file does not say it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cell_m: Option<f64>,
    /// Heights of the least and the largest value of a 16-bit file.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub height_m: Option<[f64; 2]>,
    /// Centre of the south-west cell, where the file does not say it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub origin_m: Option<[f64; 2]>,
    /// Cells along x of a raw file that is not square.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub columns: Option<usize>,
    /// hairpin's own ground: craters | fractal | flat.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub generator: Option<GeneratorName>,
    /// Edge of the generated square; 60 m if not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub size_m: Option<f64>,
    /// Seed of the generated ground; the scenario's if not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub seed: Option<u64>,
    /// Standard deviation of the generated ground's height, about.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub relief_m: Option<f64>,
    /// Share of the generated ground that is covered by rocks.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rock_cover: Option<f64>,
    /// EPSG code of the plane that the file's coordinates are in, where the file does not say it: places it on Earth.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub epsg: Option<u32>,
    /// Unit of the file's x and y, where it does not say it: m | ft | us-ft.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub unit: Option<MapUnit>,
    /// Unit of the file's heights, where it does not say it: m | ft | us-ft.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub height_unit: Option<MapUnit>,
    /// Taken off the file's coordinates: what x and y are relative to in all that is written. Where it is left out and
    /// the map lies farther than 20 km from its plane's zero, whole kilometres are, and poses of this file are in the
    /// map's own coordinates; resolved scenarios say it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub offset_m: Option<[f64; 2]>,
    /// What the map's plane is called, as resolved scenarios have it, where its projection is not known: its metres are
    /// taken for the ground's.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub unknown_plane: Option<String>,
    /// SHA-256 of the file's bytes, as resolved scenarios have it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub checksum: Option<String>,
}

/// Units of maps.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum MapUnit {
    /// Metre.
    M,
    /// International foot, 0.3048 m.
    Ft,
    /// US survey foot, 1200/3937 m.
    UsFt,
}

/// The plane of a map and what is taken off its coordinates.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Projected {
    /// EPSG code of the plane.
    pub epsg: u32,
    /// Easting and northing of x = y = 0, m.
    pub offset: [f64; 2],
}

impl TerrainSection {
    /// The plane that the map lies in, where it is known.
    pub fn projected(&self) -> Option<Projected> {
        self.epsg.map(|epsg| Projected { epsg, offset: self.offset_m.unwrap_or([0.0, 0.0]) })
    }
}

/// Rules for cells that hold no data.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum NoData {
    /// A reason to refuse the map.
    #[default]
    Error,
    /// Nowhere to drive.
    KeepOut,
    /// Filled in from around.
    Fill,
}

/// Kinds of generated ground.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum GeneratorName {
    /// Fractal ground with craters and rocks.
    Craters,
    /// Fractal ground with rocks.
    Fractal,
    /// A plane at height 0.
    Flat,
}
