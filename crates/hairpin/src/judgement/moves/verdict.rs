//! The verdict on a program's runs: a sentence and an exit code.

use super::compare::Comparison;
use super::measure::{Measured, Offset};
use super::regression::{ProgramComparison, Regression};
use super::spec::{MoveLimits, move_violations, worst_of};
use crate::judgement::{Verdict, Violation};

/// What is judged.
///
/// Plain data: what is said of a program's runs, whoever recorded them.
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

/// `FAIL k/n moves …` (1), `REGRESSION new against old …` (1), `PASS n/n moves …` (0) or `INCONCLUSIVE …` (5) where
/// nothing is limited.
///
/// Exit codes as of all verdicts: 0 within spec, 1 a violation or a regression, 5 nothing to judge by.
///
/// A move counts as failed once, in however many runs it fails. The sentence names the worst value, its move, its
/// time and its run.
pub fn moves_verdict(judged: &JudgedMoves) -> Verdict {
    let moves = judged.runs.first().map_or(0, |run| run.moves.len());
    let mut failed: Vec<usize> = Vec::new();
    for run in judged.runs {
        failed.extend(move_violations(run, judged.limits).into_iter().map(|violation| violation.leg));
    }
    failed.sort_unstable();
    failed.dedup();
    let limited = judged.limits.path.is_some() || judged.limits.late.is_some();
    let (word, exit_code) = match judged.comparison {
        _ if !failed.is_empty() => (format!("FAIL {}/{moves}", failed.len()), 1),
        None if judged.runs.is_empty() || !limited => (format!("INCONCLUSIVE {moves}"), 5),
        _ => (format!("PASS {moves}/{moves}"), 0),
    };
    let worst = worst_of(judged.runs, judged.limits);
    let worst = worst.map(|(run, violation)| worst_and_where(judged, run, &violation));
    let nothing = || "nothing to judge by: neither a limit nor a baseline".to_owned();
    let said = worst.unwrap_or_else(|| if exit_code == 5 { nothing() } else { "nothing is limited".into() });
    let mut verdict = Verdict::of(&format!("{word} moves {}: {said}", how(judged)), exit_code);
    if let Some(comparison) = judged.comparison {
        let program = ProgramComparison { program: String::new(), comparison: comparison.clone(), trends: Vec::new() };
        let releases = vec![comparison.baseline.clone(), comparison.new.clone()];
        verdict = Regression { releases, programs: vec![program] }.join(verdict, limited);
    }
    let offset = offset_told(judged.runs.iter().filter_map(|run| Some((run.offset?, run.sample))));
    for said in offset.iter().map(String::as_str).chain(judged.evidence.iter().copied()) {
        verdict.sentence += &format!("; {said}");
    }
    verdict
}

fn how(judged: &JudgedMoves) -> String {
    let runs = if judged.runs.len() == 1 { "1 run".into() } else { format!("{} runs", judged.runs.len()) };
    let parts: Vec<&str> = judged.how.iter().copied().chain([runs.as_str()]).collect();
    format!("({})", parts.join(", "))
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

/// What estimated accelerations do not exclude between samples, m beside the path.
pub fn estimate_told(most: f64) -> String {
    format!("{:.0} mm beside the path not excluded between samples by estimated accelerations", 1e3 * most)
}

/// The largest of runs' offsets, each with the time between samples (s): one that was taken off, or one that every
/// arrival of its run shares and that is told because it was not.
///
/// ms. An estimated offset is told where it is larger than the time between samples and known to half of itself.
pub fn offset_told(offsets: impl Iterator<Item = (Offset, f64)>) -> Option<String> {
    let (offset, sample) = offsets.max_by(|a, b| a.0.seconds.abs().total_cmp(&b.0.seconds.abs()))?;
    let milliseconds = 1e3 * offset.seconds;
    if offset.removed {
        Some(format!("time offset of {milliseconds:+.1} ms removed as asked"))
    } else if offset.seconds.abs() > sample && offset.spread < 0.5 * offset.seconds.abs() {
        Some(format!("times as recorded; an offset of {milliseconds:+.1} ms is estimated and not removed"))
    } else {
        None
    }
}
