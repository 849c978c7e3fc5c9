//! A query as a row of CSV: `id,x,y,yaw,k0,kf`, with or without `sx,sy,syaw`, and optional columns. A row that is wrong
//! is told as such and its neighbours stand.

use std::borrow::Cow;
use std::io;
use std::path::PathBuf;

use thiserror::Error;

use super::blocks::Block;
use crate::delimited::{delimiter_of, line_of};
use crate::frames;
use crate::quote;

/// One query in ENU and a body of forward, left, up; whatever frame it was asked in.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Asked {
    /// Start in the map: x, y in m, yaw in rad; `None`: anywhere flat.
    pub start: Option<[f64; 3]>,
    /// Goal from the start: x forward, y left in m, yaw in rad.
    pub goal: [f64; 3],
    /// κ at the start, 1/m, left positive.
    pub k0: f64,
    /// κ at the goal.
    pub kf: f64,
    /// Whether κ at the goal may be anything where the controls do not need it; files always say it.
    pub free_end: bool,
    /// Speed at the start, m/s.
    pub v0: Option<f64>,
    /// Speed at the goal, m/s.
    pub vf: Option<f64>,
    /// Direction of travel in the body, rad, left positive.
    pub direction: f64,
    /// The same at the goal, where it turns evenly along the drive; `None`: it stays.
    pub direction_end: Option<f64>,
    /// The frame it was asked in, and is to be answered in.
    pub frame: Frame,
    /// Largest |κ| of this drive, 1/m.
    pub max_curvature: Option<f64>,
    /// Distance from the goal that counts as there, m.
    pub tolerance_m: Option<f64>,
}

/// A frame of batch files.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Frame {
    /// East, north, up; body forward, left, up; yaw from east, counter-clockwise.
    #[default]
    Enu,
    /// North, east, down; body forward, right, down; yaw from north, clockwise.
    Ned,
}

impl Frame {
    /// +1 where left is positive, −1 where right is.
    pub fn left(self) -> f64 {
        match self {
            Self::Enu => 1.0,
            Self::Ned => -1.0,
        }
    }
}

/// What is wrong with a row.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("{column} = {value:?}: must be {bound}")]
pub struct Wrong {
    /// Column.
    pub column: String,
    /// The text found.
    pub value: String,
    /// What it must be.
    pub bound: &'static str,
}

/// A row of a file of queries.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// Line that it begins in, from 1.
    pub line: u64,
    /// As it was given.
    pub id: String,
    /// What it asks.
    pub asked: Result<Asked, Wrong>,
}

/// Why a file holds no queries.
#[derive(Debug, Error)]
pub enum BrokenFile {
    /// It cannot be read.
    #[error("cannot read {}: {cause}", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// The system's answer.
        cause: io::Error,
    },
    /// The first line names no columns that make a query.
    #[error("line 1: {what}; needed are id,x,y,yaw,k0,kf, or id,sx,sy,syaw,x,y,yaw,k0,kf")]
    Header {
        /// What is missing or too much.
        what: String,
    },
    /// A quote that nothing closes makes one cell of all that follows.
    #[error("its quotes do not pair up, so where its cells end cannot be told")]
    Quotes,
    /// The reader gave up.
    #[error("{0}")]
    Table(#[from] csv::Error),
}

const NEEDED: [&str; 6] = ["id", "x", "y", "yaw", "k0", "kf"];
const START: [&str; 3] = ["sx", "sy", "syaw"];
const OPTIONAL: [&str; 7] = ["v0", "vf", "direction", "direction_end", "frame", "max_curvature", "tolerance_m"];

const NUMBER: &str = "a finite number";
const POSITIVE: &str = "a finite number > 0";
const SPEED: &str = "a finite number of m/s ≥ 0";

/// Where the columns stand.
#[derive(Debug, Clone)]
pub struct Columns {
    /// How many.
    cells: usize,
    needed: [usize; NEEDED.len()],
    start: Option<[usize; START.len()]>,
    optional: [Option<usize>; OPTIONAL.len()],
    /// Columns that mean nothing here.
    pub ignored: Vec<String>,
}

/// A reader of records in memory, none of them a head.
fn records(bytes: &[u8]) -> csv::Reader<&[u8]> {
    // Cells are short; the reader's buffer as large as its text.
    let capacity = bytes.len().clamp(64, 1 << 13);
    let mut reader = csv::ReaderBuilder::new();
    reader.has_headers(false).flexible(true).trim(csv::Trim::All).buffer_capacity(capacity).from_reader(bytes)
}

