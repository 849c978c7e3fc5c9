//! The heaviest path through a matrix of costs, and the heaviest programs of an arm through a cloud of points.

use std::fmt::Write;
use std::path::PathBuf;

use hairpin::search::heaviest::{Ends, HeaviestSettings, Method, Outcome};
use hairpin_cli::commands::max_load::cloud::object as said_of;
use hairpin_formats::atomic;
use hairpin_jobs::Problem;
use hairpin_jobs::max_load::{CloudAnswer, CloudSettings, MaxLoadSettings, Programs, search_cloud};
use hairpin_jobs::sets::Set;
use hairpin_jobs::work::IfThere;
use pyo3::prelude::*;
use serde_json::json;

use crate::plain::object;
use crate::problem::wrong;
use crate::wait::Waiting;

/// What is wanted of a path.
#[derive(FromPyObject)]
pub(crate) struct Wanted {
    start: Option<usize>,
    end: Option<usize>,
    min_cost: Option<f64>,
    programs: usize,
    visits: usize,
    method: String,
    seed: u64,
    nodes: Option<u64>,
    certificate: Option<PathBuf>,
    time_limit_s: Option<f64>,
}

/// The heaviest path through the `points`·`points` numbers of `table`, row = from, NaN: no arc. The job reads a table
/// of text, in which every number has the digits that make it itself, so that costs are the same whole numbers.
#[pyfunction]
pub(crate) fn max_load<'py>(
    py: Python<'py>,
    table: &[u8],
    points: usize,
    wanted: Wanted,
    waiting: Waiting,
) -> PyResult<Bound<'py, PyAny>> {
    let costs: Vec<f64> = table.as_chunks().0.iter().map(|bytes| f64::from_ne_bytes(*bytes)).collect();
    if let Some(place) = costs.iter().enumerate().position(|(at, cost)| {
        // The diagonal has no meaning.
        at % (points + 1) != 0 && (*cost < 0.0 || cost.is_infinite())
    }) {
        let (field, value) = (format!("matrix[{}, {}]", place / points, place % points), costs[place].to_string());
        let bound = "a finite number ≥ 0, or NaN for no arc";
        return Err(wrong(py, &format!("`{field}` = {value}: must be {bound}"), &field, &value, bound));
    }
    let methods = [Method::Auto, Method::Subsets, Method::Branch, Method::Local, Method::Dfs];
    let Some(method) = methods.into_iter().find(|method| method.name() == wanted.method) else {
        let bound = methods.map(Method::name).join(", ");
        let sentence = format!("`method` = {:?}: must be one of {bound}", wanted.method);
        return Err(wrong(py, &sentence, "method", &wanted.method, &bound));
    };
    let said = waiting.wait(py, |watch| {
        let place = tempfile::tempdir().map_err(|cause| Problem::input(format!("no room for a table: {cause}")))?;
        let graph = place.path().join("matrix");
        atomic::write(&graph, text(&costs, points).as_bytes())?;
        let settings = MaxLoadSettings {
            graph,
            min_cost: wanted.min_cost.map(|cost| cost.to_string()),
            visits: wanted.visits,
            time_limit_s: wanted.time_limit_s,
            search: HeaviestSettings {
                ends: Ends { start: wanted.start, end: wanted.end },
                method,
                programs: wanted.programs,
                seed: wanted.seed,
                most_nodes: wanted.nodes,
                proof: wanted.certificate.is_some(),
                ..HeaviestSettings::default()
            },
        };
        let answer = hairpin_jobs::max_load::max_load(&settings, watch)?;
        if let Some(out) = &wanted.certificate {
            answer.write_certificate(out)?;
        }
        let (graph, found) = (&answer.graph, &answer.found);
        let path = |(cost, path): &(i64, Vec<usize>)| json!({ "path": path, "cost": graph.value(*cost) });
        Ok(json!({
            "paths": found.paths.iter().map(path).collect::<Vec<_>>(),
            "bound": found.bound.map(|bound| graph.value(bound)),
            "gap_percent": found.gap_percent().filter(|gap| gap.is_finite()),
            "proven": found.proven,
            "feasible": match found.outcome {
                Outcome::Found => Some(true),
                Outcome::Infeasible | Outcome::BelowMinCost => Some(false),
                Outcome::NotFound => None,
            },
            "method": found.method.name(),
            "time_s": answer.time.as_secs_f64(),
        }))
    })?;
    object(py, &said)
}

/// Whose programs are searched, and where they go.
#[derive(FromPyObject)]
pub(crate) struct Cloud {
    cell: String,
    points: PathBuf,
    sets: Vec<Set>,
    out: Option<PathBuf>,
    replaces: bool,
}

/// The heaviest programs of an arm through the points of a file; gives what `max-load --cloud --json` says.
#[pyfunction]
pub(crate) fn max_load_of_cloud(
    py: Python<'_>,
    cloud: Cloud,
    wanted: Wanted,
    waiting: Waiting,
) -> PyResult<Bound<'_, PyAny>> {
    let Wanted { start, end, min_cost, programs, visits, seed, time_limit_s, .. } = wanted;
    let Cloud { cell, points, sets, out, replaces } = cloud;
    let min_cost = min_cost.map(|cost| cost.to_string());
    let programs = Programs { start, end, min_cost, programs, visits, seed };
    let settings = CloudSettings { cell, points: Some(points), sets, programs, time_limit_s };
    let said = waiting.wait(py, |watch| {
        let answer = search_cloud(&settings, watch)?;
        if let (CloudAnswer::Searched(searched), Some(out)) = (&answer, &out) {
            let if_there = if replaces { IfThere::Replace } else { IfThere::Refuse };
            searched.keep(out, if_there, watch)?;
        }
        Ok(said_of(&answer, true, out.as_deref()))
    })?;
    object(py, &said)
}

/// The matrix as the job reads it.
fn text(costs: &[f64], points: usize) -> String {
    let mut text = String::new();
    for row in costs.chunks(points.max(1)) {
        for (place, cost) in row.iter().enumerate() {
            let comma = if place > 0 { "," } else { "" };
            // Writing to memory does not fail.
            let _ = if cost.is_nan() { write!(text, "{comma}") } else { write!(text, "{comma}{cost}") };
        }
        text.push('\n');
    }
    text
}
