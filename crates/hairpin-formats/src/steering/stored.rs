//! Solved drives as they are kept for comparison: CSV, one problem with its drive a row, below comments that say how it
//! was made.

use std::fmt::Write as _;

use thiserror::Error;

use super::Piece;
use crate::delimited::{Cut, Row, Rows};

/// A boundary-value problem with the drive that solved it; poses in the map, left positive.
#[derive(Debug, Clone, PartialEq)]
pub struct Stored {
    /// x, y (m), yaw (rad), curvature (1/m) of the start.
    pub start: [f64; 4],
    /// The same of the goal.
    pub goal: [f64; 4],
    /// Whether the gear may change.
    pub reversals: bool,
    /// The drive.
    pub pieces: Vec<Piece>,
}

/// Why a row is no solved problem.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("line {line}: {field} = {value:?}: must be {bound}")]
pub struct Implausible {
    /// Line in the file, from 1.
    pub line: usize,
    /// Column, or what of the drive.
    pub field: &'static str,
    /// The text found.
    pub value: String,
    /// What it must be.
    pub bound: &'static str,
}

const COLUMNS: &str = "sx,sy,syaw,k0,x,y,yaw,kf,reversals,length_m,drive";
const NAMES: [&str; 8] = ["sx", "sy", "syaw", "k0", "x", "y", "yaw", "kf"];
/// Numbers of a plausible drive stay below, m, rad, 1/m^i: beyond lie mistakes of unit.
const LARGEST: f64 = 1e6;

impl Stored {
    /// Metres driven.
    pub fn length_m(&self) -> f64 {
        let metres = |piece: &Piece| if let Piece::Arc { length_m, .. } = piece { *length_m } else { 0.0 };
        self.pieces.iter().map(metres).sum()
    }
}

/// The text of `drives` below `comment`, whose lines become comments. Numbers read back to the same bits.
///
/// A drive is its segments with `|` between: `arc ±1 LENGTH a0 … a5`, without zeros at the end, or `turn ANGLE`.
pub fn stored_text(comment: &str, drives: &[Stored]) -> String {
    let mut text: String = comment.lines().map(|line| format!("# {line}\n")).collect();
    text.push_str(COLUMNS);
    text.push('\n');
    for drive in drives {
        for number in drive.start.iter().chain(&drive.goal) {
            // Writing to a string does not fail.
            let _ = write!(text, "{number:?},");
        }
        let segments: Vec<String> = drive.pieces.iter().map(segment_text).collect();
        let _ = writeln!(text, "{},{:.3},{}", u8::from(drive.reversals), drive.length_m(), segments.join("|"));
    }
    text
}

fn segment_text(piece: &Piece) -> String {
    match piece {
        Piece::Arc { length_m, curvature, direction } => {
            let kept = curvature.iter().rposition(|a| *a != 0.0).map_or(0, |last| last + 1);
            let numbers: String = curvature[..kept].iter().map(|a| format!(" {a:?}")).collect();
            format!("arc {direction:+} {length_m:?}{numbers}")
        }
        Piece::Turn { angle_rad } => format!("turn {angle_rad:?}"),
    }
}

/// The drives of a text as [`stored_text`] writes it.
///
/// # Errors
/// [`Implausible`]: the first row that is none, with what of it.
pub fn parse_stored(text: &str) -> Result<Vec<Stored>, Implausible> {
    let mut rows = Rows::of(text, Cut { comment: Some(b'#'), ..Cut::COMMAS });
    let columns = rows.next();
    let (line, found) = columns.map_or((1, String::new()), |row| (row.line, joined(&row)));
    if found != COLUMNS {
        return Err(Implausible { line, field: "columns", value: found, bound: COLUMNS });
    }
    let wrong = |line: usize| move |(field, value, bound): Wrong| Implausible { line, field, value, bound };
    rows.map(|row| parse_row(&row).map_err(wrong(row.line))).collect()
}

/// What is wrong with a row: field, value, bound.
type Wrong = (&'static str, String, &'static str);

fn joined(row: &Row) -> String {
    row.cells().collect::<Vec<_>>().join(",")
}

