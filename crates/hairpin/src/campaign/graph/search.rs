//! The search that the scenario asks for, over any reach set.

use std::hash::Hash;

use super::answer::Answer;
use super::in_loop::by_trials;
use super::optima::by_optima;
use super::partial::by_partials;
use super::question::{Question, Wanted};
use super::rounds::by_round;
use crate::campaign::scenario::SearchMethod;
use crate::feasibility::reach::Until;
use crate::search::{
    Additive, ExactSettings, Task, UniformSettings, beam, exact, exact_proven, uniform, uniform_proven,
};

/// Searches one graph. `may_arrive(node, steps)` is necessary for the end to be reached from `node` in `steps` legs.
///
/// What is over before its legs are known is stopped, whatever the method: of legs kept back nothing follows.
pub(in crate::campaign) fn search<N: Copy + Eq + Ord + Hash, O: Additive>(
    question: Question<N, O>,
    may_arrive: &dyn Fn(&N, usize) -> bool,
) -> Answer {
    let until = Until::new(question.reach, question.looped.over);
    let question = Question { reach: &until, ..question };
    let answer = match question.looped.wanted {
        Wanted::Cases => by_method(&question, may_arrive),
        Wanted::Round(round) => by_round(&question, round),
        Wanted::Optima(_) => by_optima(&question),
    };
    if until.cut() { Answer::stopped() } else { answer }
}

/// Optima of the method `exact` are proven, its bound holds for the graph; the others find what they find.
///
/// `Worst` and `Adaptive` come here only for draws.
fn by_method<N: Copy + Eq + Ord + Hash, O: Additive>(
    question: &Question<N, O>,
    may_arrive: &dyn Fn(&N, usize) -> bool,
) -> Answer {
    match question.search.method {
        SearchMethod::Beam => match question.looped.executions.partial {
            Some(partials) => by_partials(question, &partials, may_arrive),
            None => by_beam(question, may_arrive),
        },
        SearchMethod::Exact => by_dynamic_program(question),
        SearchMethod::Uniform => by_uniform_draws(question),
        SearchMethod::InLoop => by_trials(question),
        // Their executions are asked for one by one; here is whoever only asks what is feasible.
        SearchMethod::Worst | SearchMethod::Adaptive => by_uniform_draws(question),
    }
}

/// Ends with the frontier or the iterations; an empty frontier is a proof only where the beam lost nothing.
///
/// O(iterations · width · legs of a node); scores are lower bounds of what there is, never proven best.
fn by_beam<N: Copy + Eq + Ord + Hash, O: Additive>(
    question: &Question<N, O>,
    may_arrive: &dyn Fn(&N, usize) -> bool,
) -> Answer {
    let task = Task { start: question.start, candidates: question.points, reach: question.reach };
    let outcome = beam(&task, &question.score, may_arrive, &question.beam_settings());
    let capped = || format!("{} iterations per graph were not enough", question.search.iterations);
    question.answer_of(outcome, capped)
}

/// Without revisits it is a relaxation that is refined within a budget: the answer's bound says how far off its best
/// may be. Needs all legs at once: O(legs) memory.
fn by_dynamic_program<N: Copy + Eq + Ord + Hash, O: Additive>(question: &Question<N, O>) -> Answer {
    let search = question.search;
    let settings = ExactSettings {
        length: question.length,
        best: search.per_graph as usize,
        revisits: search.revisits,
        aggregate: search.aggregate,
        ..ExactSettings::default()
    };
    let mut proven = None;
    // Of a score that sees durations, and of legs that are all known at once, there is nothing to be proven later.
    if question.score.is_timeless() && !question.reach.is_known_at_once() {
        let Some(possible) = question.possible_graph() else { return Answer::stopped() };
        let outcome = exact_proven(&possible, question.reach, &question.score, &settings);
        proven = outcome.map(|outcome| (outcome, format!("{} legs that may be", possible.legs())));
    }
    let (outcome, legs) = match proven {
        Some(proven) => proven,
        None => {
            let Some(graph) = question.leg_graph() else { return Answer::stopped() };
            (exact(&graph, &question.score, &settings), format!("{} feasible legs", graph.legs()))
        }
    };
    let proven_empty = outcome.found.is_empty() && outcome.bound.is_none();
    let reason = match (outcome.found.is_empty(), proven_empty) {
        (false, _) => None,
        (true, true) => Some(format!("none among the {legs} of the last graph")),
        (true, false) => Some("none without revisits was found within the search's budget".into()),
    };
    Answer { proven_empty, expansions: outcome.expansions, reason, ..question.answer(outcome.found, outcome.bound) }
}

/// Proven empty where no walk of the length leads from start to end.
///
/// With replacement; with revisits forbidden a draw that repeats a waypoint is thrown away and counts. Legs are proven
/// as they are drawn, and all of them first only where most draws would fail.
fn by_uniform_draws<N: Copy + Eq + Ord + Hash, O: Additive>(question: &Question<N, O>) -> Answer {
    let search = question.search;
    let settings = UniformSettings {
        length: question.length,
        wanted: search.per_graph as usize,
        draws: search.iterations.max(search.per_graph),
        revisits: search.revisits,
        aggregate: search.aggregate,
    };
    let Some(possible) = question.possible_graph() else { return Answer::stopped() };
    let proven = uniform_proven(&possible, question.reach, &question.score, question.seed, &settings);
    let (outcome, legs) = match proven {
        Some(outcome) => (outcome, possible.legs()),
        None => {
            drop(possible);
            let Some(graph) = question.leg_graph() else { return Answer::stopped() };
            (uniform(&graph, &question.score, question.seed, &settings), graph.legs())
        }
    };
    let proven_empty = outcome.walks.is_zero();
    let reason = match (outcome.found.is_empty(), proven_empty) {
        (false, _) => None,
        (true, true) => Some(format!("none among the {legs} legs that may be of the last graph")),
        (true, false) => Some(format!("{} draws all used a waypoint twice or a leg that is none", outcome.draws)),
    };
    // Repetitions are counted where they are not taken over.
    Answer { proven_empty, expansions: outcome.draws, reason, ..question.answer(outcome.found, None) }
}
