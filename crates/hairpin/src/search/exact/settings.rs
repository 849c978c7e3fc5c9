//! What is asked of the exact search.

use crate::search::objective::Aggregate;

/// What is asked for.
///
/// `expansions` is the one number that trades proof for time; memory grows with it, by the legs of each node expanded.
#[derive(Debug, Clone, PartialEq)]
pub struct ExactSettings {
    /// Waypoints of a trajectory, both ends included; at most the length the graph was built for.
    /// Below 2 there is no trajectory.
    pub length: usize,
    /// Distinct trajectories wanted: the k best. 0 is taken as 1.
    pub best: usize,
    /// Whether a waypoint may be used twice.
    /// Without, most of the time goes into what the bound cannot tell apart: walks that come back.
    pub revisits: bool,
    /// How legs add up.
    pub aggregate: Aggregate,
    /// Partial trajectories that the best-first search expands before it gives up the proof.
    /// With revisits about `best` · `length` suffice; without, as many as the graph is hard.
    pub expansions: u64,
    /// Partial trajectories per length that the beam keeps where the proof was given up.
    /// At least `best` are kept.
    pub width: usize,
}

impl Default for ExactSettings {
    fn default() -> Self {
        Self { length: 10, best: 1, revisits: false, aggregate: Aggregate::Sum, expansions: 50_000, width: 1_000 }
    }
}
