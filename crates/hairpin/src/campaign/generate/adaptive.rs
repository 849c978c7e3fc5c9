//! Rounds: execute, learn which legs are stressful, search for trajectories of such legs, execute those.
//!
//! The first round draws uniformly. Each later one fits the stress of all legs executed so far, takes every graph's
//! best under the model, and under models of resampled trajectories, which differ where little is known (bootstrapped
//! Thompson sampling); a share of its executions no model chooses: every second of them is an optimum of a score by
//! hand, the others stay uniform, so that no model sees stressful legs alone. Whatever runs on several threads is taken
//! over in order.
//!
//! ```text
//! round 0:   uniform draws in every graph                     ─▶ executed
//! round k:   legs of all rounds ─▶ models ─▶ optima of each graph, + by hand, + uniform ─▶ executed
//! at last:   the most stressful of each graph are the cases; the model of all legs is kept
//! ```
//!
//! Executions are dealt evenly over rounds and graphs; the last graph of a round is another one each time, so that
//! none gets more in the end. With a limit of time each round has its share of it.

use std::collections::HashSet;

use rayon::prelude::*;

use super::graphs::{GRAPHS_PER_CASE, Graphs};
use super::known::Known;
use super::shares::{dealt, every_second};
use crate::campaign::curve::Curve;
use crate::campaign::graph::{Outcome, Plan, Round, Wanted, fingerprint};
use crate::campaign::learn::{LegSample, ScoreModel};
use crate::campaign::samples::learn;
use crate::campaign::scenario::SearchSection;
use crate::campaign::trial::executed_case;
use crate::campaign::{Case, RoundTally, Setup, Stop, Tally};
use crate::math::random::named_seed;

/// Models of a round, the one of all trajectories included: what else is executed are second bests.
const MODELS: usize = 8;

/// Share of the first round's time in which graphs are found.
const FINDING: f64 = 0.5;
/// Executions in each graph that are asked for at a time where time is limited: finding more than can be executed would
/// use it up.
const AT_A_TIME: u64 = 8;

/// One graph that trajectories are executed in.
///
/// `kept` has executed stresses as scores, and no bound: what was measured bounds nothing.
struct Graph {
    number: u64,
    /// Fingerprints of what was executed.
    known: HashSet<[u8; 16]>,
    /// The most stressful, the first of equals first.
    ///
    /// At most `generate.search.per_graph`.
    kept: Vec<Plan>,
    curve: Curve,
}

/// A trajectory to be executed.
struct Todo {
    /// Place of its graph.
    graph: usize,
    plan: Plan,
    origin: Origin,
}

/// Where a trajectory comes from.
///
/// Told apart in the tally, so that the report shows what models were worth.
#[derive(Clone, Copy, PartialEq)]
enum Origin {
    Model,
    ByHand,
    Drawn,
}

struct Campaign<'a> {
    setup: &'a Setup,
    sampled: &'a Graphs<'a>,
    stop: &'a Stop<'a>,
    search: SearchSection,
    /// s, by the clock of the caller.
    begun: f64,
    graphs: Vec<Graph>,
    /// Legs of all trajectories executed so far, in the order of these.
    samples: Vec<LegSample>,
    /// Also those that failed or were not begun: numbers of trajectories are never used twice.
    executed: u64,
    tally: Tally,
}

/// Executes `generate.search.executions` trajectories in rounds and gives the most stressful ones to `sink`, at the
/// end. Of `known` all rounds or none are.
///
/// A round is not resumed: it depends on everything before.
pub(super) fn generate(
    sampled: &Graphs<'_>,
    known: &Known,
    stop: &Stop,
    sink: &mut dyn FnMut(&[Case], &Tally),
) -> Tally {
    if !known.tally.rounds.is_empty() {
        sink(&[], &known.tally);
        return known.tally.clone();
    }
    let setup = sampled.setup;
    let search = setup.scenario.search();
    let begun = (stop.clock)();
    let (graphs, samples, tally) = (Vec::new(), Vec::new(), Tally::default());
    let mut campaign = Campaign { setup, sampled, stop, search, begun, graphs, samples, executed: 0, tally };
    for round in 0..campaign.search.adaptive_rounds() {
        let done = campaign.graphs.is_empty() || !campaign.in_time(campaign.search.adaptive_rounds() as f64);
        if round > 0 && done || (stop.cancelled)() {
            break;
        }
        campaign.round(round);
    }
    campaign.finish(sink)
}

