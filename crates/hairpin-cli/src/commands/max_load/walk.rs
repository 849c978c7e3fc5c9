//! `--visits N`: paths that may come back to points, and their certificates.
//!
//! `{"kind","visits","points","start","end","path","cost","steps","sha256"}`: a step is `[prices]`, whose bound closes it, or `[prices, points, without,
//! [[from, to, step], …]]`: a path meets none of the points (step `without`, `null` where it must), or one of the arcs leads it out of them, to number
//! `points` where it ends.

use std::time::Instant;

use hairpin::search::heaviest::{Ends, Heaviest, WalkProof, WalkSettings, WalkStep, heaviest_walk};
use hairpin::verification::{SplitClaim, WalkClaim, WalkStepClaim, verify_walk};
use hairpin_formats::atomic;
use serde_json::{Value, json};

use super::certificate::{digest, index};
use super::graph::Graph;
use super::{answer, code};
use crate::args::{MaxLoad, SearchMethod};
use crate::console;
use crate::interrupt::{self, Deadline};
use crate::problem::Problem;

pub(super) const KIND: &str = "hairpin heaviest walk 1";

/// Searches, answers, and writes the certificate that was asked for.
pub(super) fn run(asked: &MaxLoad, graph: &Graph) -> Result<u8, Problem> {
    if !matches!(asked.method, SearchMethod::Auto | SearchMethod::Branch) {
        return Err(Problem::input("--visits: only --method branch lets points come several times"));
    }
    let settings = WalkSettings {
        ends: Ends { start: asked.start, end: asked.end },
        visits: asked.visits.into(),
        min_cost: asked.min_cost.as_deref().map(|text| graph.at_least(text)).transpose()?,
        programs: asked.programs.into(),
        most_nodes: asked.nodes,
        proof: asked.certificate.is_some(),
    };
    let (begun, deadline) = (Instant::now(), Deadline::after(asked.time_limit));
    let found = heaviest_walk(&graph.arcs, &settings, &|| interrupt::asked() || deadline.passed());
    let (found, proof) = found.map_err(Problem::input)?;
    answer::tell(asked, graph, &found, begun.elapsed());
    if let Some(out) = &asked.certificate {
        let text = certificate(graph, settings.ends, &found, proof.as_ref());
        let text =
            text.ok_or_else(|| Problem::input(format!("{}: not written, the answer is not proven", out.display())))?;
        atomic::write(out, text.as_bytes())?;
    }
    Ok(code(&found))
}

fn certificate(graph: &Graph, ends: Ends, found: &Heaviest, proof: Option<&WalkProof>) -> Option<String> {
    let ((cost, path), proof) = found.paths.first().zip(proof)?;
    let step = |step: &WalkStep| match &step.split {
        None => json!([step.prices]),
        Some(split) => json!([step.prices, split.points, split.without, split.ways]),
    };
    let mut object = json!({
        "kind": KIND,
        "visits": proof.visits,
        "points": graph.arcs.points(),
        "start": ends.start,
        "end": ends.end,
        "path": path,
        "cost": cost,
        "steps": proof.steps.iter().map(step).collect::<Value>(),
    });
    object["sha256"] = digest(&object).into();
    Some(object.to_string())
}

/// Checks a certificate, whose SHA-256 was `stated`, against the graph: 1 if anything does not hold.
pub(super) fn verify(
    asked: &MaxLoad,
    object: &Value,
    stated: Option<Value>,
    graph: &Graph,
    broken: &dyn Fn(&str) -> Problem,
) -> Result<u8, Problem> {
    let claim = claim(object, graph).ok_or_else(|| broken("a field is missing or of another kind"))?;
    let mut findings = verify_walk(&claim);
    if stated != Some(digest(object).into()) {
        findings.push("it was changed: its SHA-256 is another".into());
    }
    let code = u8::from(!findings.is_empty());
    if asked.json {
        let told = json!({
            "verified": findings.is_empty(), "cost": graph.value(claim.cost), "steps": claim.steps.len(), "findings": findings, "exit_code": code,
        });
        console::say(&told.to_string());
    } else if findings.is_empty() {
        let (cost, visits) = (graph.text(claim.cost), claim.visits);
        console::say(&format!(
            "VERIFIED: no path that comes to no point more than {visits} times and uses no move twice costs more than {cost}, by independent code"
        ));
    } else {
        console::say(&format!("NOT VERIFIED: {}", findings.join("; ")));
    }
    Ok(code)
}

fn claim(object: &Value, graph: &Graph) -> Option<WalkClaim> {
    let arcs = &graph.arcs;
    let end = |value: &Value| if value.is_null() { Some(None) } else { index(value).map(Some) };
    let pairs = (0..arcs.points()).flat_map(|from| (0..arcs.points()).map(move |to| (from, to)));
    let indices = |value: &Value| value.as_array()?.iter().map(index).collect::<Option<Vec<_>>>();
    let way = |value: &Value| match indices(value)?[..] {
        [from, to, step] => Some((from, to, step)),
        _ => None,
    };
    let step = |value: &Value| {
        let parts = value.as_array()?;
        let prices = parts.first()?.as_array()?.iter().map(Value::as_i64).collect::<Option<Vec<_>>>()?;
        let split = match parts.get(1..)? {
            [] => None,
            [points, without, ways] => Some(SplitClaim {
                points: indices(points)?,
                without: end(without)?,
                ways: ways.as_array()?.iter().map(way).collect::<Option<_>>()?,
            }),
            _ => return None,
        };
        Some(WalkStepClaim { prices, split })
    };
    Some(WalkClaim {
        points: index(&object["points"])?,
        costs: pairs.map(|(from, to)| arcs.cost(from, to)).collect(),
        start: end(&object["start"])?,
        end: end(&object["end"])?,
        visits: index(&object["visits"])?,
        path: indices(&object["path"])?,
        cost: object["cost"].as_i64()?,
        steps: object["steps"].as_array()?.iter().map(step).collect::<Option<_>>()?,
    })
}
