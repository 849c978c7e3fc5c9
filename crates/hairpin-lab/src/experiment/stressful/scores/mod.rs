//! Figure 8: per controller, the largest deviation with each score relative to uniform feasible trajectories; and
//! beyond it, executions in the loop and waypoints moved freely.
//!
//! Every trajectory comes from a graph of its own (one best per graph), no waypoint is used twice on either side, and
//! what is told are fresh runs with noise, which no search has seen.

mod kinds;
mod lifts;
mod measure;
mod size;
mod tables;
mod ways;

use hairpin_jobs::{Problem, Watch};

use crate::experiment::outcome::Outcome;
use crate::experiment::sheet::Sheet;
use lifts::{Measured, figure, summary};
use measure::measure;
use size::{Printed, Size};
use tables::Tables;

/// Per controller, the largest deviation with each score relative to no score, beside the paper's.
pub(in super::super) fn scores(sheet: &Sheet, watch: &dyn Watch) -> Result<Outcome, Problem> {
    let (size, printed): (Size, Printed) = (sheet.size()?, sheet.printed()?);
    let mut tables = Tables::new();
    let measured: Vec<Measured> =
        size.graphs().map(|graphs| measure(&size, graphs, &mut tables, watch)).collect::<Result<_, _>>()?;
    let summary = summary(&size, &printed, &measured);
    let figures = measured.iter().map(|measured| (measured.graphs.name(), figure(measured, &printed))).collect();
    let notes = vec![
        format!(
            "Deviation from `{}`, length {}, {} graphs a cell, each trajectory flown {} times with noise; lifts are of means over uniform \
             feasible trajectories, with 95 % bootstrap intervals; scores are learned from {} executions in other graphs.",
            size.from, size.length, size.graphs, size.runs, size.training
        ),
        "Waypoints are spread by `sampling` where graphs are searched, and uniformly under the baselines; none is used twice, on either side. \
         Minimum snap has times by the square root of the leg's length."
            .into(),
    ];
    Ok(Outcome {
        tables: vec![("summary", summary), ("lifts", tables.lifts), ("models", tables.models)],
        figures,
        notes,
    })
}
