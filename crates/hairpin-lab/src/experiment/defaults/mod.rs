//! What the default search is worth: every shipped robot under every controller, beside random trajectories, the best
//! of as many of them, CMA-ES, and the search in the loop.
//!
//! | file | does |
//! | --- | --- |
//! | `size` | the sheet, and the cells that it asks for |
//! | `ways` | who finds cases, and by which keys |
//! | `field` | draws, executions and fresh executions in one cell |
//! | `cmaes` | the evolution strategy |
//! | `evolve` | the same over waypoints |
//! | `run` | one independent run of a cell |
//! | `pair` | a default run beside ten times its executions by chance |
//! | `record` | what was measured, as it is kept |
//! | `statistics` | lifts, their intervals, and how often one side is ahead |
//! | `lifts` | from records to lifts |
//! | `tables` | lifts as tables, `markdown` as text |
//!
//! What a side keeps it has found by nominal executions; what is told is fresh ones under noise and `[vary]`, which no
//! side has seen.

mod cell;
mod cmaes;
mod evolve;
mod field;
mod lifts;
mod markdown;
mod pair;
mod record;
mod run;
mod size;
mod statistics;
mod tables;
mod ways;

use std::path::Path;

use hairpin_formats::atomic;
use hairpin_jobs::{Problem, Watch};

use self::cell::measure;
use self::lifts::Lifts;
use self::markdown::markdown;
use self::record::CellRecord;
use self::size::Size;
use crate::experiment::outcome::Outcome;
use crate::experiment::sheet::Sheet;

/// What progress counts.
const WHAT: &str = "cells";

/// Measures the cells that are asked for, those left out of which `out` has a record already.
pub(super) fn defaults(sheet: &Sheet, out: &Path, watch: &dyn Watch) -> Result<Outcome, Problem> {
    let size: Size = sheet.size()?;
    let cells = size.cells()?;
    if cells.is_empty() {
        return Err(Problem::input(format!("`only` = {:?}: no cell's name has one of these in it", size.only)));
    }
    let kept = out.join("cells");
    atomic::make_folder(&kept)?;
    let (mut records, mut refused): (Vec<CellRecord>, Vec<String>) = (Vec::new(), Vec::new());
    for (done, cell) in cells.iter().enumerate() {
        watch.progress(WHAT, done, cells.len());
        let file = kept.join(cell.file());
        let size = cell.size(&size);
        let mut record = CellRecord::read(&file, cell, cell.settings(&size))?;
        let keep = |record: &CellRecord| Ok(atomic::write_json(&file, record)?);
        match measure(cell, &size, &mut record, &keep, watch) {
            Ok(()) => records.push(record),
            Err(Problem::Interrupted(_)) => {
                return Err(Problem::Interrupted(format!(
                    "interrupted: {done} of {} cells are done and kept, and {} of {} runs of the next",
                    cells.len(),
                    record.runs.len(),
                    size.runs
                )));
            }
            Err(problem) => {
                // A mistake in a scenario is told with its place below it.
                let why = problem.to_string();
                let why = why.lines().next().unwrap_or_default();
                refused.push(match record.runs.len() {
                    0 => format!("{}: not measured: {why}", cell.name),
                    runs => format!("{}: measured by {runs} of {} runs alone: {why}", cell.name, size.runs),
                });
                records.extend((!record.runs.is_empty()).then_some(record));
            }
        }
    }
    watch.finished(WHAT);
    let lifts = Lifts::of(&records, size.seed());
    let text = markdown(&lifts, &size, &refused);
    let path = out.join("defaults.md");
    atomic::write(&path, text.as_bytes())?;
    let mut notes = vec![format!(
        "{} independent runs a cell of {} cases with {} executions each; seeds from `{}`; what is kept was executed {} times afresh.",
        size.runs,
        size.cases,
        size.executions,
        size.seed_of(),
        size.fresh
    )];
    notes.extend(refused);
    notes.push(path.display().to_string());
    Ok(Outcome { tables: tables::tables(&lifts), figures: Vec::new(), notes })
}
