//! What a search of one graph gave.

use super::plan::Plan;

/// What the search gave.
///
/// Counts go into the tally as they are.
#[derive(Default)]
pub(in crate::campaign) struct Answer {
    /// The best first, where a search ranks them.
    pub(in crate::campaign) plans: Vec<Plan>,
    /// Trajectories found that break a limit of whole trajectories.
    pub(in crate::campaign) refused: usize,
    /// The graph has no feasible trajectory of the length; `false` where that is only not known.
    pub(in crate::campaign) proven_empty: bool,
    /// Nodes expanded, draws made, or executions, by the search's method.
    pub(in crate::campaign) expansions: u64,
    /// Partial trajectories that a full frontier dropped.
    pub(in crate::campaign) dropped: u64,
    /// Trajectories found again.
    pub(in crate::campaign) duplicates: u64,
    /// How many of the plans, from the first, a round's models chose.
    pub(in crate::campaign) chosen: usize,
    /// How many, after those, are optima of scores by hand.
    pub(in crate::campaign) by_hand: usize,
    /// The largest stress after each execution in the loop.
    ///
    /// Never falls; in the unit of the stress.
    pub(in crate::campaign) best_so_far: Vec<f64>,
    /// Why nothing was found.
    pub(in crate::campaign) reason: Option<String>,
    /// The search was ended from outside before it knew: nothing else in here says anything of the graph.
    pub(in crate::campaign) stopped: bool,
}

impl Answer {
    /// Of a graph that nobody waited for.
    pub(super) fn stopped() -> Self {
        Self { stopped: true, ..Self::default() }
    }
}
