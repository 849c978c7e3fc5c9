//! Elevation maps from files.

use std::path::Path;

use hairpin::world::terrain::Grid;
use hairpin_formats::bounds::{self, MOST_RASTER_BYTES};
use hairpin_formats::terrain::{Georeference, Layout, MapFile, Sidecars, Source, Told, Unit, read_terrain};
use serde::Serialize;

use crate::Problem;

/// The map in the file at `path`, with what its file says of it.
///
/// # Errors
/// The file cannot be read, or is no map.
pub fn read_map(path: &Path, georeference: &Georeference) -> Result<MapFile, Problem> {
    let bytes = bounds::read(path, MOST_RASTER_BYTES).map_err(|error| Problem::of_file(path, error))?;
    read_terrain(&bytes, &path.to_string_lossy(), &Sidecars::beside(path), georeference)
        .map_err(|error| Problem::of_file(path, error))
}

/// What an elevation map says, as it was understood.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MapSummary {
    /// Cells along x, east.
    pub columns: usize,
    /// Cells along y, north.
    pub rows: usize,
    /// Edges of a cell along x and y.
    pub cell_m: [f64; 2],
    /// Least and largest x, in the map's own coordinates.
    pub x_m: [f64; 2],
    /// Least and largest y.
    pub y_m: [f64; 2],
    /// Least and largest height of the cells with data.
    pub height_m: [f32; 2],
    /// Cells without data.
    pub holes: usize,
    /// The northernmost, westernmost cell.
    pub north_west: Corner,
    /// EPSG code of the plane, where it is known.
    pub epsg: Option<u32>,
    /// What the file calls its plane.
    pub plane: Option<String>,
    /// How long a metre of the ground is on the plane, along its x and y at the map's middle; `None` where its
    /// projection is not known: its metres are taken for the ground's.
    pub ground_metre: Option<[f64; 2]>,
    /// What a campaign takes off the map's coordinates.
    pub offset_m: [f64; 2],
    /// Unit of x and y in the file.
    pub unit: UnitSummary,
    /// Unit of heights in the file.
    pub height_unit: UnitSummary,
    /// A height is the file's value times this …
    pub scale: f64,
    /// … plus this, in the file's unit.
    pub offset: f64,
    /// The value that means no data, as text: JSON has no NaN.
    pub no_data: Option<String>,
    /// Whether the file masks cells beside that.
    pub masked: bool,
    /// `north-up` or `south-up`: which row the file begins with.
    pub orientation: &'static str,
    /// `centres` or `corners`: what of a cell the file's coordinates name.
    pub coordinates_of: &'static str,
}

/// A unit of a file; a map is in metres.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct UnitSummary {
    /// What it is called.
    pub name: String,
    /// One of it.
    pub metres: f64,
    /// `file`, `given`, or `taken` where nobody says it.
    pub from: &'static str,
}

impl UnitSummary {
    fn of(unit: &Unit, from: Source) -> Self {
        let from = match from {
            Source::File => "file",
            Source::Given => "given",
            Source::Taken => "taken",
        };
        Self { name: unit.name.clone(), metres: unit.metres, from }
    }
}

impl MapSummary {
    /// Wheel bases under this are too short for its cells, m: attitudes are optimistic.
    pub fn coarse_m(&self) -> f64 {
        2.0 * self.cell_m[0].max(self.cell_m[1])
    }
}

/// The cell in a corner of a map.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Corner {
    /// Its place along x.
    pub x_m: f64,
    /// Its place along y.
    pub y_m: f64,
    /// Its height, if it has data.
    pub height_m: Option<f32>,
}

/// What the map in the file at `path` says.
///
/// # Errors
/// As of [`read_map`].
pub fn summarise_map(path: &Path, georeference: &Georeference) -> Result<MapSummary, Problem> {
    let MapFile { map, told } = read_map(path, georeference)?;
    let Grid { columns, rows, cell, .. } = *map.grid();
    let Told { unit, unit_from, height_unit, height_unit_from, epsg, name, scale, offset_m, layout, .. } = told;
    let ground_metre = scale.map(|scale| scale.along);
    let Layout { scale, offset, no_data, masked, south_up, at_centers } = layout;
    let (low, high) = map.extent();
    let [low, high] = [low, high].map(|at| [at[0] + offset_m[0], at[1] + offset_m[1]]);
    let known = |height: f32| (!height.is_nan()).then_some(height);
    let heights = (0..rows * columns).filter_map(|i| known(map.cell_height(i / columns, i % columns)));
    let [min, max] = heights.fold([f32::INFINITY, f32::NEG_INFINITY], |[low, high], h| [low.min(h), high.max(h)]);
    Ok(MapSummary {
        columns,
        rows,
        cell_m: cell,
        x_m: [low[0], high[0]],
        y_m: [low[1], high[1]],
        height_m: [min, max],
        holes: map.holes(),
        north_west: Corner { x_m: low[0], y_m: high[1], height_m: known(map.cell_height(rows - 1, 0)) },
        epsg,
        plane: Some(name).filter(|name| !name.is_empty()),
        ground_metre,
        offset_m,
        unit: UnitSummary::of(&unit, unit_from),
        height_unit: UnitSummary::of(&height_unit, height_unit_from),
        scale,
        offset,
        no_data: no_data.map(|value| value.to_string()),
        masked,
        orientation: if south_up { "south-up" } else { "north-up" },
        coordinates_of: if at_centers { "centres" } else { "corners" },
    })
}

#[cfg(test)]
mod tests {
    use hairpin::world::terrain::HoleRule;

    use super::*;

    #[test]
    fn a_map_is_summed_up() {
        let place = tempfile::tempdir().unwrap();
        let path = place.path().join("map.asc");
        let head = "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\nNODATA_value -9999\n";
        std::fs::write(&path, format!("{head}3 4\n-9999 1.5\n")).unwrap();
        let georeference = Georeference { holes: HoleRule::KeepOut, ..Georeference::default() };
        let map = summarise_map(&path, &georeference).unwrap();
        assert_eq!((map.columns, map.rows, map.holes), (2, 2, 1));
        assert_eq!((map.height_m, map.north_west.height_m), ([1.5, 4.0], Some(3.0)));
        assert!(summarise_map(&place.path().join("none.asc"), &georeference).is_err());
    }
}
