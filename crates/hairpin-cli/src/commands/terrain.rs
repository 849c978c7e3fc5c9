//! What is typed of elevation maps' files.

use hairpin::campaign::scenario::MapUnit;
use hairpin::world::terrain::HoleRule;
use hairpin_formats::terrain::Georeference;

use crate::args::{self, MapFlags};

/// What is given of a map's file.
pub(super) fn georeference(flags: &MapFlags, holes: HoleRule) -> Georeference {
    Georeference {
        cell_m: flags.terrain_cell_m,
        height_m: flags.terrain_height_m,
        origin_m: flags.terrain_origin_m,
        columns: flags.terrain_columns,
        epsg: flags.terrain_epsg,
        unit: flags.terrain_unit.map(unit),
        height_unit: flags.terrain_height_unit.map(unit),
        holes,
        ..Georeference::default()
    }
}

fn unit(unit: args::MapUnit) -> MapUnit {
    match unit {
        args::MapUnit::M => MapUnit::M,
        args::MapUnit::Ft => MapUnit::Ft,
        args::MapUnit::UsFt => MapUnit::UsFt,
    }
}
