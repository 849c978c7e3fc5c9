//! Algorithm 1: sample a graph, search it, repeat until enough cases are found or the budget ends.
//!
//! One graph is one unit of work with random streams of its own. Units run on any thread but are taken over in the
//! order of their numbers, so that what is found depends on the seed alone. Where `[vary]` shapes the plan (keys under
//! `task` and `generate`), a unit is a case: its values are drawn first, then graphs are tried for it.
//!
//! | search | file | unit of work |
//! | --- | --- | --- |
//! | beam, exact, uniform, in the loop, of arms | `mod` | a graph |
//! | any of them where `[vary]` shapes the plan | `mod` | a case, with graphs of its own |
//! | `adaptive` | `adaptive` | one: rounds depend on all before |
//! | `worst` | `worst` | one pool for all cases |
//!
//! Beside it: `division` parts a search over machines, `by_chance` draws the baseline, `optima` solves several scores
//! in the same graphs, `space` is the feasible set one trajectory at a time.

mod adaptive;
mod by_chance;
mod division;
mod graphs;
mod known;
mod optima;
mod shares;
mod space;
mod targets;
mod worst;

use std::collections::HashSet;

use rayon::prelude::*;

use self::graphs::{GRAPHS_PER_CASE, Graphs};
use super::answers::Answers;
use super::graph::{Outcome, Wanted, fingerprint, met};
use super::scenario::{SearchMethod, shapes_the_plan};
use super::trial::executed_case;
use super::{Case, CaseNumber, Executor, Scenario, Setup, Stop, Tally, Witness, vary};
use crate::math::random::case_seed;
pub use by_chance::{ByChance, Purpose, by_chance};
pub use division::{expected_before, generate_units, has_rounds, joined, renumbered, sure_units};
pub use known::Known;
pub use optima::{Optimum, optima};
pub use space::Space;
pub use targets::column;

/// Graphs that a case which is searched by itself may be drawn from.
const GRAPHS_OF_A_CASE: u64 = 1 << 32;

/// `known` without the cases that its tally does not count, as a kill between the writing of both may leave them.
///
/// Units that were taken over stay; of searches that are one, all or nothing, but for what was executed
/// ([`Tally::answers`]).
pub fn counted(scenario: &Scenario, mut known: Known) -> Known {
    let one = matches!(scenario.search().method, SearchMethod::Adaptive | SearchMethod::Worst);
    if one && !varies(scenario) || scenario.head().one_search {
        // What a round chooses depends on all before it, and one search is one: there is no place to go on from.
        let done = !known.tally.stopped && known.tally.units > 0;
        // What was executed need not be executed again.
        let failures = known.tally.answers.as_ref().map(|_| known.tally.failures.clone()).unwrap_or_default();
        let begun = || Tally { answers: known.tally.answers.clone(), failures, ..Tally::default() };
        return if done { known } else { Known { cases: Vec::new(), tally: begun() } };
    }
    let varied = varies(scenario);
    let units = known.tally.units;
    known.cases.retain(|case| if varied { (case.number.0 as u64) < units } else { case.graph < units });
    known
}

/// Whether units of work are cases of plans of their own, not graphs.
fn varies(scenario: &Scenario) -> bool {
    scenario.vary().keys().any(|key| shapes_the_plan(key))
}

/// Generates cases until `generate.search.cases` are found, the graphs are used up, or `stop` says so.
///
/// `sink` gets the new cases of each unit of work with the tally that includes it; what it was given is enough to go
/// on from there ([`Known`]) as if nothing had happened. Cases of a repeated waypoint list are counted once. What is
/// executed while it is searched for is carried out by `executor`.
///
/// `known` is the answer of an earlier call, or empty. `sink` is called on the caller's thread, in the order of
/// units, and at the end with the final tally, also where nothing could be searched: [`Tally::nothing`] then says why.
///
/// Deterministic in scenario and `known` on any number of threads, unless a time or `stop` ends it. `stop` is asked
/// before each unit: a unit that executes and was interrupted is not taken over, and is searched again.
pub fn generate(
    setup: &Setup,
    known: &Known,
    executor: &dyn Executor,
    stop: &Stop,
    sink: &mut dyn FnMut(&[Case], &Tally),
) -> Tally {
    let search = setup.scenario.search();
    let wanted = search.cases;
    let mut collector = Collector::new(setup, executor, known);
    let searchable = setup.scenario.check_search().map_err(|mistake| mistake.to_string());
    let graphs = match searchable.and_then(|()| Graphs::of(setup, executor)) {
        Ok(graphs) => graphs,
        Err(reason) => {
            collector.tally.nothing = Some(reason);
            sink(&[], &collector.tally);
            return collector.tally;
        }
    };
    if search.method == SearchMethod::Adaptive {
        return adaptive::generate(&graphs, known, stop, sink);
    }
    let varied = varies(&setup.scenario);
    if search.method == SearchMethod::Worst && !varied {
        return worst::generate(&graphs, known, stop, sink);
    }
    let units = match search.graphs {
        _ if varied => wanted,
        Some(graphs) => graphs,
        None => wanted.saturating_mul(GRAPHS_PER_CASE),
    };
    search_units(&graphs, collector, Limits { units, wanted }, stop, sink)
}

