//! The optimum of several scores in the same graphs: test sets that differ in the score alone, at the price of one.

use rayon::prelude::*;

use super::graphs::{GRAPHS_PER_CASE, Graphs};
use crate::campaign::graph::{AGGREGATES, Wanted};
use crate::campaign::{Case, OwnSimulator, Setup, Stop};
use crate::search::{Aggregate, Score};

/// What one score under one aggregate found.
///
/// Cases are numbered within each set, so that case k of every set is of the same graph.
#[derive(Debug, Clone)]
pub struct Optimum {
    /// Place of the score among the names asked for; 0 for the scenario's own.
    pub score: usize,
    /// How legs add up.
    pub aggregate: Aggregate,
    /// The best of each graph, in the same order of graphs for every score.
    pub cases: Vec<Case>,
}

/// The optima of the flights' scores called `names`, or of the scenario's own score if there are none, in as many
/// graphs as it asks for cases. A graph that lacks one is left out for all. Fewer where graphs are used up or `stop`
/// says so.
///
/// # Errors
/// Why there is nothing to search, in a sentence's part.
///
/// The dearest part of a graph is its legs, which all scores share. Deterministic on any number of threads.
pub fn optima(setup: &Setup, names: &[&str], stop: &Stop) -> Result<Vec<Optimum>, String> {
    for name in names {
        Score::named(name, 0, 1.0).map_err(|mistake| mistake.to_string())?;
    }
    setup.scenario.check_search().map_err(|mistake| mistake.to_string())?;
    let all = Graphs::of(setup, &OwnSimulator)?;
    if let Some(name) = names.first().filter(|_| !all.solver.takes_scores()) {
        return Err(format!("`{name}` is a score of flights"));
    }
    let search = setup.scenario.search();
    let wanted = search.cases as usize;
    let graphs = search.graphs.unwrap_or(search.cases.saturating_mul(GRAPHS_PER_CASE));
    let scores = (0..names.len().max(1)).flat_map(|score| AGGREGATES.map(|aggregate| (score, aggregate)));
    let mut optima: Vec<Optimum> =
        scores.map(|(score, aggregate)| Optimum { score, aggregate, cases: Vec::new() }).collect();
    let batch = 2 * rayon::current_num_threads() as u64;
    let mut first = 0;
    while first < graphs && optima[0].cases.len() < wanted && !(stop.cancelled)() {
        let last = graphs.min(first + batch).min(first + (wanted - optima[0].cases.len()) as u64);
        let outcomes: Vec<_> =
            (first..last).into_par_iter().map(|graph| all.solve(graph, Wanted::Optima(names), stop)).collect();
        for outcome in outcomes {
            for (optimum, (graph, plan)) in optima.iter_mut().zip(outcome.plans) {
                let number = optimum.cases.len();
                optimum.cases.push(plan.case(setup.scenario.seed(), graph, number));
            }
        }
        first = last;
    }
    Ok(optima)
}
