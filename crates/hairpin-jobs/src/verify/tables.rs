//! The tables of an arm's graph that a folder keeps, held to the graph that its scenario describes now.

use hairpin::campaign::arm::{ArmGraph, ArmSetup};
use hairpin_formats::folder::{ARCS, GRAPH, graph_decimals};
use hairpin_formats::{arcs, costs};

use crate::work::Work;

/// What is not in `graph.csv` and `arcs.csv` as it is in `graph`, a sentence for each; nothing of a table that the
/// folder has not.
pub(super) fn differing(work: &Work, arm: &ArmSetup, graph: &ArmGraph) -> Vec<String> {
    let mut findings = Vec::new();
    let decimals = graph_decimals(graph);
    let file = work.folder.file(GRAPH);
    if file.is_file() {
        let found = match costs::read_in(&file, decimals) {
            Ok(table) => of_costs(arm, graph, &table),
            Err(error) => Some(error.to_string()),
        };
        findings.extend(found);
    }
    let file = work.folder.file(ARCS);
    let found = match (&graph.arcs, file.is_file()) {
        (_, false) => None,
        (None, true) => Some(format!("{ARCS} has arcs, the scenario none (generate.moves)")),
        (Some(own), true) => match arcs::read(&file, decimals) {
            Ok(mut table) => {
                table.sort_unstable();
                (table != own.free)
                    .then(|| format!("{ARCS}: its arcs, or what they cost, are not those of the scenario"))
            }
            Err(error) => Some(error.to_string()),
        },
    };
    findings.extend(found);
    findings
}

fn of_costs(arm: &ArmSetup, graph: &ArmGraph, table: &costs::Costs) -> Option<String> {
    let n = graph.points();
    if table.points != n {
        return Some(format!("{GRAPH} is of {} points, the scenario of {n}", table.points));
    }
    // In the same units, however few digits the file has.
    let finer = 10_i64.checked_pow(table.decimals.saturating_sub(graph_decimals(graph)) as u32)?;
    let own = |place: usize| graph.costs[place].map(|cost| cost.saturating_mul(finer));
    let others = (0..n * n).filter(|place| table.costs[*place] != own(*place));
    let all: Vec<usize> = others.collect();
    let first = *all.first()?;
    let told = |cost: Option<i64>| cost.map_or("no move".into(), |cost| table.text(cost));
    let (from, to) = (arm.point_name(first / n), arm.point_name(first % n));
    let (said, is) = (told(table.costs[first]), told(own(first)));
    let count = all.len();
    Some(format!(
        "{GRAPH}: {count} costs are not those of the scenario, {from}→{to} first: {said}, where it has {is} (generate.cost = {})",
        arm.scenario.generate.cost.word()
    ))
}
