//! What a graph asks of a score, whatever its type: searches are compiled once a kind of node.

use super::super::objective::{Additive, ByTurn, LegView};

/// A score of any type.
pub(in crate::search) trait Scoring {
    /// [`Additive::own`], −∞ in the place of NaN.
    fn worth(&self, leg: &LegView<'_>) -> f64;
    /// [`Additive::own_and_left`].
    fn worth_and_left(&self, legs: &[LegView<'_>]) -> Vec<[f64; 2]>;
    /// [`Additive::by_turn`].
    fn worth_by_turn(&self, leg: &LegView<'_>) -> Option<ByTurn>;
    /// [`Additive::has_sink`].
    fn to_sink(&self) -> bool;
}

impl<O: Additive> Scoring for O {
    fn worth(&self, leg: &LegView<'_>) -> f64 {
        let own = Additive::own(self, leg);
        if own.is_nan() { f64::NEG_INFINITY } else { own }
    }

    fn worth_and_left(&self, legs: &[LegView<'_>]) -> Vec<[f64; 2]> {
        Additive::own_and_left(self, legs)
    }

    fn worth_by_turn(&self, leg: &LegView<'_>) -> Option<ByTurn> {
        Additive::by_turn(self, leg)
    }

    fn to_sink(&self) -> bool {
        Additive::has_sink(self)
    }
}
