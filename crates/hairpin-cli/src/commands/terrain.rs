//! What is typed of elevation maps' files.

use hairpin::world::terrain::HoleRule;
use hairpin_formats::terrain::Georeference;

use crate::args::MapFlags;

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
