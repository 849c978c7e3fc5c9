//! One cell: its runs and its pairs, one after the other, each on all threads.

use hairpin_jobs::{Problem, Watch};

use super::pair::pair;
use super::record::CellRecord;
use super::run::run;
use super::size::{Cell, Size};
use super::ways::Way;
use crate::experiment::watched::go_on;

/// What progress counts within a cell.
const RUNS: &str = "runs of the cell";

/// Measures `cell`.
///
/// # Errors
/// A robot that the scenario does not take; nothing feasible to draw; stopped.
pub(super) fn measure(cell: &Cell, size: &Size, watch: &dyn Watch) -> Result<CellRecord, Problem> {
    let pairs = if size.ways.contains(&Way::Worst) { size.pairs } else { 0 };
    let of = size.runs + pairs;
    let mut record = CellRecord {
        settings: cell.settings(size),
        drawn_how: String::new(),
        mean: cell.mean.clone(),
        runs: Vec::with_capacity(size.runs),
        pairs: Vec::with_capacity(pairs),
    };
    for number in 0..size.runs {
        watch.progress(RUNS, number, of);
        go_on(watch)?;
        let (run, drawn_how) = run(cell, size, number, watch)?;
        record.runs.push(run);
        record.drawn_how = drawn_how.to_owned();
    }
    for number in 0..pairs {
        watch.progress(RUNS, size.runs + number, of);
        go_on(watch)?;
        record.pairs.extend(pair(cell, size, number, &record.runs, watch)?);
    }
    watch.finished(RUNS);
    Ok(record)
}
