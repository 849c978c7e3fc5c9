//! Elevation maps from files.

use std::path::Path;

use hairpin::world::terrain::ElevationMap;
use hairpin_formats::terrain::{Georeference, read_terrain};

use crate::Problem;

/// The map in the file at `path`.
///
/// # Errors
/// The file cannot be read, or is no map.
pub fn read_map(path: &Path, georeference: &Georeference) -> Result<ElevationMap, Problem> {
    let refuse = |why: String| Problem::input(format!("{}: {why}", path.display()));
    let bytes = std::fs::read(path).map_err(|error| refuse(error.to_string()))?;
    read_terrain(&bytes, &path.to_string_lossy(), georeference).map_err(|error| refuse(error.to_string()))
}
