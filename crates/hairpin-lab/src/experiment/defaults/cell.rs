//! One cell: its runs and its pairs, one after the other, each on all threads.

use hairpin::math::random::named_seed;
use hairpin_jobs::{Problem, Watch};

use super::field::setup;
use super::pair::pair;
use super::record::CellRecord;
use super::run::run;
use super::size::{Cell, Size};
use super::ways::Way;
use crate::experiment::watched::go_on;

/// What progress counts within a cell.
const RUNS: &str = "runs of the cell";
/// Grounds that are drawn for one that a robot can begin on, at most.
const GROUNDS: u64 = 100;

/// Measures what is missing of `cell` in `record`, and has it kept after each run and each pair.
///
/// # Errors
/// A robot that the scenario does not take; nothing feasible to draw; a record that cannot be written; stopped.
pub(super) fn measure(
    cell: &Cell,
    size: &Size,
    record: &mut CellRecord,
    keep: &dyn Fn(&CellRecord) -> Result<(), Problem>,
    watch: &dyn Watch,
) -> Result<(), Problem> {
    let pairs = if size.ways.contains(&Way::Worst) { size.pairs } else { 0 };
    let of = size.runs + pairs;
    for number in record.runs.len()..size.runs {
        watch.progress(RUNS, number, of);
        go_on(watch)?;
        let seed = run_seed(cell, size, number);
        let (run, drawn_how) = run(&cell.on_ground(seed)?, size, seed, watch)?;
        record.runs.push(run);
        drawn_how.clone_into(&mut record.drawn_how);
        keep(record)?;
    }
    for number in record.pairs.len()..pairs {
        watch.progress(RUNS, size.runs + number, of);
        go_on(watch)?;
        let seed = run_seed(cell, size, number);
        let measured = record.runs.get(number);
        record.pairs.push(pair(&cell.on_ground(seed)?, size, seed, measured, watch)?);
        keep(record)?;
    }
    watch.finished(RUNS);
    Ok(())
}

/// The seed of run number `run` of `cell`.
fn run_seed(cell: &Cell, size: &Size, run: usize) -> u64 {
    named_seed(named_seed(size.seed(), &cell.name, 0), "run", run as u64)
}

impl Cell {
    /// It with a ground of its own under `seed`, where ground is drawn: the same for all sides of a run, and the first
    /// of those drawn on which the robot can begin.
    ///
    /// # Errors
    /// There is none.
    fn on_ground(&self, seed: u64) -> Result<Self, Problem> {
        let Some(key) = &self.ground else { return Ok(self.clone()) };
        let mut problem = None;
        for number in 0..GROUNDS {
            let mut cell = self.clone();
            let drawn = named_seed(seed, "ground", number) >> 1;
            cell.sets.push((key.clone(), drawn.to_string()));
            match setup(&cell, seed, &[]) {
                Ok(_) => return Ok(cell),
                Err(why) => problem = Some(why),
            }
        }
        Err(problem.unwrap_or_else(|| Problem::input("no ground was drawn")))
    }
}
