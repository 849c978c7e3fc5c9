//! A score by name or by a model.

use super::ScoreModel;
use crate::search::{LegView, Objective, Score};

/// What a scenario scores legs by.
#[derive(Debug, Clone, Copy)]
pub(in crate::campaign) enum AnyScore<'a> {
    /// One of those that have names.
    Named(Score),
    /// One that was learned.
    Learned(&'a ScoreModel),
}

impl Objective for AnyScore<'_> {
    type Memory = ();

    fn start(&self) {}

    fn extend(&self, (): &(), leg: &LegView<'_>) -> (f64, ()) {
        match self {
            Self::Named(score) => score.extend(&(), leg),
            Self::Learned(model) => (model.expected(&leg.features, leg.duration), ()),
        }
    }
}
