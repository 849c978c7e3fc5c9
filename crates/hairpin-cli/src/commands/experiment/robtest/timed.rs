//! One search on one thread, with the time it took.

use hairpin::search::heaviest::{Arcs, Heaviest, HeaviestSettings, heaviest};

use super::super::go_on;
use crate::commands::bench::clock::{Stopwatch, alone, median_time};
use crate::interrupt;
use crate::problem::Problem;

/// Searches shorter than this many seconds are repeated for their time: the clock of processor time ticks.
const REPEATED: f64 = 0.05;

/// Processor seconds of one search, and what it found within `limit` of them.
pub(super) fn timed(arcs: &Arcs, settings: &HeaviestSettings, limit: f64) -> Result<(f64, Heaviest), Problem> {
    let watch = Stopwatch::start();
    let stop = || interrupt::asked() || watch.passed(limit);
    let found = alone(|| heaviest(arcs, settings, &stop)).map_err(Problem::input)?;
    go_on()?;
    let spent = watch.spent();
    if spent > REPEATED || !found.proven {
        return Ok((spent, found));
    }
    Ok((alone(|| median_time(1, || heaviest(arcs, settings, &|| false))), found))
}
