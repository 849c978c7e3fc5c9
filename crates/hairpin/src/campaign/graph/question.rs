//! One graph, and what is asked of it.

use std::collections::HashSet;
use std::hash::Hash;

use nalgebra::Point3;

use super::answer::Answer;
use super::executions::{Executions, Move, Surroundings};
use super::plan::Plan;
use crate::campaign::SeenLeg;
use crate::campaign::learn::ScoreModel;
use crate::campaign::scenario::SearchSection;
use crate::feasibility::reach::Reach;
use crate::search::beam::Ended;
use crate::search::{Additive, BeamOutcome, BeamSettings, Found, LegGraph};

/// One graph and what is asked of it.
///
/// `points[0]` is the start, the last the end or the sink; lengths count waypoints.
pub(in crate::campaign) struct Question<'a, N, O> {
    /// The scenario's own section: numbers of what is kept, budgets, revisits and the aggregate.
    pub(in crate::campaign) search: &'a SearchSection,
    /// Waypoints of a trajectory, both ends included.
    pub(in crate::campaign) length: usize,
    pub(in crate::campaign) points: &'a [Point3<f64>],
    /// Not a type of its own each: it is asked once an expansion, and the searches are compiled once a kind of node.
    /// Which legs there are.
    pub(in crate::campaign) reach: &'a dyn Reach<N>,
    /// Its waypoint is number 0.
    pub(in crate::campaign) start: N,
    /// What a leg is worth.
    pub(in crate::campaign) score: O,
    /// Seed of what the search itself draws.
    pub(in crate::campaign) seed: u64,
    /// Steps from the end within which the beam asks the reach set itself whether the end can be reached.
    pub(in crate::campaign) lookahead: usize,
    /// The plan of what was found; `None` for what breaks a limit of whole trajectories.
    pub(in crate::campaign) plan: &'a dyn Fn(Found<N>) -> Option<Plan>,
    /// Whether the last leg is one to the sink of a task without an end.
    pub(in crate::campaign) free_end: bool,
    /// Scores beside this one whose optima a search in the loop starts from, or a round of an adaptive campaign is to
    /// have.
    pub(in crate::campaign) also: Vec<O>,
    pub(in crate::campaign) looped: Looped<'a>,
}

/// What only searches that execute ask.
#[derive(Clone, Copy)]
pub(in crate::campaign) struct Looped<'a> {
    pub(in crate::campaign) executions: Executions<'a>,
    /// What is searched beside the waypoints.
    pub(in crate::campaign) surroundings: Option<Surroundings<'a>>,
    /// A plan with other waypoints, as many; `None` where they are not feasible.
    pub(in crate::campaign) moved: Move<'a>,
    pub(in crate::campaign) wanted: Wanted<'a>,
    /// Whether nobody waits for the answer any longer.
    pub(in crate::campaign) over: &'a dyn Fn() -> bool,
}

/// What is wanted of a graph.
///
/// Decides the method before the scenario's is looked at.
#[derive(Debug, Clone, Copy)]
pub(in crate::campaign) enum Wanted<'a> {
    /// What the scenario's method finds.
    Cases,
    /// What the round of an adaptive campaign is to execute.
    Round(&'a Round<'a>),
    /// The optimum of each score with one of these names, or of the scenario's own if there are none, under both
    /// aggregates.
    Optima(&'a [&'a str]),
}

/// One round.
///
/// optima + by_hand + draws trajectories, none of which is `known`; fewer where the graph has fewer.
#[derive(Debug, Clone, Copy)]
pub(in crate::campaign) struct Round<'a> {
    /// From 0. The first one draws what the method `uniform` does.
    pub(in crate::campaign) number: u64,
    /// Place of the graph among those of the campaign: where it begins with the scores by hand.
    pub(in crate::campaign) place: u64,
    /// Trajectories wanted that are best under the models, each in turn.
    pub(in crate::campaign) optima: usize,
    /// Trajectories wanted that are best under scores by hand; drawn where there are no such scores.
    pub(in crate::campaign) by_hand: usize,
    /// Uniform draws wanted beside them.
    pub(in crate::campaign) draws: usize,
    /// Scores of legs.
    pub(in crate::campaign) models: &'a [ScoreModel],
    /// Fingerprints of what was executed before.
    pub(in crate::campaign) known: &'a HashSet<[u8; 16]>,
}

