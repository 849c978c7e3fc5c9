//! The question that a search of drives is asked, with an end or without.

use std::hash::Hash;

use nalgebra::Point3;

use crate::campaign::graph::{Looped, Outcome, Plan, Question, search};
use crate::campaign::learn::AnyScore;
use crate::campaign::scenario::{DriveScenario, SearchSection};
use crate::feasibility::reach::Reach;
use crate::math::random::named_seed;
use crate::search::{Found, OpenEnd};

/// One graph, and how it is searched.
///
/// Points have the ground's heights, m.
#[derive(Clone, Copy)]
pub(super) struct Graph<'a> {
    pub(super) search: &'a SearchSection,
    /// Number of the graph.
    pub(super) graph: u64,
    /// Its waypoints, the start first and, if there is one, the end last.
    pub(super) points: &'a [Point3<f64>],
    /// Executions, models and surroundings of a search that runs what it finds.
    pub(super) looped: Looped<'a>,
}

/// A graph, and what its legs and scores are.
///
/// Nodes `N` are those of the reach set: of a roadmap headed waypoints, of a step-wise set waypoints with what came
/// before.
pub(super) struct Asked<'a, N> {
    pub(super) scenario: &'a DriveScenario,
    pub(super) graph: Graph<'a>,
    pub(super) reach: &'a dyn Reach<N>,
    pub(super) start: N,
    pub(super) score: AnyScore<'a>,
    /// Those beside it.
    pub(super) also: Vec<AnyScore<'a>>,
    /// Steps from the end within which the beam asks the reach set itself whether the end can be reached.
    pub(super) lookahead: usize,
}

/// Searches from the start to the task's end, or to wherever the last waypoint lies. `may_arrive(node, steps)` is
/// necessary for the end to be reached from `node` in `steps` legs; `plan` gives `None` for what no drive can be made
/// of.
///
/// Without an end the trajectory has a leg more in the search, which leads from any waypoint to an end that all have in
/// common and costs nothing; plans come without it.
///
/// The uniform method draws from a stream of its own for each graph. Without an end the lookahead is 0: every node
/// arrives by its last leg.
pub(super) fn ask<N>(
    asked: Asked<'_, N>,
    may_arrive: &dyn Fn(&N, usize) -> bool,
    plan: impl Fn(Found<N>) -> Option<Plan>,
) -> Outcome
where
    N: Copy + Eq + Ord + Hash,
{
    let Asked { scenario, graph, reach, start, score, also, lookahead } = asked;
    let Graph { search: section, graph, points, looped } = graph;
    let seed = named_seed(scenario.seed, "uniform", graph);
    let length = scenario.task.length as usize;
    if scenario.task.end_m.is_some() {
        let (plan, free_end) = (&plan, false);
        let question = Question {
            search: section,
            length,
            points,
            reach,
            start,
            score,
            seed,
            lookahead,
            plan,
            free_end,
            also,
            looped,
        };
        return Outcome::of(graph, search(question, may_arrive));
    }
    let open = OpenEnd::new(reach, points);
    let question = Question {
        search: section,
        length: length + 1,
        points: open.candidates(),
        reach: &open,
        start: open.task(start).start,
        score: open.score(&score, section.aggregate),
        seed,
        lookahead: 0,
        plan: &|found| plan(open.closed(found)),
        free_end: true,
        also: also.iter().map(|score| open.score(score, section.aggregate)).collect(),
        looped,
    };
    Outcome::of(graph, search(question, &OpenEnd::<&dyn Reach<N>>::may_arrive))
}

/// A round's other models.
///
/// Scores that a round asks beside its first model, each for an optimum of its own.
pub(super) fn beside<'a>(looped: &Looped<'a>) -> Vec<AnyScore<'a>> {
    looped.models().iter().skip(1).map(AnyScore::Learned).collect()
}
