//! The heights of a map, cell by cell.

use hairpin::world::terrain::Grid;

use super::error::{MOST_CELLS, TerrainError};

/// Heights as a raster has them, rows from the north, NaN where there is no data.
pub(super) struct Raster {
    pub(super) grid: Grid,
    pub(super) heights: Vec<f32>,
}

/// Refuses maps of more than [`MOST_CELLS`] before anything is allocated.
pub(super) fn bounded(columns: u64, rows: u64) -> Result<(usize, usize), TerrainError> {
    match columns.checked_mul(rows) {
        Some(cells) if cells <= MOST_CELLS => Ok((columns as usize, rows as usize)),
        _ => Err(TerrainError::TooLarge { columns, rows }),
    }
}
