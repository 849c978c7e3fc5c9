//! Simulation in the loop over one graph: the scores' optima and a few uniform draws are executed, evolved within the
//! graph's legs and, where waypoints may be moved, shifted.
//!
//! ```text
//! 0.4 of all executions    disturbances, where these are searched
//! 0.2 of the others        evolve; all of them where waypoints do not move
//! the rest                 shift, in three stages
//! 2 a trajectory kept      obstacles, at last
//! ```
//!
//! Shares are of counts, so that the answer is the same on any machine; what a stage leaves unused the next one gets.

use std::hash::Hash;

use nalgebra::Point3;

use super::answer::Answer;
use super::executions::Executions;
use super::optima::optima;
use super::plan::Plan;
use super::question::{Looped, Question};
use crate::campaign::scenario::UNMEASURED;
use crate::math::random::named_seed;
use crate::search::in_loop::{EvolveSettings, ShiftSettings, Tested, Trial, climb, evolve, shift};
use crate::search::{Additive, Aggregate, Found, LegGraph, UniformSettings, uniform};

/// One in so many executions is of a uniform draw.
const DRAWN: u64 = 10;
/// Share of the executions that go to disturbances (wind, gusts, a force) where they are searched, and trajectories
/// that are disturbed.
const DISTURBED: f64 = 0.4;
const MOST_DISTURBED: usize = 3;
/// Share of the others that evolution gets where waypoints may be moved.
const EVOLVED: f64 = 0.2;
/// Trajectories whose waypoints are moved, and the share of the executions left that they get together: many are tried,
/// the best go on.
const STAGES: [(usize, f64); 3] = [(6, 0.4), (2, 0.4), (1, 1.0)];
/// First and largest step of a moved waypoint, as shares of the mean leg.
const STEP: f64 = 0.15;
const LARGEST_STEP: f64 = 0.3;

/// Of the executions 40 % go to disturbances where these are searched, and of the others a fifth to evolution where
/// waypoints are moved as well; then the best 6, 2 and 1 are moved on with 40 %, 40 % and all of what is left.
/// Obstacles come last, two executions for each trajectory that is kept.
pub(super) fn by_trials<N: Copy + Eq + Ord + Hash, O: Additive>(question: &Question<N, O>) -> Answer {
    let search = question.search;
    let Some(graph) = question.leg_graph() else { return Answer::stopped() };
    let first = first(question, &graph);
    if first.is_empty() {
        let reason = Some(format!("none among the {} feasible legs of the last graph", graph.legs()));
        return Answer { proven_empty: graph.legs() == 0, reason, ..Answer::default() };
    }
    let Looped { executions: Executions { execute, duration, furnish, .. }, surroundings, .. } = question.looped;
    let disturbance = surroundings.filter(|surroundings| surroundings.coordinates > 0);
    let furnished = surroundings.is_some_and(|surroundings| surroundings.obstacles);
    // Obstacles are put around what is kept, in two executions each.
    let budget = search.executions.saturating_sub(if furnished { 2 * search.per_graph } else { 0 }).max(1);
    let undisturbed = if disturbance.is_some() { (budget as f64 * (1.0 - DISTURBED)).ceil() } else { budget as f64 };
    let settings = EvolveSettings {
        length: question.length,
        executions: ((undisturbed * if search.moves_waypoints() { EVOLVED } else { 1.0 }) as u64)
            .max(1 + search.confirm),
        per_trial: 1 + search.confirm,
        revisits: search.revisits,
        ..EvolveSettings::default()
    };
    let seed = named_seed(question.seed, "evolution", 0);
    let evolved =
        evolve(&graph, &first, seed, &settings, |found, least| execute(&question.planned(found.clone())?, least));
    let mut best_so_far = evolved.best_so_far;
    let climber = |Tested { found, trial }| {
        let mut plan = question.planned(found)?;
        plan.score = trial.rank().told();
        let step = STEP * mean_leg(&plan);
        Some(Climber { plan, trial, step })
    };
    let mut climbers: Vec<Climber> = evolved.pool.into_iter().filter_map(climber).collect();
    if search.moves_waypoints() {
        for (stage, (most, share)) in STAGES.into_iter().enumerate() {
            let most = most.min(climbers.len());
            let left = (undisturbed as u64).saturating_sub(best_so_far.len() as u64) as f64;
            let each = (left * share) as u64 / most.max(1) as u64;
            for (place, climber) in climbers[..most].iter_mut().enumerate() {
                let seed = named_seed(question.seed, "shift", (stage * STAGES[0].0 + place) as u64);
                go_on(&mut best_so_far, &climber.climb(&question.looped, seed, [each, 1 + search.confirm]));
            }
            hardest_first(&mut climbers);
        }
    }
    if let Some(disturbance) = disturbance {
        let most = MOST_DISTURBED.min(climbers.len());
        // One execution of each is its duration's.
        let each = budget.saturating_sub(best_so_far.len() as u64) / most.max(1) as u64;
        for (place, Climber { plan, trial, .. }) in climbers[..most].iter_mut().enumerate() {
            let Some(time) = Some(each).filter(|each| *each > 1).and_then(|_| duration(plan)) else { continue };
            let seed = named_seed(question.seed, "air", place as u64);
            let calm = vec![0.0; disturbance.coordinates];
            go_on(&mut best_so_far, &[trial.stress]);
            let climbed =
                climb(&calm, *trial, seed, [each - 1, 1 + search.confirm], disturbance.bound, |place, least| {
                    execute(&(disturbance.put)(plan, place, time), least)
                });
            go_on(&mut best_so_far, &climbed.best_so_far);
            *trial = climbed.trial;
            if let Some(place) = climbed.place {
                *plan = Plan { score: trial.rank().told(), ..(disturbance.put)(plan, &place, time) };
            }
        }
        hardest_first(&mut climbers);
    }
    climbers.truncate(search.per_graph as usize);
    let mut plans: Vec<Plan> = climbers.into_iter().map(|climber| climber.plan).collect();
    // Where nothing finds room, and nothing else stands there, there is no clearance to measure either.
    let no_room = "no obstacle of those asked for (`generate.environment.obstacles`) finds room where executions leave their plan";
    let mut reason = plans.is_empty().then(|| if furnished { no_room } else { UNMEASURED }.to_owned());
    if furnished && !plans.is_empty() {
        let among = |plan: &Plan| furnish(plan).map(|(plan, trial)| Plan { score: trial.rank().told(), ..plan });
        let most = best_so_far.last().copied().unwrap_or(f64::NEG_INFINITY);
        best_so_far.extend(std::iter::repeat_n(most, 2 * plans.len()));
        plans = plans.iter().filter_map(among).collect();
        reason = plans.is_empty().then(|| no_room.to_owned());
    }
    Answer { plans, expansions: best_so_far.len() as u64, best_so_far, reason, ..Answer::default() }
}

