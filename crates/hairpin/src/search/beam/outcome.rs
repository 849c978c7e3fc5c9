//! What the beam found in a graph, and why it ended.

use crate::search::task::Found;

/// Why a graph ended.
///
/// Only `Exhausted { proof: true }` says anything of trajectories that were not found.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ended {
    /// `per_graph` trajectories were found.
    Complete,
    /// Nothing is left to expand.
    Exhausted {
        /// Whatever was dropped cannot reach the end, or has a kept twin with the same futures: if nothing was found,
        /// there is nothing.
        proof: bool,
    },
    /// The iterations were used up, or what scores does not go on.
    Capped,
}

/// What a graph gave.
#[derive(Debug, Clone, PartialEq)]
pub struct BeamOutcome<N> {
    /// Distinct trajectories, best score first, ties by waypoint index.
    pub found: Vec<Found<N>>,
    /// Why the graph ended.
    pub ended: Ended,
    /// Iterations made.
    pub iterations: usize,
    /// Partial trajectories expanded.
    pub expansions: u64,
    /// Reach sets evaluated; the others were remembered.
    pub evaluations: u64,
    /// Partial trajectories dropped because the frontier was full.
    pub dropped: u64,
    /// Partial trajectories not made because they could not be scored.
    pub unkept: u64,
    /// Partial trajectories not made because the end is out of their reach.
    pub pruned: u64,
    /// Partial trajectories not kept because as good a one has the same future.
    pub reduced: u64,
    /// Trajectories found again over other nodes.
    pub duplicates: u64,
}
