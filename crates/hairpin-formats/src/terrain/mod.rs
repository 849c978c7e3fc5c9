//! Elevation maps in: GeoTIFF, ESRI ASCII grid, 16-bit PNG, raw 16-bit rasters and NumPy arrays.

mod ascii;
mod geotiff;
mod keep_out;
mod numpy;
mod raster;

#[cfg(test)]
mod tests;

pub use keep_out::{KeepOutError, read_keep_outs};

use hairpin::world::terrain::{ElevationMap, Grid, HoleRule, MapError};
use thiserror::Error;

/// What a file does not say of itself; what it does say must not be given.
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
    /// What to do with cells without data.
    pub holes: HoleRule,
}

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

/// Cells of a map at most: 400 MB of heights.
pub const MOST_CELLS: u64 = 100_000_000;

/// Heights as a raster has them, rows from the north, NaN where there is no data.
struct Raster {
    grid: Grid,
    heights: Vec<f32>,
}

/// Reads the elevation map `bytes`; the ending of `name` tells the format.
///
/// # Errors
/// [`TerrainError`].
pub fn read_terrain(bytes: &[u8], name: &str, georeference: &Georeference) -> Result<ElevationMap, TerrainError> {
    let ending = name.rsplit('.').next().unwrap_or_default().to_ascii_lowercase();
    let says_itself = matches!(ending.as_str(), "tif" | "tiff" | "asc");
    if says_itself {
        let given = [
            ("cell_m", georeference.cell_m.is_some()),
            ("height_m", georeference.height_m.is_some()),
            ("origin_m", georeference.origin_m.is_some()),
            ("columns", georeference.columns.is_some()),
        ];
        if let Some((key, _)) = given.iter().find(|(_, given)| *given) {
            return Err(TerrainError::Unwanted { key });
        }
    }
    let raster = match ending.as_str() {
        "tif" | "tiff" => geotiff::read(bytes)?,
        "asc" => ascii::read(bytes)?,
        "png" => raster::read_png(bytes, georeference)?,
        "raw" | "bin" => raster::read_raw(bytes, georeference)?,
        "npy" => numpy::read(bytes, georeference)?,
        _ => return Err(TerrainError::Format),
    };
    Ok(ElevationMap::new(raster.grid, &raster.heights, georeference.holes)?)
}

/// Refuses maps of more than [`MOST_CELLS`] before anything is allocated.
fn bounded(columns: u64, rows: u64) -> Result<(usize, usize), TerrainError> {
    match columns.checked_mul(rows) {
        Some(cells) if cells <= MOST_CELLS => Ok((columns as usize, rows as usize)),
        _ => Err(TerrainError::TooLarge { columns, rows }),
    }
}

/// The grid of a file that does not know where it lies.
fn placed(columns: usize, rows: usize, georeference: &Georeference) -> Result<Grid, TerrainError> {
    let cell = georeference.cell_m.ok_or(TerrainError::Missing { key: "cell_m" })?;
    let first_center = georeference.origin_m.unwrap_or([0.0, 0.0]);
    Ok(Grid { columns, rows, first_center, cell: [cell, cell] })
}
