//! What a search of one graph gave.

use super::plan::Plan;

/// What the search gave.
#[derive(Default)]
pub(in crate::campaign) struct Answer {
    pub(in crate::campaign) plans: Vec<Plan>,
    /// Trajectories found that break a limit of whole trajectories.
    pub(in crate::campaign) refused: usize,
    pub(in crate::campaign) proven_empty: bool,
    pub(in crate::campaign) expansions: u64,
    pub(in crate::campaign) dropped: u64,
    pub(in crate::campaign) duplicates: u64,
    /// How many of the plans, from the first, a round's models chose.
    pub(in crate::campaign) chosen: usize,
    /// How many, after those, are optima of scores by hand.
    pub(in crate::campaign) by_hand: usize,
    /// The largest stress after each execution in the loop.
    pub(in crate::campaign) best_so_far: Vec<f64>,
    /// Why nothing was found.
    pub(in crate::campaign) reason: Option<String>,
}
