//! One case: its witness, and the rows of its planned motion held to that.

use hairpin::campaign::{self, Case, PlannedRows, Setup};
use hairpin::verification::Finding;

use super::answer::Answer;
use crate::work::Work;

/// `hold` proves a case against the scenario.
pub(super) fn check(work: &Work, case: &Case, hold: fn(&Setup, &Case) -> campaign::Verified) -> Answer {
    let finding = |what: String| Answer::Checked {
        case: case.number,
        witness: true,
        planned: false,
        position_m: None,
        findings: vec![what],
    };
    if let Some(why) = campaign::foreign_seed(&work.setup, case) {
        return finding(why);
    }
    let mut case = case.clone();
    if let Err(error) = work.folder.read_witness(&mut case) {
        return finding(error.to_string());
    }
    let claims = case.evidence.is_of_a_witness();
    let witness = case.witness.is_some();
    if case.environment.is_none() && !witness && !claims {
        return Answer::NothingClaimed;
    }
    let verified = hold(&work.setup, &case);
    match verified.proof {
        Some(proof) if witness || !claims => {
            let mut findings: Vec<String> = proof.findings.iter().map(words).collect();
            // Rows are held to what was proven.
            let planned = if witness && findings.is_empty() { of_rows(work, &case) } else { None };
            findings.extend(planned.iter().flatten().cloned());
            Answer::Checked {
                case: case.number,
                witness,
                planned: planned.is_some(),
                position_m: (!proof.findings.iter().any(is_no_number)).then_some(proof.position.value),
                findings,
            }
        }
        _ => finding("its profile is missing".into()),
    }
}

/// What does not hold of the rows of its planned motion; `None` in a folder that keeps none.
fn of_rows(work: &Work, case: &Case) -> Option<Vec<String>> {
    match work.folder.read_planned_rows(case.number) {
        Ok(kept) => kept.map(|(rows, period)| {
            let kept = PlannedRows { rows: &rows, period };
            campaign::verify_planned(&work.setup, case, &kept).iter().map(words).collect()
        }),
        Err(error) => Some(vec![error.to_string()]),
    }
}

/// Whether what was written is no number, so that nothing was flown by it.
fn is_no_number(finding: &Finding) -> bool {
    finding.value.is_nan() && finding.bound == f64::MAX
}

pub(super) fn words(finding: &Finding) -> String {
    let Finding { field, value, bound, unit, at, leg } = finding;
    // What is refused in words alone has neither.
    let numbers = match bound.is_nan() {
        true => String::new(),
        false if is_no_number(finding) => " holds a number that cannot be".to_owned(),
        false => format!(" = {value:.6e} {unit}, bound {bound:.6e} {unit}"),
    };
    format!("{field}{numbers}, leg {leg}→{}, t = {at:.3} s", leg + 1)
}
