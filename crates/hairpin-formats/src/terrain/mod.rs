//! Elevation maps in: GeoTIFF, ESRI ASCII grid, 16-bit PNG, raw 16-bit rasters and NumPy arrays.

mod ascii;
mod error;
mod georeference;
mod geotiff;
mod keep_out;
mod numpy;
mod raster;
mod sixteen_bit;

#[cfg(test)]
mod tests;

pub use error::{MOST_CELLS, TerrainError};
pub use georeference::Georeference;
pub use keep_out::{KeepOutError, read_keep_outs};

use hairpin::world::terrain::ElevationMap;

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
        "png" => sixteen_bit::read_png(bytes, georeference)?,
        "raw" | "bin" => sixteen_bit::read_raw(bytes, georeference)?,
        "npy" => numpy::read(bytes, georeference)?,
        _ => return Err(TerrainError::Format),
    };
    Ok(ElevationMap::new(raster.grid, &raster.heights, georeference.holes)?)
}
