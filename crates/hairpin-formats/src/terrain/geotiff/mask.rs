//! Masks within the file: a directory of its own (NewSubfileType 4) whose zeros are cells without data.

use tiff::decoder::DecodingResult;
use tiff::tags::{ByteOrder, Tag};
use tiff::{TiffError, TiffFormatError, TiffResult};

use super::decoder::{Tiff, limits, open};
use super::pages::{MASK, SMALLER};
use super::sparse;

const PHOTOMETRIC: u16 = 262;
const BLACK_IS_ZERO: u16 = 1;

/// What a file has of a mask.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Mask {
    /// None.
    Absent,
    /// One, which holes were made by.
    Applied,
    /// One of which strips or tiles are not in the file.
    Sparse,
}

/// Makes holes where the file's mask says so.
pub(super) fn apply(
    bytes: &[u8],
    tiff: &mut Tiff<'_>,
    (columns, rows): (usize, usize),
    heights: &mut [f32],
) -> TiffResult<Mask> {
    while tiff.more_images() {
        tiff.next_image()?;
        let kind = tiff.find_tag_unsigned::<u32>(Tag::NewSubfileType)?.unwrap_or(0);
        if kind & MASK == 0 || kind & SMALLER != 0 {
            continue;
        }
        let (wide, high) = tiff.dimensions()?;
        if (wide as usize, high as usize) != (columns, rows) {
            return Err(TiffFormatError::InconsistentSizesEncountered.into());
        }
        if !sparse::missing(tiff).is_ok_and(|missing| missing.is_none()) {
            return Ok(Mask::Sparse);
        }
        let at = tiff.ifd_pointer().ok_or(TiffFormatError::ImageFileDirectoryNotFound)?.0;
        let order = tiff.byte_order();
        let values = decode(bytes, at, order, heights.len())?;
        let bits = values.len() < heights.len();
        let stride = columns.div_ceil(8);
        for (index, height) in heights.iter_mut().enumerate() {
            let inside = if bits {
                let (row, column) = (index / columns, index % columns);
                values[row * stride + column / 8] & (0x80 >> (column % 8)) != 0
            } else {
                values[index] != 0
            };
            if !inside {
                *height = f32::NAN;
            }
        }
        return Ok(Mask::Applied);
    }
    Ok(Mask::Absent)
}

/// The values of the mask whose directory is at `at`: a byte or a bit each, rows padded to bytes.
///
/// The library reads no transparency masks. What one holds is a grey picture, so that is what a copy says it is.
fn decode(bytes: &[u8], at: u64, order: ByteOrder, cells: usize) -> TiffResult<Vec<u8>> {
    let mut copy = bytes.to_vec();
    call_grey(&mut copy, at, order).ok_or(TiffFormatError::ImageFileDirectoryNotFound)?;
    let mut mask = open(&copy)?.with_limits(limits(cells));
    while mask.ifd_pointer().is_none_or(|here| here.0 != at) {
        mask.next_image()?;
    }
    let (columns, rows) = mask.dimensions()?;
    match mask.read_image()? {
        DecodingResult::U8(values) if values.len() >= (columns as usize).div_ceil(8) * rows as usize => Ok(values),
        _ => Err(TiffError::FormatError(TiffFormatError::InconsistentSizesEncountered)),
    }
}

/// Writes into the directory at `at` that its picture is grey.
fn call_grey(bytes: &mut [u8], at: u64, order: ByteOrder) -> Option<()> {
    let big = u16_at(bytes, 2, order)? == 43;
    let at = usize::try_from(at).ok()?;
    let (count, head, entry) =
        if big { (u64_at(bytes, at, order)?, 8, 20) } else { (u16_at(bytes, at, order)?.into(), 2, 12) };
    for index in 0..usize::try_from(count).ok()?.min(bytes.len() / entry) {
        let place = at.checked_add(head + index * entry)?;
        if u16_at(bytes, place, order)? == PHOTOMETRIC {
            let value = place + if big { 12 } else { 8 };
            let grey = match order {
                ByteOrder::LittleEndian => BLACK_IS_ZERO.to_le_bytes(),
                ByteOrder::BigEndian => BLACK_IS_ZERO.to_be_bytes(),
            };
            bytes.get_mut(value..value + 2)?.copy_from_slice(&grey);
            return Some(());
        }
    }
    None
}

fn u16_at(bytes: &[u8], at: usize, order: ByteOrder) -> Option<u16> {
    let word = bytes.get(at..at.checked_add(2)?)?.try_into().ok()?;
    Some(if order == ByteOrder::LittleEndian { u16::from_le_bytes(word) } else { u16::from_be_bytes(word) })
}

fn u64_at(bytes: &[u8], at: usize, order: ByteOrder) -> Option<u64> {
    let word = bytes.get(at..at.checked_add(8)?)?.try_into().ok()?;
    Some(if order == ByteOrder::LittleEndian { u64::from_le_bytes(word) } else { u64::from_be_bytes(word) })
}
