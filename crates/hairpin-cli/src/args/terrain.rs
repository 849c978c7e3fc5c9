//! What can be typed of elevation maps.

use std::path::PathBuf;

use clap::{Args, Subcommand, ValueEnum};

use super::numbers::{pair, positive};

/// What is shown.
#[derive(Debug, Args)]
pub(crate) struct Show {
    #[command(subcommand)]
    pub(crate) what: Shown,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Shown {
    /// An elevation map: extent, cells, heights, holes, a corner's sample
    Terrain(ShowTerrain),
}

#[derive(Debug, Args)]
pub(crate) struct ShowTerrain {
    /// GeoTIFF, ESRI ASCII grid, 16-bit PNG or raw raster, NumPy array
    pub(crate) terrain: PathBuf,
    #[command(flatten)]
    pub(crate) map: MapFlags,
    /// One JSON object on stdout
    #[arg(long)]
    pub(crate) json: bool,
}

/// What an elevation map's file does not say of itself.
#[derive(Debug, Default, Args)]
pub(crate) struct MapFlags {
    /// Edge of a cell, m, where the map's file does not say it (PNG, raw, NumPy)
    #[arg(long, value_name = "M", value_parser = positive, requires = "terrain")]
    pub(crate) terrain_cell_m: Option<f64>,
    /// Heights of the least and largest 16-bit value, m, of PNG and raw maps
    #[arg(long, value_name = "LOW,HIGH", value_parser = pair, allow_hyphen_values = true, requires = "terrain")]
    pub(crate) terrain_height_m: Option<[f64; 2]>,
    /// Centre of the south-west cell, m, of PNG, raw and NumPy maps
    #[arg(long, value_name = "X,Y", value_parser = pair, allow_hyphen_values = true, requires = "terrain")]
    pub(crate) terrain_origin_m: Option<[f64; 2]>,
    /// Cells along x of a raw map that is not square
    #[arg(long, value_name = "N", requires = "terrain")]
    pub(crate) terrain_columns: Option<usize>,
    /// EPSG code of the map's plane, where its file does not say it
    #[arg(long, value_name = "CODE", requires = "terrain")]
    pub(crate) terrain_epsg: Option<u32>,
    /// Unit of the map's x and y, where its file does not say it
    #[arg(long, value_name = "UNIT", requires = "terrain")]
    pub(crate) terrain_unit: Option<MapUnit>,
    /// Unit of the map's heights, where its file does not say it
    #[arg(long, value_name = "UNIT", requires = "terrain")]
    pub(crate) terrain_height_unit: Option<MapUnit>,
}

/// Units of elevation maps.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum MapUnit {
    /// Metre
    M,
    /// International foot, 0.3048 m
    Ft,
    /// US survey foot, 1200/3937 m
    UsFt,
}

/// Rules for cells of an elevation map that hold no data.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum NoData {
    /// A reason to refuse the map
    Error,
    /// Nowhere to drive
    KeepOut,
    /// Filled in from around
    Fill,
}
