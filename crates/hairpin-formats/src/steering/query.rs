//! Queries as CSV: `id,x,y,yaw,k0,kf`, with or without `sx,sy,syaw`, and optional columns. A row that is wrong is told
//! as such and its neighbours stand; a file that is no table of queries is refused as a whole.

use std::io;
use std::path::{Path, PathBuf};

use thiserror::Error;

use crate::bounds;
use crate::delimited::line_of;
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

/// A file of queries.
#[derive(Debug, Clone, PartialEq)]
pub struct Queries {
    /// In their order.
    pub rows: Vec<Row>,
    /// Columns that mean nothing here.
    pub ignored: Vec<String>,
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

/// Reads a file.
///
/// # Errors
/// It cannot be read, or is no table of queries.
pub fn read(path: &Path) -> Result<Queries, BrokenFile> {
    let bytes = bounds::read_table(path).map_err(|cause| BrokenFile::Unreadable { path: path.into(), cause })?;
    parse(&bytes)
}

/// Reads a table: a byte order mark, any line ends, quoted cells, blanks around cells, columns in any order.
///
/// # Errors
/// Columns are missing or named twice; quotes do not pair up.
pub fn parse(bytes: &[u8]) -> Result<Queries, BrokenFile> {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    if bytes.iter().filter(|byte| **byte == b'"').count() % 2 == 1 {
        return Err(BrokenFile::Quotes);
    }
    let mut reader = csv::ReaderBuilder::new().flexible(true).trim(csv::Trim::All).from_reader(bytes);
    let names: Vec<String> = reader.byte_headers()?.iter().map(text).collect();
    let columns = Columns::new(&names)?;
    let mut rows = Vec::new();
    for record in reader.byte_records() {
        let record = record?;
        let line = record.position().map_or(0, |from| line_of(bytes, None, from)) as u64;
        let cells: Vec<String> = record.iter().map(text).collect();
        let id = columns.cell(&cells, "id").unwrap_or_default().to_owned();
        let asked = if cells.len() == names.len() {
            columns.asked(&cells)
        } else {
            let value = format!("{} cells", cells.len());
            Err(Wrong { column: "row".into(), value, bound: "as many cells as the header has" })
        };
        rows.push(Row { line, id, asked });
    }
    let known = |name: &String| NEEDED.iter().chain(&START).chain(&OPTIONAL).any(|column| column == name);
    Ok(Queries { rows, ignored: names.into_iter().filter(|name| !known(name)).collect() })
}

/// Bytes that are no UTF-8 stay visible in what is told of their cell.
fn text(cell: &[u8]) -> String {
    String::from_utf8_lossy(cell).into_owned()
}

/// Where the columns stand.
struct Columns<'n> {
    names: &'n [String],
    with_start: bool,
}

impl<'n> Columns<'n> {
    fn new(names: &'n [String]) -> Result<Self, BrokenFile> {
        let times = |column: &str| names.iter().filter(|name| *name == column).count();
        let refuse = |what: String| Err(BrokenFile::Header { what });
        if let Some(column) = NEEDED.iter().chain(&START).chain(&OPTIONAL).find(|column| times(column) > 1) {
            return refuse(format!("the column `{column}` stands there twice"));
        }
        if let Some(column) = NEEDED.iter().find(|column| times(column) == 0) {
            return refuse(format!("no column `{column}`"));
        }
        let given = START.iter().filter(|column| times(column) == 1).count();
        if given != 0 && given != START.len() {
            return refuse("sx, sy and syaw belong together".into());
        }
        Ok(Self { names, with_start: given > 0 })
    }

