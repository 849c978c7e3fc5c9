//! Simulation in the loop over one graph: the scores' optima and a few uniform draws are executed, evolved within the graph's
//! legs and, where waypoints may be moved, shifted.

use std::hash::Hash;

use super::outcome::Plan;
use super::search::{Answer, Looped, Question};
use crate::feasibility::reach::Reach;
use crate::math::random::named_seed;
use crate::search::in_loop::{EvolveSettings, ShiftSettings, Tested, evolve, shift};
use crate::search::{Aggregate, ExactSettings, Found, LegGraph, Objective, UniformSettings, exact, uniform};

/// One in so many executions is of a uniform draw.
const DRAWN: u64 = 10;
/// Share of the executions that evolution gets where waypoints may be moved.
const EVOLVED: f64 = 0.5;
/// Trajectories of the pool whose waypoints are moved, at most.
const SHIFTED: usize = 3;
/// First step of a moved waypoint, as a share of the mean leg.
const STEP: f64 = 0.15;

pub(super) fn by_trials<N: Copy + Eq + Ord + Hash, R: Reach<N>, O: Objective<Memory = ()>>(
    question: &Question<N, R, O>,
) -> Answer {
    let search = question.search;
    let graph = question.leg_graph();
    let graph = if search.revisits { graph } else { graph.without_returns(question.length) };
    let first = first(question, &graph);
    if first.is_empty() {
        let reason = Some(format!("none among the {} feasible legs of the last graph", graph.legs()));
        return Answer { proven_empty: graph.legs() == 0, reason, ..Answer::default() };
    }
    let budget = search.executions;
    let settings = EvolveSettings {
        length: question.length,
        executions: if search.move_waypoints { ((budget as f64 * EVOLVED) as u64).max(1) } else { budget },
        revisits: search.revisits,
        ..EvolveSettings::default()
    };
    let Looped { execute, moved, .. } = question.looped;
    let seed = named_seed(question.seed, "evolution", 0);
    let evolved = evolve(&graph, &first, seed, &settings, |found| execute(&question.planned(found.clone())?));
    let mut best_so_far = evolved.best_so_far;
    let mut plans = Vec::new();
    for (place, Tested { found, trial }) in evolved.pool.into_iter().enumerate() {
        let Some(mut plan) = question.planned(found) else { continue };
        plan.score = trial.stress;
        if search.move_waypoints && place < SHIFTED {
            let left = budget.saturating_sub(best_so_far.len() as u64) / (SHIFTED - place) as u64;
            let settings = ShiftSettings { executions: left, step: STEP * mean_leg(&plan), free_end: false };
            let seed = named_seed(question.seed, "shift", place as u64);
            let shifted = shift(&plan.waypoints, trial, seed, &settings, |points| moved(&plan, points), execute);
            let most = best_so_far.last().copied().unwrap_or(f64::NEG_INFINITY);
            best_so_far.extend(shifted.best_so_far.iter().map(|stress| most.max(*stress)));
            if let Some(better) = shifted.plan {
                plan = Plan { score: shifted.trial.stress, ..better };
            }
        }
        plans.push(plan);
    }
    plans.sort_by(|a, b| b.score.total_cmp(&a.score));
    plans.truncate(search.per_graph as usize);
    let reason = plans.is_empty().then(|| "no execution of what was found ended with a measure".to_string());
    Answer { plans, expansions: best_so_far.len() as u64, best_so_far, reason, ..Answer::default() }
}

/// What evolution starts from: every score's optima under both aggregates, and uniform draws.
fn first<N: Copy + Eq + Ord + Hash, R: Reach<N>, O: Objective<Memory = ()>>(
    question: &Question<N, R, O>,
    graph: &LegGraph<'_, N>,
) -> Vec<Found<N>> {
    let search = question.search;
    let mut first = Vec::new();
    for score in std::iter::once(&question.score).chain(&question.also) {
        for aggregate in [Aggregate::Max, Aggregate::Sum] {
            let settings = ExactSettings {
                length: question.length,
                best: 1,
                revisits: search.revisits,
                aggregate,
                ..ExactSettings::default()
            };
            first.extend(exact(graph, score, &settings).found);
        }
    }
    let drawn = UniformSettings {
        length: question.length,
        wanted: search.executions.div_ceil(DRAWN) as usize,
        draws: search.iterations.max(search.executions),
        revisits: search.revisits,
        aggregate: Aggregate::Sum,
    };
    first.extend(uniform(graph, &question.score, question.seed, &drawn).found);
    first
}

fn mean_leg(plan: &Plan) -> f64 {
    let legs = plan.waypoints.windows(2).map(|pair| (pair[1] - pair[0]).norm());
    legs.sum::<f64>() / (plan.waypoints.len() - 1) as f64
}
