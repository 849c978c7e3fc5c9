//! What one graph gives.

use super::answer::Answer;
use super::plan::Plan;
use crate::campaign::curve::Curve;
use crate::campaign::failures::Failures;

/// What one unit of work gave.
///
/// Mergeable: a case that tries several graphs adds them up.
#[derive(Debug, Clone, Default)]
pub(in crate::campaign) struct Outcome {
    /// Number of the graph, plan.
    pub(in crate::campaign) plans: Vec<(u64, Plan)>,
    /// Graphs searched.
    pub(in crate::campaign) graphs: u64,
    /// Of these, proven to have no trajectory.
    pub(in crate::campaign) proven_empty: u64,
    /// Nodes, draws or executions.
    pub(in crate::campaign) expansions: u64,
    /// As in [`Answer`].
    pub(in crate::campaign) dropped: u64,
    /// As in [`Answer`].
    pub(in crate::campaign) duplicates: u64,
    /// Of a round of an adaptive campaign: how many of the plans, from the first, models chose.
    pub(in crate::campaign) chosen: usize,
    /// How many of them, after those, are optima of scores by hand.
    pub(in crate::campaign) by_hand: usize,
    /// Of searches in the loop: the largest stress after each execution, of every graph that was executed in.
    pub(in crate::campaign) curves: Vec<Curve>,
    /// Executions that failed.
    pub(in crate::campaign) failures: Failures,
    /// Whether any came to a flight.
    pub(in crate::campaign) flown: bool,
    /// Why there is no plan.
    pub(in crate::campaign) reason: Option<String>,
    /// As in [`Answer`]: the graph is to be searched again.
    pub(in crate::campaign) stopped: bool,
}

impl Outcome {
    /// The outcome of graph number `graph`.
    pub(in crate::campaign) fn of(graph: u64, answer: Answer) -> Self {
        let all_refused = answer.plans.is_empty() && answer.refused > 0;
        let broken = "what was found breaks a limit of whole trajectories: it takes longer than generate.limits allows, or, of what \
                      drives, not all of its ground carries it; others of the graph were not looked for";
        let refused = all_refused.then(|| broken.to_owned());
        Self {
            plans: answer.plans.into_iter().map(|plan| (graph, plan)).collect(),
            graphs: 1,
            proven_empty: answer.proven_empty.into(),
            expansions: answer.expansions,
            dropped: answer.dropped,
            duplicates: answer.duplicates,
            chosen: answer.chosen,
            by_hand: answer.by_hand,
            curves: (!answer.best_so_far.is_empty())
                .then(|| Curve::of(graph, &answer.best_so_far))
                .into_iter()
                .collect(),
            failures: Failures::default(),
            flown: false,
            reason: answer.reason.or(refused),
            stopped: answer.stopped,
        }
    }

    /// The reason is the other's, the later one.
    pub(in crate::campaign) fn add(&mut self, other: Outcome) {
        self.plans.extend(other.plans);
        self.graphs += other.graphs;
        self.proven_empty += other.proven_empty;
        self.expansions += other.expansions;
        self.dropped += other.dropped;
        self.duplicates += other.duplicates;
        self.curves.extend(other.curves);
        self.failures.add(other.failures);
        self.flown |= other.flown;
        self.reason = other.reason;
        self.stopped |= other.stopped;
    }
}
