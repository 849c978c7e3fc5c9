//! The optimum over the legs of a graph, proven: dynamic programming, and best-first search in the order of its bound.
//!
//! With revisits the bound is the truth: the k best trajectories come off the queue first. Without, the bound is that
//! of walks which may come back, and the first trajectories without revisits that come off the queue are the
//! best; where the queue would grow beyond its budget, a beam in the order of the bound finds a good one and its gap is
//! told.
//!
//! ```text
//! V_s(v)  best of the walks of s legs from v to the end             (graph::value, backwards)
//! f = g ⊕ V                                                          A*: score so far, best still to come
//! ```
//!
//! V is exact over walks, hence an admissible and consistent bound over trajectories without revisits: the first
//! complete entry off the queue is the best (Hart, Nilsson and Raphael 1968). Where revisits are allowed no entry is
//! ever expanded in vain, and the k best cost about k · length expansions.

mod best_first;
mod descent;
mod settings;
#[cfg(feature = "unit-tests")]
mod tests;
mod worth;

use std::borrow::Cow;
use std::cell::OnceCell;
use std::collections::{HashMap, HashSet};

use rustc_hash::FxBuildHasher;

use self::best_first::{BestFirst, Prove};
use self::worth::Worth;
use super::graph::{LegGraph, LegScores, Scoring, Values};
use super::objective::{Additive, Aggregate};
use super::task::Found;
use crate::feasibility::reach::Reach;

pub use settings::ExactSettings;

/// The answer.
///
/// `found[..proven]` are the best there are; of later ones only `bound` is known. Two trajectories through other nodes
/// of the same waypoints count once.
///
/// | `found` | `bound` | meaning |
/// | --- | --- | --- |
/// | some, `proven` ≥ 1 | their first score | the best |
/// | some, `proven` = 0 | at least it | the best lies within [`Self::gap`] |
/// | none | some | none was found; there may be one without revisits |
/// | none | `None` | there is none |
#[derive(Debug, Clone, PartialEq)]
pub struct ExactOutcome<N> {
    /// Distinct trajectories, best first.
    pub found: Vec<Found<N>>,
    /// How many of them, from the first, are proven to be the best there are.
    pub proven: usize,
    /// Proven upper bound of the best score; `None` if it is proven that there is no trajectory.
    pub bound: Option<f64>,
    /// Partial trajectories expanded.
    pub expansions: u64,
}

impl<N> ExactOutcome<N> {
    /// How much better than the best one found a trajectory might be; 0: proven optimal.
    ///
    /// In the score's unit, at least 0; `None` where nothing was found or nothing exists.
    pub fn gap(&self) -> Option<f64> {
        Some((self.bound? - self.found.first()?.score).max(0.0))
    }
}

/// The best trajectories of `graph` under a score that is additive over legs, or over pairs of them.
///
/// ```
/// use hairpin::feasibility::reach::{Everywhere, StepNode, StepReach, StepSettings};
/// use hairpin::search::{ExactSettings, LegGraph, LegView, exact};
/// use nalgebra::Point3;
///
/// let points: Vec<Point3<f64>> = [0.0, 1.0, 5.0, 2.0, 3.0].map(|x| Point3::new(x, 0.0, 1.0)).into();
/// let reach = StepReach::new(&Everywhere, &points, StepSettings::default());
/// let graph = LegGraph::explore(StepNode { previous: 0, current: 0 }, &points, &reach, 4);
/// let settings = ExactSettings { length: 4, best: 2, ..ExactSettings::default() };
/// let answer = exact(&graph, &|leg: &LegView<'_>| leg.features.length, &settings);
/// assert_eq!(answer.found[0].waypoints, [0, 2, 1, 4]); // 5 + 4 + 2 m
/// assert_eq!((answer.proven, answer.gap()), (2, Some(0.0)));
/// ```
pub fn exact<N, O>(graph: &LegGraph<'_, N>, objective: &O, settings: &ExactSettings) -> ExactOutcome<N>
where
    N: Copy,
    O: Additive,
{
    let [outcome] = ExactSearch::new(graph, settings.clone()).best(objective, [settings.aggregate]);
    outcome
}

/// The same of a graph of legs that may be ([`LegGraph::explore_possible`]) by `reach`, which is asked for the legs of
/// what comes into question alone: what more legs could become bounds what these can.
///
/// `None` where that bound is too far off to come to a proof within the
/// budget, or the score depends on the durations of legs, which are not known before they are proven: legs are then
/// better proven first.
pub fn exact_proven<N, O, R>(
    possible: &LegGraph<'_, N>,
    reach: &R,
    objective: &O,
    settings: &ExactSettings,
) -> Option<ExactOutcome<N>>
where
    N: Copy,
    O: Additive,
    R: Reach<N> + ?Sized,
{
    if !objective.is_timeless() {
        return None;
    }
    let search = ExactSearch::new(possible, settings.clone());
    let mut known: HashMap<(u32, u32), Option<f64>, FxBuildHasher> = HashMap::default();
    let mut prove = |from, to, time| {
        // Without revisits it has nodes of its own.
        let prove = || reach.proven(&search.graph.node(from), &search.graph.node(to), time);
        *known.entry((from, to)).or_insert_with(prove)
    };
    search.scored(objective).by(settings.aggregate).proven(settings.best, &mut prove)
}

/// Searches of one graph for several scores: what they share is done once.
///
/// Several scores of one graph (all scores by hand, for a search in the loop) share its trimming.
///
/// Made once a graph: without revisits the graph is copied and trimmed unless it was already
/// ([`LegGraph::into_without_returns`]).
#[derive(Debug)]
pub struct ExactSearch<'g, 'a, N: Copy> {
    graph: Cow<'g, LegGraph<'a, N>>,
    settings: ExactSettings,
    /// Whether there is any trajectory, revisits allowed.
    any: bool,
    near_start: Vec<Vec<u32>>,
}

impl<'g, 'a, N: Copy> ExactSearch<'g, 'a, N> {
    /// Prepares searches of `graph`, of whose `settings` those count that are not about scores.
    ///
    /// `settings.aggregate` is not used: [`Self::best`] and [`Scored::by`] are given theirs.
    pub fn new(graph: &'g LegGraph<'a, N>, settings: ExactSettings) -> Self {
        let graph = if settings.revisits { Cow::Borrowed(graph) } else { graph.without_returns(settings.length) };
        let any = graph.has_walk(settings.length);
        let near_start = graph.near_start(settings.length);
        Self { graph, settings, any, near_start }
    }

    /// The best trajectories under `objective`, by each of `aggregates`.
    ///
    /// One scoring of all legs for all K aggregates; each has a dynamic program of its own.
    pub fn best<O: Additive, const K: usize>(&self, objective: &O, aggregates: [Aggregate; K]) -> [ExactOutcome<N>; K] {
        let scored = self.scored(objective);
        aggregates.map(|aggregate| scored.by(aggregate).best(self.settings.best))
    }

    /// The legs under `objective`.
    ///
    /// O(legs) calls of the objective, by rows, unless it is given by turns ([`Additive::by_turn`]). No call where
    /// there is no trajectory.
    pub fn scored<'s, O: Additive>(&'s self, objective: &'s O) -> Scored<'s, 'g, 'a, N> {
        Scored { search: self, objective, scores: OnceCell::new() }
    }
}

/// The legs of a graph under one score.
///
/// Borrows the search; scores stay as they were asked, so that several aggregates and several counts share them.
pub struct Scored<'s, 'g, 'a, N: Copy> {
    search: &'s ExactSearch<'g, 'a, N>,
    objective: &'s dyn Scoring,
    /// Of all legs, once they are needed.
    scores: OnceCell<LegScores>,
}

