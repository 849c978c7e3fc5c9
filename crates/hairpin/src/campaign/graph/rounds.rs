//! What a round of an adaptive campaign has executed in one graph: the best under models, optima of scores by hand, and
//! uniform draws.

use std::cell::LazyCell;
use std::collections::HashSet;
use std::hash::Hash;

use super::answer::Answer;
use super::optima::AGGREGATES;
use super::plan::{Plan, fingerprint};
use super::question::{Question, Round};
use crate::math::random::named_seed;
use crate::search::{Additive, Aggregate, ExactSearch, ExactSettings, Found, LegGraph, UniformSettings, uniform};

/// A score is asked for so many of its best at first, and then for this multiple of them …
const MORE: usize = 4;
/// … as long as all are known, up to so many.
const MOST_BEST: usize = 256;
/// From one round to the next a graph passes over so many scores by hand, or the same of them would meet the same
/// graphs.
const NEXT_BY_HAND: u64 = 7;
/// Uniform draws are repeated with twice as many as long as too few are new, so often.
const REDRAWS: u32 = 6;

/// Trajectories that were not executed yet. What models cannot give is drawn, so that a round is as large as it was
/// asked for.
///
/// Models share the optima wanted evenly, the first ones one more; scores by hand take turns over rounds and graphs,
/// each under both aggregates.
pub(super) fn by_round<N: Copy + Eq + Ord + Hash, O: Additive>(question: &Question<N, O>, round: &Round) -> Answer {
    let Some(graph) = question.leg_graph() else { return Answer::stopped() };
    let settings =
        ExactSettings { length: question.length, revisits: question.search.revisits, ..ExactSettings::default() };
    // A first round only draws.
    let search = LazyCell::new(|| ExactSearch::new(&graph, settings));
    let mut new = New { question, known: round.known.clone(), plans: Vec::new() };
    // The question's own score is the first model, if there is one.
    let (models, by_hand) = question.also.split_at(round.models.len().saturating_sub(1));
    if !round.models.is_empty() {
        for (place, score) in std::iter::once(&question.score).chain(models).enumerate() {
            let scores = 1 + models.len();
            new.best(&search, score, question.search.aggregate, (round.optima + scores - 1 - place) / scores);
        }
    }
    let chosen = new.plans.len();
    let first = NEXT_BY_HAND.wrapping_mul(round.number).wrapping_add(round.place);
    let scores = (by_hand.len() * AGGREGATES.len()) as u64;
    for turn in (0..round.by_hand as u64).filter(|_| scores > 0) {
        let turn = (first.wrapping_add(turn) % scores) as usize;
        new.best(&search, &by_hand[turn / AGGREGATES.len()], AGGREGATES[turn % AGGREGATES.len()], 1);
    }
    let by_hand = new.plans.len() - chosen;
    let wanted = round.optima + round.by_hand + round.draws - new.plans.len();
    let empty = new.draw(&graph, round.number, wanted);
    let reason = match (new.plans.is_empty(), empty) {
        (false, _) => None,
        (true, true) => Some(format!("none among the {} feasible legs of the last graph", graph.legs())),
        (true, false) => Some("all draws used a waypoint twice, or broke a limit".into()),
    };
    Answer { proven_empty: empty, plans: new.plans, chosen, by_hand, reason, ..Answer::default() }
}

struct New<'q, 'a, N, O> {
    question: &'q Question<'a, N, O>,
    known: HashSet<[u8; 16]>,
    plans: Vec<Plan>,
}

impl<N: Copy + Eq + Ord + Hash, O: Additive> New<'_, '_, N, O> {
    /// Takes up to `wanted` of `found` that are not known; how many there were.
    fn take(&mut self, found: Vec<Found<N>>, wanted: usize) -> usize {
        let before = self.plans.len();
        for found in found {
            if self.plans.len() - before >= wanted {
                break;
            }
            let Some(plan) = self.question.planned(found) else { continue };
            if self.known.insert(fingerprint(plan.waypoints.iter().copied())) {
                self.plans.push(plan);
            }
        }
        self.plans.len() - before
    }

    /// The best `wanted` under `score`.
    ///
    /// Asks for the best k, then 4 k, up to 256, until enough are new or there are no more.
    fn best(&mut self, search: &ExactSearch<'_, '_, N>, score: &O, aggregate: Aggregate, mut wanted: usize) {
        if wanted == 0 {
            return;
        }
        let scored = search.scored(score);
        let ranking = scored.by(aggregate);
        let mut best = wanted;
        while wanted > 0 {
            let found = ranking.best(best).found;
            let all = found.len() < best;
            wanted -= self.take(found, wanted);
            best *= MORE;
            if all || best > MOST_BEST.max(MORE * wanted) {
                break;
            }
        }
    }

    /// Uniform draws; whether there is nothing to draw from.
    ///
    /// Draws of a seed are a sequence: twice as many begin with those that are known. Six repetitions at most.
    fn draw(&mut self, graph: &LegGraph<'_, N>, number: u64, mut wanted: usize) -> bool {
        let (search, seed) = (self.question.search, self.question.seed);
        let seed = if number == 0 { seed } else { named_seed(seed, "round", number) };
        let mut most = wanted;
        for _ in 0..=REDRAWS {
            if wanted == 0 {
                return false;
            }
            let settings = UniformSettings {
                length: self.question.length,
                wanted: most,
                draws: search.iterations.max(most as u64),
                revisits: search.revisits,
                aggregate: Aggregate::Sum,
            };
            // One seed: more draws begin with the same ones, which are known then.
            let outcome = uniform(graph, &self.question.score, seed, &settings);
            if outcome.walks.is_zero() {
                return true;
            }
            let all = outcome.found.len() < most;
            wanted -= self.take(outcome.found, wanted);
            if all {
                return false;
            }
            most *= 2;
        }
        false
    }
}