/// Where units of work end.
///
/// The first that is reached ends the search.
struct Limits {
    /// Number of the first that is not taken any more.
    units: u64,
    /// Number of cases with which it is enough.
    wanted: u64,
}

/// Searches unit after unit, from where `collector` stands.
///
/// At a time two units for each thread or, where that takes no time worth mentioning, more: threads wait for each other
/// at the end of each such batch. Never many more than are needed for the cases that still lack, and no more of
/// searches that execute. What is found does not depend on it.
fn search_units(
    graphs: &Graphs,
    mut collector: Collector,
    Limits { units, wanted }: Limits,
    stop: &Stop,
    sink: &mut dyn FnMut(&[Case], &Tally),
) -> Tally {
    let (setup, varied) = (graphs.setup, varies(&graphs.setup.scenario));
    let per_graph = setup.scenario.search().per_graph.max(1);
    let least = 2 * rayon::current_num_threads() as u64;
    let mut batch = least;
    let cut_short = setup.scenario.executes() || setup.user_score().is_some();
    (stop.progress)(collector.cases, wanted as usize);
    'units: while collector.tally.units < units && (collector.cases as u64) < wanted {
        let first = collector.tally.units;
        // What is executed is dear: no more graphs than may be needed.
        let needed = (wanted - collector.cases as u64).div_ceil(per_graph);
        let begun = (stop.clock)();
        let last =
            units.min(first + if setup.scenario.executes() { least.min(needed) } else { batch.min(least.max(needed)) });
        let outcomes: Vec<Option<Outcome>> = (first..last)
            .into_par_iter()
            .map(|unit| {
                let begins = !(stop.cancelled)();
                let outcome = begins.then(|| {
                    if varied { drawn_case(graphs, unit, stop) } else { graphs.solve(unit, Wanted::Cases, stop) }
                });
                // Where legs, executions or the user's scores were denied, a graph was searched in part, and is
                // searched again by whoever goes on.
                outcome.filter(|outcome| !(outcome.stopped || cut_short && (stop.cancelled)()))
            })
            .collect();
        for outcome in outcomes {
            // A unit that was not done ends the row: what lies behind the gap is done again.
            let Some(outcome) = outcome else {
                collector.tally.stopped = true;
                break 'units;
            };
            let number = varied.then_some(collector.tally.units as usize);
            let new = collector.take(outcome, number, wanted);
            sink(&new, &collector.tally);
            if collector.cases as u64 >= wanted {
                break;
            }
            if collector.is_in_vain() {
                break 'units;
            }
        }
        batch = batch_after(batch, (stop.clock)() - begun, least);
        // One search gives its best so far where it is stopped.
        collector.tally.stopped |= setup.scenario.head().one_search && (stop.cancelled)();
        (stop.progress)(collector.cases, wanted as usize);
    }
    collector.finish(wanted);
    sink(&[], &collector.tally);
    collector.tally
}

/// How many units come after a batch of `batch` that took so many seconds: so many that it takes some tenths of one,
/// which progress can wait for.
fn batch_after(batch: u64, seconds: f64, least: u64) -> u64 {
    match seconds {
        _ if seconds < 0.1 => (2 * batch).min(32 * least),
        _ if seconds > 0.5 => (batch / 2).max(least),
        _ => batch,
    }
}

