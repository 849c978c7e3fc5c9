//! The optimum of every score over one graph, which is built once for all of them.

use std::hash::Hash;

use super::answer::Answer;
use super::question::Question;
use crate::search::{Additive, Aggregate, ExactOutcome, ExactSearch, ExactSettings, LegGraph};

/// How legs add up, in the order of the optima of one score.
pub(in crate::campaign) const AGGREGATES: [Aggregate; 2] = [Aggregate::Max, Aggregate::Sum];

/// Of every score of the question, its own first, the optimum under each of [`AGGREGATES`].
///
/// Each at most one trajectory, with its bound. Ends early once nobody waits for them.
pub(super) fn optima<'q, N: Copy + Eq + Ord + Hash, O: Additive>(
    question: &'q Question<N, O>,
    graph: &'q LegGraph<'_, N>,
) -> impl Iterator<Item = ExactOutcome<N>> {
    let settings = ExactSettings {
        length: question.length,
        best: 1,
        revisits: question.search.revisits,
        ..ExactSettings::default()
    };
    let search = ExactSearch::new(graph, settings);
    let scores = std::iter::once(&question.score).chain(&question.also).take_while(|_| !(question.looped.over)());
    scores.flat_map(move |score| search.best(score, AGGREGATES))
}

/// The plans of [`optima`] in their order; none at all where one is missing, so that no score has graphs that another
/// has not.
pub(super) fn by_optima<N: Copy + Eq + Ord + Hash, O: Additive>(question: &Question<N, O>) -> Answer {
    let Some(graph) = question.leg_graph() else { return Answer::stopped() };
    let mut all = Answer::default();
    for outcome in optima(question, &graph) {
        let proven_empty = outcome.found.is_empty() && outcome.bound.is_none();
        let Answer { mut plans, refused, .. } = question.answer(outcome.found, outcome.bound);
        all.expansions += outcome.expansions;
        let Some(plan) = plans.pop() else {
            let reason =
                Some(format!("a score has no optimum among the {} feasible legs of the last graph", graph.legs()));
            return Answer { plans, refused, proven_empty, reason, ..all };
        };
        all.plans.push(plan);
    }
    if all.plans.len() < AGGREGATES.len() * (1 + question.also.len()) { Answer::stopped() } else { all }
}
