//! Elevation maps from the files of the command line.

use std::path::Path;

use hairpin::world::terrain::{ElevationMap, HoleRule};
use hairpin_formats::terrain::Georeference;
use hairpin_jobs::Problem;
use hairpin_jobs::terrain::read_map;

use crate::args::MapFlags;

/// The map in the file at `path`, its holes treated by the rule `holes`.
pub(super) fn read(path: &Path, flags: &MapFlags, holes: HoleRule) -> Result<ElevationMap, Problem> {
    read_map(path, &georeference(flags, holes))
}

/// What is given of a map's file.
pub(super) fn georeference(flags: &MapFlags, holes: HoleRule) -> Georeference {
    Georeference {
        cell_m: flags.terrain_cell_m,
        height_m: flags.terrain_height_m,
        origin_m: flags.terrain_origin_m,
        columns: None,
        holes,
    }
}
