//! Parts three and four: the verdict on the flights in the folder, and the report.

use hairpin::campaign::baseline::Moves;
use hairpin::campaign::{
    self, Case, CaseResult, Grid, Influence, Reruns, RunDeviation, Status, Tally,
    report::{Shown, worst_first},
    vary,
};
use hairpin::judgement::Verdict;
use hairpin::judgement::moves::{Outcome, Regression};
use hairpin_formats::executor::ATTITUDE_UNKNOWN;
use hairpin_formats::junit::{self, Suite};
use rayon::prelude::*;
use std::collections::BTreeSet;
use std::sync::atomic::{AtomicUsize, Ordering};

use super::{Replayed, Repro};
use crate::folder::Work;
use crate::problem::Problem;

/// Violating cases that get a `repro/CASE.json`, the worst ones.
const REPROS: usize = 20;

/// Confidence of the shares of violations that come again.
const CONFIDENCE: f64 = 0.95;

/// A judged case: its result, the deviations of its runs, and the cells of the grid of motion that they met.
type Judged = (CaseResult, Vec<RunDeviation>, BTreeSet<usize>);

/// What judging came to.
pub(crate) struct Judgement {
    pub(crate) results: Vec<CaseResult>,
    pub(crate) verdict: Verdict,
    pub(crate) influences: Vec<Influence>,
    /// Cases of which a flight came without attitudes.
    pub(crate) attitude_unknown: usize,
    /// Of arms: what every run did on every move.
    pub(crate) moves: Moves,
    /// Of arms with a baseline.
    pub(crate) regression: Option<Regression>,
}

/// Judges every case and writes results, JUnit (with what was `replayed` before), repro files, and which parameter did it.
pub(crate) fn judge(work: &Work, cases: &[Case], tally: &Tally, replayed: &[Replayed]) -> Result<Judgement, Problem> {
    let table = work.folder.read_runs_table()?;
    let attitude_unknown = AtomicUsize::new(0);
    let grid = Grid::of(&work.setup);
    let judged: Result<Vec<Judged>, Problem> = cases
        .par_iter()
        .map(|case| {
            let runs = work.folder.read_runs(case.number, &table)?;
            if runs.is_empty() {
                return Err(Problem::input(format!(
                    "case {} has not been executed: hairpin execute {}",
                    case.id(),
                    work.folder.path().display()
                )));
            }
            attitude_unknown.fetch_add(runs.iter().any(super::attitude_unknown).into(), Ordering::Relaxed);
            let (mut result, mut deviations) = campaign::judge_runs(&work.setup, case, &runs)?;
            // Missions that were made elsewhere were planned by other scenarios.
            if tally.missions.is_empty() {
                let of_plan = vary::draw_for_case(&work.setup.scenario, case.seed, case.number);
                let all = deviations.iter_mut().map(|run| &mut run.drawn).chain([&mut result.drawn]);
                all.for_each(|drawn| drawn.extend_from_slice(&of_plan));
            }
            if result.status == Status::Fail {
                result.reruns = reruns(work, case)?;
            }
            let met = runs.iter().flat_map(|run| grid.met(&work.setup, &case.waypoints, run)).collect();
            Ok((result, deviations, met))
        })
        .collect();
    let (mut results, mut deviations, mut met) = (Vec::new(), Vec::new(), Vec::new());
    for (result, runs, cells) in judged? {
        results.push(result);
        deviations.push(runs);
        met.push(cells);
    }
    let coverage = grid.coverage(&met);
    let deviations = deviations.concat();
    let influences = campaign::influences(&work.setup.scenario, &deviations);
    let moves = work.setup.arm().map(|arm| arm.moves(cases, &deviations)).unwrap_or_default();
    let verdict = campaign::verdict(&work.setup, cases, &results, tally);
    let (verdict, regression) = with_moves(work, &moves, verdict)?;
    work.folder.write_results(cases, &results)?;
    if work.setup.arm().is_some() {
        work.folder.write_moves(&moves)?;
    }
    let suite = suite(work, tally, &verdict, &results, (regression.as_ref(), replayed));
    junit::write(&work.folder.file("junit.xml"), &suite, &results)?;
    write_repros(work, cases, &results)?;
    work.folder.write_influences(&influences)?;
    work.folder.write_coverage(&coverage)?;
    Ok(Judgement { results, verdict, influences, attitude_unknown: attitude_unknown.into_inner(), moves, regression })
}

/// How often the violation of `case` came again; `None` where it was not run again.
fn reruns(work: &Work, case: &Case) -> Result<Option<Reruns>, Problem> {
    let mut counted = Reruns { violated: 0, of: 0 };
    let again = work.folder.read_reruns(case.number)?;
    for run in &again {
        match campaign::judge(&work.setup, case, std::slice::from_ref(run))?.status {
            Status::Fail => (counted.violated, counted.of) = (counted.violated + 1, counted.of + 1),
            Status::Pass => counted.of += 1,
            // What was not flown, or cannot be judged, is no answer.
            Status::ExecutorFailed | Status::Inconclusive => {}
        }
    }
    Ok((!again.is_empty()).then_some(counted))
}