/// Case number `case` of a scenario whose plan varies: its own scenario, its own graphs.
///
/// Draws come from the case's own seed; up to 20 graphs are tried, the first that gives something is taken. Graph
/// numbers of different cases never meet.
fn drawn_case(nominal: &Graphs, case: u64, stop: &Stop) -> Outcome {
    let Graphs { setup, executor, .. } = *nominal;
    let seed = case_seed(setup.scenario.seed(), case);
    let draws = vary::draw_for_case(&setup.scenario, seed, CaseNumber(case as usize));
    let drawn = setup.drawn(&draws).map_err(|mistake| mistake.to_string());
    let graphs = match drawn.as_ref().map_err(Clone::clone).and_then(|drawn| Graphs::of(drawn, executor)) {
        Ok(graphs) => graphs.with_seed(seed),
        Err(reason) => return Outcome { reason: Some(reason), ..Outcome::default() },
    };
    let search = setup.scenario.search();
    if search.method == SearchMethod::Worst {
        let executions = setup.scenario.searched_executions() / search.cases;
        let pool = worst::pool(&graphs, 1, [executions, case * GRAPHS_OF_A_CASE], &Answers::default(), stop);
        let (graphs, expansions, failures) = (pool.drawn, pool.curve.executions, pool.failures());
        let plans: Vec<_> = pool.plans.into_iter().map(|drawn| (drawn.graph, drawn.plan)).collect();
        return Outcome {
            flown: !plans.is_empty(),
            plans,
            graphs,
            expansions,
            curves: vec![pool.curve],
            failures,
            reason: pool.nothing,
            ..Outcome::default()
        };
    }
    let mut total = Outcome::default();
    for attempt in 0..GRAPHS_PER_CASE {
        let outcome = graphs.solve(case * GRAPHS_PER_CASE + attempt, Wanted::Cases, stop);
        let done = !outcome.plans.is_empty() || outcome.stopped;
        total.add(outcome);
        if done {
            break;
        }
    }
    total
}

/// Takes outcomes over in order: numbers cases, drops repetitions, keeps the tally.
///
/// Runs on one thread, after each batch; its order is what makes the answer that of one thread.
struct Collector<'a> {
    setup: &'a Setup,
    executor: &'a dyn Executor,
    tally: Tally,
    cases: usize,
    seen: HashSet<[u8; 16]>,
    /// Whether repetitions are dropped.
    drops: bool,
    /// Whether any execution came to a flight.
    flown: bool,
}

impl<'a> Collector<'a> {
    fn new(setup: &'a Setup, executor: &'a dyn Executor, known: &Known) -> Self {
        let seen = known.cases.iter().map(|case| fingerprint(met(&case.waypoints, case.program()))).collect();
        let tally = Tally { stopped: false, ..known.tally.clone() };
        // What was found before had been flown.
        let (cases, flown) = (known.cases.len(), known.tally.solved > 0);
        Self { setup, executor, tally, cases, seen, drops: true, flown }
    }

    /// Whether as many executions as one pool for all cases has failed, and none else was: whoever fails so often flies
    /// nothing in other graphs either.
    fn is_in_vain(&self) -> bool {
        let failed = self.tally.failures.failed;
        failed > 0 && failed >= self.setup.scenario.search().pooled_executions() && !self.flown
    }

    /// `number` is the case's, where units are cases; else cases are numbered as they come. Repetitions are told by a
    /// hash of what is met: waypoints, and of arms the program.
    fn take(&mut self, outcome: Outcome, number: Option<usize>, wanted: u64) -> Vec<Case> {
        let mut new = Vec::new();
        self.tally.units += 1;
        self.tally.graphs += outcome.graphs;
        self.tally.solved += u64::from(!outcome.plans.is_empty());
        self.tally.proven_empty += outcome.proven_empty;
        self.tally.expansions += outcome.expansions;
        self.tally.dropped += outcome.dropped;
        self.tally.duplicates += outcome.duplicates;
        if self.tally.solved == 0 {
            self.tally.nothing = outcome.reason.or(self.tally.nothing.take());
        } else {
            self.tally.nothing = None;
        }
        self.tally.curves.extend(outcome.curves);
        self.tally.failures.add(outcome.failures);
        self.flown |= outcome.flown;
        for (graph, plan) in outcome.plans {
            if self.cases as u64 >= wanted {
                break;
            }
            let is_new =
                self.seen.insert(fingerprint(met(&plan.waypoints, plan.witness.as_ref().and_then(Witness::program))));
            if self.drops && !is_new {
                self.tally.duplicates += 1;
                continue;
            }
            new.push(match number {
                // What was drawn for a case hangs on its own seed.
                Some(number) => plan.case(self.setup.scenario.seed(), graph, number),
                None => executed_case(self.setup, self.executor, plan, (graph, self.cases)),
            });
            self.cases += 1;
        }
        new
    }

    fn finish(&mut self, wanted: u64) {
        self.tally.complete = self.cases as u64 >= wanted && !self.tally.stopped;
    }
}
