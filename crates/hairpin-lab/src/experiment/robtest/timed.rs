//! One search on one thread, with the time it took.

use hairpin::search::heaviest::{Arcs, Heaviest, HeaviestSettings, heaviest};
use hairpin_jobs::{Problem, Watch};

use crate::clock::{Stopwatch, alone, median_time};
use crate::experiment::watched::go_on;

/// Searches shorter than this many seconds are repeated for their time: the clock of processor time ticks.
const REPEATED: f64 = 0.05;

/// Processor seconds of one search, and what it found within `limit` of them.
pub(super) fn timed(
    arcs: &Arcs,
    settings: &HeaviestSettings,
    limit: f64,
    watch: &dyn Watch,
) -> Result<(f64, Heaviest), Problem> {
    let stopwatch = Stopwatch::start();
    let stop = || watch.stopped() || stopwatch.passed(limit);
    let found = alone(|| heaviest(arcs, settings, &stop)).map_err(Problem::input)?;
    go_on(watch)?;
    let spent = stopwatch.spent();
    if spent > REPEATED || !found.proven {
        return Ok((spent, found));
    }
    Ok((alone(|| median_time(1, || heaviest(arcs, settings, &|| false))), found))
}
