//! ESRI ASCII grid: a header of six words, then rows from the north.

use hairpin::world::terrain::Grid;

use super::error::TerrainError;
use super::raster::{Raster, bounded};

pub(super) fn read(bytes: &[u8]) -> Result<Raster, TerrainError> {
    let text =
        std::str::from_utf8(bytes).map_err(|_| TerrainError::Broken("no text: an ASCII grid is needed".into()))?;
    let mut header = Header::default();
    let mut heights = Vec::new();
    let mut cells = None;
    for (index, line) in text.lines().enumerate() {
        let wrong = |what: String| TerrainError::Broken(format!("line {}: {what}", index + 1));
        let mut words = line.split_whitespace().peekable();
        let Some(first) = words.peek() else { continue };
        if first.starts_with(|c: char| c.is_ascii_alphabetic()) && !first.eq_ignore_ascii_case("nan") {
            let key = first.to_ascii_lowercase();
            words.next();
            let value = words.next().ok_or_else(|| wrong(format!("{key} has no value")))?;
            header.set(&key, value).map_err(wrong)?;
            continue;
        }
        let (columns, rows) = match cells {
            Some(cells) => cells,
            None => {
                let size = bounded(header.need(header.columns, "ncols")?, header.need(header.rows, "nrows")?)?;
                *cells.insert(size)
            }
        };
        for word in words {
            let height: f32 = word.parse().map_err(|_| wrong(format!("{word:?} is no height")))?;
            if heights.len() == columns * rows {
                return Err(wrong(format!("more than {columns} x {rows} heights")));
            }
            let hole = !height.is_finite() || f64::from(height) == header.no_data || height == header.no_data as f32;
            heights.push(if hole { f32::NAN } else { height });
        }
    }
    let (columns, rows) = cells.ok_or_else(|| TerrainError::Broken("no heights".into()))?;
    let cell = header.need(header.cell, "cellsize")?;
    let place = |center: Option<f64>, corner: Option<f64>, key| match (center, corner) {
        (Some(center), None) => Ok(center),
        (None, Some(corner)) => Ok(corner + 0.5 * cell),
        _ => Err(TerrainError::Broken(format!("{key} is needed once"))),
    };
    let first_center = [
        place(header.center[0], header.corner[0], "xllcorner or xllcenter")?,
        place(header.center[1], header.corner[1], "yllcorner or yllcenter")?,
    ];
    Ok(Raster { grid: Grid { columns, rows, first_center, cell: [cell, cell] }, heights })
}

struct Header {
    columns: Option<u64>,
    rows: Option<u64>,
    corner: [Option<f64>; 2],
    center: [Option<f64>; 2],
    cell: Option<f64>,
    no_data: f64,
}

impl Default for Header {
    /// The format's own default of no data is −9999.
    fn default() -> Self {
        Self { columns: None, rows: None, corner: [None; 2], center: [None; 2], cell: None, no_data: -9999.0 }
    }
}

impl Header {
    fn set(&mut self, key: &str, value: &str) -> Result<(), String> {
        let number =
            || value.parse::<f64>().ok().filter(|v| v.is_finite()).ok_or(format!("{key} = {value:?} is no number"));
        let count = || value.parse::<u64>().map_err(|_| format!("{key} = {value:?} is no number of cells"));
        match key {
            "ncols" => self.columns = Some(count()?),
            "nrows" => self.rows = Some(count()?),
            "xllcorner" => self.corner[0] = Some(number()?),
            "yllcorner" => self.corner[1] = Some(number()?),
            "xllcenter" => self.center[0] = Some(number()?),
            "yllcenter" => self.center[1] = Some(number()?),
            "cellsize" => self.cell = Some(number()?),
            "nodata_value" => self.no_data = number()?,
            _ => return Err(format!("{key:?} is no word of an ASCII grid's header")),
        }
        Ok(())
    }

    fn need<T>(&self, value: Option<T>, key: &str) -> Result<T, TerrainError> {
        value.ok_or_else(|| TerrainError::Broken(format!("{key} is missing before the first height")))
    }
}
