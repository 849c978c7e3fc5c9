//! Where candidates for legs of drives are lost.

use super::DriveSetup;
use super::solve::DriveSolver;
use crate::campaign::graph::{Counter, GRAPHS, Losses};

/// Counts the candidates of the first `graphs` graphs, a few at most.
pub(super) fn losses(setup: &DriveSetup, graphs: u64) -> Losses {
    let mut counter = Counter::default();
    if let Ok(solver) = DriveSolver::new(setup) {
        for graph in 0..graphs.min(GRAPHS) {
            solver.count(graph, &mut counter);
        }
    }
    counter.losses("pairs of headed waypoints near the start")
}
