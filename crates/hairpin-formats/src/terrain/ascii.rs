//! ESRI ASCII grid: a header of six words, then rows from the north.

use hairpin::world::terrain::Grid;

use super::error::TerrainError;
use super::no_data;
use super::raster::{Layout, Raster, bounded};
use super::reference::Reference;
use crate::quote;

pub(super) fn read(bytes: &[u8]) -> Result<Raster, TerrainError> {
    let text =
        std::str::from_utf8(bytes).map_err(|_| TerrainError::Broken("no text: an ASCII grid is needed".into()))?;
    // Editors of Windows begin a text with a mark of its encoding.
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let mut header = Header::default();
    let mut rows = None;
    for (index, line) in text.lines().enumerate() {
        let wrong = |what: String| TerrainError::Broken(format!("line {}: {what}", index + 1));
        let Some(first) = line.split_whitespace().next() else { continue };
        if rows.is_none() && !is_height(first) {
            header.read(line).map_err(wrong)?;
            continue;
        }
        let rows = match &mut rows {
            Some(rows) => rows,
            None => rows.insert(Rows::after(&header)?),
        };
        rows.read(line, header.no_data()).map_err(wrong)?;
    }
    let Rows { columns, rows, heights } = rows.ok_or_else(|| TerrainError::Broken("no heights".into()))?;
    let cell = match (header.cell, header.sides) {
        (None, [Some(dx), Some(dy)]) => [dx, dy],
        (cell, [None, None]) => [header.need(cell, "cellsize")?; 2],
        _ => return Err(TerrainError::Broken("either cellsize or dx and dy are needed".into())),
    };
    let place = |center: Option<f64>, corner: Option<f64>, cell: f64, key| match (center, corner) {
        (Some(center), None) => Ok(center),
        (None, Some(corner)) => Ok(corner + 0.5 * cell),
        _ => Err(TerrainError::Broken(format!("{key} is needed once"))),
    };
    let first_center = [
        place(header.center[0], header.corner[0], cell[0], "xllcorner or xllcenter")?,
        place(header.center[1], header.corner[1], cell[1], "yllcorner or yllcenter")?,
    ];
    let layout = Layout {
        no_data: Some(header.no_data()),
        at_centers: header.center.iter().any(Option::is_some),
        ..Layout::default()
    };
    let grid = Grid { columns, rows, first_center, cell };
    Ok(Raster { grid, heights, reference: Reference::default(), layout })
}

fn is_height(word: &str) -> bool {
    no_data::parse(word).is_some()
}

/// The heights, row by row.
struct Rows {
    columns: usize,
    rows: usize,
    heights: Vec<f32>,
}

impl Rows {
    fn after(header: &Header) -> Result<Self, TerrainError> {
        let (columns, rows) = bounded(header.need(header.columns, "ncols")?, header.need(header.rows, "nrows")?)?;
        Ok(Self { columns, rows, heights: Vec::new() })
    }

    /// A word of the header would change what the heights above it are.
    fn read(&mut self, line: &str, no_data: f64) -> Result<(), String> {
        for word in line.split_whitespace() {
            if KEYS.contains(&word.to_ascii_lowercase().as_str()) {
                return Err(format!("{:?} after the first height: the header must be before it", quote::cell(word)));
            }
            let height = match word.parse::<f32>() {
                Ok(height) => height,
                Err(_) => no_data::parse(word).ok_or_else(|| format!("{:?} is no height", quote::cell(word)))? as f32,
            };
            if self.heights.len() == self.columns * self.rows {
                return Err(format!("more than {} x {} heights", self.columns, self.rows));
            }
            let value = f64::from(height);
            let hole = no_data::is_none(value) || value == no_data || height == no_data as f32;
            self.heights.push(if hole { f32::NAN } else { height });
        }
        Ok(())
    }
}

const KEYS: [&str; 11] = [
    "ncols",
    "nrows",
    "xllcorner",
    "yllcorner",
    "xllcenter",
    "yllcenter",
    "cellsize",
    "dx",
    "dy",
    "nodata_value",
    "nodata",
];

#[derive(Default)]
struct Header {
    columns: Option<u64>,
    rows: Option<u64>,
    corner: [Option<f64>; 2],
    center: [Option<f64>; 2],
    cell: Option<f64>,
    /// dx and dy, of cells that are not square.
    sides: [Option<f64>; 2],
    no_data: Option<f64>,
}

impl Header {
    /// A line of a word and its value.
    fn read(&mut self, line: &str) -> Result<(), String> {
        let mut words = line.split_whitespace();
        let key = words.next().unwrap_or_default().to_ascii_lowercase();
        if !KEYS.contains(&key.as_str()) {
            return Err(format!("{:?} is no word of an ASCII grid's header", quote::cell(&key)));
        }
        let value = words.next().ok_or_else(|| format!("{key} has no value"))?;
        if let Some(more) = words.next() {
            let (value, more) = (quote::cell(value), quote::cell(more));
            return Err(format!("{key} = {value:?} is followed by {more:?}: it must have one value"));
        }
        self.set(&key, value)
    }

    fn set(&mut self, key: &str, value: &str) -> Result<(), String> {
        let no_number = || format!("{key} = {:?} is no number", quote::cell(value));
        let number = || value.parse::<f64>().ok().filter(|v| v.is_finite()).ok_or_else(no_number);
        let count =
            || value.parse::<u64>().map_err(|_| format!("{key} = {:?} is no number of cells", quote::cell(value)));
        let twice = match key {
            "ncols" => self.columns.replace(count()?).is_some(),
            "nrows" => self.rows.replace(count()?).is_some(),
            "xllcorner" => self.corner[0].replace(number()?).is_some(),
            "yllcorner" => self.corner[1].replace(number()?).is_some(),
            "xllcenter" => self.center[0].replace(number()?).is_some(),
            "yllcenter" => self.center[1].replace(number()?).is_some(),
            "cellsize" => self.cell.replace(number()?).is_some(),
            "dx" => self.sides[0].replace(number()?).is_some(),
            "dy" => self.sides[1].replace(number()?).is_some(),
            _ => self.no_data.replace(no_data::parse(value).ok_or_else(no_number)?).is_some(),
        };
        if twice {
            Err(format!("{key} = {:?} is given again: it must be given once", quote::cell(value)))
        } else {
            Ok(())
        }
    }

    /// The format's own default of no data is −9999.
    fn no_data(&self) -> f64 {
        self.no_data.unwrap_or(-9999.0)
    }

    fn need<T>(&self, value: Option<T>, key: &str) -> Result<T, TerrainError> {
        value.ok_or_else(|| TerrainError::Broken(format!("{key} is missing before the first height")))
    }
}
