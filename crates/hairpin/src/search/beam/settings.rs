//! How a graph is searched by the beam.
//!
//! The paper fixes length, width and the aggregate; iterations, the frontier's size, reduction and lookahead are what a
//! program adds that must end on graphs without a trajectory, too.

use crate::search::objective::Aggregate;

/// How a graph is searched. The defaults are the paper's, and ours where it has none.
///
/// Iterations · width expansions at most, each one reach set (remembered) and as many scores as it has legs; memory is
/// `frontier` partial trajectories, which share their beginnings.
#[derive(Debug, Clone, PartialEq)]
pub struct BeamSettings {
    /// Waypoints of a trajectory, both ends included; below 2 there is no trajectory.
    pub length: usize,
    /// Partial trajectories expanded per iteration; 0 is taken as 1.
    pub width: usize,
    /// Distinct trajectories after which the graph ends; 0 is taken as 1. The last iteration may give more.
    pub per_graph: usize,
    /// Whether a waypoint may be used twice. Without revisits the optimum is not back and forth between two points.
    pub revisits: bool,
    /// How legs add up.
    pub aggregate: Aggregate,
    /// Iterations after which the graph is given up: an infeasible graph may never end by itself.
    pub iterations: usize,
    /// Partial trajectories kept after an iteration; the worst are dropped and counted.
    /// At 100 000 the memory of a graph is some tens of megabytes. 0 keeps nothing, and then nothing is found.
    pub frontier: usize,
    /// Of partial trajectories with equal length and node only the best so many are kept (*commutativity reduction*);
    /// `None` keeps all. Their futures are the same with revisits, if the objective has no memory, and then nothing
    /// is lost as long as this is at least `per_graph`. Without revisits futures differ by what was visited, and the
    /// reduction is a heuristic that may lose trajectories: it then withholds the proof that there is none. The
    /// default, 3, solved the same 200 graphs of 250 waypoints as `None` at lengths 8, 10 and 50, and makes hard graphs
    /// end.
    pub keep: Option<usize>,
    /// Steps from the end within which it is known exactly whether the end can be reached (lazily computed backward
    /// pass over walks), at most 64; further away only `may_arrive` is asked.
    /// 0 asks `may_arrive` alone. Costs at most legs · lookahead for the whole graph.
    pub lookahead: usize,
}

impl Default for BeamSettings {
    fn default() -> Self {
        Self {
            length: 10,
            width: 5,
            per_graph: 1,
            revisits: false,
            aggregate: Aggregate::Sum,
            iterations: 10_000,
            frontier: 100_000,
            keep: Some(3),
            lookahead: 3,
        }
    }
}
