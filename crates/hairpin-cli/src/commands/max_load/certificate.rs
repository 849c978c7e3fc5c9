//! `--certificate` and `--verify`: the proof of a heaviest path as a JSON file, and its check by independent code.
//!
//! `{"kind","points","start","end","path","cost","scale","directed","steps","sha256"}`: costs in whole numbers (the table's
//! times the power of ten that makes them whole); a step is `[multipliers, out, into, next]`, next `[]` (closed), `[step]`
//! or `[choice, step with it out, step with it in]`; sha256 is of the object without it.

use std::fs;
use std::path::Path;

use hairpin::search::heaviest::{Arcs, Ends, Heaviest, Next, Step};
use hairpin::verification::{HeaviestClaim, NextClaim, StepClaim, TreeClaim, verify_heaviest};
use hairpin_formats::{atomic, checksum};
use serde_json::{Value, json};

use super::graph::Graph;
use crate::args::MaxLoad;
use crate::console;
use crate::problem::Problem;

const KIND: &str = "hairpin heaviest path 1";

/// Writes the proof of an answer that is proven.
pub(super) fn write(out: &Path, graph: &Graph, ends: Ends, found: &Heaviest) -> Result<(), Problem> {
    let Some((cost, path)) = found.paths.first().filter(|_| found.proven) else {
        return Err(Problem::input(format!("{}: not written, the answer is not proven", out.display())));
    };
    let step = |step: &Step| {
        let next = match step.next {
            Next::Closed => json!([]),
            Next::Again(step) => json!([step]),
            Next::Branch { choice, out, into } => json!([choice, out, into]),
        };
        json!([step.multipliers, step.out, step.into, next])
    };
    let proof = found.proof.as_ref();
    let mut object = json!({
        "kind": KIND,
        "points": graph.arcs.points(),
        "start": ends.start,
        "end": ends.end,
        "path": path,
        "cost": cost,
        "scale": proof.map(|proof| proof.scale),
        "directed": proof.map(|proof| proof.directed),
        "steps": proof.map(|proof| proof.steps.iter().map(step).collect::<Value>()),
    });
    object["sha256"] = digest(&object).into();
    Ok(atomic::write(out, object.to_string().as_bytes())?)
}

/// Checks a certificate against the graph: 1 if anything does not hold.
pub(super) fn verify(asked: &MaxLoad, certificate: &Path, graph: &Graph) -> Result<u8, Problem> {
    let broken = |what: &str| Problem::input(format!("{}: {what}", certificate.display()));
    let text = fs::read_to_string(certificate).map_err(|cause| broken(&format!("cannot be read: {cause}")))?;
    let mut object: Value = serde_json::from_str(&text).map_err(|error| broken(&format!("is no JSON: {error}")))?;
    let stated = object.as_object_mut().and_then(|object| object.shift_remove("sha256"));
    if object["kind"] == super::walk::KIND {
        return super::walk::verify(asked, &object, stated, graph, &broken);
    }
    if object["kind"] != KIND {
        return Err(broken("is no certificate of a heaviest path"));
    }
    let claim = claim(&object, &graph.arcs).ok_or_else(|| broken("a field is missing or of another kind"))?;
    let mut findings: Vec<String> = verify_heaviest(&claim)
        .into_iter()
        .map(|finding| finding.step.map_or(finding.what.clone(), |step| format!("step {step}: {}", finding.what)))
        .collect();
    if stated != Some(digest(&object).into()) {
        findings.push("it was changed: its SHA-256 is another".into());
    }
    let code = u8::from(!findings.is_empty());
    let cost = graph.text(claim.cost);
    if asked.json {
        let steps = claim.tree.as_ref().map(|tree| tree.steps.len());
        console::say(
            &json!({ "verified": findings.is_empty(), "cost": graph.value(claim.cost), "steps": steps, "findings": findings, "exit_code": code })
                .to_string(),
        );
    } else if findings.is_empty() {
        console::say(&format!("VERIFIED: no loop-free path costs more than {cost}, by independent code"));
    } else {
        console::say(&format!("NOT VERIFIED: {}", findings.join("; ")));
    }
    Ok(code)
}

pub(super) fn digest(object: &Value) -> String {
    checksum::sha256(&object.to_string())
}

fn claim(object: &Value, arcs: &Arcs) -> Option<HeaviestClaim> {
    let points = usize::try_from(object["points"].as_u64()?).ok()?;
    let end = |value: &Value| if value.is_null() { Some(None) } else { index(value).map(Some) };
    let table = (0..arcs.points()).flat_map(|from| (0..arcs.points()).map(move |to| (from, to)));
    let tree = if object["steps"].is_null() {
        None
    } else {
        let steps = object["steps"].as_array()?.iter().map(step).collect::<Option<Vec<_>>>()?;
        Some(TreeClaim { scale: object["scale"].as_i64()?, directed: object["directed"].as_bool()?, steps })
    };
    Some(HeaviestClaim {
        points,
        costs: table.map(|(from, to)| arcs.cost(from, to)).collect(),
        start: end(&object["start"])?,
        end: end(&object["end"])?,
        path: object["path"].as_array()?.iter().map(index).collect::<Option<_>>()?,
        cost: object["cost"].as_i64()?,
        tree,
    })
}

pub(super) fn index(value: &Value) -> Option<usize> {
    usize::try_from(value.as_u64()?).ok()
}

fn step(value: &Value) -> Option<StepClaim> {
    let numbers = |value: &Value| value.as_array()?.iter().map(Value::as_u64).collect::<Option<Vec<_>>>();
    let next = value[3].as_array()?.iter().map(index).collect::<Option<Vec<_>>>()?;
    Some(StepClaim {
        multipliers: value[0].as_array()?.iter().map(Value::as_i64).collect::<Option<_>>()?,
        out: numbers(&value[1])?,
        into: numbers(&value[2])?,
        next: match next[..] {
            [] => NextClaim::Closed,
            [step] => NextClaim::Again(step),
            [choice, out, into] => NextClaim::Branch { choice: choice as u64, out, into },
            _ => return None,
        },
    })
}
