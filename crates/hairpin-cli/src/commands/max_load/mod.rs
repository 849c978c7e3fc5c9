//! `hairpin max-load`: the heaviest path through a graph, or through a cloud of an arm's points.

mod answer;
mod certificate;
pub mod cloud;

use hairpin::search::heaviest::{Ends, HeaviestSettings, Method};
use hairpin_jobs::max_load::{MaxLoadSettings, max_load};
use hairpin_jobs::{Problem, Watch};

use crate::args::{MaxLoad, SearchMethod};
use crate::settings;

/// Runs the command: 3 if there is no path, 5 if none was found in time.
pub(crate) fn run(asked: &MaxLoad, watch: &dyn Watch) -> Result<u8, Problem> {
    settings::take_threads(&asked.threads);
    let path = match (&asked.graph, &asked.cloud, &asked.cell) {
        (_, points, Some(cell)) => return cloud::run(asked, points.as_deref(), cell, watch),
        (Some(path), ..) => path,
        _ => {
            return Err(Problem::input(
                "give the costs of a graph, --graph COSTS.csv, or an arm's points, --cloud POINTS.csv CELL, or a CELL with its own",
            ));
        }
    };
    if let Some(file) = &asked.verify {
        return certificate::verify(path, file, asked.json);
    }
    let answer = max_load(
        &MaxLoadSettings {
            graph: path.clone(),
            min_cost: asked.min_cost.clone(),
            visits: asked.visits.into(),
            time_limit_s: asked.time_limit,
            search: HeaviestSettings {
                ends: Ends { start: asked.start, end: asked.end },
                method: method(asked.method),
                programs: asked.programs.into(),
                seed: asked.seed,
                most_nodes: asked.nodes,
                proof: asked.certificate.is_some(),
                ..HeaviestSettings::default()
            },
        },
        watch,
    )?;
    if let Some(out) = &asked.certificate {
        answer.write_certificate(out)?;
    }
    answer::tell(asked, &answer);
    Ok(answer::code(&answer.found))
}

fn method(method: SearchMethod) -> Method {
    match method {
        SearchMethod::Auto => Method::Auto,
        SearchMethod::Subsets => Method::Subsets,
        SearchMethod::Branch => Method::Branch,
        SearchMethod::Local => Method::Local,
        SearchMethod::Dfs => Method::Dfs,
    }
}
