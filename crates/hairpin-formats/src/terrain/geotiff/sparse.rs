//! Strips and tiles that are not in the file (GDAL's `SPARSE_OK`): their count of bytes is 0, and so is their offset,
//! where the file's header is.

use tiff::tags::Tag;
use tiff::{TiffError, TiffFormatError, TiffResult};

use super::decoder::Tiff;
use crate::terrain::error::TerrainError;

/// Which of an image's strips or tiles are not in the file, in their order; nothing where all are.
pub(super) fn missing(tiff: &mut Tiff<'_>) -> Result<Option<Vec<bool>>, TerrainError> {
    let mut find = |tag| tiff.find_tag_unsigned_vec::<u64>(tag).ok().flatten();
    let tiles = find(Tag::TileOffsets).zip(find(Tag::TileByteCounts));
    let (what, found) = match tiles {
        Some(tiles) => ("tile", Some(tiles)),
        None => ("strip", find(Tag::StripOffsets).zip(find(Tag::StripByteCounts))),
    };
    // What has neither is refused where it is read.
    let Some((offsets, counts)) = found else { return Ok(None) };
    let all = || offsets.iter().zip(&counts);
    if let Some(chunk) = all().position(|(offset, count)| *offset == 0 && *count > 0) {
        let what = format!("{what} {chunk}, of {} bytes, at byte 0 of the file, where its header is", counts[chunk]);
        return Err(TerrainError::Broken(what));
    }
    let missing: Vec<bool> = all().map(|(_, count)| *count == 0).collect();
    Ok(missing.contains(&true).then_some(missing))
}

/// Heights of an image of `columns` × `rows` cells some of whose strips or tiles are `missing`: `none` there, what
/// `scaled` makes of the values of others.
pub(super) fn read(
    tiff: &mut Tiff<'_>,
    (columns, rows): (usize, usize),
    missing: &[bool],
    none: f32,
    scaled: impl Fn(tiff::decoder::DecodingResult) -> Result<Vec<f32>, TerrainError>,
    broken: impl Fn(TiffError) -> TerrainError,
) -> Result<Vec<f32>, TerrainError> {
    let (wide, high) = tiff.chunk_dimensions();
    let (wide, high) = (wide as usize, high as usize);
    let inconsistent = || broken(TiffFormatError::InconsistentSizesEncountered.into());
    if wide == 0 || high == 0 || missing.len() < columns.div_ceil(wide) * rows.div_ceil(high) {
        return Err(inconsistent());
    }
    let across = columns.div_ceil(wide);
    let mut heights = vec![none; columns * rows];
    for (chunk, _) in missing.iter().enumerate().filter(|(_, missing)| !**missing) {
        let (west, north) = (chunk % across * wide, chunk / across * high);
        if north >= rows {
            break;
        }
        let values = scaled(chunk_of(tiff, chunk).map_err(&broken)?)?;
        let (own_wide, own_high) = (wide.min(columns - west), high.min(rows - north));
        if values.len() < own_wide * own_high {
            return Err(inconsistent());
        }
        for (row, values) in values.chunks_exact(own_wide).take(own_high).enumerate() {
            heights[(north + row) * columns + west..][..own_wide].copy_from_slice(values);
        }
    }
    Ok(heights)
}

fn chunk_of(tiff: &mut Tiff<'_>, chunk: usize) -> TiffResult<tiff::decoder::DecodingResult> {
    let chunk = u32::try_from(chunk).map_err(|_| TiffFormatError::InconsistentSizesEncountered)?;
    tiff.read_chunk(chunk)
}
