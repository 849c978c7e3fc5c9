//! Cases by chance: drawn from all that are feasible, so that nobody chose them.

use std::collections::HashSet;

use rayon::prelude::*;

use super::graphs::{GRAPHS_PER_CASE, Graphs};
use super::varies;
use crate::campaign::graph::{Plan, Round, Wanted};
use crate::campaign::{Case, CaseNumber, Setup, Stop, vary};
use crate::math::random::named_seed;

/// What cases by chance are for. Each has seeds and graphs of its own, which no campaign's are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Purpose {
    /// What a campaign's stress stands beside.
    Baseline,
    /// Limits that follow from what is ordinary.
    Limits,
}

impl Purpose {
    fn seeds(self) -> &'static str {
        match self {
            Self::Baseline => "baseline",
            Self::Limits => "calibrate",
        }
    }

    /// Its first graph: no search has so many.
    fn first_graph(self) -> u64 {
        match self {
            Self::Baseline => 1 << 40,
            Self::Limits => 1 << 41,
        }
    }
}

/// Cases by chance.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ByChance {
    /// In the order of their numbers.
    pub cases: Vec<Case>,
    /// Whether nothing can be drawn of this kind of robot.
    pub lacks_draws: bool,
    /// Where they are fewer than asked for, and it was not stopped: why, in a sentence's part.
    pub reason: Option<String>,
}

/// Draws `count` cases of what `setup` finds feasible, the claim and its limits included, numbered from 0; fewer where
/// 20 graphs for each do not give so many, where the kind of robot has nothing to draw from, or where `stop` says so.
///
/// Where `[vary]` shapes plans, each case draws its own values first. What a search would find beside the waypoints is
/// left out. One seed gives the same cases on any number of threads.
pub fn by_chance(setup: &Setup, (purpose, count): (Purpose, u64), stop: &Stop) -> ByChance {
    let mut drawn = ByChance::default();
    let graphs = match Graphs::of(setup) {
        Ok(graphs) if graphs.solver.draws() => graphs,
        Ok(_) => return ByChance { lacks_draws: true, ..drawn },
        Err(reason) => return ByChance { reason: Some(reason), ..drawn },
    };
    let varied = varies(&setup.scenario);
    let units = if varied { count } else { count.saturating_mul(GRAPHS_PER_CASE) };
    let batch = 2 * rayon::current_num_threads() as u64;
    let (mut next, root) = (0, setup.scenario.seed());
    (stop.progress)(0, count as usize);
    while (drawn.cases.len() as u64) < count && next < units && !(stop.cancelled)() {
        let missing = count - drawn.cases.len() as u64;
        let last = units.min(next + batch.min(missing));
        let found: Vec<Result<(u64, Plan), Option<String>>> = (next..last)
            .into_par_iter()
            .map(|unit| match varied {
                true => drawn_plan(setup, (purpose, unit), stop),
                false => draw(&graphs, purpose.first_graph() + unit, stop),
            })
            .collect();
        for (found, unit) in found.into_iter().zip(next..) {
            match found {
                Ok((graph, plan)) => {
                    let number = if varied { unit as usize } else { drawn.cases.len() };
                    let seed = named_seed(root, purpose.seeds(), number as u64);
                    drawn.cases.push(Case { seed, ..plan.case(root, graph, number) });
                }
                Err(reason) => drawn.reason = reason.or(drawn.reason),
            }
        }
        next = last;
        (stop.progress)(drawn.cases.len(), count as usize);
    }
    if drawn.cases.len() as u64 == count {
        drawn.reason = None;
    }
    drawn
}

/// A plan of case number `number` where plans vary: of the scenario that is drawn for it, in graphs of its own.
fn drawn_plan(setup: &Setup, (purpose, number): (Purpose, u64), stop: &Stop) -> Result<(u64, Plan), Option<String>> {
    let seed = named_seed(setup.scenario.seed(), purpose.seeds(), number);
    let draws = vary::draw_for_case(&setup.scenario, seed, CaseNumber(number as usize));
    let drawn = setup.drawn(&draws).map_err(|mistake| Some(mistake.to_string()))?;
    let graphs = Graphs::of(&drawn).map_err(Some)?;
    let first = purpose.first_graph() + number * GRAPHS_PER_CASE;
    let mut why = None;
    for graph in (first..first + GRAPHS_PER_CASE).take_while(|_| !(stop.cancelled)()) {
        match draw(&graphs, graph, stop) {
            Ok(found) => return Ok(found),
            Err(reason) => why = reason,
        }
    }
    Err(why)
}

/// One trajectory of graph number `graph`, as [`crate::campaign::chance::SAMPLER`] says; or why there is none.
fn draw(graphs: &Graphs, graph: u64, stop: &Stop) -> Result<(u64, Plan), Option<String>> {
    if (stop.cancelled)() {
        return Err(None);
    }
    let known = HashSet::new();
    let round = Round { number: 0, place: 0, optima: 0, by_hand: 0, draws: 1, models: &[], known: &known };
    let outcome = graphs.solve(graph, Wanted::Round(&round), stop);
    outcome.plans.into_iter().next().ok_or(outcome.reason)
}
