//! Rounds: execute, learn which legs are stressful, search for trajectories of such legs, execute those.
//!
//! The first round draws uniformly. Each later one fits the stress of all legs executed so far, takes every graph's
//! best under the model, and under models of resampled trajectories, which differ where little is known (bootstrapped
//! Thompson sampling); a share of its executions no model chooses: every second of them is an optimum of a score by
//! hand, the others stay uniform, so that no model sees stressful legs alone. Whatever runs on several threads is taken
//! over in order.
//!
//! What is learned is stress alone, on the legs that were flown: of a run that fails the legs until then, as they were
//! measured. That it fails is no number of a leg's; it decides what is kept.
//!
//! ```text
//! round 0:   uniform draws in every graph                     ─▶ executed
//! round k:   legs of all rounds ─▶ models ─▶ optima of each graph, + by hand, + uniform ─▶ executed
//! at last:   the gravest of each graph are the cases; the model of all legs is kept
//! ```
//!
//! Executions are dealt evenly over rounds and graphs; the last graph of a round is another one each time, so that
//! none gets more in the end. With a limit of time each round has its share of it.

mod carried_out;
mod chosen;

use std::collections::HashSet;

use super::graphs::Graphs;
use super::known::Known;
use super::shares::dealt;
use crate::campaign::counted::Counted;
use crate::campaign::curve::Curve;
use crate::campaign::graph::{Plan, fingerprint};
use crate::campaign::learn::LegSample;
use crate::campaign::samples::learn;
use crate::campaign::scenario::{SearchSection, UNMEASURED};
use crate::campaign::trial::executed_case;
use crate::campaign::{Case, RoundTally, Setup, Stop, Tally};
use crate::search::in_loop::Rank;

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
    /// Its number in the campaign's stream of graphs.
    number: u64,
    /// Fingerprints of what was executed.
    known: HashSet<[u8; 16]>,
    /// The gravest, the first of equals first.
    ///
    /// At most `generate.search.per_graph`.
    kept: Vec<(Rank, Plan)>,
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
    /// Who executes.
    executor: &'a Counted<'a>,
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
/// At most `executions` are made; fewer where graphs run out of trajectories or the time ends. Deterministic without a
/// limit of time.
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
    let executor = &Counted::new(sampled.executor, stop.cancelled);
    let mut campaign = Campaign { setup, sampled, executor, stop, search, begun, graphs, samples, executed: 0, tally };
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
    ///
    /// Means of stress are told for each origin: the models' choice, scores by hand and draws, `None` where there were
    /// none.
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
        // Of all that was executed: what is kept first may have failed, with less.
        let largest: Vec<f64> = self.graphs.iter().filter_map(|graph| Some(graph.curve.rises.last()?.1)).collect();
        told.largest = largest.iter().copied().reduce(f64::max);
        told.mean_largest = mean((largest.iter().sum(), largest.len() as u64));
        self.tally.expansions += told.executions;
        self.tally.rounds.push(told);
        (self.stop.progress)(self.tally.expansions as usize, self.search.executions as usize);
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

    /// Cases come graph after graph, the gravest of each first, until as many as asked for; a trajectory that
    /// two graphs share counts once.
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
            for (_, plan) in kept {
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
        self.tally.failures = self.executor.take();
        self.tally.stopped = (self.stop.cancelled)() || in_vain;
        self.tally.complete = !self.tally.stopped && cases.len() >= wanted;
        if !cases.is_empty() {
            self.tally.nothing = None;
        } else if self.tally.solved > 0 && !self.tally.stopped {
            self.tally.nothing = Some(UNMEASURED.into());
        }
        sink(&cases, &self.tally);
        self.tally
    }
}
