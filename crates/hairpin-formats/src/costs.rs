//! Costs of arcs as CSV: N lines of N numbers, row = from, column = to, an empty cell where there is no arc.
//!
//! Decimals become whole numbers without passing through floating point: all costs times the same power of ten.

use std::io;
use std::path::{Path, PathBuf};

use thiserror::Error;

use crate::bounds;
use crate::delimited::{Cut, Row, Rows};
use crate::quote;

/// More digits behind the point leave no room in front of it.
const MOST_DECIMALS: usize = 18;

/// Why a file is no table of costs.
#[derive(Debug, Error)]
pub enum CostsError {
    /// The file cannot be read.
    #[error("cannot read {}: {cause}", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// The system's answer.
        cause: io::Error,
    },
    /// No line with anything in it.
    #[error("{}: empty; needed: N lines of N costs", path.display())]
    Empty {
        /// The file.
        path: PathBuf,
    },
    /// Its first line names columns.
    #[error("{}, line 1 looks like a header: a table of costs has none; needed: N lines of N costs", path.display())]
    Header {
        /// The file.
        path: PathBuf,
    },
    /// A line is longer or shorter than the table has lines.
    #[error("{}, line {line}: {found} cells, must be {expected}, as many as there are lines", path.display())]
    Width {
        /// The file.
        path: PathBuf,
        /// Line, counted from 1.
        line: usize,
        /// Cells found.
        found: usize,
        /// Lines of the table.
        expected: usize,
    },
    /// A cell is no cost.
    #[error(
        "{}, line {line}, column {column}: `{value}`, must be a decimal number ≥ 0, or empty for no arc",
        path.display()
    )]
    Value {
        /// The file.
        path: PathBuf,
        /// Line, counted from 1.
        line: usize,
        /// Column, counted from 1.
        column: usize,
        /// The text found.
        value: String,
    },
    /// A cost times the common scale has no room in 64 bits.
    #[error(
        "{}, line {line}, column {column}: `{value}` × {scale} (the scale at which all costs are whole) overflows 64 \
         bits: round all costs to fewer decimals, or give them in a coarser unit",
        path.display()
    )]
    Overflow {
        /// The file.
        path: PathBuf,
        /// Line, counted from 1.
        line: usize,
        /// Column, counted from 1.
        column: usize,
        /// The text found.
        value: String,
        /// The power of ten.
        scale: String,
    },
}

impl CostsError {
    /// The line that it is on, from 1; `None` of what is wrong with all of it.
    pub fn line(&self) -> Option<usize> {
        match self {
            Self::Width { line, .. } | Self::Value { line, .. } | Self::Overflow { line, .. } => Some(*line),
            Self::Header { .. } => Some(1),
            Self::Unreadable { .. } | Self::Empty { .. } => None,
        }
    }

    /// Line and column of a number that is wrong, both from 1, and what it must be.
    pub fn entry(&self) -> Option<([usize; 2], String)> {
        match self {
            Self::Value { line, column, .. } => {
                Some(([*line, *column], "a decimal number ≥ 0, or empty for no arc".into()))
            }
            Self::Overflow { line, column, scale, .. } => {
                let bound = format!(
                    "within 64 bits times {scale}, at which all costs are whole: fewer decimals, or a coarser unit"
                );
                Some(([*line, *column], bound))
            }
            Self::Unreadable { .. } | Self::Empty { .. } | Self::Header { .. } | Self::Width { .. } => None,
        }
    }
}

/// A table of costs, whole numbers of 1/10^decimals of the file's unit.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Costs {
    /// Number of points.
    pub points: usize,
    /// Costs in rows; `None` without an arc, and on the diagonal.
    pub costs: Vec<Option<i64>>,
    /// Digits behind the point that whole numbers stand for.
    pub decimals: usize,
}

impl Costs {
    /// The power of ten that all costs of the file were multiplied by.
    pub fn scale(&self) -> i64 {
        10i64.pow(self.decimals as u32)
    }

    /// A cost as the file would have it: in its unit, exactly.
    pub fn text(&self, cost: i64) -> String {
        text(cost, self.decimals)
    }

    /// The smallest whole cost that is at least the decimal number `text`; `None` if that is no cost.
    pub fn at_least(&self, text: &str) -> Option<i64> {
        let number = Decimal::parse(text.trim())?;
        let finer = number.decimals().saturating_sub(self.decimals);
        if finer > MOST_DECIMALS {
            return None;
        }
        let (cost, step) = (number.times(self.decimals + finer)?, 10i64.pow(finer as u32));
        Some(cost / step + i64::from(cost % step > 0))
    }
}

