//! GeoTIFF: one band of heights with pixel scale and tie point, or a transformation without rotation.
//!
//! Overviews and a mask beside that are known; of several full pages none is taken.
//!
//! Sources: OGC GeoTIFF 1.1 (19-008r4); GDAL's tags GDAL_METADATA (scale, offset, unit of a band), GDAL_NODATA and its
//! masks within the file.

mod decoder;
mod keys;
mod mask;
mod metadata;
mod pages;
mod place;
mod sparse;

use tiff::decoder::DecodingResult;
use tiff::tags::Tag;

use super::error::TerrainError;
use super::no_data;
use super::raster::{Layout, Raster, bounded, held};
use super::remedy::Remedy;
use decoder::{Tiff, limits, open};
use mask::Mask;
use metadata::Band;
use pages::Ambiguous;

pub(super) fn read(bytes: &[u8], file: &str) -> Result<Raster, TerrainError> {
    let broken = |error: tiff::TiffError| {
        let why = format!("no readable GeoTIFF ({error}); if GDAL reads it");
        TerrainError::Convert { why, command: Remedy::rewrite(file, "-co COMPRESS=DEFLATE ") }
    };
    let mut tiff = open(bytes).map_err(broken)?;
    if let Some(ambiguous) = pages::ambiguous(&mut tiff).map_err(broken)? {
        return Err(one_page(ambiguous, file));
    }
    let (columns, rows) = tiff.dimensions().map_err(broken)?;
    let (columns, rows) = bounded(columns.into(), rows.into())?;
    let mut tiff = tiff.with_limits(limits(columns * rows));
    let convert = |why: String, options: &str| TerrainError::Convert { why, command: Remedy::rewrite(file, options) };
    let number = |tiff: &mut Tiff<'_>, tag| tiff.find_tag_unsigned::<u16>(tag).map_err(broken);
    let samples = number(&mut tiff, Tag::SamplesPerPixel)?.unwrap_or(1);
    if samples != 1 {
        return Err(convert(format!("{samples} bands: one band of heights is needed"), "-b 1 "));
    }
    // The decoder turns heights over where white is zero, and takes numbers of colours for heights.
    if let Some(picture) = number(&mut tiff, Tag::PhotometricInterpretation)?.filter(|picture| *picture != 1) {
        let what = match picture {
            0 => "white is zero, which readers turn over or not",
            3 => "its values are numbers of colours, not heights",
            _ => "its values are no shades of grey",
        };
        let why = format!("its PhotometricInterpretation is {picture}: {what}");
        return Err(convert(why, "-co PHOTOMETRIC=MINISBLACK "));
    }
    let compression = number(&mut tiff, Tag::Compression)?.unwrap_or(1);
    if let Some(packed) = unread(compression) {
        return Err(convert(format!("compressed by {packed}, which is not read here"), "-co COMPRESS=DEFLATE "));
    }
    held(columns, rows, bytes.len(), compression != 1)?;
    if let Some(orientation) = number(&mut tiff, Tag::Orientation)?.filter(|orientation| *orientation != 1) {
        return Err(convert(format!("its Orientation is {orientation}: rows from the top are needed"), ""));
    }
    if let Some(order) = number(&mut tiff, Tag::FillOrder)?.filter(|order| *order != 1) {
        return Err(convert(format!("its FillOrder is {order}: bits from the highest (1) are needed"), ""));
    }
    let keys = keys::read(&mut tiff);
    if let Some(kind) = keys.unknown_raster {
        let why = format!("its GTRasterType is {kind}: 1 (areas) or 2 (points) is needed; this takes areas");
        return Err(convert(why, "-mo AREA_OR_POINT=Area "));
    }
    let placed = place::read(&mut tiff, columns, rows, keys.at_centers, file)?;
    let band = metadata::read(&mut tiff)?;
    let mut heights = match sparse::missing(&mut tiff)? {
        None => scaled(tiff.read_image().map_err(broken)?, &band)?,
        Some(missing) => {
            // What is not in the file is not known, or 0 where no value means that, as GDAL has it.
            let none = if band.no_data.is_some() { f32::NAN } else { band.height(0.0) };
            sparse::read(&mut tiff, (columns, rows), &missing, none, |values| scaled(values, &band), broken)?
        }
    };
    let mask = mask::apply(bytes, &mut tiff, (columns, rows), &mut heights).map_err(broken)?;
    if mask == Mask::Sparse {
        return Err(convert("strips or tiles of its mask are not in the file (SPARSE_OK)".into(), ""));
    }
    let masked = mask == Mask::Applied;
    if placed.south_up {
        turn_over(&mut heights, columns);
    }
    let mut reference = keys.reference;
    reference.also_heights_in(band.unit.clone());
    let Band { scale, offset, no_data, .. } = band;
    let layout = Layout { scale, offset, no_data, masked, south_up: placed.south_up, at_centers: keys.at_centers };
    Ok(Raster { grid: placed.grid, heights, reference, layout })
}

