//! Arcs of a cloud as CSV, `from,via,to,cost,reason`: rows of the cloud from 0, the cost of a possible arc in the
//! graph's unit, and why another is refused.

use std::path::{Path, PathBuf};

use thiserror::Error;

use crate::bounds;
use crate::costs;
use crate::quote;

const HEADER: [&str; 5] = ["from", "via", "to", "cost", "reason"];

/// Why a file is no table of arcs.
#[derive(Debug, Error)]
pub enum ArcsError {
    /// The file cannot be read, or is no CSV of five columns.
    #[error("{}: {cause}", path.display())]
    Csv {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        cause: csv::Error,
    },
    /// A cell that is none.
    #[error("{}, line {line}: {column} = `{value}`, must be {bound}", path.display())]
    Value {
        /// The file.
        path: PathBuf,
        /// Line, from 1.
        line: u64,
        /// Column.
        column: &'static str,
        /// The text found.
        value: String,
        /// What it must be.
        bound: String,
    },
}

/// The table of `arcs` in their order: \[from, via, to\] with the cost, a whole number of 10^−`decimals` of the unit,
/// or the reason.
pub fn text<'a>(arcs: impl IntoIterator<Item = ([usize; 3], Result<i64, &'a str>)>, decimals: usize) -> String {
    let mut writer = csv::Writer::from_writer(Vec::new());
    // Writing into memory does not fail, and what was written is UTF-8 as its parts are.
    let _ = writer.write_record(HEADER);
    for (points, outcome) in arcs {
        let [from, via, to] = points.map(|point| point.to_string());
        let (cost, reason) = match outcome {
            Ok(cost) => (costs::text(cost, decimals), ""),
            Err(reason) => (String::new(), reason),
        };
        let _ = writer.write_record([from.as_str(), &via, &to, &cost, reason]);
    }
    String::from_utf8(writer.into_inner().unwrap_or_default()).unwrap_or_default()
}

/// The possible arcs of a file, costs in whole numbers of 10^−`decimals`.
///
/// # Errors
/// The first thing wrong, with its place.
pub fn read(path: &Path, decimals: usize) -> Result<Vec<([usize; 3], i64)>, ArcsError> {
    let broken = |cause: csv::Error| ArcsError::Csv { path: path.into(), cause };
    let bytes = bounds::read_table(path).map_err(|cause| broken(cause.into()))?;
    let mut free = Vec::new();
    for record in csv::Reader::from_reader(bytes.as_slice()).into_records() {
        let record = record.map_err(broken)?;
        let cell = |column: usize| record.get(column).unwrap_or_default().trim();
        let wrong = |column: usize, bound: String| ArcsError::Value {
            path: path.into(),
            line: record.position().map_or(0, csv::Position::line),
            column: HEADER[column],
            value: quote::cell(cell(column)),
            bound,
        };
        if cell(3).is_empty() {
            continue;
        }
        let row = |column: usize| cell(column).parse().map_err(|_| wrong(column, "a row of the cloud, from 0".into()));
        let points = [row(0)?, row(1)?, row(2)?];
        let cost = costs::whole(cell(3), decimals);
        free.push((points, cost.ok_or_else(|| wrong(3, format!("a cost ≥ 0 of at most {decimals} decimals")))?));
    }
    Ok(free)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_is_read_again_and_what_is_broken_refused_with_its_place() {
        let place = tempfile::tempdir().unwrap();
        let file = place.path().join("arcs.csv");
        let reason = "link 3 meets \"fixture, left\" at 12 % of the move";
        let arcs = [([0, 1, 2], Ok(100_000)), ([2, 1, 0], Err(reason)), ([0, 2, 1], Ok(7))];
        std::fs::write(&file, text(arcs, 3)).unwrap();
        assert_eq!(read(&file, 3).unwrap(), [([0, 1, 2], 100_000), ([0, 2, 1], 7)]);
        assert!(text(arcs, 3).contains("0,1,2,100.000,\n2,1,0,,\"link 3 meets \"\"fixture, left\"\""));
        for (row, words) in [
            ("0,1,x,5,", "line 2: to = `x`"),
            ("0,1,2,-5,", "cost = `-5`"),
            ("0,1,2,0.0005,", "at most 3 decimals"),
            ("0,1,2", "line: 2"),
        ] {
            std::fs::write(&file, format!("from,via,to,cost,reason\n{row}\n")).unwrap();
            let error = read(&file, 3).unwrap_err().to_string();
            assert!(error.contains(words) && error.contains("arcs.csv"), "{error}");
        }
    }
}