    fn cell<'c>(&self, cells: &'c [String], column: &str) -> Option<&'c str> {
        let place = self.names.iter().position(|name| name == column)?;
        cells.get(place).map(String::as_str)
    }

    fn asked(&self, cells: &[String]) -> Result<Asked, Wrong> {
        let wrong = |column: &str, bound| {
            let value = quote::cell(self.cell(cells, column).unwrap_or_default());
            Wrong { column: column.to_owned(), value, bound }
        };
        let number = |column: &str| {
            let cell = self.cell(cells, column).and_then(|cell| cell.parse::<f64>().ok());
            cell.filter(|number| number.is_finite()).ok_or_else(|| wrong(column, NUMBER))
        };
        let optional = |column: &str, bound: &'static str, good: &dyn Fn(f64) -> bool| match self
            .cell(cells, column)
            .filter(|cell| !cell.is_empty())
        {
            None => Ok(None),
            Some(cell) => match cell.parse::<f64>() {
                Ok(number) if number.is_finite() && good(number) => Ok(Some(number)),
                _ => Err(wrong(column, bound)),
            },
        };
        let frame = match self.cell(cells, "frame").unwrap_or_default() {
            "" | "enu" | "ENU" => Frame::Enu,
            "ned" | "NED" => Frame::Ned,
            _ => return Err(wrong("frame", "enu or ned")),
        };
        if self.cell(cells, "id").is_none_or(str::is_empty) {
            return Err(wrong("id", "a name for the query"));
        }
        let left = frame.left();
        let start = match (self.with_start, frame) {
            (false, _) => None,
            (true, Frame::Enu) => Some([number("sx")?, number("sy")?, number("syaw")?]),
            (true, Frame::Ned) => {
                let (north, east, yaw) = (number("sx")?, number("sy")?, number("syaw")?);
                Some([east, north, frames::other_yaw(yaw)])
            }
        };
        Ok(Asked {
            start,
            goal: [number("x")?, left * number("y")?, left * number("yaw")?],
            k0: left * number("k0")?,
            kf: left * number("kf")?,
            free_end: false,
            v0: optional("v0", SPEED, &|v| v >= 0.0)?,
            vf: optional("vf", SPEED, &|v| v >= 0.0)?,
            direction: left * optional("direction", NUMBER, &|_| true)?.unwrap_or(0.0),
            direction_end: optional("direction_end", NUMBER, &|_| true)?.map(|direction| left * direction),
            frame,
            max_curvature: optional("max_curvature", POSITIVE, &|k| k > 0.0)?,
            tolerance_m: optional("tolerance_m", POSITIVE, &|m| m > 0.0)?,
        })
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_2;

    use super::*;

    fn rows(text: &str) -> Vec<Row> {
        parse(text.as_bytes()).unwrap().rows
    }

    #[test]
    fn plain_quoted_and_foreign_line_ends() {
        let plain = rows("id,x,y,yaw,k0,kf\na,1,2,0.5,-0.1,0.2\n");
        let foreign =
            rows("\u{feff}kf,\"id\",note,yaw,\"y\",x,k0\r\n0.2,\"a\",\"say \"\"no\"\", please\",0.5, 2 ,1,-0.1\r\n");
        assert_eq!(plain[0].asked, foreign[0].asked);
        assert_eq!((plain[0].id.as_str(), foreign[0].id.as_str(), plain[0].line), ("a", "a", 2));
        let asked = plain[0].asked.clone().unwrap();
        assert_eq!((asked.goal, asked.k0, asked.kf, asked.start), ([1.0, 2.0, 0.5], -0.1, 0.2, None));
        assert_eq!(parse(b"id,x,y,yaw,k0,kf,colour\n").unwrap().ignored, ["colour"]);
        assert!(rows("id,x,y,yaw,k0,kf\n").is_empty());
        assert_eq!(rows("id,x,y,yaw,k0,kf\r\n\r\n\na,1,2,0.5,-0.1,0.2\n")[0].line, 4);
    }

    #[test]
    fn optional_columns_may_be_empty() {
        let head = "id,sx,sy,syaw,x,y,yaw,k0,kf,v0,vf,direction,frame,max_curvature,tolerance_m\n";
        let all = rows(&format!("{head}q,10,20,1,1,2,3,0,0,0.5,1,0.1,enu,0.8,0.02\nr,0,0,0,1,2,3,0,0,,,,,,\n"));
        let full = all[0].asked.clone().unwrap();
        assert_eq!(
            (full.start, full.v0, full.vf, full.direction),
            (Some([10.0, 20.0, 1.0]), Some(0.5), Some(1.0), 0.1)
        );
        assert_eq!((full.max_curvature, full.tolerance_m), (Some(0.8), Some(0.02)));
        let empty = all[1].asked.clone().unwrap();
        assert_eq!((empty.v0, empty.direction, empty.frame, empty.max_curvature), (None, 0.0, Frame::Enu, None));
    }

    #[test]
    fn ned_is_turned_over_once() {
        let head = "id,sx,sy,syaw,x,y,yaw,k0,kf,direction,frame\n";
        let asked = rows(&format!("{head}q,100,7,0,3,1,0.5,0.1,-0.2,0.3,ned\n"))[0].asked.clone().unwrap();
        // 100 m north and 7 m east, heading north; the goal is to the right, which is not left.
        assert_eq!(asked.start.map(|[x, y, _]| [x, y]), Some([7.0, 100.0]));
        assert!((asked.start.unwrap()[2] - FRAC_PI_2).abs() < 1e-15);
        assert_eq!((asked.goal, asked.k0, asked.kf, asked.direction), ([3.0, -1.0, -0.5], -0.1, 0.2, -0.3));
    }

    #[test]
    fn wrong_rows_are_told_and_their_neighbours_stand() {
        let head = "id,x,y,yaw,k0,kf,frame,max_curvature,v0\n";
        let text = "a,1,2,0,0,0,enu,,\nb,one,2,0,0,0,,,\nc,1,NaN,0,0,0,,,\nd,1,2,inf,0,0,,,\ne,1,2,0,,0,,,\nf,1,2,0,0,0,map,,\n\
                    g,1,2,0,0,0,,-1,\nh,1,2,0,0,0,,,-1\ni,1,2,0\n,1,2,0,0,0,,,\nz,1,2,0,0,0,,,\n";
        let found: Vec<String> = rows(&format!("{head}{text}"))
            .iter()
            .map(|row| row.asked.as_ref().map_or_else(|wrong| wrong.column.clone(), |_| "good".into()))
            .collect();
        assert_eq!(found, ["good", "x", "y", "yaw", "k0", "frame", "max_curvature", "v0", "row", "id", "good"]);
        let latin = parse(b"id,x,y,yaw,k0,kf\n\xe9,1,2,0,0,\xff\n").unwrap();
        assert_eq!(latin.rows[0].asked.as_ref().unwrap_err().column, "kf");
    }

    #[test]
    fn broken_files_are_refused() {
        for (text, told) in [
            ("", "no column `id`"),
            ("id,x,y,yaw,k0\n", "no column `kf`"),
            ("id,x,y,yaw,k0,kf,x\n", "twice"),
            ("id,sx,x,y,yaw,k0,kf\n", "belong together"),
            ("id,x,y,yaw,k0,kf\n\"a,1,2,0,0,0\nb,1,2,0,0,0\n", "quotes"),
            ("{\"id\": 1}\n", "no column"),
        ] {
            let found = parse(text.as_bytes()).unwrap_err().to_string();
            assert!(found.contains(told), "{text:?}: {found}");
        }
        assert!(read(Path::new("no-such.csv")).unwrap_err().to_string().contains("no-such.csv"));
    }
}