/// `cost` · 10^−`decimals` (at most 18), exactly and with all its digits.
pub fn text(cost: i64, decimals: usize) -> String {
    if decimals == 0 {
        return cost.to_string();
    }
    let scale = 10i128.pow(decimals as u32);
    let (sign, cost) = (if cost < 0 { "-" } else { "" }, i128::from(cost).abs());
    format!("{sign}{}.{:0width$}", cost / scale, cost % scale, width = decimals)
}

/// A cell times 10^`decimals`; `None` where it is no cost, or no whole one then, or has no room in 64 bits.
pub(crate) fn whole(cell: &str, decimals: usize) -> Option<i64> {
    let number = Decimal::parse(cell.trim())?;
    if number.decimals() <= decimals { number.times(decimals) } else { None }
}

/// Reads a file. Blank lines at its end are skipped, spaces around numbers too; the diagonal has no meaning: any number
/// may stand there, NaN and infinity too, or nothing.
///
/// # Errors
/// The first thing wrong, with line and column.
pub fn read(path: &Path) -> Result<Costs, CostsError> {
    read_in(path, 0)
}

/// Reads a file whose whole numbers are to stand for `least` digits behind the point at least, whether or not its costs
/// need them.
///
/// # Errors
/// As [`read`].
pub fn read_in(path: &Path, least: usize) -> Result<Costs, CostsError> {
    let bytes = bounds::read_table(path).map_err(|cause| CostsError::Unreadable { path: path.into(), cause })?;
    // Bytes that are no UTF-8 stay visible in the message of the cell that they stand in.
    parse(path, &String::from_utf8_lossy(&bytes), least)
}

/// A number as digits in front of the point, behind it, and a power of ten.
struct Decimal<'t> {
    whole: &'t str,
    fraction: &'t str,
    exponent: i32,
}

impl<'t> Decimal<'t> {
    fn parse(text: &'t str) -> Option<Self> {
        let (number, exponent) = match text.split_once(['e', 'E']) {
            Some((number, exponent)) => (number, exponent.parse().ok()?),
            None => (text, 0),
        };
        let number = number.strip_prefix('+').unwrap_or(number);
        let (whole, fraction) = number.split_once('.').unwrap_or((number, ""));
        let digits = |part: &str| part.bytes().all(|byte| byte.is_ascii_digit());
        let minus_zero = whole.strip_prefix('-').filter(|rest| [*rest, fraction].concat().bytes().all(|b| b == b'0'));
        let whole = minus_zero.unwrap_or(whole);
        let number = digits(whole) && digits(fraction) && !(whole.is_empty() && fraction.is_empty());
        number.then(|| Self { whole, fraction: fraction.trim_end_matches('0'), exponent })
    }

    /// Digits behind the point that it needs.
    fn decimals(&self) -> usize {
        let zero = self.fraction.is_empty() && self.whole.bytes().all(|byte| byte == b'0');
        let trailing = self.whole.len() - self.whole.trim_end_matches('0').len();
        let shown = if self.fraction.is_empty() { -(trailing as i64) } else { self.fraction.len() as i64 };
        if zero { 0 } else { (shown - i64::from(self.exponent)).max(0) as usize }
    }

    /// The number times 10^decimals.
    fn times(&self, decimals: usize) -> Option<i64> {
        let mut value: i128 = 0;
        for byte in self.whole.bytes().chain(self.fraction.bytes()) {
            value = value.checked_mul(10)?.checked_add(i128::from(byte - b'0'))?;
        }
        let mut shift = decimals as i64 + i64::from(self.exponent) - self.fraction.len() as i64;
        while shift > 0 && value != 0 {
            value = value.checked_mul(10)?;
            shift -= 1;
        }
        while shift < 0 && value != 0 {
            // Only zeros go: `decimals` counts all others.
            value /= 10;
            shift += 1;
        }
        i64::try_from(value).ok()
    }
}

