//! `hairpin verify`: every witness integrated by independent code, and the planned motions held to them.

use hairpin::campaign::arm::GraphAgain;
use hairpin_jobs::Problem;
use hairpin_jobs::verify::{Answer, Verified, verify};
use serde_json::{Value, json};

use crate::args::Verify;
use crate::exit::{DONE, FINDING};
use crate::{console, settings};

/// Runs the command: 1 for a finding.
pub(crate) fn run(asked: &Verify) -> Result<u8, Problem> {
    settings::take_threads(&asked.threads);
    let verified = verify(&asked.folder)?;
    let code = if verified.has_findings() { FINDING } else { DONE };
    if asked.json {
        console::say(&object(&verified, code).to_string());
    } else {
        in_words(&verified);
    }
    Ok(code)
}

/// What machines get.
pub fn object(verified: &Verified, code: u8) -> Value {
    let [planned, theirs] = verified.planned();
    json!({
        "checked": verified.checked(), "failed": verified.failed().count(),
        "worst": verified.worst().map(of_case), "exit_code": code,
        "optimum": verified.optimum.as_ref().map(|optimum| json!({
            "verified": optimum.findings.is_empty(), "steps": optimum.steps, "findings": optimum.findings,
        })),
        "graph": verified.graph.as_ref().map(|graph| json!({ "moves": graph.moves, "findings": graph.findings })),
        "tables": verified.tables,
        "planned": { "checked": planned, "failed": planned - theirs }, "unknown": verified.unknown,
        "nothing": verified.nothing, "edited": verified.edited,
    })
}

fn of_case(answer: &Answer) -> Value {
    match answer {
        Answer::NothingClaimed => Value::Null,
        Answer::Checked { case, position_m, findings, .. } => {
            json!({ "case": case.to_string(), "end_error_m": position_m, "findings": findings })
        }
    }
}

fn in_words(verified: &Verified) {
    if let Some(why) = &verified.nothing {
        console::say(&format!("NOTHING TO VERIFY: {why}"));
        return;
    }
    for answer in verified.failed() {
        if let Answer::Checked { case, findings, .. } = answer {
            console::say(&format!("case {case}: {}", findings.join("; ")));
        }
    }
    let (all, checked) = (verified.answers.len(), verified.checked());
    if all > checked {
        console::warn(&format!("{} of {all} cases claim no witness: nothing to verify there", all - checked));
    }
    let worst =
        verified.largest_m().map_or(String::new(), |error| format!("; largest end error of a leg {error:.3e} m"));
    let unread = match verified.unread() {
        0 => String::new(),
        unread => format!("; of {unread} cases no witness can be read"),
    };
    let planned = match verified.planned() {
        [0, _] => String::new(),
        [all, theirs] => format!("; {theirs}/{all} planned motions in trajectories/ are those of their witnesses"),
    };
    let optimal = match &verified.optimum {
        None => String::new(),
        Some(optimum) if optimum.findings.is_empty() => "; no program is heavier than case 0000's".into(),
        Some(optimum) => format!("; {}", optimum.findings.join("; ")),
    };
    let environments = match verified.surrounded {
        [0, _] => String::new(),
        [all, clear] => format!("; the plans of {clear}/{all} cases are clear of what was placed around them"),
    };
    let free = match &verified.graph {
        None => String::new(),
        Some(GraphAgain { moves, findings }) => {
            findings.iter().for_each(|finding| console::say(&format!("graph: {finding}")));
            format!("; {} of {moves} moves of the graph followed again hold", moves - findings.len())
        }
    };
    verified.tables.iter().for_each(|finding| console::say(finding));
    let unknown = verified.unknown.as_deref().map_or(String::new(), |what| format!("; {what}"));
    let word = if verified.has_findings() { "NOT VERIFIED" } else { "VERIFIED" };
    // Without a witness it is about what stands around plans, or about a graph.
    let integrated = match verified.witnesses() {
        [0, _] => String::new(),
        [all, fine] => format!("; {fine}/{all} witnesses integrated by independent code"),
    };
    let edited = match verified.edited.join(", ") {
        keys if keys.is_empty() => String::new(),
        keys => format!("; of the scenario as it is now: {keys} changed since the campaign was made"),
    };
    let told = format!("{integrated}{unread}{worst}{planned}{optimal}{environments}{free}{unknown}{edited}");
    console::say(&format!("{word} {}", told.trim_start_matches("; ")));
}