impl Campaign<'_> {
    /// Without a limit of time in one part; with one in parts of 8 executions per graph, so that what was found can
    /// still be executed.
    fn round(&mut self, number: u64) {
        let share = dealt(self.search.executions, self.search.adaptive_rounds(), number);
        let mut told = RoundTally::default();
        let models = if number == 0 { Vec::new() } else { self.models(number, share, &mut told) };
        let most = match self.search.time_s {
            None => share,
            Some(_) => AT_A_TIME * self.search.adaptive_graphs(),
        };
        let mut sums = [(0.0, 0_u64); 3];
        for part in 0..share.div_ceil(most) {
            let share = most.min(share - part * most);
            let todo = match (number, part) {
                (0, 0) => self.first(share),
                _ => self.next((number, part), share, &models),
            };
            self.execute((number, part), todo, &mut told, &mut sums);
            if !self.goes_on(number) {
                break;
            }
        }
        let mean = |(sum, count): (f64, u64)| (count > 0).then(|| sum / count as f64);
        [told.chosen_mean, told.by_hand_mean, told.drawn_mean] = sums.map(mean);
        let largest: Vec<f64> = self.graphs.iter().filter_map(|graph| Some(graph.kept.first()?.score)).collect();
        told.largest = largest.iter().copied().reduce(f64::max);
        told.mean_largest = mean((largest.iter().sum(), largest.len() as u64));
        self.tally.expansions += told.executions;
        self.tally.rounds.push(told);
        (self.stop.progress)(self.tally.expansions as usize, self.search.executions as usize);
    }

    /// Executes `todo` in part `part` of round `number`; stresses are added to `sums`, by origin.
    fn execute(
        &mut self,
        (number, part): (u64, u64),
        todo: Vec<Todo>,
        told: &mut RoundTally,
        sums: &mut [(f64, u64); 3],
    ) {
        let results: Vec<Option<_>> = todo
            .par_iter()
            .enumerate()
            .map(|(place, todo)| {
                // What is not begun in time does not count.
                let graph = self.graphs[todo.graph].number;
                let trajectory = self.executed as usize + place;
                let found = || {
                    // An infinite stress could not be told from a mistake.
                    let learned = self.sampled.trials(graph).execute_and_learn(&todo.plan, trajectory);
                    learned.filter(|(trial, _)| trial.stress.is_finite())
                };
                self.begins(number, part).then(found)
            })
            .collect();
        self.executed += results.len() as u64;
        for (Todo { graph, plan, origin }, result) in todo.into_iter().zip(results) {
            let Some(result) = result else { continue };
            told.executions += 1;
            told.drawn += u64::from(origin == Origin::Drawn);
            told.by_hand += u64::from(origin == Origin::ByHand);
            let graph = &mut self.graphs[graph];
            graph.known.insert(fingerprint(plan.waypoints.iter().copied()));
            graph.curve.push(result.as_ref().map(|(trial, _)| trial.stress));
            let Some((trial, samples)) = result else {
                told.failed += 1;
                continue;
            };
            let (sum, count) = &mut sums[origin as usize];
            (*sum, *count) = (*sum + trial.stress, *count + 1);
            self.samples.extend(samples);
            let place = graph.kept.partition_point(|kept| kept.score >= trial.stress);
            graph.kept.insert(place, Plan { score: trial.stress, bound: None, ..plan });
            graph.kept.truncate(self.search.per_graph as usize);
        }
    }

    /// Whether executions of part `part` of round `number` may begin. Those of the first may wherever the round began
    /// in time: learning and searching take what they take, and a round that executed nothing would have been for
    /// nothing.
    fn begins(&self, number: u64, part: u64) -> bool {
        if part == 0 { !(self.stop.cancelled)() } else { self.goes_on(number) }
    }

    /// Whether round `number` goes on: neither stopped, nor is the round's share of the time used up.
    fn goes_on(&self, number: u64) -> bool {
        self.in_time((number + 1) as f64) && !(self.stop.cancelled)()
    }

    /// Whether the time of so many rounds is not used up.
    fn in_time(&self, rounds: f64) -> bool {
        let share = rounds / self.search.adaptive_rounds() as f64;
        self.search.time_s.is_none_or(|time| (self.stop.clock)() - self.begun < share * time)
    }

    /// Finds as many graphs as cases are asked for, in the order of their numbers, and draws in each, `share` in all.
    fn first(&mut self, share: u64) -> Vec<Todo> {
        let wanted = self.search.adaptive_graphs() as usize;
        let units = self.search.graphs.unwrap_or(self.search.cases.saturating_mul(GRAPHS_PER_CASE));
        let known = HashSet::new();
        let most = share.div_ceil(wanted as u64) as usize;
        let round = Round { number: 0, place: 0, optima: 0, by_hand: 0, draws: most, models: &[], known: &known };
        let batch = 2 * rayon::current_num_threads() as u64;
        let mut todo = Vec::new();
        while self.tally.units < units && self.graphs.len() < wanted && self.goes_on(0) && self.in_time(FINDING) {
            let (first, last) = (self.tally.units, units.min(self.tally.units + batch));
            let outcomes: Vec<Outcome> = (first..last)
                .into_par_iter()
                .map(|graph| self.sampled.solve(graph, Wanted::Round(&round), self.stop))
                .collect();
            for (outcome, number) in outcomes.into_iter().zip(first..) {
                if self.graphs.len() == wanted {
                    break;
                }
                self.tally.units += 1;
                self.tally.graphs += outcome.graphs;
                self.tally.proven_empty += outcome.proven_empty;
                if outcome.plans.is_empty() {
                    self.tally.nothing = outcome.reason;
                    continue;
                }
                self.tally.solved += 1;
                let graph = self.graphs.len();
                let own = dealt(share, wanted as u64, graph as u64) as usize;
                let plans = outcome.plans.into_iter().take(own);
                todo.extend(plans.map(|(_, plan)| Todo { graph, plan, origin: Origin::Drawn }));
                let curve = Curve { graph: number, ..Curve::default() };
                self.graphs.push(Graph { number, known: HashSet::new(), kept: Vec::new(), curve });
            }
        }
        todo
    }

    /// What part of round `number` executes, `share` in all, by what all rounds before it have taught.
    fn next(&self, (number, part): (u64, u64), share: u64, models: &[ScoreModel]) -> Vec<Todo> {
        let (graphs, search) = (self.graphs.len() as u64, &self.search);
        if graphs == 0 {
            return Vec::new();
        }
        let draws = if number == 0 { share } else { self.unchosen(share) };
        // Where graphs get different numbers they are others every round.
        let turn = |place: usize| (place as u64 + number) % graphs;
        let of = |total: u64, place: usize| dealt(total, graphs, turn(place)) as usize;
        let outcomes: Vec<Option<Outcome>> = (0..self.graphs.len())
            .into_par_iter()
            .map(|place| {
                let graph = &self.graphs[place];
                let whole = of(share, place);
                let free = of(draws, place).min(whole);
                // A first round only draws.
                let by_hand = if number == 0 { 0 } else { every_second(draws, graphs, turn(place)) };
                let by_hand = by_hand.min(free as u64) as usize;
                let round = Round {
                    // Every part draws others.
                    number: number + part * search.adaptive_rounds(),
                    place: place as u64,
                    optima: whole - free,
                    by_hand,
                    draws: free - by_hand,
                    models,
                    known: &graph.known,
                };
                self.begins(number, part).then(|| self.sampled.solve(graph.number, Wanted::Round(&round), self.stop))
            })
            .collect();
        let mut todo = Vec::new();
        for (graph, outcome) in outcomes.into_iter().enumerate() {
            let Some(Outcome { plans, chosen, by_hand, .. }) = outcome else { continue };
            let origin = |place: usize| match place {
                _ if place < chosen => Origin::Model,
                _ if place < chosen + by_hand => Origin::ByHand,
                _ => Origin::Drawn,
            };
            let plans = plans.into_iter().enumerate();
            todo.extend(plans.map(|(place, (_, plan))| Todo { graph, plan, origin: origin(place) }));
        }
        todo
    }

    /// Of `share` executions of a later round, those that no model chooses.
    fn unchosen(&self, share: u64) -> u64 {
        libm::round(self.search.explore * share as f64) as u64
    }

    /// The models that round `number` chooses its `share` of executions by, the first of all trajectories; none where
    /// they teach nothing.
    ///
    /// At most 8: one of all trajectories and bootstrap resamples of them. `told` gets the held-out R² and rank
    /// correlation, or why nothing was learned.
    fn models(&self, number: u64, share: u64, told: &mut RoundTally) -> Vec<ScoreModel> {
        let chosen = share.saturating_sub(self.unchosen(share));
        if chosen == 0 || self.graphs.is_empty() {
            return Vec::new();
        }
        let count = (chosen.div_ceil(self.graphs.len() as u64) as usize).clamp(1, MODELS);
        let model = match learn(self.setup, self.search.stress, &self.samples) {
            Ok(model) => model,
            Err(reason) => {
                told.unlearned = Some(reason.to_string());
                return Vec::new();
            }
        };
        (told.r2, told.rank_correlation) = (Some(model.held_out.r2), model.held_out.rank_correlation);
        let seed = named_seed(self.setup.scenario.seed(), "models", number);
        let others: Vec<ScoreModel> = (1..count as u64)
            .into_par_iter()
            .filter_map(|other| model.resampled(&self.samples, named_seed(seed, "resampled", other)).ok())
            .collect();
        std::iter::once(model).chain(others).collect()
    }

    fn finish(mut self, sink: &mut dyn FnMut(&[Case], &Tally)) -> Tally {
        let wanted = self.search.cases as usize;
        match learn(self.setup, self.search.stress, &self.samples) {
            Ok(model) => self.tally.model = Some(Box::new(model)),
            Err(reason) => self.tally.unlearned = Some(reason.to_string()),
        }
        // Where time was too short for anything, it was not found out whether anything is feasible.
        let in_vain = self.search.time_s.is_some() && self.tally.expansions == 0 && !self.in_time(FINDING);
        let mut cases = Vec::new();
        let mut seen = HashSet::new();
        for Graph { number, kept, curve, .. } in self.graphs {
            self.tally.curves.push(curve);
            for plan in kept {
                // Graphs of few waypoints may have the same trajectory.
                if cases.len() == wanted {
                    break;
                }
                if seen.insert(fingerprint(plan.waypoints.iter().copied())) {
                    cases.push(executed_case(self.setup, self.sampled.executor, plan, (number, cases.len())));
                } else {
                    self.tally.duplicates += 1;
                }
            }
        }
        self.tally.stopped = (self.stop.cancelled)() || in_vain;
        self.tally.complete = !self.tally.stopped && cases.len() >= wanted;
        if !cases.is_empty() {
            self.tally.nothing = None;
        } else if self.tally.solved > 0 {
            self.tally.nothing = Some("no execution of what was drawn ended with a measure of its stress".into());
        }
        sink(&cases, &self.tally);
        self.tally
    }
}
