//! Elevation maps from the files of the command line.

use std::fs;
use std::path::Path;

use hairpin::world::terrain::{ElevationMap, HoleRule};
use hairpin_formats::terrain::{Georeference, read_terrain};

use crate::args::MapFlags;
use crate::problem::Problem;

/// The map in the file at `path`, its holes treated by the rule `holes`.
pub(super) fn read(path: &Path, flags: &MapFlags, holes: HoleRule) -> Result<ElevationMap, Problem> {
    let refuse = |why: String| Problem::input(format!("{}: {why}", path.display()));
    let bytes = fs::read(path).map_err(|error| refuse(error.to_string()))?;
    let georeference = Georeference {
        cell_m: flags.terrain_cell_m,
        height_m: flags.terrain_height_m,
        origin_m: flags.terrain_origin_m,
        columns: None,
        holes,
    };
    read_terrain(&bytes, &path.to_string_lossy(), &georeference).map_err(|error| refuse(error.to_string()))
}
