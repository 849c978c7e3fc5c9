//! What a round executes: draws at first, then what models and scores by hand choose.

use std::collections::HashSet;

use rayon::prelude::*;

use super::{Campaign, FINDING, Graph, MODELS, Origin, Todo};
use crate::campaign::RoundTally;
use crate::campaign::curve::Curve;
use crate::campaign::generate::graphs::GRAPHS_PER_CASE;
use crate::campaign::generate::shares::{dealt, every_second};
use crate::campaign::graph::{Outcome, Round, Wanted};
use crate::campaign::learn::ScoreModel;
use crate::campaign::samples::learn;
use crate::math::random::named_seed;

impl Campaign<'_> {
    /// Finds as many graphs as cases are asked for, in the order of their numbers, and draws in each, `share` in all.
    ///
    /// ⌈share / graphs⌉ draws are asked of each, of which each graph keeps those that it is dealt. Graphs in which
    /// nothing is feasible count as units and take no place.
    pub(super) fn first(&mut self, share: u64) -> Vec<Todo> {
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
                if outcome.stopped || self.graphs.len() == wanted {
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
    ///
    /// ```text
    /// whole = dealt(share)      optima = whole − free      free = by hand + draws, by `explore`
    /// ```
    ///
    /// Of the free ones every second is by hand, but in round 0. A graph that has fewer new trajectories gives fewer;
    /// nobody else gets its share.
    pub(super) fn next(&self, (number, part): (u64, u64), share: u64, models: &[ScoreModel]) -> Vec<Todo> {
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
    ///
    /// Rounded to the nearest, halves away from 0.
    fn unchosen(&self, share: u64) -> u64 {
        libm::round(self.search.explore * share as f64) as u64
    }

    /// The models that round `number` chooses its `share` of executions by, the first of all trajectories; none where
    /// they teach nothing.
    ///
    /// At most 8: one of all trajectories and bootstrap resamples of them. `told` gets the held-out R² and rank
    /// correlation, or why nothing was learned.
    ///
    /// One model for each choice of a graph, up to 8. A resample that cannot be fitted is left out.
    pub(super) fn models(&self, number: u64, share: u64, told: &mut RoundTally) -> Vec<ScoreModel> {
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
}
