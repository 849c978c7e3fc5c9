//! Places to keep out of, in the map: x east, y north.

use std::path::PathBuf;

use clap::Args;

use crate::args::numbers::{corners, triple};

/// Corners of a polygon as they are typed.
#[derive(Debug, Clone)]
pub(crate) struct Corners(pub(crate) Vec<[f64; 2]>);

#[derive(Debug, Args)]
pub(crate) struct KeepOutFlags {
    /// Places to keep out of: keep_out = [{ name, circle = { center_m, radius_m } }, ...] or polygon = { points_m }, as
    /// in scenarios
    #[arg(long, value_name = "FILE.toml")]
    pub(crate) keep_out: Option<PathBuf>,
    /// A round place to keep out of, such as a rock, m in the map (x east, y north); may be given again
    #[arg(long, value_name = "X,Y,RADIUS", value_parser = triple, allow_hyphen_values = true)]
    pub(crate) keep_out_circle: Vec<[f64; 3]>,
    /// One with three corners or more; may be given again
    #[arg(long, value_name = "X,Y,X,Y,X,Y", value_parser = polygon, allow_hyphen_values = true)]
    pub(crate) keep_out_polygon: Vec<Corners>,
}

fn polygon(text: &str) -> Result<Corners, String> {
    corners(text).map(Corners)
}
