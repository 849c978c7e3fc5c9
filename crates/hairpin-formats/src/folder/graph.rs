//! What only arms leave in a campaign folder: the graph, and why moves are not in it.

use std::fmt::Write as _;

use hairpin::campaign::arm::{ArmGraph, ArmSetup};

use super::{ARCS, CampaignFolder, FolderError, GRAPH, REASONS};
use crate::{arcs, atomic, costs};

impl CampaignFolder {
    /// Writes `graph.csv` (costs in the graph's unit, row = from, empty where there is no move), `reasons.csv`, and
    /// `arcs.csv` where there are arcs.
    ///
    /// # Errors
    /// A file cannot be written.
    pub fn write_graph(&self, arm: &ArmSetup, graph: &ArmGraph) -> Result<(), FolderError> {
        let (n, decimals, names) = (graph.points(), graph_decimals(graph), arm.part_names());
        let mut table = String::new();
        for from in 0..n {
            let cells = (0..n)
                .map(|to| graph.costs[from * n + to].map_or_else(String::new, |cost| costs::text(cost, decimals)));
            let row: Vec<String> = cells.collect();
            table.push_str(&row.join(","));
            table.push('\n');
        }
        let mut reasons = String::from("from,to,reason\n");
        let pairs = (0..n).flat_map(|from| (0..n).map(move |to| (from, to)));
        for (from, to) in pairs {
            if let Some(refusal) = graph.reachability.refusal(from, to) {
                let sentence = refusal.in_words(&names).to_string().replace('"', "\"\"");
                writeln!(reasons, "{from},{to},\"{sentence}\"").expect("strings take everything");
            }
        }
        atomic::write(&self.file(GRAPH), table.as_bytes())?;
        atomic::write(&self.file(REASONS), reasons.as_bytes())?;
        let Some(triples) = &graph.arcs else { return Ok(()) };
        let refused =
            triples.refused.iter().map(|(points, refusal)| (*points, Err(refusal.in_words(&names).to_string())));
        let mut all: Vec<([usize; 3], Result<i64, String>)> =
            triples.free.iter().map(|(points, cost)| (*points, Ok(*cost))).chain(refused).collect();
        all.sort_by_key(|(points, _)| *points);
        let rows = all.iter().map(|(points, outcome)| (*points, outcome.as_ref().copied().map_err(String::as_str)));
        Ok(atomic::write(&self.file(ARCS), arcs::text(rows, decimals).as_bytes())?)
    }
}

/// Digits behind the point of the graph's unit: units are powers of ten, so that costs are written as they are
/// searched, without rounding.
pub fn graph_decimals(graph: &ArmGraph) -> usize {
    (0..=18).find(|power| 10_i64.pow(*power) as f64 * graph.unit > 0.5).unwrap_or(18) as usize
}
