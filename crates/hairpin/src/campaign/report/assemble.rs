//! From the pieces of a judged campaign to its report.

use std::collections::BTreeMap;

use super::data::{Beside, Metric, Pieces, ReportData, Shown, worst_first};
use super::facts::{facts, key_numbers, metrics};
use super::length::length;
use crate::campaign::CaseNumber;
use crate::campaign::generate::column;
use crate::campaign::verdict::named;

/// Puts the pieces of a report together.
pub fn assemble(pieces: Pieces) -> ReportData {
    let order = |shown: &Shown| -> usize {
        let ordered = worst_first(pieces.results);
        ordered.iter().position(|result| result.case == shown.result.case).unwrap_or(usize::MAX)
    };
    let mut shown = pieces.shown.clone();
    shown.sort_by_cached_key(order);
    let is_shown = |case: &CaseNumber| shown.iter().any(|shown| shown.result.case == *case);
    let named = pieces.asked.or_else(|| named(pieces.setup, pieces.results).map(|named| named.case));
    ReportData {
        title: pieces.setup.robot_name().to_owned(),
        verdict: pieces.verdict.clone(),
        key_numbers: key_numbers(&pieces),
        facts: facts(&pieces),
        drawing: pieces.setup.kind().drawing(&shown.iter().flat_map(Shown::places).collect::<Vec<_>>()),
        length: length(pieces.setup),
        beside: Beside::default(),
        logs: BTreeMap::new(),
        folder: None,
        opens: named.filter(is_shown).or_else(|| Some(shown.first()?.result.case)),
        results: worst_first(pieces.results).into_iter().cloned().collect(),
        metrics: metrics(&pieces),
        shown,
        assumptions: pieces.assumptions,
        frame: pieces.frame,
        claims: pieces.cases.iter().map(|case| (case.number, case.claim())).collect(),
        influences: pieces.influences,
        regression: None,
        coverage: pieces.coverage,
        confidence: pieces.setup.scenario.confidence_of_intervals(),
        stress: pieces.setup.scenario.sought(),
        told_in: pieces.tally.and_then(|tally| tally.told_in.clone()).unwrap_or_else(|| column(pieces.setup)),
        curves: pieces.tally.map_or_else(Vec::new, |tally| tally.curves.clone()),
        rounds: pieces.tally.map_or_else(Vec::new, |tally| tally.rounds.clone()),
    }
}

/// The same of `cases` alone, in their order; the page opens with the first.
pub fn in_order(data: &ReportData, cases: &[CaseNumber]) -> ReportData {
    let place = |case: &CaseNumber| data.results.iter().position(|result| result.case == *case);
    let places: Vec<usize> = cases.iter().filter_map(place).collect();
    let metrics = data
        .metrics
        .iter()
        .map(|metric| Metric { values: places.iter().map(|place| metric.values[*place]).collect(), ..metric.clone() });
    let full = cases.iter().filter_map(|case| data.shown.iter().find(|shown| shown.result.case == *case));
    ReportData {
        opens: cases.first().copied(),
        metrics: metrics.collect(),
        results: places.iter().map(|place| data.results[*place].clone()).collect(),
        shown: full.cloned().collect(),
        ..data.clone()
    }
}
