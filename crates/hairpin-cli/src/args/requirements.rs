//! What can be typed after `hairpin requirements`.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::terrain::MapFlags;

/// Every value is measured in this run. Exit code 0 if every requirement is met, 1 if not.
///
/// The source is T. Howard's rough terrain trajectory generator for planetary rovers (2006): its requirements R-1 …
/// R-17 and the 19 tests of its results document.
#[derive(Debug, Args)]
pub(crate) struct Requirements {
    /// Whose requirements
    #[arg(value_enum)]
    pub(crate) of: Generator,
    /// Elevation map to drive on; cratered ground from a seed if not given
    #[arg(long, value_name = "DEM")]
    pub(crate) terrain: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) map: MapFlags,
    /// Put rocks on that map, which cover this share of it; those of two cells and more
    #[arg(long, value_name = "SHARE", requires = "terrain")]
    pub(crate) rocks: Option<f64>,
    /// Queries of each large family
    #[arg(long, value_name = "N", default_value_t = 300, value_parser = clap::value_parser!(u32).range(20..=1_000_000))]
    pub(crate) queries: u32,
    /// Solve the problems of the regression store again, write their drives into DIR, and end
    #[arg(long, value_name = "DIR", conflicts_with = "terrain")]
    pub(crate) write_regression: Option<PathBuf>,
    /// One JSON object on stdout
    #[arg(long)]
    pub(crate) json: bool,
}

/// Generators that have requirements.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Generator {
    /// Boundary-value drives of rovers
    Rover,
}
