//! The verdict on a program's runs: a sentence and an exit code.

use super::compare::{Comparison, Metric, MoveComparison, Outcome};
use super::measure::Measured;
use super::spec::{MoveLimits, move_violations, worst_of};
use crate::judgement::{Verdict, Violation};

/// What is judged.
#[derive(Debug, Clone, Copy)]
pub struct JudgedMoves<'a> {
    /// How obtained, in order: `["simulated", "virtual controller", "irb120"]`.
    pub how: &'a [&'a str],
    /// All runs of one program.
    pub runs: &'a [Measured],
    /// What is within spec.
    pub limits: &'a MoveLimits,
    /// Against a baseline, if there is one.
    pub comparison: Option<&'a Comparison>,
    /// What must be said with it: `all links clear`, `optimal`.
    pub evidence: &'a [&'a str],
}

/// `FAIL k/n moves …` (1), `REGRESSION new against old …` (1), `PASS n/n moves …` (0) or `INCONCLUSIVE …` (5) where nothing is limited.
pub fn moves_verdict(judged: &JudgedMoves) -> Verdict {
    let moves = judged.runs.first().map_or(0, |run| run.moves.len());
    let mut failed: Vec<usize> = Vec::new();
    for run in judged.runs {
        failed.extend(move_violations(run, judged.limits).into_iter().map(|violation| violation.leg));
    }
    failed.sort_unstable();
    failed.dedup();
    let worse = judged.comparison.map_or(0, |comparison| comparison.count(Outcome::Worse));
    let limited = judged.limits.path.is_some() || judged.limits.late.is_some();
    let mut parts = Vec::new();
    let worst = worst_of(judged.runs, judged.limits);
    parts.extend(worst.as_ref().map(|(run, violation)| worst_and_where(judged, *run, violation)));
    let (start, exit_code) = match judged.comparison {
        _ if !failed.is_empty() => (format!("FAIL {}/{moves} moves {}", failed.len(), how(judged)), 1),
        Some(comparison) if worse > 0 => {
            let spec = if limited { "all still within spec" } else { "no spec was given" };
            parts = vec![outside(comparison), spec.into()];
            (regression(comparison), 1)
        }
        _ if judged.runs.is_empty() || !(limited || judged.comparison.is_some()) => {
            parts.push("nothing to judge by: neither a limit nor a baseline".into());
            (format!("INCONCLUSIVE {moves} moves {}", how(judged)), 5)
        }
        _ => (format!("PASS {moves}/{moves} moves {}", how(judged)), 0),
    };
    if let Some(comparison) = judged.comparison {
        let (baseline, better) = (&comparison.baseline, comparison.count(Outcome::Better));
        if !failed.is_empty() && worse > 0 {
            parts.push(format!("against {baseline}: {}", outside(comparison)));
        } else if worse == 0 {
            parts.push(format!("against {baseline}: no move outside the baseline's band"));
        }
        if better > 0 {
            parts.push(format!("{better} better than the band"));
        }
    }
    parts.extend(offsets(judged.runs));
    parts.extend(judged.evidence.iter().map(|evidence| (*evidence).to_owned()));
    Verdict { sentence: format!("{start}: {}", parts.join("; ")), exit_code }
}

fn how(judged: &JudgedMoves) -> String {
    let runs = if judged.runs.len() == 1 { "1 run".into() } else { format!("{} runs", judged.runs.len()) };
    let parts: Vec<&str> = judged.how.iter().copied().chain([runs.as_str()]).collect();
    format!("({})", parts.join(", "))
}

fn regression(comparison: &Comparison) -> String {
    let [before, now] = comparison.runs;
    format!("REGRESSION {} against {} ({now} + {before} runs)", comparison.new, comparison.baseline)
}

/// `3/48 moves outside the baseline's band, worst p17→p09 +41 ms (band ±6 ms)`.
fn outside(comparison: &Comparison) -> String {
    let count = format!("{}/{} moves outside the baseline's band", comparison.count(Outcome::Worse), comparison.moves);
    match (comparison.lost.first(), comparison.worst()) {
        (Some(lost), _) => format!("{count}, move {lost} no longer completed in every run"),
        (None, Some(worst)) => format!("{count}, worst {}", beyond(worst)),
        (None, None) => count,
    }
}

fn beyond(one: &MoveComparison) -> String {
    let (difference, band, unit) = match one.metric {
        Metric::Duration => (1e3 * one.difference(), 1e3 * one.band, "ms"),
        Metric::Deviation => (1e3 * one.difference(), 1e3 * one.band, "mm"),
    };
    let decimals = match one.metric {
        Metric::Duration if difference >= 10.0 => 0,
        Metric::Duration => 1,
        Metric::Deviation => 2,
    };
    // A band is never printed as wide as what lies outside it.
    let decimals = (decimals..12).find(|d| format!("{difference:.d$}") != format!("{band:.d$}")).unwrap_or(12);
    format!("{} +{difference:.decimals$} {unit} (band ±{band:.decimals$} {unit})", one.name)
}

fn worst_and_where(judged: &JudgedMoves, run: usize, violation: &Violation) -> String {
    let name = &judged.runs[run].moves[violation.leg].name;
    let of_run = if judged.runs.len() == 1 { String::new() } else { format!(", run {run}") };
    if violation.what == "unreached" {
        return format!("{name} not reached, {} of {} targets were{of_run}", violation.value, violation.limit);
    }
    let (value, limit) = violation.printed();
    let relation = if violation.value > violation.limit { '>' } else { '≤' };
    let late = if violation.what == "arrival" { " late" } else { "" };
    format!("worst {value}{late} {relation} {limit}, {name}, t = {:.2} s{of_run}", violation.at)
}

/// An offset that was taken off, or one that every arrival shares and that is told because it was not.
fn offsets(runs: &[Measured]) -> Option<String> {
    let largest = runs.iter().filter_map(|run| run.offset.map(|offset| (offset, run.sample)));
    let (offset, sample) = largest.max_by(|a, b| a.0.seconds.abs().total_cmp(&b.0.seconds.abs()))?;
    let milliseconds = 1e3 * offset.seconds;
    if offset.removed {
        Some(format!("time offset of {milliseconds:+.1} ms removed as asked"))
    } else if offset.seconds.abs() > sample && offset.spread < 0.5 * offset.seconds.abs() {
        Some(format!("times as recorded; an offset of {milliseconds:+.1} ms is estimated and not removed"))
    } else {
        None
    }
}