/// The verdict by the limits, with what an arm's baseline and the recordings' clocks say. The new release is called after the campaign's folder.
pub(crate) fn with_moves(
    work: &Work,
    moves: &Moves,
    verdict: Verdict,
) -> Result<(Verdict, Option<Regression>), Problem> {
    let Some(arm) = work.setup.arm().filter(|_| !moves.cases.is_empty()) else { return Ok((verdict, None)) };
    let path = std::fs::canonicalize(work.folder.path()).unwrap_or_else(|_| work.folder.path().to_owned());
    let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let regression = arm.regression(moves, &name);
    let regression = regression.map_err(|error| Problem::input(format!("`spec.regression`: {error}")))?;
    Ok((arm.verdict_with(verdict, moves, regression.as_ref()), regression))
}

fn suite(
    work: &Work,
    tally: &Tally,
    verdict: &Verdict,
    results: &[CaseResult],
    (regression, replayed): (Option<&Regression>, &[Replayed]),
) -> Suite {
    let programs = regression.iter().flat_map(|regression| &regression.programs).zip(results);
    let worse = programs.map(|(one, result)| {
        let against = &one.comparison.baseline;
        let worse = one.comparison.compared.iter().filter(|one| one.outcome == Outcome::Worse);
        let lost =
            one.comparison.lost.iter().map(|index| format!("move {index} no longer completed, against {against}"));
        (result.case, worse.map(|one| format!("{} against {against}", one.told())).chain(lost).collect())
    });
    let scenario = &work.setup.scenario;
    let by_a_case = results.iter().any(|result| result.status == Status::Inconclusive);
    let property = |name: &str, value: String| (name.to_owned(), value);
    Suite {
        name: work.setup.robot_name().to_owned(),
        asked: tally.asked(scenario.search().cases),
        missing: tally.nothing.clone().unwrap_or_else(|| "not found within the budget".into()),
        inconclusive: (verdict.exit_code == 5 && !by_a_case).then(|| verdict.sentence.clone()),
        properties: [
            property("verdict", verdict.sentence.clone()),
            property("seed", scenario.seed().to_string()),
            property("version", env!("CARGO_PKG_VERSION").into()),
        ]
        .into_iter()
        .chain(results.iter().filter_map(rerun_property))
        .collect(),
        regressions: worse.collect(),
        saved: replayed.iter().map(Replayed::named).collect(),
    }
}

/// `reruns 0117`: `3 of 10 violate, share 0.30 [0.07, 0.65]`. A test case of Jenkins' schema has no properties of its own.
fn rerun_property(result: &CaseResult) -> Option<(String, String)> {
    let reruns = result.reruns?;
    let share = reruns.share(CONFIDENCE)?;
    let (violated, of) = (reruns.violated, reruns.of);
    let value = format!("{violated} of {of} violate, share {:.2} [{:.2}, {:.2}]", share.value, share.low, share.high);
    Some((format!("reruns {:04}", result.case), value))
}

fn write_repros(work: &Work, cases: &[Case], results: &[CaseResult]) -> Result<(), Problem> {
    let folder = work.folder.file("repro");
    // Only what is judged anew goes: shrunk cases, those of a larger campaign before, and files of the users' own are there to be run again.
    for old in cases.iter().map(|case| folder.join(format!("{}.json", case.id()))) {
        match std::fs::remove_file(&old) {
            Err(error) if error.kind() != std::io::ErrorKind::NotFound => {
                return Err(Problem::input(format!("cannot remove {}: {error}", old.display())));
            }
            _ => {}
        }
    }
    let violating = worst_first(results).into_iter().filter(|result| result.status == Status::Fail);
    for result in violating.take(REPROS) {
        if let Some(case) = cases.iter().find(|case| case.number == result.case) {
            Repro::of(&work.setup, case, result).write(&folder.join(format!("{}.json", case.id())))?;
        }
    }
    Ok(())
}

/// Writes `report.html`.
pub(crate) fn report(
    work: &Work,
    cases: &[Case],
    tally: &Tally,
    verdict: &Verdict,
    (moves, regression): (&Moves, Option<&Regression>),
) -> Result<(), Problem> {
    let mut assumptions = campaign::assumptions(&work.setup, cases, tally);
    if let Some(arm) = work.setup.arm() {
        assumptions.extend(arm.said_of_moves(moves, regression));
    }
    let mut data = hairpin_formats::report::from_folder(&work.folder, &work.setup, verdict.clone(), assumptions)
        .map_err(Problem::input)?;
    data.regression = regression.cloned();
    let level = |shown: &Shown| shown.flown.as_ref().is_some_and(|track| track.channel(ATTITUDE_UNKNOWN).is_some());
    if data.shown.iter().any(level) {
        data.assumptions.push("The executor sent no attitudes: they are unknown, and drawn level.".into());
    }
    Ok(hairpin_formats::report::write(&work.folder.file("report.html"), &data)?)
}