/// Pages are like bands: a map is one of them, and who has it says which.
fn one_page(ambiguous: Ambiguous, file: &str) -> TerrainError {
    let (why, page) = match ambiguous {
        Ambiguous::Several(second) => (
            format!(
                "several full pages, of which the second is directory {second}: one is needed; this takes the first"
            ),
            1,
        ),
        Ambiguous::SmallerFirst(Some(page)) => (
            format!("its first page is a smaller copy or a mask, directory {page} is the full one; this takes it"),
            page,
        ),
        Ambiguous::SmallerFirst(None) => (
            "its first page says that it is a smaller copy or a mask, and there is no full one; this takes it".into(),
            1,
        ),
        Ambiguous::TooMany => ("more than 100 directories; this takes the first".into(), 1),
    };
    TerrainError::Convert { why, command: Remedy::page(file, page) }
}

/// What a compression is called that is not read here.
fn unread(compression: u16) -> Option<String> {
    Some(match compression {
        1 | 5 | 8 | 32773 | 32946 | 50000 => return None,
        6 | 7 => "JPEG, which loses heights".into(),
        34887 => "LERC".into(),
        34925 => "LZMA".into(),
        50001 => "WebP".into(),
        50002 => "JPEG XL".into(),
        other => format!("method {other}"),
    })
}

fn scaled(values: DecodingResult, band: &Band) -> Result<Vec<f32>, TerrainError> {
    // Floats are written as text of another precision; whole numbers are what they are.
    let float = |value: f64| -> f32 {
        let none = band.no_data.is_some_and(|no_data| value == no_data || value as f32 == no_data as f32);
        if none || no_data::is_none(value) { f32::NAN } else { band.height(value) }
    };
    let whole = |value: f64| -> f32 { if band.no_data == Some(value) { f32::NAN } else { band.height(value) } };
    Ok(match values {
        DecodingResult::F32(v) => v.into_iter().map(|value| float(value.into())).collect(),
        DecodingResult::F64(v) => v.into_iter().map(float).collect(),
        DecodingResult::U8(v) => v.into_iter().map(|value| whole(value.into())).collect(),
        DecodingResult::I8(v) => v.into_iter().map(|value| whole(value.into())).collect(),
        DecodingResult::U16(v) => v.into_iter().map(|value| whole(value.into())).collect(),
        DecodingResult::I16(v) => v.into_iter().map(|value| whole(value.into())).collect(),
        DecodingResult::U32(v) => v.into_iter().map(|value| whole(value.into())).collect(),
        DecodingResult::I32(v) => v.into_iter().map(|value| whole(value.into())).collect(),
        _ => return Err(TerrainError::Broken("samples of this type are no heights".into())),
    })
}

/// The rows in the opposite order.
fn turn_over(heights: &mut [f32], columns: usize) {
    let rows = heights.len() / columns;
    for row in 0..rows / 2 {
        let (above, below) = heights.split_at_mut((rows - 1 - row) * columns);
        above[row * columns..][..columns].swap_with_slice(&mut below[..columns]);
    }
}
