//! `hairpin verify`: every witness integrated by independent code.

use hairpin::campaign::arm::{GraphAgain, graph_of};
use hairpin::campaign::{self, Case, Evidence};
use hairpin::verification::Finding;
use rayon::prelude::*;
use serde_json::{Value, json};

use super::parts::optimum;
use crate::args::Verify;
use crate::console;
use crate::folder::{self, Work};
use crate::problem::Problem;

/// What came of one case.
enum Answer {
    /// It claims no witness.
    NothingClaimed,
    /// Whether it has a witness, the largest end error over its legs, m, and what does not hold.
    Checked { case: usize, witness: bool, position_m: f64, findings: Vec<String> },
}

impl Answer {
    /// Whether all that was checked holds.
    fn fine(&self) -> bool {
        matches!(self, Self::Checked { findings, .. } if findings.is_empty())
    }
}

/// Runs the command: 1 for a finding.
pub(crate) fn run(verify: &Verify) -> Result<u8, Problem> {
    folder::take_threads(&verify.threads);
    let work = folder::look(&verify.folder)?;
    let cases = work.folder.read_cases_without_profiles()?;
    let answers: Vec<Answer> = cases.par_iter().map(|case| check(&work, case)).collect();
    let mut checked = 0;
    let mut failed = Vec::new();
    let mut worst: Option<(bool, f64, &Answer)> = None;
    for answer in &answers {
        let Answer::Checked { position_m, findings, .. } = answer else { continue };
        checked += 1;
        let rank = (!findings.is_empty(), *position_m);
        if worst.as_ref().is_none_or(|(found, at, _)| (*found, *at) < rank) {
            worst = Some((rank.0, rank.1, answer));
        }
        if !findings.is_empty() {
            failed.push(answer);
        }
    }
    let optimum = work.setup.arm().and_then(|arm| optimum::verify(&work, &arm, &cases));
    let lighter = optimum.as_ref().is_some_and(|optimum| !optimum.findings.is_empty());
    // Of the graph, the moves that no program uses as well.
    let graph =
        work.setup.arm().and_then(|arm| Some(arm.graph_again(&graph_of(&arm).ok()?))).filter(|graph| graph.moves > 0);
    let unfree = graph.as_ref().is_some_and(|graph| !graph.findings.is_empty());
    let code = u8::from(!failed.is_empty() || lighter || unfree);
    if verify.json {
        let worst = worst.map(|(_, _, answer)| object(answer));
        console::say(
            &json!({
                "checked": checked, "failed": failed.len(), "worst": worst, "exit_code": code,
                "optimum": optimum.as_ref().map(|optimum| json!({
                    "verified": optimum.findings.is_empty(), "steps": optimum.steps, "findings": optimum.findings,
                })),
                "graph": graph.as_ref().map(|graph| json!({ "moves": graph.moves, "findings": graph.findings })),
            })
            .to_string(),
        );
        return Ok(code);
    }
    for answer in &failed {
        if let Answer::Checked { case, findings, .. } = answer {
            console::say(&format!("case {case:04}: {}", findings.join("; ")));
        }
    }
    let unclaimed = answers.len() - checked;
    if unclaimed > 0 {
        console::warn(&format!("{unclaimed} of {} cases claim no witness: nothing to verify there", answers.len()));
    }
    let worst = worst.filter(|(.., answer)| matches!(answer, Answer::Checked { witness: true, .. }));
    let worst =
        worst.map_or(String::new(), |(_, position_m, _)| format!("; largest end error of a leg {:.3e} m", position_m));
    let optimal = match &optimum {
        None => String::new(),
        Some(optimum) if optimum.findings.is_empty() => "; no program is heavier than case 0000's".into(),
        Some(optimum) => format!("; {}", optimum.findings.join("; ")),
    };
    let surrounded: Vec<&Answer> = answers
        .iter()
        .zip(&cases)
        .filter(|(answer, case)| case.environment.is_some() && matches!(answer, Answer::Checked { .. }))
        .map(|(answer, _)| answer)
        .collect();
    let clear = surrounded.iter().filter(|answer| answer.fine()).count();
    let environments = match surrounded.len() {
        0 => String::new(),
        all => format!("; the plans of {clear}/{all} cases are clear of what was placed around them"),
    };
    let witnessed = answers.iter().filter(|answer| matches!(answer, Answer::Checked { witness: true, .. }));
    let (fine, witnesses) = witnessed.fold((0, 0), |(fine, all), answer| (fine + usize::from(answer.fine()), all + 1));
    let free = match &graph {
        None => String::new(),
        Some(GraphAgain { moves, findings }) => {
            findings.iter().for_each(|finding| console::say(&format!("graph: {finding}")));
            format!("; {} of {moves} moves of the graph followed again hold", moves - findings.len())
        }
    };
    let word = if code == 0 { "VERIFIED" } else { "NOT VERIFIED" };
    console::say(&format!(
        "{word} {fine}/{witnesses} witnesses integrated by independent code{worst}{optimal}{environments}{free}"
    ));
    Ok(code)
}

fn check(work: &Work, case: &Case) -> Answer {
    let finding =
        |what: String| Answer::Checked { case: case.number, witness: true, position_m: f64::MAX, findings: vec![what] };
    let mut case = case.clone();
    if let Err(error) = work.folder.read_witness(&mut case) {
        return finding(error.to_string());
    }
    let claims = matches!(case.evidence, Evidence::Witnessed | Evidence::ClearAllLinks | Evidence::ClearToolSphere);
    let witness = case.witness.is_some();
    if case.environment.is_none() && !witness && !claims {
        return Answer::NothingClaimed;
    }
    let verified = campaign::verify(&work.setup, &case);
    match verified.proof {
        Some(proof) if witness || !claims => Answer::Checked {
            case: case.number,
            witness,
            position_m: proof.position.value,
            findings: proof.findings.iter().map(words).collect(),
        },
        _ => finding("its profile is missing".into()),
    }
}

fn words(finding: &Finding) -> String {
    let Finding { field, value, bound, unit, at, leg } = finding;
    format!("{field} = {value:.6e} {unit}, bound {bound:.6e} {unit}, leg {leg}→{}, t = {at:.3} s", leg + 1)
}

fn object(answer: &Answer) -> Value {
    match answer {
        Answer::NothingClaimed => Value::Null,
        Answer::Checked { case, position_m, findings, .. } => {
            let position = (*position_m < f64::MAX).then_some(*position_m);
            json!({ "case": format!("{case:04}"), "end_error_m": position, "findings": findings })
        }
    }
}
