//! What each reader models, refuses and ignores, as `docs/readers.md` has it: every row of that page is fed here, once
//! without the thing and once with it, and does what its word says.
//!
//! A row more: a line in the page's table and a [`Sample`] of the same name in the list of its format's file.

mod logs;
mod maps;
mod programs;
mod tables;
#[allow(dead_code)]
#[path = "../../../src/logs/tests/write_bag.rs"]
mod write_bag;
#[allow(dead_code)]
#[path = "../../../src/logs/tests/write_ulog.rs"]
mod write_ulog;

use std::collections::BTreeMap;

/// One row.
#[derive(Clone)]
pub(crate) struct Sample {
    /// Its first cell.
    pub(crate) row: &'static str,
    /// Reads a text.
    pub(crate) read: fn(&str) -> Answer,
    /// What is read without what the row is about.
    pub(crate) without: String,
    /// The same with it.
    pub(crate) with: String,
}

/// What a reader makes of a text.
#[derive(Debug, PartialEq)]
pub(crate) enum Answer {
    /// An error, in words.
    Refused(String),
    /// Read, and not all of it is certain.
    Open,
    /// Read, as everything that it came to.
    Read(String),
}

const PAGE: &str = include_str!("../../../../../docs/readers.md");

/// Rows of all tables of the page: name, word.
fn rows() -> Vec<(String, String)> {
    let cells = |line: &str| line.split('|').map(|cell| cell.trim().to_owned()).collect::<Vec<_>>();
    let rows = PAGE.lines().filter(|line| line.starts_with("| `")).map(cells);
    rows.map(|cells| (cells[1].trim_matches('`').to_owned(), cells[3].clone())).collect()
}

fn word(sample: &Sample) -> String {
    let before = (sample.read)(&sample.without);
    if !matches!(before, Answer::Read(_)) {
        return format!("not read even without it: {before:?}");
    }
    match (sample.read)(&sample.with) {
        Answer::Refused(why) if why.len() > 10 => "refuses".into(),
        Answer::Refused(why) => format!("refuses with `{why}`, which says nothing"),
        Answer::Open => "inconclusive".into(),
        same if same == before => "ignores".into(),
        Answer::Read(_) => "models".into(),
    }
}

#[test]
fn every_row_does_what_its_word_says() {
    let samples: Vec<Sample> = [programs::samples(), tables::samples(), maps::samples(), logs::samples()].concat();
    let found: BTreeMap<String, String> = samples.iter().map(|sample| (sample.row.to_owned(), word(sample))).collect();
    assert_eq!(found.len(), samples.len(), "two samples of one row");
    let rows = rows();
    assert!(rows.len() > 40, "{}", rows.len());
    let wrong: Vec<_> = rows.iter().filter(|(row, said)| found.get(row) != Some(said)).collect();
    let does: Vec<_> = wrong.iter().map(|(row, _)| (row, found.get(row))).collect();
    assert!(wrong.is_empty(), "docs/readers.md says {wrong:?}, and what happens is {does:?}");
    let told: Vec<&String> = rows.iter().map(|(row, _)| row).collect();
    let missing: Vec<&String> = found.keys().filter(|row| !told.contains(row)).collect();
    assert!(missing.is_empty(), "not in docs/readers.md: {missing:?}");
}