impl<N: Copy> Scored<'_, '_, '_, N> {
    /// What trajectories can become whose legs add up as `aggregate` says.
    ///
    /// One backward pass, O(legs · length) time and nodes · length doubles.
    pub fn by(&self, aggregate: Aggregate) -> Ranking<'_, N> {
        let ExactSearch { graph, settings, any, near_start } = self.search;
        let length = settings.length;
        let known = || match graph.values_by_turn(length, self.objective, aggregate, near_start) {
            Some(values) => (Worth::Asked(self.objective), values),
            None => {
                let scores = self.scores.get_or_init(|| graph.scores(self.objective));
                (Worth::Kept(scores), graph.values(length, scores, aggregate, near_start))
            }
        };
        let settings = ExactSettings { aggregate, ..settings.clone() };
        Ranking { graph, settings, known: any.then(known) }
    }
}

/// The trajectories of a graph in the order of their scores: asking for more of them does over only what is different.
///
/// Nothing is kept from one call of [`Ranking::best`] to the next but the values.
pub struct Ranking<'s, N: Copy> {
    graph: &'s LegGraph<'s, N>,
    settings: ExactSettings,
    /// Scores of legs, and the best that is still to come after them.
    known: Option<(Worth<'s>, Values)>,
}

impl<N: Copy> Ranking<'_, N> {
    /// The `count` best; 0 is taken as 1.
    ///
    /// At most [`ExactSettings::expansions`] expansions with proof; where that does not suffice for `count`, the beam
    /// of `width` adds what it finds, without proof, behind those that are proven.
    pub fn best(&self, count: usize) -> ExactOutcome<N> {
        let (graph, best) = (self.graph, count.max(1));
        let Some((scores, values)) = &self.known else {
            return ExactOutcome { found: Vec::new(), proven: 0, bound: None, expansions: 0 };
        };
        let settings = &ExactSettings { best, ..self.settings.clone() };
        let mut search = best_first::best_first(graph, scores, values, settings, &mut |_, _, time| Some(time));
        let proven = search.found.len();
        if search.open_bound.is_some() && proven < best {
            let (more, expansions) = descent::descent(graph, scores, values, settings);
            search.expansions += expansions;
            let known: HashSet<Vec<u32>> = search.found.iter().map(|found| found.waypoints.clone()).collect();
            let new = more.into_iter().filter(|found| !known.contains(&found.waypoints));
            search.found.extend(new.take(best - proven));
        }
        let bound = if proven > 0 { search.found.first().map(|found| found.score) } else { search.open_bound };
        let BestFirst { found, expansions, .. } = search;
        ExactOutcome { found, proven, bound, expansions }
    }

    /// The `count` best whose legs `prove` has; `None` where the expansions do not suffice for a proof.
    fn proven(&self, count: usize, prove: &mut Prove<'_>) -> Option<ExactOutcome<N>> {
        let Some((scores, values)) = &self.known else {
            return Some(ExactOutcome { found: Vec::new(), proven: 0, bound: None, expansions: 0 });
        };
        let settings = ExactSettings { best: count.max(1), ..self.settings.clone() };
        let BestFirst { found, open_bound, expansions } =
            best_first::best_first(self.graph, scores, values, &settings, prove);
        let bound = found.first().map(|found| found.score);
        open_bound.is_none().then_some(ExactOutcome { proven: found.len(), found, bound, expansions })
    }
}
