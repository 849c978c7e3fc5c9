//! Experiments that are stopped: half of a table is none.

use hairpin::campaign::Stop;
use hairpin_jobs::{Problem, Watch};

/// What is said of an experiment that was stopped.
pub(super) fn interrupted() -> Problem {
    Problem::Interrupted("interrupted: nothing was written".into())
}

/// Asked between two measurements.
pub(super) fn go_on(watch: &dyn Watch) -> Result<(), Problem> {
    if watch.stopped() { Err(interrupted()) } else { Ok(()) }
}

/// `work`, which ends early where `watch` stops it: then it is none.
pub(super) fn watched<T>(watch: &dyn Watch, work: impl FnOnce(&Stop) -> T) -> Result<T, Problem> {
    let stopped = || watch.stopped();
    let done = work(&Stop { cancelled: &stopped, ..Stop::never() });
    go_on(watch)?;
    Ok(done)
}
