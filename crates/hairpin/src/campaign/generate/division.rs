//! A search in parts that know nothing of each other: units of work that one machine would take one after the other are
//! searched anywhere, and what they gave is put together in their order.
//!
//! Only searches whose units know nothing of each other can be parted; the rest ([`sure_units`] is `None`) run on one
//! machine. Putting together gives the bytes that one machine would have written.

use std::collections::HashSet;
use std::ops::Range;

use super::graphs::Graphs;
use super::{Collector, Known, Limits, search_units, varies};
use crate::campaign::graph::{Plan, fingerprint, met};
use crate::campaign::scenario::SearchMethod;
use crate::campaign::{Case, CaseNumber, Executor, Scenario, Setup, Stop, Tally};
use crate::math::random::case_seed;

/// Units of work that a search takes whatever comes of them: graphs or, where `[vary]` shapes the plan, cases. `None`
/// of a search that is one, in which everything depends on all that was executed before.
///
/// A search may take more, where graphs give fewer cases than they may: what is taken for sure can be dealt out
/// beforehand.
pub fn sure_units(scenario: &Scenario) -> Option<u64> {
    let search = scenario.search();
    let varied = varies(scenario);
    if learns(scenario) || scenario.head().one_search {
        return None;
    }
    if varied {
        return Some(search.cases);
    }
    // Each gives so many cases at most: with fewer graphs there are too few.
    let least = search.cases.div_ceil(search.per_graph.max(1));
    Some(search.graphs.map_or(least, |graphs| graphs.min(least)))
}

/// Whether a search learns from each round of its executions for the next one.
fn learns(scenario: &Scenario) -> bool {
    let method = scenario.search().method;
    method == SearchMethod::Adaptive || (method == SearchMethod::Worst && !varies(scenario))
}

/// Whether a search that is one comes in rounds that are the same wherever it is searched: it learns, and no clock ends
/// it. All that is executed in such a round can be executed by others.
pub fn has_rounds(scenario: &Scenario) -> bool {
    let search = scenario.search();
    learns(scenario) && search.seconds.is_none() && search.time_s.is_none()
}

/// How many cases the units before number `unit` give where each gives all that it may.
///
/// The number that the first case of `unit` would have; where repetitions are dropped it has a smaller one in the
/// end.
pub fn expected_before(scenario: &Scenario, unit: u64) -> u64 {
    if varies(scenario) { unit } else { unit * scenario.search().per_graph.max(1) }
}

/// Searches `units` alone. Their cases are numbered from `first` on (where `[vary]` shapes the plan, as their units
/// are); none is dropped for being another unit's.
///
/// `units` are half open. The tally counts these units alone but for `units`, which is the number of the next one.
pub fn generate_units(
    setup: &Setup,
    (units, first): (Range<u64>, u64),
    executor: &dyn Executor,
    stop: &Stop,
    sink: &mut dyn FnMut(&[Case], &Tally),
) -> Tally {
    let per_unit = setup.scenario.search().per_graph.max(1);
    let all = (units.end - units.start).saturating_mul(per_unit);
    let known = Known { tally: Tally { units: units.start, ..Tally::default() }, ..Known::default() };
    let mut collector = Collector::new(setup, executor, &known);
    (collector.cases, collector.drops) = (first as usize, false);
    match Graphs::of(setup, executor) {
        Ok(graphs) => {
            let limits = Limits { units: units.end, wanted: first.saturating_add(all) };
            search_units(&graphs, collector, limits, stop, sink)
        }
        Err(reason) => {
            let tally = Tally { nothing: Some(reason), ..collector.tally };
            sink(&[], &tally);
            tally
        }
    }
}

/// What was found in units that follow one another, part by part, as one machine would have it that took them over in
/// their order: cases that repeat are dropped, and those that stay are numbered. With them go, part by part, the
/// numbers that stayed as they were.
///
/// `parts` come in the order of their units. Only as many cases as are asked for are kept. Cases that kept their
/// numbers kept their seeds, so that what was executed of them is still theirs.
pub fn joined(scenario: &Scenario, parts: impl IntoIterator<Item = Known>) -> (Known, Vec<Vec<CaseNumber>>) {
    let (wanted, root, varied) = (scenario.search().cases, scenario.seed(), varies(scenario));
    let (mut all, mut same) = (Known::default(), Vec::new());
    let mut seen: HashSet<[u8; 16]> = HashSet::new();
    for Known { cases, tally: part } in parts {
        let tally = &mut all.tally;
        tally.units = part.units;
        tally.graphs += part.graphs;
        tally.solved += part.solved;
        tally.proven_empty += part.proven_empty;
        tally.expansions += part.expansions;
        tally.dropped += part.dropped;
        tally.duplicates += part.duplicates;
        tally.nothing = if tally.solved == 0 { part.nothing.or(tally.nothing.take()) } else { None };
        tally.curves.extend(part.curves);
        tally.failures.add(part.failures);
        let mut stayed = Vec::new();
        for case in cases {
            if all.cases.len() as u64 >= wanted {
                break;
            }
            if !seen.insert(fingerprint(met(&case.waypoints, case.program()))) {
                all.tally.duplicates += 1;
                continue;
            }
            let number = if varied { case.number.0 } else { all.cases.len() };
            stayed.extend((case.number.0 == number).then_some(case.number));
            all.cases.push(numbered(case, number, root));
        }
        same.push(stayed);
    }
    (all, same)
}

/// `cases`, which follow one another, numbered from `first` on.
///
/// For cases that another campaign gave. Seeds follow from numbers, but those that were executed with.
pub fn renumbered(scenario: &Scenario, cases: Vec<Case>, first: u64) -> Vec<Case> {
    let numbers = first as usize..;
    cases.into_iter().zip(numbers).map(|(case, number)| numbered(case, number, scenario.seed())).collect()
}

/// `case` under another number: its seed follows from that, unless it is one that it was executed with.
fn numbered(case: Case, number: usize, root: u64) -> Case {
    if case.number.0 == number {
        return case;
    }
    let kept = (case.seed != case_seed(root, case.number.0 as u64)).then_some(case.seed);
    let renumbered = Plan::of(&case).case(root, case.graph, number);
    Case { seed: kept.unwrap_or(renumbered.seed), ..renumbered }
}