impl<'a> Looped<'a> {
    /// The models that a round searches under.
    pub(in crate::campaign) fn models(&self) -> &'a [ScoreModel] {
        match self.wanted {
            Wanted::Round(round) => round.models,
            _ => &[],
        }
    }
}

impl<N: Copy + Eq + Ord + Hash, O: Additive> Question<'_, N, O> {
    /// The plan of `found`, with what the search saw of its legs.
    pub(super) fn planned(&self, found: Found<N>) -> Option<Plan> {
        let seen = self.seen(&found);
        let mut plan = (self.plan)(found)?;
        plan.seen = seen;
        // The leg to the sink of a task without an end is none of the plan's.
        plan.seen.truncate(plan.leg_times.len());
        Some(plan)
    }

    /// Up to the first leg that the reach set has no longer.
    fn seen(&self, found: &Found<N>) -> Vec<SeenLeg> {
        let see = |pair: &[N]| {
            let leg = self.reach.leg(&pair[0], &pair[1], self.points)?;
            Some(SeenLeg { features: leg.features, duration: leg.duration })
        };
        found.nodes.windows(2).map_while(see).collect()
    }

    /// The answer with the plans of `found`, the best first, and a proven upper bound of the score.
    ///
    /// Those that break a limit of whole trajectories are counted as refused.
    pub(super) fn answer(&self, found: Vec<Found<N>>, bound: Option<f64>) -> Answer {
        let count = found.len();
        let plans: Vec<Plan> = found.into_iter().filter_map(|found| self.planned(found)).collect();
        let refused = count - plans.len();
        Answer { plans: plans.into_iter().map(|plan| Plan { bound, ..plan }).collect(), refused, ..Answer::default() }
    }

    /// How the beam is to search.
    pub(super) fn beam_settings(&self) -> BeamSettings {
        let search = self.search;
        BeamSettings {
            length: self.length,
            width: search.width as usize,
            per_graph: search.per_graph as usize,
            revisits: search.revisits,
            aggregate: search.aggregate,
            iterations: search.iterations as usize,
            frontier: search.frontier as usize,
            keep: BeamSettings::default().keep.map(|keep| keep.max(search.per_graph as usize)),
            lookahead: self.lookahead,
        }
    }

    /// The answer of the beam; `capped` says why it found nothing before its end.
    pub(super) fn answer_of(&self, outcome: BeamOutcome<N>, capped: impl Fn() -> String) -> Answer {
        let mut found = outcome.found;
        found.truncate(self.search.per_graph as usize);
        let reason = match outcome.ended {
            _ if !found.is_empty() => None,
            Ended::Capped => Some(capped()),
            Ended::Exhausted { proof: true } => Some("every partial trajectory ends before the end is reached".into()),
            _ => Some("the frontier ran empty before the end was reached".into()),
        };
        Answer {
            proven_empty: found.is_empty() && outcome.ended == Ended::Exhausted { proof: true },
            expansions: outcome.expansions,
            dropped: outcome.dropped,
            duplicates: outcome.duplicates,
            reason,
            ..self.answer(found, None)
        }
    }

    /// All legs of the graph that are on some way of the right length; without revisits, if there are to be none, those
    /// that no such way has.
    ///
    /// `None` once nobody waits for them.
    pub(super) fn leg_graph(&self) -> Option<LegGraph<'_, N>> {
        self.cut_down(LegGraph::explore(self.start, self.points, self.reach, self.length))
    }

    /// The same of all legs that may be.
    pub(super) fn possible_graph(&self) -> Option<LegGraph<'_, N>> {
        self.cut_down(LegGraph::explore_possible(self.start, self.points, self.reach, self.length))
    }

    fn cut_down<'g>(&self, graph: LegGraph<'g, N>) -> Option<LegGraph<'g, N>> {
        let graph = (!(self.looped.over)()).then_some(graph)?;
        Some(if self.search.revisits { graph } else { graph.into_without_returns(self.length) })
    }
}
