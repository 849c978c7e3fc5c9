//! A score by name, by a model, or by what else knows legs.

use super::ScoreModel;
use crate::campaign::user_score::{LegFacts, LegScorer};
use crate::search::{Additive, ByTurn, LegView, Objective, Score};

/// What a scenario scores legs by.
///
/// One type for all, so that the searches are compiled for each kind of node and not for each score.
///
/// Memory is one number, what the last leg leaves: named scores and those of one's own leave 0.
#[derive(Clone, Copy)]
pub(in crate::campaign) enum AnyScore<'a> {
    /// One of those that have names.
    Named(Score),
    /// One that was learned.
    Learned(&'a ScoreModel),
    /// One of the user's own.
    User(&'a dyn LegScorer),
    /// What the search's own side knows of a leg; it leaves nothing to the next.
    Own(&'a dyn Fn(&LegView<'_>) -> f64),
}

impl AnyScore<'_> {
    /// [`Additive::own`] and [`Additive::left`].
    ///
    /// In the unit of the score; of a learned one its stress.
    fn both(&self, leg: &LegView<'_>) -> [f64; 2] {
        match self {
            Self::Named(score) => [score.own(leg), score.left(leg)],
            Self::Learned(model) => [model.own(&leg.features, leg.duration), model.left(&leg.features, leg.duration)],
            Self::User(user) => user.own_and_left(&[LegFacts::of(leg)])[0],
            Self::Own(stress) => [stress(leg), 0.0],
        }
    }
}

impl Objective for AnyScore<'_> {
    /// What the last leg leaves to the next.
    type Memory = f64;

    fn start(&self) -> f64 {
        0.0
    }

    fn extend(&self, before: &f64, leg: &LegView<'_>) -> (f64, f64) {
        let [own, left] = self.both(leg);
        (own + before, left)
    }
}

impl Additive for AnyScore<'_> {
    fn own(&self, leg: &LegView<'_>) -> f64 {
        self.both(leg)[0]
    }

    fn left(&self, leg: &LegView<'_>) -> f64 {
        self.both(leg)[1]
    }

    fn by_turn(&self, leg: &LegView<'_>) -> Option<ByTurn> {
        match self {
            Self::Named(score) => score.by_turn(leg),
            Self::Learned(_) | Self::User(_) | Self::Own(_) => None,
        }
    }

    fn is_timeless(&self) -> bool {
        matches!(self, Self::Named(_))
    }

    fn own_and_left(&self, legs: &[LegView<'_>]) -> Vec<[f64; 2]> {
        match self {
            Self::Named(score) => score.own_and_left(legs),
            Self::Learned(model) => model.own_and_left(legs.iter().map(|leg| (&leg.features, leg.duration))),
            Self::User(user) => user.own_and_left(&legs.iter().map(LegFacts::of).collect::<Vec<_>>()),
            Self::Own(_) => legs.iter().map(|leg| self.both(leg)).collect(),
        }
    }
}
