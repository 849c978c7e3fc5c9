//! GeoTIFF: one band of heights with pixel scale and tie point, or a transformation without rotation.
//!
//! GTRasterTypeGeoKey tells whether a tie point names a cell's corner (1, the default) or its centre (2); GDAL_NODATA
//! tells which value means no data. Source: OGC GeoTIFF 1.1 (19-008r4).

use std::io::Cursor;

use hairpin::world::terrain::Grid;
use tiff::decoder::{Decoder, DecodingResult, Limits};
use tiff::tags::Tag;

use super::error::{MOST_CELLS, TerrainError};
use super::raster::{Raster, bounded};

const RASTER_TYPE: u16 = 1025;
const PIXEL_IS_POINT: u16 = 2;

type Tiff<'a> = Decoder<Cursor<&'a [u8]>>;

pub(super) fn read(bytes: &[u8]) -> Result<Raster, TerrainError> {
    let broken = |error: tiff::TiffError| TerrainError::Broken(format!("no readable GeoTIFF: {error}"));
    let mut limits = Limits::default();
    // Eight bytes a cell at most; the image's own strips cannot be larger.
    limits.decoding_buffer_size = 8 * MOST_CELLS as usize;
    limits.intermediate_buffer_size = limits.decoding_buffer_size;
    let mut tiff = Decoder::new(Cursor::new(bytes)).map_err(broken)?.with_limits(limits);
    let (columns, rows) = tiff.dimensions().map_err(broken)?;
    let (columns, rows) = bounded(columns.into(), rows.into())?;
    // A header can promise gigabytes that the file does not hold; a compressed cell still takes some bits.
    if columns * rows / 2048 > bytes.len() {
        let said = format!("the header says {columns} x {rows} cells, the file has {} bytes", bytes.len());
        return Err(TerrainError::Broken(said));
    }
    let samples = tiff.find_tag_unsigned::<u16>(Tag::SamplesPerPixel).map_err(broken)?.unwrap_or(1);
    if samples != 1 {
        return Err(TerrainError::Broken(format!("{samples} bands: one band of heights is needed")));
    }
    let grid = grid(&mut tiff, columns, rows)?;
    let no_data = no_data(&mut tiff)?;
    let values = match tiff.read_image().map_err(broken)? {
        DecodingResult::F32(v) => v,
        DecodingResult::F64(v) => v.into_iter().map(|h| h as f32).collect(),
        DecodingResult::U8(v) => v.into_iter().map(f32::from).collect(),
        DecodingResult::I8(v) => v.into_iter().map(f32::from).collect(),
        DecodingResult::U16(v) => v.into_iter().map(f32::from).collect(),
        DecodingResult::I16(v) => v.into_iter().map(f32::from).collect(),
        DecodingResult::U32(v) => v.into_iter().map(|h| h as f32).collect(),
        DecodingResult::I32(v) => v.into_iter().map(|h| h as f32).collect(),
        _ => return Err(TerrainError::Broken("samples of this type are no heights".into())),
    };
    let heights = values.into_iter().map(|h| if is_hole(h, no_data) { f32::NAN } else { h }).collect();
    Ok(Raster { grid, heights })
}

/// Heights below this are the −3.4e38 of tools that forget to say so.
const LOWEST: f32 = -1e30;

fn is_hole(height: f32, no_data: Option<f64>) -> bool {
    !height.is_finite() || height < LOWEST || no_data.is_some_and(|value| height == value as f32)
}

fn no_data(tiff: &mut Tiff<'_>) -> Result<Option<f64>, TerrainError> {
    let Ok(text) = tiff.get_tag_ascii_string(Tag::GdalNodata) else { return Ok(None) };
    let text = text.trim_matches(['\0', ' ']);
    match text.parse::<f64>() {
        Ok(value) => Ok(Some(value)),
        Err(_) => Err(TerrainError::Broken(format!("GDAL_NODATA = {text:?} is no number"))),
    }
}

/// Where the cells lie, from ModelPixelScale and ModelTiepoint or from ModelTransformation.
fn grid(tiff: &mut Tiff<'_>, columns: usize, rows: usize) -> Result<Grid, TerrainError> {
    let broken = |text: &str| TerrainError::Broken(text.into());
    // Column and row, in cells from the north-west corner of the raster, and where they lie.
    let (scale, tie) =
        match (tiff.get_tag_f64_vec(Tag::ModelPixelScaleTag), tiff.get_tag_f64_vec(Tag::ModelTiepointTag)) {
            (Ok(scale), Ok(tie)) if scale.len() >= 2 && tie.len() >= 6 => {
                ([scale[0], scale[1]], [tie[0], tie[1], tie[3], tie[4]])
            }
            _ => match tiff.get_tag_f64_vec(Tag::ModelTransformationTag) {
                Ok(m) if m.len() == 16 => {
                    if m[1] != 0.0 || m[4] != 0.0 {
                        return Err(broken("the raster is rotated against its coordinates: warp it first"));
                    }
                    ([m[0], -m[5]], [0.0, 0.0, m[3], m[7]])
                }
                _ => return Err(broken("no georeference: ModelPixelScale and ModelTiepoint are needed")),
            },
        };
    if !(scale.iter().all(|s| s.is_finite() && *s > 0.0) && tie.iter().all(|t| t.is_finite())) {
        return Err(broken("the georeference needs positive, finite cell sizes and a finite tie point"));
    }
    let to_center = if raster_type(tiff) == PIXEL_IS_POINT { 0.0 } else { 0.5 };
    let west = tie[2] + (to_center - tie[0]) * scale[0];
    let south = tie[3] - ((rows - 1) as f64 + to_center - tie[1]) * scale[1];
    Ok(Grid { columns, rows, first_center: [west, south], cell: scale })
}

fn raster_type(tiff: &mut Tiff<'_>) -> u16 {
    let keys = tiff.get_tag_u16_vec(Tag::GeoKeyDirectoryTag).unwrap_or_default();
    // A header of four numbers, then (key, place, count, value) each.
    keys.chunks_exact(4).skip(1).find(|key| key[0] == RASTER_TYPE && key[1] == 0).map_or(1, |key| key[3])
}