fn parse(path: &Path, text: &str, least: usize) -> Result<Costs, CostsError> {
    if let Some(costs) = plain(text, least) {
        return Ok(costs);
    }
    let rows: Vec<Row> = Rows::of(text, Cut::COMMAS).collect();
    // Blank lines count but at the end.
    let points = rows.last().map_or(0, |last| last.line);
    if points == 0 {
        return Err(CostsError::Empty { path: path.into() });
    }
    // No cost is a word; words stand on no diagonal either.
    let is_word = |cell: &str| cell.contains(char::is_alphabetic) && cell.parse::<f64>().is_err();
    if rows.first().is_some_and(|first| first.len() > 1 && first.cells().skip(1).all(is_word)) {
        return Err(CostsError::Header { path: path.into() });
    }
    let width = |line: usize, found: usize| CostsError::Width { path: path.into(), line, found, expected: points };
    if let Some(line) = (1..).zip(&rows).find_map(|(line, row)| (row.line != line).then_some(line)) {
        return Err(width(line, 1));
    }
    let wrong = |row: usize, column: usize, value: &str| CostsError::Value {
        path: path.into(),
        line: row + 1,
        column: column + 1,
        value: quote::cell(value),
    };
    let mut numbers = Vec::new();
    for (row, cells) in rows.iter().enumerate() {
        if cells.len() != points {
            return Err(width(row + 1, cells.len()));
        }
        for (column, cell) in cells.cells().enumerate() {
            if row == column && !is_idle(cell) {
                return Err(wrong(row, column, cell));
            }
            if row != column && !cell.is_empty() {
                let number = Decimal::parse(cell).ok_or_else(|| wrong(row, column, cell))?;
                numbers.push((row, column, cell, number));
            }
        }
    }
    let decimals = numbers.iter().map(|(.., number)| number.decimals()).max().unwrap_or(0).max(least);
    let mut costs = vec![None; points * points];
    for (row, column, cell, number) in &numbers {
        let cost = (decimals <= MOST_DECIMALS).then(|| number.times(decimals)).flatten();
        costs[row * points + column] = Some(cost.ok_or_else(|| CostsError::Overflow {
            path: path.into(),
            line: row + 1,
            column: column + 1,
            value: quote::cell(cell),
            scale: format!("10^{decimals}"),
        })?);
    }
    Ok(Costs { points, costs, decimals })
}

/// Whether it may stand where no arc can be. Words may not: they are those of a header or of a column of names.
fn is_idle(cell: &str) -> bool {
    cell.is_empty() || cell.parse::<f64>().is_ok()
}

/// A table of nothing but digits, points, commas and line ends, without a mistake; of another, which [`parse`] reads by
/// its rows, or says what is wrong with it, `None`.
///
/// Millions of cells that programs wrote are read in one pass over their bytes, in a tenth of the time.
fn plain(text: &str, least: usize) -> Option<Costs> {
    let text = text.strip_suffix('\n').unwrap_or(text);
    let points = 1 + text.bytes().filter(|byte| *byte == b'\n').count();
    // A cell takes at least its comma.
    if text.trim_ascii().is_empty() || text.len() + 1 < points * points {
        return None;
    }
    // Digits without the point, and how many of them are behind it.
    let mut cells = Vec::with_capacity(points * points);
    for line in text.split('\n') {
        let before = cells.len();
        for cell in line.strip_suffix('\r').unwrap_or(line).as_bytes().split(|byte| *byte == b',') {
            cells.push(plain_cell(cell)?);
        }
        if cells.len() != before + points {
            return None;
        }
    }
    let decimals = |(at, cell): (usize, &Option<(i64, u8)>)| match cell {
        Some((_, decimals)) if at % (points + 1) != 0 => usize::from(*decimals),
        _ => 0,
    };
    let most = cells.iter().enumerate().map(decimals).max().unwrap_or(0).max(least);
    let mut costs = vec![None; points * points];
    for (at, cell) in cells.into_iter().enumerate().filter(|(at, _)| at % (points + 1) != 0) {
        if let Some((digits, decimals)) = cell {
            costs[at] = Some(digits.checked_mul(10i64.checked_pow(most as u32 - u32::from(decimals))?)?);
        }
    }
    (most <= MOST_DECIMALS).then_some(Costs { points, costs, decimals: most })
}

