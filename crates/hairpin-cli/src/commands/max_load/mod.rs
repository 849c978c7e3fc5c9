//! `hairpin max-load`: the heaviest path through a graph, or through a cloud of an arm's points.

mod answer;
mod certificate;
mod cloud;
mod graph;
mod walk;

use std::time::Instant;

use hairpin::search::heaviest::{Ends, Heaviest, HeaviestSettings, Method, Outcome, heaviest};

use crate::args::{MaxLoad, SearchMethod};
use crate::folder;
use crate::interrupt::{self, Deadline};
use crate::problem::Problem;
use graph::Graph;

/// Runs the command: 3 if there is no path, 5 if none was found in time.
pub(crate) fn run(asked: &MaxLoad) -> Result<u8, Problem> {
    folder::take_threads(&asked.threads);
    let path = match (&asked.graph, &asked.cloud, &asked.cell) {
        (_, Some(points), Some(cell)) => return cloud::run(asked, points, cell),
        (Some(path), ..) => path,
        _ => {
            return Err(Problem::input(
                "give the costs of a graph, --graph COSTS.csv, or an arm's points, --cloud POINTS.csv CELL",
            ));
        }
    };
    let graph = Graph::read(path)?;
    if let Some(path) = &asked.verify {
        return certificate::verify(asked, path, &graph);
    }
    if asked.visits > 1 {
        return walk::run(asked, &graph);
    }
    let settings = settings(asked, &graph)?;
    let (begun, deadline) = (Instant::now(), Deadline::after(asked.time_limit));
    let found = heaviest(&graph.arcs, &settings, &|| interrupt::asked() || deadline.passed());
    let found = found.map_err(Problem::input)?;
    answer::tell(asked, &graph, &found, begun.elapsed());
    if let Some(out) = &asked.certificate {
        certificate::write(out, &graph, settings.ends, &found, None)?;
    }
    Ok(code(&found))
}

fn settings(asked: &MaxLoad, graph: &Graph) -> Result<HeaviestSettings, Problem> {
    let method = match asked.method {
        SearchMethod::Auto => Method::Auto,
        SearchMethod::Subsets => Method::Subsets,
        SearchMethod::Branch => Method::Branch,
        SearchMethod::Local => Method::Local,
        SearchMethod::Dfs => Method::Dfs,
    };
    let min_cost = asked.min_cost.as_deref().map(|text| graph.at_least(text)).transpose()?;
    Ok(HeaviestSettings {
        ends: Ends { start: asked.start, end: asked.end },
        min_cost,
        method,
        programs: asked.programs.into(),
        seed: asked.seed,
        most_nodes: asked.nodes,
        proof: asked.certificate.is_some(),
        ..HeaviestSettings::default()
    })
}

fn code(found: &Heaviest) -> u8 {
    match found.outcome {
        Outcome::Found => 0,
        Outcome::Infeasible | Outcome::BelowMinCost => 3,
        Outcome::NotFound => 5,
    }
}
