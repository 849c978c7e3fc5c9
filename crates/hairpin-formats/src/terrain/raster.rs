//! The heights of a map, cell by cell.

use hairpin::world::terrain::Grid;

use super::error::{MOST_CELLS, TerrainError};
use super::reference::Reference;

/// Heights as a raster has them, in the file's own units, rows from the north, NaN where there is no data.
pub(super) struct Raster {
    pub(super) grid: Grid,
    pub(super) heights: Vec<f32>,
    pub(super) reference: Reference,
    pub(super) layout: Layout,
}

/// How the file lays out and writes what it holds.
#[derive(Debug, Clone, PartialEq)]
pub struct Layout {
    /// A height is the value in the file times this …
    pub scale: f64,
    /// … plus this.
    pub offset: f64,
    /// The value that means no data.
    pub no_data: Option<f64>,
    /// Whether cells are masked beside that.
    pub masked: bool,
    /// Whether the file's first row is the south one.
    pub south_up: bool,
    /// Whether its coordinates name cells' centres, not their corners.
    pub at_centers: bool,
}

impl Default for Layout {
    fn default() -> Self {
        Self { scale: 1.0, offset: 0.0, no_data: None, masked: false, south_up: false, at_centers: true }
    }
}

/// Cells of four bytes that any packed file may stand for …
const ANY_CELLS: usize = 16_000_000;
/// … and for each of its bytes: heights come to half of theirs, cells without data to nearly nothing.
const CELLS_PER_BYTE: usize = 200;

/// Refuses a header that promises more than the file can hold, before memory is taken for it.
pub(super) fn held(columns: usize, rows: usize, bytes: usize, packed: bool) -> Result<(), TerrainError> {
    let most = if packed { ANY_CELLS.saturating_add(bytes.saturating_mul(CELLS_PER_BYTE)) } else { bytes };
    if columns * rows <= most {
        return Ok(());
    }
    let said = format!("the header says {columns} x {rows} cells, more than {bytes} bytes can hold");
    Err(TerrainError::Broken(said))
}

/// Refuses maps of more than [`MOST_CELLS`] before anything is allocated.
pub(super) fn bounded(columns: u64, rows: u64) -> Result<(usize, usize), TerrainError> {
    match columns.checked_mul(rows) {
        Some(cells) if cells <= MOST_CELLS => Ok((columns as usize, rows as usize)),
        _ => Err(TerrainError::TooLarge { columns, rows }),
    }
}
