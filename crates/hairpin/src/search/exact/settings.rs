//! What is asked of the exact search.

use crate::search::objective::Aggregate;

/// What is asked for.
///
/// `expansions` is the one number that trades proof for time; memory grows with it, by the legs of each node expanded.
#[derive(Debug, Clone, PartialEq)]
pub struct ExactSettings {
    /// Waypoints of a trajectory, both ends included; at most the length the graph was built for.
    pub length: usize,
    /// Distinct trajectories wanted: the k best. 0 is taken as 1.
    pub best: usize,
    /// Whether a waypoint may be used twice.
    pub revisits: bool,
    /// How legs add up.
    pub aggregate: Aggregate,
    /// Partial trajectories that the best-first search expands before it gives up the proof.
    pub expansions: u64,
    /// Partial trajectories per length that the beam keeps where the proof was given up.
    pub width: usize,
}

impl Default for ExactSettings {
    fn default() -> Self {
        Self { length: 10, best: 1, revisits: false, aggregate: Aggregate::Sum, expansions: 50_000, width: 1_000 }
    }
}
