//! From a judged log to what its page has of it: what was planned, simulated and flown, on the log's own clock.

use hairpin::campaign::report::{Drawn, Moment, Shown, shown};
use hairpin::campaign::{Case, CaseResult, Log, Run};
use hairpin::judgement::finding;
use hairpin::trajectory::Track;
use nalgebra::Vector3;

use super::against::Ready;
use super::aside::{Aside, aside, placed};
use super::found::{Found, JudgedLog};
use super::sheet::Sheet;
use crate::Problem;

/// Samples of a log that are kept for its page: more than it draws.
const KEPT: usize = 2000;

/// A flight or a drive, of which `log` is what was judged, with its sheet.
///
/// # Errors
/// As of [`aside`].
pub(super) fn of_flight(
    judged: JudgedLog,
    case: &Case,
    log: Option<Log>,
    against: &Ready,
) -> Result<JudgedLog, Problem> {
    let flown = judged.found.as_ref().and_then(|found| found.flown.as_ref());
    let result = CaseResult {
        measures: flown.map(|flown| flown.measures.clone()),
        ended: judged.found.as_ref().map_or("", ended).into(),
        violations: flown.map_or_else(Vec::new, |flown| flown.violations.clone()),
        message: why(&judged),
        ..CaseResult::bare(case.number, judged.outcome.status())
    };
    let begins = judged.found.as_ref().and_then(|found| found.span_s).map_or(0.0, |[from, _]| from);
    let moment = judged.found.as_ref().and_then(moment);
    let breaks = log.as_ref().map_or_else(Vec::new, |log| log.breaks.clone());
    let outcome = log.map_or_else(|| Err("nothing is left to judge".to_owned()), |log| Ok(log.flight));
    let run = Run { case: case.number, run: 0, drawn: Vec::new(), outcome, full_rate: None };
    let mut sheet = sheet(case, result, Drawn { run: &run, breaks: &breaks }, begins, against)?;
    // What is open is no violation, and has a moment nevertheless.
    if sheet.shown.result.violations.is_empty() {
        sheet.shown.moment = moment.or(sheet.shown.moment);
    }
    Ok(JudgedLog { sheet: Some(Box::new(sheet)), ..judged })
}

/// A run of an arm's program with its sheet; its times are counted from where the program begins.
///
/// # Errors
/// As of [`aside`].
pub(super) fn of_program(judged: JudgedLog, case: &Case, run: &Run, against: &Ready) -> Result<JudgedLog, Problem> {
    let Some(program) = &judged.program else { return Ok(judged) };
    let mut result = CaseResult { status: judged.outcome.status(), message: why(&judged), ..program.result.clone() };
    if program.short.is_some() {
        // A log that ends early says nothing of how the arm went on.
        result.violations.retain(|violation| !violation.is_unfinished());
    }
    let sheet = sheet(case, result, run.into(), 0.0, against)?;
    Ok(JudgedLog { sheet: Some(Box::new(sheet)), ..judged })
}

fn sheet(case: &Case, result: CaseResult, run: Drawn, begins: f64, against: &Ready) -> Result<Sheet, Problem> {
    let Aside { planned, runs, simulated, notes } = aside(against, case)?;
    let later = |track: &Track| placed(track, Vector3::zeros(), begins);
    let mut others = Vec::with_capacity(runs.len());
    for run in runs {
        // The log is the first of them.
        let outcome = match run.outcome {
            Ok(flight) => Ok(hairpin::trajectory::Flight { track: later(&flight.track)?, ..flight }),
            Err(why) => Err(why),
        };
        others.push(Run { run: 1 + run.run, outcome, ..run });
    }
    let shown = shown(&against.setup, case, &result, later(&planned)?, Some(run), &others).map_err(Problem::input)?;
    Ok(Sheet { case: case.clone(), shown: thinned(shown), simulated, notes })
}

/// How the judged part ended.
fn ended(found: &Found) -> &str {
    match (&found.ended, found.to_the_end) {
        (Some(words), _) => words,
        (None, true) => "done",
        (None, false) => "the log ends",
    }
}

/// Why nothing is decided, as the verdict says it.
fn why(judged: &JudgedLog) -> Option<String> {
    let is_open = judged.verdict.exit_code != 0 && judged.verdict.exit_code != 1;
    let told = judged.verdict.sentence.split_once("): ").map_or(judged.verdict.sentence.as_str(), |(_, why)| why);
    is_open.then(|| told.to_owned())
}

/// When what is open is open.
fn moment(found: &Found) -> Option<Moment> {
    if let Some(cut) = found.cuts.first() {
        return Some(Moment { at: cut.t_s, told: cut.in_words(), mark: "cut out".into() });
    }
    let doubt = found.flown.as_ref()?.doubts.first().filter(|_| found.finished)?;
    let (value, what) = (&doubt.value, doubt.value.what.replace('-', " "));
    let told = format!("{what} {} is open at t={:.2} s", finding(value), value.at);
    Some(Moment { at: value.at, told, mark: format!("{what} open") })
}

/// With fewer samples, so that many logs have room; both ends, the worst and the moment stay.
fn thinned(mut shown: Shown) -> Shown {
    let Some(track) = shown.flown.take() else { return shown };
    let count = track.len();
    let worst = (0..count).max_by(|a, b| shown.distances[*a].total_cmp(&shown.distances[*b]));
    let moment = shown.moment.as_ref().map(|moment| track.times().partition_point(|t| *t < moment.at));
    let evenly = (0..count).step_by(count.div_ceil(KEPT).max(1)).chain(count.checked_sub(1));
    let mut kept: Vec<usize> = evenly.chain(worst).chain(moment.filter(|i| *i < count)).collect();
    kept.sort_unstable();
    kept.dedup();
    let of = |values: &[f64]| kept.iter().map(|i| values[*i]).collect::<Vec<f64>>();
    let flown = track.only(&kept);
    (shown.distances, shown.judged) = (of(&shown.distances), kept.iter().map(|i| shown.judged[*i]).collect());
    Shown { flown: Some(flown), ..shown }
}
