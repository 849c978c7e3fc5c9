//! 16-bit rasters whose values are scaled heights: PNG, and raw little-endian files.

use super::error::TerrainError;
use super::georeference::{Georeference, placed};
use super::raster::{Layout, Raster, bounded, held};
use super::reference::Reference;

/// Heights from `values` between the two given heights; the value `none` is no height.
fn scaled(
    values: impl Iterator<Item = u16>,
    none: Option<u16>,
    georeference: &Georeference,
) -> Result<Vec<f32>, TerrainError> {
    let [low, high] = georeference.height_m.ok_or(TerrainError::Missing { key: "height_m" })?;
    if !(low.is_finite() && high.is_finite() && low < high) {
        let bound = "two finite heights, the lower first";
        return Err(TerrainError::Wrong { key: "height_m", value: format!("[{low}, {high}]"), bound });
    }
    let step = (high - low) / f64::from(u16::MAX);
    let height = |value| (low + step * f64::from(value)) as f32;
    Ok(values.map(|value| if none == Some(value) { f32::NAN } else { height(value) }).collect())
}

pub(super) fn read_png(bytes: &[u8], georeference: &Georeference) -> Result<Raster, TerrainError> {
    let broken = |error: png::DecodingError| TerrainError::Broken(format!("no readable PNG: {error}"));
    let mut reader = png::Decoder::new(std::io::Cursor::new(bytes)).read_info().map_err(broken)?;
    let info = reader.info();
    let (columns, rows) = bounded(info.width.into(), info.height.into())?;
    if (info.color_type, info.bit_depth) != (png::ColorType::Grayscale, png::BitDepth::Sixteen) {
        let found = format!("{:?} of {:?} bits: 16-bit greyscale is needed", info.color_type, info.bit_depth);
        return Err(TerrainError::Broken(found));
    }
    // tRNS: cells of this grey are transparent, as programs write those without data.
    let none = info.trns.as_deref().and_then(<[u8]>::first_chunk).map(|bytes| u16::from_be_bytes(*bytes));
    held(columns, rows, bytes.len(), true)?;
    let mut pixels = vec![0; 2 * columns * rows];
    reader.next_frame(&mut pixels).map_err(broken)?;
    let values = pixels.chunks_exact(2).map(|pair| u16::from_be_bytes([pair[0], pair[1]]));
    let (grid, heights) = (placed(columns, rows, georeference)?, scaled(values, none, georeference)?);
    let layout = Layout { no_data: none.map(f64::from), ..Layout::default() };
    Ok(Raster { grid, heights, reference: Reference::default(), layout })
}

pub(super) fn read_raw(bytes: &[u8], georeference: &Georeference) -> Result<Raster, TerrainError> {
    let cells = bytes.len() / 2;
    let columns = georeference.columns.unwrap_or_else(|| cells.isqrt());
    if columns == 0
        || !bytes.len().is_multiple_of(2)
        || !cells.is_multiple_of(columns)
        || (georeference.columns.is_none() && columns * columns != cells)
    {
        let found =
            format!("{} bytes are no rows of {columns} 16-bit heights; `columns` tells their number", bytes.len());
        return Err(TerrainError::Broken(found));
    }
    let (columns, rows) = bounded(columns as u64, (cells / columns) as u64)?;
    let values = bytes.chunks_exact(2).map(|pair| u16::from_le_bytes([pair[0], pair[1]]));
    let (grid, heights) = (placed(columns, rows, georeference)?, scaled(values, None, georeference)?);
    Ok(Raster { grid, heights, reference: Reference::default(), layout: Layout::default() })
}
