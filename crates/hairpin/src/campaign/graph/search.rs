//! The search that the scenario asks for, over any reach set.

use std::hash::Hash;

use nalgebra::Point3;

use crate::campaign::scenario::{SearchMethod, SearchSection};
use crate::feasibility::reach::Reach;
use crate::search::beam::Ended;
use crate::search::{
    BeamSettings, ExactSettings, Found, LegGraph, Objective, Task, UniformSettings, beam, exact, uniform,
};

/// One graph and what is asked of it.
pub(in crate::campaign) struct Question<'a, N, R, O> {
    pub(in crate::campaign) search: &'a SearchSection,
    /// Waypoints of a trajectory, both ends included.
    pub(in crate::campaign) length: usize,
    pub(in crate::campaign) points: &'a [Point3<f64>],
    pub(in crate::campaign) reach: &'a R,
    pub(in crate::campaign) start: N,
    pub(in crate::campaign) score: O,
    /// Seed of what the search itself draws.
    pub(in crate::campaign) seed: u64,
    /// Steps from the end within which the beam asks the reach set itself whether the end can be reached.
    pub(in crate::campaign) lookahead: usize,
}

/// What the search gave.
pub(in crate::campaign) struct Answer<N> {
    pub(in crate::campaign) found: Vec<Found<N>>,
    /// Proven upper bound of the score.
    pub(in crate::campaign) bound: Option<f64>,
    pub(in crate::campaign) proven_empty: bool,
    pub(in crate::campaign) expansions: u64,
    pub(in crate::campaign) dropped: u64,
    pub(in crate::campaign) duplicates: u64,
    /// Why nothing was found.
    pub(in crate::campaign) reason: Option<String>,
}

/// Searches one graph. `may_arrive(node, steps)` is necessary for the end to be reached from `node` in `steps` legs.
pub(in crate::campaign) fn search<N: Copy + Eq + Ord + Hash, R: Reach<N>, O: Objective<Memory = ()>>(
    question: &Question<N, R, O>,
    may_arrive: impl Fn(&N, usize) -> bool,
) -> Answer<N> {
    match question.search.method {
        SearchMethod::Beam => by_beam(question, may_arrive),
        SearchMethod::Exact => by_dynamic_program(question),
        SearchMethod::Uniform => by_uniform_draws(question),
    }
}

fn by_beam<N: Copy + Eq + Ord + Hash, R: Reach<N>, O: Objective<Memory = ()>>(
    question: &Question<N, R, O>,
    may_arrive: impl Fn(&N, usize) -> bool,
) -> Answer<N> {
    let search = question.search;
    let settings = BeamSettings {
        length: question.length,
        width: search.width as usize,
        per_graph: search.per_graph as usize,
        revisits: search.revisits,
        aggregate: search.aggregate,
        iterations: search.iterations as usize,
        frontier: search.frontier as usize,
        keep: BeamSettings::default().keep.map(|keep| keep.max(search.per_graph as usize)),
        lookahead: question.lookahead,
    };
    let task = Task { start: question.start, candidates: question.points, reach: question.reach };
    let outcome = beam(&task, &question.score, may_arrive, &settings);
    let mut found = outcome.found;
    found.truncate(search.per_graph as usize);
    let reason = match outcome.ended {
        _ if !found.is_empty() => None,
        Ended::Capped => Some(format!("{} iterations per graph were not enough", search.iterations)),
        Ended::Exhausted { proof: true } => Some("every partial trajectory ends before the end is reached".into()),
        _ => Some("the frontier ran empty before the end was reached".into()),
    };
    Answer {
        proven_empty: found.is_empty() && outcome.ended == Ended::Exhausted { proof: true },
        found,
        bound: None,
        expansions: outcome.expansions,
        dropped: outcome.dropped,
        duplicates: outcome.duplicates,
        reason,
    }
}

fn by_dynamic_program<N: Copy + Eq + Ord + Hash, R: Reach<N>, O: Objective<Memory = ()>>(
    question: &Question<N, R, O>,
) -> Answer<N> {
    let search = question.search;
    let graph = leg_graph(question);
    let settings = ExactSettings {
        length: question.length,
        best: search.per_graph as usize,
        revisits: search.revisits,
        aggregate: search.aggregate,
        ..ExactSettings::default()
    };
    let outcome = exact(&graph, &question.score, &settings);
    let proven_empty = outcome.found.is_empty() && outcome.bound.is_none();
    let reason = match (outcome.found.is_empty(), proven_empty) {
        (false, _) => None,
        (true, true) => Some(format!("none among the {} feasible legs of the last graph", graph.legs())),
        (true, false) => Some("none without revisits was found within the search's budget".into()),
    };
    Answer {
        found: outcome.found,
        bound: outcome.bound,
        proven_empty,
        expansions: outcome.expansions,
        dropped: 0,
        duplicates: 0,
        reason,
    }
}

fn by_uniform_draws<N: Copy + Eq + Ord + Hash, R: Reach<N>, O: Objective<Memory = ()>>(
    question: &Question<N, R, O>,
) -> Answer<N> {
    let search = question.search;
    let graph = leg_graph(question);
    let settings = UniformSettings {
        length: question.length,
        wanted: search.per_graph as usize,
        draws: search.iterations.max(search.per_graph),
        revisits: search.revisits,
        aggregate: search.aggregate,
    };
    let outcome = uniform(&graph, &question.score, question.seed, &settings);
    let proven_empty = outcome.walks.is_zero();
    let reason = match (outcome.found.is_empty(), proven_empty) {
        (false, _) => None,
        (true, true) => Some(format!("none among the {} feasible legs of the last graph", graph.legs())),
        (true, false) => Some(format!("{} draws all used a waypoint twice", outcome.draws)),
    };
    Answer {
        found: outcome.found,
        bound: None,
        proven_empty,
        expansions: outcome.draws,
        dropped: 0,
        // Repetitions are counted where they are not taken over.
        duplicates: 0,
        reason,
    }
}

/// All legs of the graph that are on some way of the right length.
fn leg_graph<'a, N: Copy + Eq + Ord + Hash, R: Reach<N>, O>(question: &Question<'a, N, R, O>) -> LegGraph<'a, N> {
    LegGraph::explore(question.start, question.points, question.reach, question.length)
}
