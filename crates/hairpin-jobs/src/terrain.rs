//! Elevation maps from files.

use std::path::Path;

use hairpin::world::terrain::{ElevationMap, Grid};
use hairpin_formats::terrain::{Georeference, read_terrain};

use serde::Serialize;

use crate::Problem;

/// The map in the file at `path`.
///
/// # Errors
/// The file cannot be read, or is no map.
pub fn read_map(path: &Path, georeference: &Georeference) -> Result<ElevationMap, Problem> {
    let bytes = std::fs::read(path).map_err(|error| Problem::of_file(path, error))?;
    read_terrain(&bytes, &path.to_string_lossy(), georeference).map_err(|error| Problem::of_file(path, error))
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
    /// Least and largest x.
    pub x_m: [f64; 2],
    /// Least and largest y.
    pub y_m: [f64; 2],
    /// Least and largest height of the cells with data.
    pub height_m: [f32; 2],
    /// Cells without data.
    pub holes: usize,
    /// The file's first cell.
    pub north_west: Corner,
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
    let map = read_map(path, georeference)?;
    let Grid { columns, rows, cell, .. } = *map.grid();
    let (low, high) = map.extent();
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
