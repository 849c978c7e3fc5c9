//! The beam on `hull`: FlightGoggles, 250 waypoints, width 5, start (10, 10, 10), end (20, 20, 20), no speed cap; the
//! first completion ends a graph. Through the pipeline as a campaign runs it: sampling, set-up and pruning of every
//! graph are counted, and one distinct trajectory a graph.

use hairpin::campaign::{Known, OwnSimulator, Setup, Stop, Tally, generate};
use hairpin_formats::scenario::setup_for;
use hairpin_jobs::Problem;

use super::row::Row;
use crate::clock::{alone, median_rate};

/// Trajectories per run.
const CASES: u64 = 2000;

pub(super) fn rows() -> Vec<Row> {
    vec![
        Row::at_least("beam-expansions", "1/s", 700_000.0, |_| beam(50, true, |tally| tally.expansions)),
        Row::at_least("beam-trajectories-8", "1/s", 2_000.0, |_| beam(8, false, |tally| tally.solved)),
        Row::at_least("beam-trajectories-10", "1/s", 2_000.0, |_| beam(10, false, |tally| tally.solved)),
        Row::at_least("beam-trajectories-50", "1/s", 1_000.0, |_| long_trajectories()),
        Row::at_least("beam-trajectories-50-revisits", "1/s", 1_000.0, |_| beam(50, true, |tally| tally.solved)),
    ]
}

/// The scenario of these benches with `cases` of `length` waypoints.
pub(super) fn scenario(length: usize, revisits: bool, cases: u64) -> Result<Setup, Problem> {
    let set = |key: &str, value: String| (key.to_owned(), value);
    let sets = [
        set("world", "{ size_m = [30, 30, 30] }".into()),
        set("task", format!("{{ start_m = [10, 10, 10], end_m = [20, 20, 20], length = {length} }}")),
        set("generate", "{ reach = \"hull\", score = \"high-velocity-90\" }".into()),
        set("generate.search", format!("{{ waypoints = 250, width = 5, revisits = {revisits}, cases = {cases} }}")),
    ];
    Ok(setup_for("flightgoggles", &sets)?)
}

/// Generates on this thread alone, so that its clock sees all of it.
pub(super) fn on_one_thread(setup: &Setup, stop: &Stop) -> Tally {
    alone(|| generate(setup, &Known::default(), &OwnSimulator, stop, &mut |_, _| ()))
}

/// Distinct trajectories of length 50 without revisits, 1/s.
pub(super) fn long_trajectories() -> Result<f64, Problem> {
    beam(50, false, |tally| tally.solved)
}

fn beam(length: usize, revisits: bool, items: fn(&Tally) -> u64) -> Result<f64, Problem> {
    let setup = scenario(length, revisits, CASES)?;
    Ok(median_rate(5, || items(&on_one_thread(&setup, &Stop::never()))))
}
