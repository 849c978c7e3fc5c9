//! What the beam found in a graph, and why it ended.

use crate::search::task::Found;

/// Why a graph ended.
///
/// Only `Exhausted { proof: true }` says anything of trajectories that were not found.
///
/// | variant | found | what to do |
/// | --- | --- | --- |
/// | `Complete` | `per_graph` or more | – |
/// | `Exhausted`, proof | all that there are | another graph, or a larger reach |
/// | `Exhausted`, no proof | maybe not all | a larger `frontier` or `keep` |
/// | `Capped` | maybe not all | more `iterations` |
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
///
/// Counters tell where partial trajectories went, so that an empty answer can be explained; they are the same in
/// every run.
#[derive(Debug, Clone, PartialEq)]
pub struct BeamOutcome<N> {
    /// Distinct trajectories, best score first, ties by waypoint index.
    /// By waypoints; of the same waypoints over several nodes the one that was complete first.
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
    /// Above 0 there is no proof.
    pub dropped: u64,
    /// Partial trajectories not made because they could not be scored.
    /// The growth said `None`: an execution failed, or a budget ended. Above 0 there is no proof.
    pub unkept: u64,
    /// Partial trajectories not made because the end is out of their reach.
    /// By the lookahead, exactly, or by the caller's necessary test; neither loses a trajectory.
    pub pruned: u64,
    /// Partial trajectories not kept because as good a one has the same future.
    /// With revisits and a score without memory that loses nothing as long as `keep` ≥ `per_graph`.
    pub reduced: u64,
    /// Trajectories found again over other nodes.
    pub duplicates: u64,
}
