//! NumPy arrays: two dimensions of floats in metres, rows from the north, NaN or values beyond ±1e30 where
//! there is no data.
//!
//! The header is a dictionary of three values (numpy.lib.format, versions 1 to 3). It is read as just that: a general
//! reader of Python's literals takes as long as somebody's brackets want it to.

use super::error::TerrainError;
use super::georeference::{Georeference, placed};
use super::no_data;
use super::raster::{Layout, Raster, bounded};
use super::reference::Reference;

/// Headers of two dimensions have a hundred bytes.
const LONGEST_HEADER: usize = 4096;

pub(super) fn read(bytes: &[u8], georeference: &Georeference) -> Result<Raster, TerrainError> {
    let broken = |what: &str| TerrainError::Broken(format!("no readable NumPy array: {what}"));
    if georeference.height_m.is_some() {
        return Err(TerrainError::Unwanted { key: "height_m" });
    }
    let (header, data) = split(bytes).map_err(broken)?;
    let Header { descr, fortran, shape } = Header::read(header)
        .ok_or_else(|| broken("its header says no 'descr', 'fortran_order' and 'shape' of plain numbers"))?;
    let [rows, columns] = shape[..] else {
        return Err(TerrainError::Broken(format!("an array of shape {shape:?}: rows and columns are needed")));
    };
    let (columns, rows) = bounded(columns, rows)?;
    let size = match descr {
        "<f4" | ">f4" => 4,
        "<f8" | ">f8" => 8,
        _ => {
            let descr: String = descr.chars().take(40).collect();
            let found = format!("an array of '{descr}': float32 or float64 in metres is needed");
            return Err(TerrainError::Broken(found));
        }
    };
    // The data must be there before room for it is taken, and nothing that is none of it.
    let needed = size * columns * rows;
    if data.len() != needed {
        let found = data.len();
        return Err(broken(&format!("the header says {rows} x {columns} heights, {needed} bytes; {found} follow")));
    }
    let known = |height: f32| if no_data::is_none(height.into()) { f32::NAN } else { height };
    // Arrays may be large: each number is touched once.
    let heights: Vec<f32> = match descr {
        "<f4" => data.as_chunks().0.iter().map(|b| known(f32::from_le_bytes(*b))).collect(),
        ">f4" => data.as_chunks().0.iter().map(|b| known(f32::from_be_bytes(*b))).collect(),
        "<f8" => data.as_chunks().0.iter().map(|b| known(f64::from_le_bytes(*b) as f32)).collect(),
        _ => data.as_chunks().0.iter().map(|b| known(f64::from_be_bytes(*b) as f32)).collect(),
    };
    let heights = match fortran {
        false => heights,
        true => (0..rows * columns).map(|i| heights[i % columns * rows + i / columns]).collect(),
    };
    let (reference, layout) = (Reference::default(), Layout::default());
    Ok(Raster { grid: placed(columns, rows, georeference)?, heights, reference, layout })
}

/// The text of the header, and what follows it.
fn split(bytes: &[u8]) -> Result<(&str, &[u8]), &'static str> {
    let rest = bytes.strip_prefix(b"\x93NUMPY").ok_or("it does not begin as one")?;
    let (length, rest) = match *rest {
        [1, _, a, b, ref rest @ ..] => (usize::from(u16::from_le_bytes([a, b])), rest),
        [2 | 3, _, a, b, c, d, ref rest @ ..] => (u32::from_le_bytes([a, b, c, d]) as usize, rest),
        _ => return Err("it is of another version"),
    };
    if length > LONGEST_HEADER {
        return Err("its header is longer than that of any array of numbers");
    }
    let (header, data) = rest.split_at_checked(length).ok_or("it ends within its header")?;
    Ok((std::str::from_utf8(header).map_err(|_| "its header is no text")?, data))
}

struct Header<'t> {
    descr: &'t str,
    fortran: bool,
    shape: Vec<u64>,
}

impl<'t> Header<'t> {
    /// `{'descr': '<f4', 'fortran_order': False, 'shape': (2, 3), }`
    fn read(text: &'t str) -> Option<Self> {
        let mut rest = text.trim().strip_prefix('{')?.strip_suffix('}')?.trim();
        let (mut descr, mut fortran, mut shape) = (None, None, None);
        while !rest.is_empty() {
            let (key, after) = quoted(rest)?;
            rest = after.trim_start().strip_prefix(':')?.trim_start();
            match key {
                "descr" => {
                    let (word, after) = quoted(rest)?;
                    (descr, rest) = (Some(word), after);
                }
                "fortran_order" => {
                    let (word, after) = rest.split_at(rest.find([',', '}']).unwrap_or(rest.len()));
                    (fortran, rest) = (Some(word.trim().parse::<Bool>().ok()?.0), after);
                }
                "shape" => {
                    let (inside, after) = rest.strip_prefix('(')?.split_once(')')?;
                    let sizes = inside.split(',').map(str::trim).filter(|size| !size.is_empty());
                    (shape, rest) = (Some(sizes.map(|size| size.parse().ok()).collect::<Option<Vec<u64>>>()?), after);
                }
                _ => return None,
            }
            rest = rest.trim_start();
            rest = rest.strip_prefix(',').unwrap_or(rest).trim_start();
        }
        Some(Self { descr: descr?, fortran: fortran?, shape: shape? })
    }
}

/// A word in quotes of either kind, and what follows.
fn quoted(text: &str) -> Option<(&str, &str)> {
    let quote = text.chars().next().filter(|c| matches!(c, '\'' | '"'))?;
    text[1..].split_once(quote)
}

/// Python's.
struct Bool(bool);

impl std::str::FromStr for Bool {
    type Err = ();

    fn from_str(word: &str) -> Result<Self, ()> {
        match word {
            "True" => Ok(Self(true)),
            "False" => Ok(Self(false)),
            _ => Err(()),
        }
    }
}