fn parse_row(row: &Row) -> Result<Stored, Wrong> {
    let cells: Vec<&str> = row.cells().collect();
    let [numbers @ .., reversals, _, drive] = &cells[..] else {
        return Err(("row", joined(row), "eleven cells"));
    };
    if numbers.len() != NAMES.len() {
        return Err(("row", joined(row), "eleven cells"));
    }
    let mut ends = [0.0; 8];
    for ((end, cell), name) in ends.iter_mut().zip(numbers).zip(NAMES) {
        *end = number(name, cell)?;
    }
    let [sx, sy, syaw, k0, x, y, yaw, kf] = ends;
    let reversals = match *reversals {
        "0" => false,
        "1" => true,
        other => return Err(("reversals", other.into(), "0 or 1")),
    };
    let segments = drive.split('|').filter(|segment| !segment.is_empty());
    let pieces = segments.map(parse_segment).collect::<Result<_, Wrong>>()?;
    Ok(Stored { start: [sx, sy, syaw, k0], goal: [x, y, yaw, kf], reversals, pieces })
}

fn parse_segment(segment: &str) -> Result<Piece, Wrong> {
    let words: Vec<&str> = segment.split(' ').collect();
    match words[..] {
        ["turn", angle] => Ok(Piece::Turn { angle_rad: number("turn", angle)? }),
        ["arc", direction, length, ref rest @ ..] if rest.len() <= 6 => {
            let direction = match direction {
                "+1" => 1,
                "-1" => -1,
                other => return Err(("direction", other.into(), "+1 or -1")),
            };
            let length_m = number("length", length)?;
            if length_m < 0.0 {
                return Err(("length", length.into(), "≥ 0 m"));
            }
            let mut curvature = [0.0; 6];
            for (a, word) in curvature.iter_mut().zip(rest) {
                *a = number("curvature", word)?;
            }
            Ok(Piece::Arc { length_m, curvature, direction })
        }
        _ => Err(("segment", segment.into(), "arc ±1 LENGTH a0 … a5, or turn ANGLE")),
    }
}

fn number(field: &'static str, text: &str) -> Result<f64, Wrong> {
    let number = text.parse().ok().filter(|number: &f64| number.abs() <= LARGEST);
    number.ok_or_else(|| (field, text.into(), "a number within ±1e6"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn drive() -> Stored {
        let curvature = [0.1, -0.25, 0.0, 1.0 / 3.0, 0.0, 0.0];
        let pieces = vec![
            Piece::Arc { length_m: 2.5, curvature, direction: -1 },
            Piece::Turn { angle_rad: -0.5 },
            Piece::Arc { length_m: 1.0, curvature: [0.0; 6], direction: 1 },
        ];
        Stored { start: [0.0, 1.0, -2.0, 0.1], goal: [3.0, 4.0, 0.7, 0.0], reversals: true, pieces }
    }

    #[test]
    fn drives_come_back_to_the_bit() {
        let drives = vec![drive(), Stored { pieces: Vec::new(), reversals: false, ..drive() }];
        let text = stored_text("made by a test\nwith two drives", &drives);
        assert!(text.starts_with("# made by a test\n# with two drives\nsx,sy,"), "{text}");
        assert_eq!(parse_stored(&text).unwrap(), drives);
        assert_eq!(drive().length_m(), 3.5);
    }

    #[test]
    fn implausible_rows_are_refused_by_line_and_field() {
        let text = stored_text("", &[drive()]);
        for (from, to, field) in [
            ("2.5", "-2.5", "length"),
            ("2.5", "inf", "length"),
            ("-0.25", "NaN", "curvature"),
            ("0.1 ", "1e300 ", "curvature"),
            ("arc -1", "arc 0", "direction"),
            ("turn -0.5", "turn", "segment"),
            ("|turn", "|spin", "segment"),
            ("arc +1 1.0", "arc +1 1.0 0 0 0 0 0 0 0", "segment"),
            ("0.7", "", "yaw"),
            (",1,", ",2,", "reversals"),
            ("0.0,1.0,", "0.0,", "row"),
            ("sx,sy", "x0,y0", "columns"),
        ] {
            let broken = text.replacen(from, to, 1);
            assert_ne!(broken, text, "{from}");
            let refused = parse_stored(&broken).expect_err(field);
            assert_eq!((refused.field, refused.line), (field, if field == "columns" { 1 } else { 2 }), "{refused}");
        }
        assert_eq!(parse_stored("").unwrap_err().field, "columns");
    }
}
