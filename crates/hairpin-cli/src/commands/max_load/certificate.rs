//! `--certificate` and `--verify`: the proof of a heaviest path as a file, and its check against the graph by independent code.

use std::fs;
use std::path::Path;

use hairpin::search::heaviest::{Ends, Heaviest, WalkProof};
use hairpin_formats::atomic;
use serde_json::{Value, json};

use super::graph::Graph;
use crate::args::MaxLoad;
use crate::commands::certificate;
use crate::console;
use crate::problem::Problem;

/// Writes the proof of an answer that is proven.
pub(super) fn write(
    out: &Path,
    graph: &Graph,
    ends: Ends,
    found: &Heaviest,
    walk: Option<&WalkProof>,
) -> Result<(), Problem> {
    let Some(object) = certificate::object(graph.arcs.points(), ends, found, walk) else {
        return Err(Problem::input(format!("{}: not written, the answer is not proven", out.display())));
    };
    Ok(atomic::write(out, certificate::sealed(object).as_bytes())?)
}

/// Checks a certificate against the graph: 1 if anything does not hold.
pub(super) fn verify(asked: &MaxLoad, file: &Path, graph: &Graph) -> Result<u8, Problem> {
    let broken = |what: &str| Problem::input(format!("{}: {what}", file.display()));
    let text = fs::read_to_string(file).map_err(|cause| broken(&format!("cannot be read: {cause}")))?;
    let object: Value = serde_json::from_str(&text).map_err(|error| broken(&format!("is no JSON: {error}")))?;
    let n = graph.arcs.points();
    let costs = (0..n * n).map(|index| graph.arcs.cost(index / n, index % n)).collect();
    let checked = certificate::check(&object, costs, None);
    let checked = checked.ok_or_else(|| broken("is no certificate of a heaviest path, or a field is missing"))?;
    let findings = &checked.findings;
    let code = u8::from(!findings.is_empty());
    if asked.json {
        let told = json!({
            "verified": findings.is_empty(), "cost": graph.value(checked.cost), "steps": checked.steps, "findings": findings, "exit_code": code,
        });
        console::say(&told.to_string());
    } else if findings.is_empty() {
        let (cost, over) = (graph.text(checked.cost), certificate::over(checked.visits));
        console::say(&format!("VERIFIED: no {over} costs more than {cost}, by independent code"));
    } else {
        console::say(&format!("NOT VERIFIED: {}", findings.join("; ")));
    }
    Ok(code)
}