/// Digits without their point, and how many of them are behind it but for zeros at the end; `Some(None)` of an empty
/// cell, `None` of what is no such number or has too many digits to be sure that it fits.
fn plain_cell(cell: &[u8]) -> Option<Option<(i64, u8)>> {
    if cell.is_empty() {
        return Some(None);
    }
    let (mut digits, mut decimals, mut behind, mut any) = (0i64, 0u8, false, false);
    if cell.len() > MOST_DECIMALS {
        return None;
    }
    for byte in cell {
        match byte {
            b'0'..=b'9' => {
                (digits, any) = (10 * digits + i64::from(byte - b'0'), true);
                decimals += u8::from(behind);
            }
            b'.' if !behind => behind = true,
            _ => return None,
        }
    }
    while decimals > 0 && digits % 10 == 0 {
        (digits, decimals) = (digits / 10, decimals - 1);
    }
    any.then_some(Some((digits, decimals)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Costs, String> {
        parse(Path::new("costs.csv"), text, 0).map_err(|error| error.to_string())
    }

    #[test]
    fn decimals_become_whole_numbers_exactly() {
        let costs = read("7,1.25,\n+3e1,,0.1\r\n1e-3,-0,\n\n").unwrap();
        assert_eq!(costs.decimals, 3);
        assert_eq!(costs.costs, [None, Some(1250), None, Some(30_000), None, Some(100), Some(1), Some(0), None]);
        assert_eq!(costs.text(1250), "1.250");
        // 0.1 + 0.2 and 16 digits, which no double holds.
        let costs = read(",0.1234567890123456\n0.3,").unwrap();
        assert_eq!(costs.costs[1], Some(1_234_567_890_123_456));
        assert_eq!(costs.text(costs.costs[2].unwrap()), "0.3000000000000000");
        let finer = parse(Path::new("costs.csv"), ",100.000\n5.000,", 3).unwrap();
        assert_eq!((finer.decimals, finer.costs[1]), (3, Some(100_000)));
        let costs = read(",100\n5.50,").unwrap();
        assert_eq!((costs.decimals, costs.costs[1]), (1, Some(1000)));
        assert_eq!(["2", "2.01", "0", "2.1000", "-1", "x"].map(|text| costs.at_least(text)), {
            [Some(20), Some(21), Some(0), Some(21), None, None]
        });
    }

    /// A blank before its first cell makes a table one that is read by its rows.
    #[test]
    fn plain_tables_are_read_as_others_are() {
        for text in
            ["0,1\n2,0\n", "0,1\r\n2,0", ",1.50,2\n.25,,3.\n,7,9.999\n", "0.125,10\n100,0.5\n", "5\n", "0,00012\n0.0,1"]
        {
            assert!(plain(text, 0).is_some(), "{text:?}");
            for least in [0, 3] {
                let by_rows = parse(Path::new("costs.csv"), &format!(" {text}"), least).unwrap();
                assert_eq!(plain(text, least), Some(by_rows), "{text:?}");
            }
        }
        for text in ["", "\n", "0,1\n\n2,0\n", "0,1\n2\n", "1,2,3\n", ",.\n1,", ",1e3\n1,", ",12345678901234567890\n1,"]
        {
            assert_eq!(plain(text, 0), None, "{text:?}");
        }
    }

    /// Tools fill it with what can be no cost, so that it is never chosen.
    #[test]
    fn any_number_may_stand_on_the_diagonal() {
        let plain = read(",1.5\n2,\n").unwrap();
        for idle in ["-1", "nan", "NaN", "inf", "-inf", "0.001", "1e300"] {
            assert_eq!(read(&format!("{idle},1.5\n2,{idle}\n")), Ok(plain.clone()), "{idle}");
        }
    }

    #[test]
    fn what_is_no_cost_is_refused_with_its_place() {
        for (text, words) in [
            ("", "empty"),
            ("0,1\n2\n", "line 2: 1 cells, must be 2"),
            ("0,1,2\n3,4,5\n", "line 1: 3 cells, must be 2"),
            ("0,-1\n1,0\n", "line 1, column 2: `-1`"),
            ("0,1\nnan,0\n", "line 2, column 1: `nan`"),
            ("0,inf\n1,0\n", "line 1, column 2: `inf`"),
            ("0,1\n1 2,0\n", "line 2, column 1: `1 2`"),
            ("x,1\n1,0\n", "line 1, column 1: `x`"),
            ("a,b,c\n0,1,2\n1,0,2\n1,2,0\n", "line 1 looks like a header"),
            ("from,a,b,c\na,0,1,2\nb,1,0,2\nc,1,2,0\n", "line 1 looks like a header"),
            ("0,.\n1,0\n", "line 1, column 2: `.`"),
            ("0,12345678901\n0.000000001,0\n", "`12345678901` × 10^9"),
            ("0,1e30\n1,0\n", "`1e30` × 10^0"),
            ("0,1e-30\n1,0\n", "`1e-30` × 10^30"),
            ("0,1e999999999\n1,0\n", "`1e999999999`"),
        ] {
            let error = read(text).unwrap_err();
            assert!(error.contains(words), "{text:?} should mention {words:?}: {error}");
        }
    }
}
