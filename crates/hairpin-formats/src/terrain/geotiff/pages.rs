//! The directories of a file: a map is its one full page, beside which smaller copies of it and a mask may lie.

use tiff::TiffResult;
use tiff::tags::Tag;

use super::decoder::Tiff;

/// Bits of NewSubfileType: a smaller copy; a mask.
pub(super) const SMALLER: u32 = 1;
pub(super) const MASK: u32 = 4;
/// Values of SubfileType, which NewSubfileType replaced: a smaller copy.
const ONCE_SMALLER: u32 = 2;
/// Overviews halve the sides, each with a mask: no file has this many.
const MOST_DIRECTORIES: usize = 100;

/// What a file's directories are that is no map with its overviews and its mask.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Ambiguous {
    /// More than one full page; the second is the directory of this number, from 1.
    Several(usize),
    /// The first is a smaller copy or a mask; the first full page is the directory of this number, if there is one.
    SmallerFirst(Option<usize>),
    /// More than are looked at.
    TooMany,
}

/// Why the first directory of a file is not the map; `None` where it is the only full page.
///
/// What has neither tag is full: TIFF 6.0's default of NewSubfileType is 0.
pub(super) fn ambiguous(tiff: &mut Tiff<'_>) -> TiffResult<Option<Ambiguous>> {
    let mut full = Vec::new();
    let mut next = tiff.ifd_pointer();
    for number in 1.. {
        let Some(at) = next else { break };
        if number > MOST_DIRECTORIES {
            return Ok(Some(Ambiguous::TooMany));
        }
        let directory = tiff.read_directory(at)?;
        let mut tags = tiff.read_directory_tags(&directory);
        let kind = tags.find_tag_unsigned::<u32>(Tag::NewSubfileType)?;
        let once = tags.find_tag_unsigned::<u32>(Tag::SubfileType)?;
        if kind.unwrap_or(0) & (SMALLER | MASK) == 0 && (kind.is_some() || once != Some(ONCE_SMALLER)) {
            full.push(number);
        }
        match full[..] {
            [1, second] => return Ok(Some(Ambiguous::Several(second))),
            [first] if first > 1 => return Ok(Some(Ambiguous::SmallerFirst(Some(first)))),
            _ => {}
        }
        next = directory.next();
    }
    Ok(full.is_empty().then_some(Ambiguous::SmallerFirst(None)))
}
