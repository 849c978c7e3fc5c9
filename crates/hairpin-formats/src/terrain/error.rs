//! Why a file is no elevation map.

use hairpin::world::terrain::MapError;
use thiserror::Error;

/// Cells of a map at most: 400 MB of heights.
pub const MOST_CELLS: u64 = 100_000_000;

/// Why a file is no elevation map.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum TerrainError {
    /// The name says no format.
    #[error("must be named .tif, .tiff, .asc, .png, .raw, .bin or .npy")]
    Format,
    /// The file cannot be understood.
    #[error("{0}")]
    Broken(String),
    /// More cells than are worth reading at once.
    #[error("{columns} x {rows} cells: at most {MOST_CELLS} in all; crop the map first")]
    TooLarge {
        /// Cells along x.
        columns: u64,
        /// Cells along y.
        rows: u64,
    },
    /// The file does not say it, and it was not given.
    #[error("{key}: the file does not say it; it must be given")]
    Missing {
        /// Key of the terrain's table.
        key: &'static str,
    },
    /// The file says it itself.
    #[error("{key}: the file says it itself; it must not be given")]
    Unwanted {
        /// Key of the terrain's table.
        key: &'static str,
    },
    /// A number is out of bounds.
    #[error("{key} = {value}: must be {bound}")]
    Wrong {
        /// Key of the terrain's table.
        key: &'static str,
        /// Its value.
        value: String,
        /// What it must be.
        bound: &'static str,
    },
    /// The cells are no map.
    #[error(transparent)]
    Map(#[from] MapError),
}
