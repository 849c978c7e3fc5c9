//! What legs score: kept of all of them, or asked one by one.

use super::super::graph::{LegGraph, LegScores, Scoring};

/// The scores of a graph's legs.
#[derive(Clone, Copy)]
pub(super) enum Worth<'k> {
    /// All of them.
    Kept(&'k LegScores),
    /// Of which none leaves anything to the next leg.
    Asked(&'k dyn Scoring),
}

impl Worth<'_> {
    /// What leg number `leg`, which `node` has, scores without what was left to it.
    pub(super) fn own<N: Copy>(&self, graph: &LegGraph<'_, N>, (node, leg): (u32, usize)) -> f64 {
        match self {
            Self::Kept(scores) => scores.own(leg),
            Self::Asked(score) => score.worth(&graph.view(node, leg)),
        }
    }

    /// What `leg` leaves to the first of the `legs` that come after it.
    pub(super) fn left(&self, leg: usize, legs: usize) -> f64 {
        match self {
            Self::Kept(scores) => scores.left(leg, legs),
            Self::Asked(_) => 0.0,
        }
    }
}
