//! `--verify`: a certificate checked against the graph by independent code.

use std::path::Path;

use hairpin_jobs::Problem;
use hairpin_jobs::max_load::verify_certificate;
use serde_json::json;

use crate::console;
use crate::exit::{DONE, FINDING};

/// Checks a certificate against the graph: 1 if anything does not hold.
pub(super) fn verify(graph: &Path, file: &Path, json: bool) -> Result<u8, Problem> {
    let (graph, checked) = verify_certificate(graph, file)?;
    let findings = &checked.findings;
    let code = if findings.is_empty() { DONE } else { FINDING };
    if json {
        let object = json!({
            "verified": findings.is_empty(), "cost": graph.value(checked.cost), "steps": checked.steps, "findings": findings, "exit_code": code,
        });
        console::say(&object.to_string());
    } else if findings.is_empty() {
        let (cost, over) = (graph.text(checked.cost), over(checked.visits));
        console::say(&format!("VERIFIED: no {over} costs more than {cost}, by independent code"));
    } else {
        console::say(&format!("NOT VERIFIED: {}", findings.join("; ")));
    }
    Ok(code)
}

/// Over what a certificate says that a path is the heaviest.
fn over(visits: usize) -> String {
    match visits {
        1 => "loop-free path".into(),
        _ => format!("path that comes to no point more than {visits} times and uses no move twice"),
    }
}
