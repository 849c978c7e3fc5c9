//! Simulation in the loop over one graph: the scores' optima and a few uniform draws are executed, evolved within the graph's
//! legs and, where waypoints may be moved, shifted.

use std::hash::Hash;

use super::outcome::Plan;
use super::search::{Answer, Executions, Looped, Question};
use crate::feasibility::reach::Reach;
use crate::math::random::named_seed;
use crate::search::in_loop::{EvolveSettings, ShiftSettings, Tested, climb, evolve, shift};
use crate::search::{Aggregate, ExactSettings, Found, LegGraph, Objective, UniformSettings, exact, uniform};

/// One in so many executions is of a uniform draw.
const DRAWN: u64 = 10;
/// Trajectories of the pool whose waypoints are moved and whose surroundings are searched, at most.
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
    let Looped { executions: Executions { execute, duration, furnish }, surroundings, moved, .. } = question.looped;
    let air = surroundings.filter(|surroundings| surroundings.coordinates > 0);
    let furnished = surroundings.is_some_and(|surroundings| surroundings.obstacles);
    // Obstacles are put around what is kept, in two executions each.
    let budget = search.executions.saturating_sub(if furnished { 2 * search.per_graph } else { 0 }).max(1);
    let phases = 1 + u64::from(search.move_waypoints) + u64::from(air.is_some());
    let settings = EvolveSettings {
        length: question.length,
        executions: (budget / phases).max(1),
        revisits: search.revisits,
        ..EvolveSettings::default()
    };
    let seed = named_seed(question.seed, "evolution", 0);
    let evolved = evolve(&graph, &first, seed, &settings, |found| execute(&question.planned(found.clone())?));
    let mut best_so_far = evolved.best_so_far;
    let mut plans = Vec::new();
    for (place, Tested { found, trial }) in evolved.pool.into_iter().enumerate() {
        let Some(mut plan) = question.planned(found) else { continue };
        plan.score = trial.stress;
        let mut trial = trial;
        let left = budget.saturating_sub(best_so_far.len() as u64) / SHIFTED.saturating_sub(place).max(1) as u64;
        if search.move_waypoints && place < SHIFTED {
            let executions = left / (phases - 1).max(1);
            let settings = ShiftSettings { executions, step: STEP * mean_leg(&plan), free_end: false };
            let seed = named_seed(question.seed, "shift", place as u64);
            let shifted = shift(&plan.waypoints, trial, seed, &settings, |points| moved(&plan, points), execute);
            go_on(&mut best_so_far, &shifted.best_so_far);
            trial = shifted.trial;
            if let Some(better) = shifted.plan {
                plan = Plan { score: trial.stress, ..better };
            }
        }
        let executions = (left / (phases - 1).max(1)).saturating_sub(1);
        if let Some(air) = air.filter(|_| place < SHIFTED && executions > 0)
            && let Some(time) = duration(&plan)
        {
            let seed = named_seed(question.seed, "air", place as u64);
            let calm = vec![0.0; air.coordinates];
            go_on(&mut best_so_far, &[trial.stress]);
            let climbed =
                climb(&calm, trial, seed, executions, air.bound, |place| execute(&(air.put)(&plan, place, time)));
            go_on(&mut best_so_far, &climbed.best_so_far);
            if let Some(place) = climbed.place {
                plan = Plan { score: climbed.trial.stress, ..(air.put)(&plan, &place, time) };
            }
        }
        plans.push(plan);
    }
    plans.sort_by(|a, b| b.score.total_cmp(&a.score));
    plans.truncate(search.per_graph as usize);
    let mut reason = plans.is_empty().then(|| "no execution of what was found ended with a measure".to_string());
    if furnished && !plans.is_empty() {
        let among = |plan: &Plan| furnish(plan).map(|(plan, trial)| Plan { score: trial.stress, ..plan });
        let most = best_so_far.last().copied().unwrap_or(f64::NEG_INFINITY);
        best_so_far.extend(std::iter::repeat_n(most, 2 * plans.len()));
        plans = plans.iter().filter_map(among).collect();
        reason = plans.is_empty().then(|| "no obstacle finds room where flights leave their plan".to_string());
    }
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

/// Adds what was executed after `so_far` for another trajectory.
fn go_on(so_far: &mut Vec<f64>, next: &[f64]) {
    let most = so_far.last().copied().unwrap_or(f64::NEG_INFINITY);
    so_far.extend(next.iter().map(|stress| most.max(*stress)));
}

fn mean_leg(plan: &Plan) -> f64 {
    let legs = plan.waypoints.windows(2).map(|pair| (pair[1] - pair[0]).norm());
    legs.sum::<f64>() / (plan.waypoints.len() - 1) as f64
}
