//! What a file does not say of where it lies.

use hairpin::campaign::scenario::MapUnit;
use hairpin::world::terrain::{Grid, HoleRule};

use super::error::TerrainError;

/// What a file does not say of itself; what it does say must not be given, or be the same.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Georeference {
    /// Edge length of a cell, m: for PNG, raw and NumPy files.
    pub cell_m: Option<f64>,
    /// Heights of the least and the largest value a 16-bit file can hold, m.
    pub height_m: Option<[f64; 2]>,
    /// Centre of the south-west cell, m; (0, 0) if not given: for PNG, raw and NumPy files.
    pub origin_m: Option<[f64; 2]>,
    /// Cells along x: for raw files, square if not given.
    pub columns: Option<usize>,
    /// EPSG code of the plane.
    pub epsg: Option<u32>,
    /// Unit of x and y, and of heights where they have no other: for GeoTIFF and ASCII grids.
    pub unit: Option<MapUnit>,
    /// Unit of heights.
    pub height_unit: Option<MapUnit>,
    /// Taken off the coordinates, m; [`super::offset_of`] chooses it if not given.
    pub offset_m: Option<[f64; 2]>,
    /// Heights whose unit nobody says are taken in that of x and y, to show the file.
    pub assume_heights: bool,
    /// What to do with cells without data.
    pub holes: HoleRule,
}

/// The grid of a file that does not know where it lies.
pub(super) fn placed(columns: usize, rows: usize, georeference: &Georeference) -> Result<Grid, TerrainError> {
    let cell = georeference.cell_m.ok_or(TerrainError::Missing { key: "cell_m" })?;
    let first_center = georeference.origin_m.unwrap_or([0.0, 0.0]);
    Ok(Grid { columns, rows, first_center, cell: [cell, cell] })
}
