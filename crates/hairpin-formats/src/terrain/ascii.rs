//! ESRI ASCII grid: a header of six words, each once, then rows from the north and nothing else.

use hairpin::world::terrain::Grid;

use super::error::TerrainError;
use super::no_data;
use super::raster::{Layout, Raster, bounded};
use super::reference::Reference;
use crate::quote;

pub(super) fn read(bytes: &[u8]) -> Result<Raster, TerrainError> {
    let text =
        std::str::from_utf8(bytes).map_err(|_| TerrainError::Broken("no text: an ASCII grid is needed".into()))?;
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let mut header = Header::default();
    let mut heights = Vec::new();
    let mut cells = None;
    for (index, line) in text.lines().enumerate() {
        let wrong = |what: String| TerrainError::Broken(format!("line {}: {what}", index + 1));
        let mut words = line.split_whitespace().peekable();
        let Some(first) = words.peek().copied() else { continue };
        let is_word = first.starts_with(|c: char| c.is_ascii_alphabetic()) && first.parse::<f64>().is_err();
        if is_word {
            let key = first.to_ascii_lowercase();
            words.next();
            let value = words.next().ok_or_else(|| wrong(format!("{key} has no value")))?;
            if cells.is_some() {
                return Err(wrong(format!("{:?} amid the heights: its place is before them", quote::cell(&key))));
            }
            if let Some(more) = words.next() {
                return Err(wrong(format!("{:?} after the value of {key}", quote::cell(more))));
            }
            header.set(&key, value).map_err(wrong)?;
            continue;
        }
        let (columns, rows) = match cells {
            Some(cells) => cells,
            None => {
                let [columns, rows] = [(header.columns, "ncols"), (header.rows, "nrows")].map(|(count, key)| {
                    count.ok_or_else(|| wrong(format!("{:?}, and {key} is missing before it", quote::cell(first))))
                });
                *cells.insert(bounded(columns?, rows?)?)
            }
        };
        for word in words {
            let height = match word.parse::<f32>() {
                Ok(height) => height,
                Err(_) => {
                    no_data::parse(word).ok_or_else(|| wrong(format!("{:?} is no height", quote::cell(word))))? as f32
                }
            };
            if heights.len() == columns * rows {
                return Err(wrong(format!("more than {columns} x {rows} heights")));
            }
            let value = f64::from(height);
            let hole = no_data::is_none(value) || value == header.no_data || height == header.no_data as f32;
            heights.push(if hole { f32::NAN } else { height });
        }
    }
    let (columns, rows) = cells.ok_or_else(|| TerrainError::Broken("no heights".into()))?;
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
        no_data: Some(header.no_data),
        at_centers: header.center.iter().any(Option::is_some),
        ..Layout::default()
    };
    let grid = Grid { columns, rows, first_center, cell };
    Ok(Raster { grid, heights, reference: Reference::default(), layout })
}

struct Header {
    columns: Option<u64>,
    rows: Option<u64>,
    corner: [Option<f64>; 2],
    center: [Option<f64>; 2],
    cell: Option<f64>,
    /// dx and dy, of cells that are not square.
    sides: [Option<f64>; 2],
    no_data: f64,
    /// Words that were read.
    known: Vec<String>,
}

impl Default for Header {
    /// The format's own default of no data is −9999.
    fn default() -> Self {
        let (corner, center, sides) = ([None; 2], [None; 2], [None; 2]);
        Self { columns: None, rows: None, corner, center, cell: None, sides, no_data: -9999.0, known: Vec::new() }
    }
}

impl Header {
    fn set(&mut self, key: &str, value: &str) -> Result<(), String> {
        let number = || {
            value
                .parse::<f64>()
                .ok()
                .filter(|v| v.is_finite())
                .ok_or(format!("{key} = {:?} is no number", quote::cell(value)))
        };
        let count =
            || value.parse::<u64>().map_err(|_| format!("{key} = {:?} is no number of cells", quote::cell(value)));
        let own = key.trim_end_matches("_value");
        if self.known.iter().any(|known| known == own) {
            return Err(format!("{key} = {:?}: {own} was there before", quote::cell(value)));
        }
        self.known.push(own.to_owned());
        match key {
            "ncols" => self.columns = Some(count()?),
            "nrows" => self.rows = Some(count()?),
            "xllcorner" => self.corner[0] = Some(number()?),
            "yllcorner" => self.corner[1] = Some(number()?),
            "xllcenter" => self.center[0] = Some(number()?),
            "yllcenter" => self.center[1] = Some(number()?),
            "cellsize" => self.cell = Some(number()?),
            "dx" => self.sides[0] = Some(number()?),
            "dy" => self.sides[1] = Some(number()?),
            "nodata_value" | "nodata" => {
                self.no_data =
                    no_data::parse(value).ok_or_else(|| format!("{key} = {:?} is no number", quote::cell(value)))?;
            }
            _ => return Err(format!("{:?} is no word of an ASCII grid's header", quote::cell(key))),
        }
        Ok(())
    }

    fn need<T>(&self, value: Option<T>, key: &str) -> Result<T, TerrainError> {
        value.ok_or_else(|| TerrainError::Broken(format!("{key} is missing before the first height")))
    }
}
