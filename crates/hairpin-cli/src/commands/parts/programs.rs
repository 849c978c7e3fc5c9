//! Programs that were found without generating a campaign.

use hairpin::campaign::arm::{ArmGraph, ArmSetup};
use hairpin::campaign::{Case, Stop, Tally};

use super::graph::keep_graph;
use super::keep::keep_cases;
use super::optimum;
use crate::folder::Work;
use crate::problem::Problem;

/// Writes the programs that were found, as `generate` would.
pub(crate) fn keep_programs(
    work: &Work,
    arm: &ArmSetup,
    graph: &ArmGraph,
    cases: &[Case],
    stop: &Stop,
) -> Result<(), Problem> {
    keep_graph(work, arm, graph)?;
    optimum::keep(work, arm, graph, cases, stop)?;
    let tally = Tally { complete: true, graphs: 1, units: 1, solved: u64::from(!cases.is_empty()), ..Tally::default() };
    keep_cases(work, cases, 0, &tally)
}
