//! Reads QGC WPL 110, the text of mission items that every ground station reads and writes.

use super::follow::follow;
use super::item::{Frame, Item, Wrong};
use super::uploaded::Uploaded;
use crate::frames::Geodetic;

/// The first line.
pub const HEAD: &str = "QGC WPL 110";
/// Fields of a row.
const FIELDS: [&str; 12] = [
    "index",
    "current",
    "frame",
    "command",
    "param1",
    "param2",
    "param3",
    "param4",
    "latitude",
    "longitude",
    "altitude",
    "autocontinue",
];
/// Rows at most: as many items as a plan may have.
const MOST_ROWS: usize = 20_000;

/// Reads the text of a file: its first line, then rows of twelve fields between single tabs that end with a line feed
/// alone, row 0 the home.
///
/// # Errors
/// The first thing that is not so, or that no vehicle could be sent, with its line.
pub fn parse(text: &str) -> Result<Uploaded, Wrong> {
    let mut lines = text.split('\n').enumerate().map(|(index, line)| (index + 1, line)).peekable();
    let (_, head) = lines.next().unwrap_or((1, ""));
    if head != HEAD {
        let must = format!("`{HEAD}`, with a line feed alone behind it");
        return Err(Wrong::new("line 1", format!("`{}`", head.escape_default()), must));
    }
    let (mut home, mut items) = (None, Vec::new());
    while let Some((number, line)) = lines.next() {
        // What stands behind the last line feed is no line.
        if line.is_empty() && lines.peek().is_none() {
            break;
        }
        if items.len() == MOST_ROWS {
            return Err(Wrong::new(format!("line {number}"), "one more", format!("at most {MOST_ROWS} items")));
        }
        let row = Row::of(number, line)?;
        match home {
            None => home = Some(row.home()?),
            Some(_) => items.push(row.item(items.len() + 1)?),
        }
    }
    let home = home.ok_or_else(|| Wrong::new("line 2", "nothing", "the home, `0\t1\t0\t16\t…`"))?;
    follow(&items, home, true)
}

/// A row, cut.
struct Row<'a> {
    line: usize,
    cells: [&'a str; 12],
}

impl<'a> Row<'a> {
    fn of(line: usize, text: &'a str) -> Result<Self, Wrong> {
        let at = || format!("line {line}");
        let ways = [
            (text.is_empty(), "no blank line"),
            (
                text.ends_with('\r'),
                "a line that ends with a line feed alone, without the carriage return of other systems",
            ),
            (text.starts_with('#'), "no comment"),
        ];
        if let Some((_, must)) = ways.iter().find(|(is_so, _)| *is_so) {
            return Err(Wrong::new(at(), format!("`{}`", text.escape_default()), *must));
        }
        let cells: Vec<&str> = text.split('\t').take(FIELDS.len() + 1).collect();
        match cells.try_into() {
            Ok(cells) => Ok(Self { line, cells }),
            Err(_) => {
                let found = text.split('\t').count();
                Err(Wrong::new(at(), format!("{found} fields"), "12 fields between single tabs"))
            }
        }
    }

    fn at(&self, field: usize) -> String {
        format!("line {}, field {} ({})", self.line, field + 1, FIELDS[field])
    }

    fn wrong(&self, field: usize, must: &str) -> Wrong {
        Wrong::new(self.at(field), format!("`{}`", self.cells[field].escape_default()), must)
    }

    fn count(&self, field: usize) -> Result<u64, Wrong> {
        self.cells[field].parse().map_err(|_| self.wrong(field, "a whole number"))
    }

    fn flag(&self, field: usize) -> Result<bool, Wrong> {
        match self.count(field)? {
            0 => Ok(false),
            1 => Ok(true),
            _ => Err(self.wrong(field, "0 or 1")),
        }
    }

    /// A number; that of a parameter may be `nan`: left to the vehicle.
    fn number(&self, field: usize) -> Result<f64, Wrong> {
        let number = self.cells[field].parse::<f64>().map_err(|_| self.wrong(field, "a number"))?;
        if number.is_infinite() { Err(self.wrong(field, "a finite number")) } else { Ok(number) }
    }

    fn expect(&self, field: usize, wanted: u64, must: &str) -> Result<(), Wrong> {
        if self.count(field)? == wanted { Ok(()) } else { Err(self.wrong(field, must)) }
    }

    fn home(&self) -> Result<Geodetic, Wrong> {
        self.expect(0, 0, "0, the home")?;
        self.flag(1)?;
        self.expect(2, 0, "0, the frame of the home: above sea level")?;
        self.expect(3, 16, "16, as the home is written")?;
        let within = |field: usize, most: f64, must: &str| {
            let number = self.number(field)?;
            if number.abs() <= most { Ok(number) } else { Err(self.wrong(field, must)) }
        };
        Ok(Geodetic {
            lat_deg: within(8, 90.0, "a latitude, from -90 to 90°")?,
            lon_deg: within(9, 180.0, "a longitude, from -180 to 180°")?,
            alt_amsl_m: within(10, 20_000.0, "an altitude within 20000 m of the sea")?,
        })
    }

    fn item(&self, number: usize) -> Result<Item, Wrong> {
        self.expect(0, number as u64, &format!("{number}: rows are counted from 0"))?;
        self.flag(1)?;
        let at = format!("line {}, ", self.line);
        let mut params = [f64::NAN; 7];
        for (place, value) in params.iter_mut().enumerate() {
            *value = self.number(4 + place)?;
        }
        let (frame, command) = (Frame::of(self.count(2)?, &at)?, self.count(3)?);
        Ok(Item { at, number, command, frame, params, goes_on: self.flag(11)? })
    }
}
