//! Two campaigns for a build server: what fails that did not fail before.

use std::path::Path;

use hairpin::campaign::report::{Length, length, violation};
use hairpin::campaign::{CaseResult, Comparison, Status};
use hairpin_formats::junit::{Outcome, OutcomeKind, outcomes_text};

use super::campaigns::{Compared, pairs};
use crate::Problem;
use crate::next::replay_command;
use crate::work::open_as_made;

/// A test for each pair of two campaigns that were [`super::compare`]d: newly failing is a failure, with both runs and
/// the command that flies B's again; what failed before is skipped, for nothing about it is new. Where nothing could be
/// compared each pair is an error. With `regression` a metric that got worse is a failure of its own.
///
/// # Errors
/// Folders that cannot be read.
pub fn junit_text(a: &Path, b: &Path, compared: &Compared, regression: bool) -> Result<String, Problem> {
    let (before, after) = (open_as_made(a)?, open_as_made(b)?);
    let (comparison, length) = (&compared.comparison, length(&after.setup));
    let mut outcomes: Vec<Outcome> = pairs((&before, a), (&after, b))?
        .iter()
        .map(|[(_, was), (_, is)]| outcome(comparison, [was, is], &length, b))
        .collect();
    let worse = comparison.metrics.iter().filter(|metric| regression && metric.change == "worse");
    outcomes.extend(worse.map(|metric| Outcome {
        name: format!("regression of {}", metric.metric),
        kind: OutcomeKind::Regression,
        sentence: format!(
            "{}: median {:.4} in A, {:.4} in B over {} pairs, p = {:.2e} (Holm)",
            metric.metric, metric.median_a, metric.median_b, metric.pairs, metric.p_holm
        ),
        more: Vec::new(),
    }));
    let count = |name: &str, value: usize| (name.to_owned(), value.to_string());
    let properties = [
        ("verdict".to_owned(), comparison.sentence()),
        ("a".to_owned(), a.display().to_string()),
        ("b".to_owned(), b.display().to_string()),
        count("newly_failing", comparison.newly_failing.len()),
        count("newly_passing", comparison.newly_passing.len()),
        count("better", comparison.better),
        count("worse", comparison.worse),
        count("unchanged", comparison.unchanged),
        count("not_compared", comparison.undecided.len()),
        count("not_paired", comparison.unpaired.len()),
        ("scenario_differences".to_owned(), compared.differences.join(", ")),
    ];
    Ok(outcomes_text("compare", &properties, &outcomes))
}

fn outcome(comparison: &Comparison, [was, is]: [&CaseResult; 2], length: &Length, b: &Path) -> Outcome {
    let told = |result: &CaseResult| told(result, length);
    let name = is.case.to_string();
    let of = |names: &[String]| names.contains(&name);
    let (kind, sentence) = if of(&comparison.newly_failing) {
        (OutcomeKind::Regression, format!("newly failing: B {}; A {}", told(is), told(was)))
    } else if of(&comparison.undecided) {
        let kind = if comparison.inconclusive() { OutcomeKind::Open } else { OutcomeKind::Skipped };
        (kind, format!("not compared: A {}; B {}", told(was), told(is)))
    } else if is.status == Status::Fail {
        (OutcomeKind::Skipped, format!("fails in A as well: A {}; B {}", told(was), told(is)))
    } else {
        (OutcomeKind::Pass, String::new())
    };
    let more = match kind {
        OutcomeKind::Regression => vec![
            format!("A: {}", told(was)),
            format!("B: {}", told(is)),
            format!("again: {}", replay_command(b, Some(&name))),
        ],
        _ => Vec::new(),
    };
    Outcome { name, kind, sentence, more }
}

/// `fail, deviation 0.65 m > 0.50 m at t=12.34 s`, `pass, largest deviation 0.42 m at t=3.10 s`.
fn told(result: &CaseResult, length: &Length) -> String {
    let found = result.violations.first().map(violation);
    let largest = || {
        let m = result.measured()?;
        Some(format!("largest deviation {} at t={:.2} s", length.told(m.max_deviation), m.t_worst))
    };
    let other = || result.message.clone().unwrap_or_else(|| result.ended.clone());
    format!("{}, {}", result.status.word(), found.or_else(largest).unwrap_or_else(other))
}
