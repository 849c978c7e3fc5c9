//! What only arms leave in a campaign folder: the graph, and why moves are not in it.

use std::fmt::Write as _;

use hairpin::campaign::arm::{ArmGraph, ArmSetup};
use hairpin::campaign::{Case, Stop, Tally};
use hairpin_formats::atomic;

use crate::folder::Work;
use crate::problem::Problem;

/// Writes `graph.csv` (costs in the graph's unit, row = from, empty where there is no move) and `reasons.csv`.
pub(crate) fn keep_graph(work: &Work, arm: &ArmSetup, graph: &ArmGraph) -> Result<(), Problem> {
    let n = graph.points();
    // Units are powers of ten: costs are written as they are searched, without rounding.
    let power = (0..=18).find(|power| 10_i64.pow(*power) as f64 * graph.unit > 0.5);
    let decimals = power.unwrap_or(18);
    let mut costs = String::new();
    for from in 0..n {
        let cells = (0..n).map(|to| match graph.costs[from * n + to] {
            Some(cost) => exactly(cost, decimals),
            None => String::new(),
        });
        let row: Vec<String> = cells.collect();
        costs.push_str(&row.join(","));
        costs.push('\n');
    }
    let names = arm.part_names();
    let mut reasons = String::from("from,to,reason\n");
    let pairs = (0..n).flat_map(|from| (0..n).map(move |to| (from, to)));
    for (from, to) in pairs {
        if let Some(refusal) = graph.reachability.refusal(from, to) {
            let sentence = refusal.told(&names).to_string().replace('"', "\"\"");
            writeln!(reasons, "{from},{to},\"{sentence}\"").expect("strings take everything");
        }
    }
    atomic::write(&work.folder.file("graph.csv"), costs.as_bytes())?;
    Ok(atomic::write(&work.folder.file("reasons.csv"), reasons.as_bytes())?)
}

/// `cost` · 10^−decimals.
fn exactly(cost: i64, decimals: u32) -> String {
    let one = 10_i64.pow(decimals);
    if decimals == 0 {
        cost.to_string()
    } else {
        format!("{}.{:0width$}", cost / one, cost % one, width = decimals as usize)
    }
}

/// Writes the programs that were found, as `generate` would.
pub(crate) fn keep_programs(
    work: &Work,
    arm: &ArmSetup,
    graph: &ArmGraph,
    cases: &[Case],
    stop: &Stop,
) -> Result<(), Problem> {
    keep_graph(work, arm, graph)?;
    super::optimum::keep(work, arm, graph, cases, stop)?;
    let tally = Tally { complete: true, graphs: 1, units: 1, solved: u64::from(!cases.is_empty()), ..Tally::default() };
    super::generate::save(work, cases, 0, &tally)
}