/// A trajectory whose waypoints may be moved, and how far it has come.
///
/// One trajectory in [`crate::search::in_loop::shift`], gone on with stage after stage.
struct Climber {
    plan: Plan,
    trial: Trial,
    /// Of the next move, m.
    step: f64,
}

impl Climber {
    /// Moves waypoints by `executions` at most, `per_trial` each; the largest stress after each.
    fn climb(&mut self, looped: &Looped, seed: u64, [executions, per_trial]: [u64; 2]) -> Vec<f64> {
        let largest = LARGEST_STEP * mean_leg(&self.plan);
        let settings = ShiftSettings { executions, per_trial, step: self.step, largest, free_end: false };
        let feasible = |points: &[Point3<f64>]| (looped.moved)(&self.plan, points);
        let execute = looped.executions.execute;
        let shifted = shift(&self.plan.waypoints, self.trial, seed, &settings, feasible, execute);
        (self.trial, self.step) = (shifted.trial, shifted.step);
        if let Some(better) = shifted.plan {
            self.plan = Plan { score: self.trial.rank().told(), ..better };
        }
        shifted.best_so_far
    }
}

/// Beside the searches, which are compiled for each kind of node: a sort is as large as they are.
fn hardest_first(climbers: &mut [Climber]) {
    climbers.sort_by(|a, b| b.trial.fails.cmp(&a.trial.fails).then(b.trial.stress.total_cmp(&a.trial.stress)));
}

/// What evolution starts from: every score's optima under both aggregates, and uniform draws.
fn first<N: Copy + Eq + Ord + Hash, O: Additive>(question: &Question<N, O>, graph: &LegGraph<'_, N>) -> Vec<Found<N>> {
    let search = question.search;
    let mut first: Vec<Found<N>> = optima(question, graph).flat_map(|outcome| outcome.found).collect();
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

/// m.
fn mean_leg(plan: &Plan) -> f64 {
    let legs = plan.waypoints.windows(2).map(|pair| (pair[1] - pair[0]).norm());
    legs.sum::<f64>() / (plan.waypoints.len() - 1) as f64
}
