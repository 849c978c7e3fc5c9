//! The decoder of TIFF, and what it may take.

use std::io::Cursor;

use tiff::TiffResult;
use tiff::decoder::{Decoder, Limits};

/// A TIFF file in memory.
pub(super) type Tiff<'a> = Decoder<Cursor<&'a [u8]>>;

/// The file in `bytes`, at its first directory.
pub(super) fn open(bytes: &[u8]) -> TiffResult<Tiff<'_>> {
    Decoder::new(Cursor::new(bytes))
}

/// A tile may be larger than the image.
const LARGEST_TILE: usize = 16 << 20;

/// What the decoder may take for so many cells: eight bytes each at most.
pub(super) fn limits(cells: usize) -> Limits {
    let mut limits = Limits::default();
    limits.decoding_buffer_size = cells.saturating_mul(8).max(LARGEST_TILE);
    limits.intermediate_buffer_size = limits.decoding_buffer_size;
    limits
}