impl Columns {
    /// The columns that `head`, the table's first record, names.
    pub(super) fn new(head: &[u8]) -> Result<Self, BrokenFile> {
        let mut record = csv::ByteRecord::new();
        records(head).read_byte_record(&mut record)?;
        let names: Vec<Cow<'_, str>> = record.iter().map(String::from_utf8_lossy).collect();
        let place = |column: &str| names.iter().position(|name| name == column);
        let times = |column: &str| names.iter().filter(|name| *name == column).count();
        let refuse = |what: String| Err(BrokenFile::Header { what });
        if let Some(column) = NEEDED.iter().chain(&START).chain(&OPTIONAL).find(|column| times(column) > 1) {
            return refuse(format!("the column `{column}` stands there twice"));
        }
        let mut needed = [0; NEEDED.len()];
        for (at, column) in needed.iter_mut().zip(NEEDED) {
            let Some(place) = place(column) else {
                let between = match delimiter_of(head) {
                    b';' => ": its cells stand between semicolons, and must stand between commas",
                    b'\t' => ": its cells stand between tabs, and must stand between commas",
                    _ => "",
                };
                return refuse(format!("no column `{column}`{between}"));
            };
            *at = place;
        }
        let start = match START.map(place) {
            [Some(x), Some(y), Some(yaw)] => Some([x, y, yaw]),
            [None, None, None] => None,
            _ => return refuse("sx, sy and syaw belong together".into()),
        };
        let known = |name: &str| NEEDED.iter().chain(&START).chain(&OPTIONAL).any(|column| *column == name);
        let ignored = names.iter().filter(|name| !known(name)).map(ToString::to_string).collect();
        Ok(Self { cells: names.len(), needed, start, optional: OPTIONAL.map(place), ignored })
    }

    /// The rows of `block`.
    ///
    /// # Errors
    /// The reader gives up.
    pub fn rows(&self, block: &Block) -> csv::Result<Vec<Row>> {
        let (mut reader, mut record) = (records(&block.bytes), csv::ByteRecord::new());
        let mut rows = Vec::new();
        while reader.read_byte_record(&mut record)? {
            let line = record.position().map_or(0, |from| line_of(&block.bytes, None, from)) as u64;
            let cells = Cells { columns: self, record: &record };
            let asked = if record.len() == self.cells {
                cells.asked()
            } else {
                let value = format!("{} cells", record.len());
                Err(Wrong { column: "row".into(), value, bound: "as many cells as the header has" })
            };
            // Bytes that are no UTF-8 stay visible.
            rows.push(Row { line: block.line + line - 1, id: cells.text(self.needed[0]).into_owned(), asked });
        }
        Ok(rows)
    }
}

/// One record.
struct Cells<'r> {
    columns: &'r Columns,
    record: &'r csv::ByteRecord,
}

impl<'r> Cells<'r> {
    fn text(&self, place: usize) -> Cow<'r, str> {
        String::from_utf8_lossy(self.record.get(place).unwrap_or_default())
    }

    fn number(&self, place: usize) -> Option<f64> {
        let cell = std::str::from_utf8(self.record.get(place)?).ok()?;
        cell.parse().ok().filter(|number: &f64| number.is_finite())
    }

    fn asked(&self) -> Result<Asked, Wrong> {
        let Columns { needed, start, optional, .. } = self.columns;
        let wrong = |place: usize, column: &str, bound| {
            let value = quote::cell(&self.text(place));
            Wrong { column: column.to_owned(), value, bound }
        };
        let number = |place: usize, column: &str| self.number(place).ok_or_else(|| wrong(place, column, NUMBER));
        let given = |i: usize| optional[i].filter(|place| self.record.get(*place).is_some_and(|cell| !cell.is_empty()));
        let optional = |i: usize, bound: &'static str, good: &dyn Fn(f64) -> bool| match given(i) {
            None => Ok(None),
            Some(place) => {
                let found = self.number(place).filter(|number| good(*number));
                found.map(Some).ok_or_else(|| wrong(place, OPTIONAL[i], bound))
            }
        };
        let frame = match given(4).map(|place| (place, self.text(place))) {
            None => Frame::Enu,
            Some((_, text)) if matches!(&*text, "enu" | "ENU") => Frame::Enu,
            Some((_, text)) if matches!(&*text, "ned" | "NED") => Frame::Ned,
            Some((place, _)) => return Err(wrong(place, OPTIONAL[4], "enu or ned")),
        };
        if self.record.get(needed[0]).is_none_or(<[u8]>::is_empty) {
            return Err(wrong(needed[0], NEEDED[0], "a name for the query"));
        }
        let left = frame.left();
        let start = match (start, frame) {
            (None, _) => None,
            (Some([x, y, yaw]), Frame::Enu) => {
                Some([number(*x, START[0])?, number(*y, START[1])?, number(*yaw, START[2])?])
            }
            (Some([x, y, yaw]), Frame::Ned) => {
                let (north, east, yaw) = (number(*x, START[0])?, number(*y, START[1])?, number(*yaw, START[2])?);
                Some([east, north, frames::other_yaw(yaw)])
            }
        };
        let needed = |i: usize| number(needed[i], NEEDED[i]);
        Ok(Asked {
            start,
            goal: [needed(1)?, left * needed(2)?, left * needed(3)?],
            k0: left * needed(4)?,
            kf: left * needed(5)?,
            free_end: false,
            v0: optional(0, SPEED, &|v| v >= 0.0)?,
            vf: optional(1, SPEED, &|v| v >= 0.0)?,
            direction: left * optional(2, NUMBER, &|_| true)?.unwrap_or(0.0),
            direction_end: optional(3, NUMBER, &|_| true)?.map(|direction| left * direction),
            frame,
            max_curvature: optional(5, POSITIVE, &|k| k > 0.0)?,
            tolerance_m: optional(6, POSITIVE, &|m| m > 0.0)?,
        })
    }
}
