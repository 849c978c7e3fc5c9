//! The verdict on the flights in a campaign folder.

mod repros;
mod suite;
#[cfg(test)]
mod tests;

use std::collections::BTreeSet;
use std::path::Path;

use hairpin::campaign::arm::ArmSetup;
use hairpin::campaign::baseline::Moves;
use hairpin::campaign::{
    self, Baseline, Case, CaseNumber, CaseResult, Grid, Influence, Reruns, RunDeviation, Setup, Status, Tally, Undone,
    vary,
};
use hairpin::judgement::Verdict;
use hairpin::judgement::moves::Regression;
use hairpin_formats::junit;
use hairpin_formats::missions::Demands;
use rayon::prelude::*;

use crate::baseline::{missing, read_baseline};
use crate::budget::Part;
use crate::differences::differences;
use crate::execute::{ToJudge, attitude_unknown, reruns_to_judge, reruns_with_motion, runs_to_judge, runs_with_motion};
use crate::missions::{self, Compared, compare, read_told, with_compared};
use crate::saved::Replayed;
use crate::sets::Set;
use crate::work::{Work, keep_changes, of_another_version, open_to_change, open_to_read, same_as_executed};
use crate::{Budget, Problem};
use repros::write_repros;
use suite::suite;

/// What judging came to.
#[derive(Debug)]
pub struct Judgement {
    /// The cases' results.
    pub results: Vec<CaseResult>,
    /// The campaign's own, without saved cases.
    pub verdict: Verdict,
    /// Which of what was varied did it, the strongest first.
    pub influences: Vec<Influence>,
    /// Cases of which a flight came without attitudes.
    pub attitude_unknown: usize,
    /// Cases whose deviations are measured otherwise than when they were executed.
    pub otherwise: usize,
    /// Runs of those that are measured of the rows that are kept.
    pub from_rows: usize,
    /// Runs of those whose motion was not kept, so that they were flown anew.
    pub flown_anew: usize,
    /// Of arms: what every run did on every move.
    pub moves: Moves,
    /// Of arms with a baseline.
    pub regression: Option<Regression>,
    /// What random feasible cases came to.
    pub baseline: Option<Baseline>,
    /// Of missions made elsewhere: how stressful they are beside what a search finds.
    pub missions: Option<Compared>,
}

/// A campaign that is judged.
pub struct Judged {
    /// The campaign.
    pub work: Work,
    /// Its cases.
    pub cases: Vec<Case>,
    /// What the search did.
    pub tally: Tally,
    /// What judging came to.
    pub judgement: Judgement,
    /// What its user has to know beside that, in sentences.
    pub told: Vec<String>,
    /// Which keys of the folder's scenario were changed, in a sentence; `None` where none was.
    pub kept: Option<String>,
}

/// Judges the executed campaign in `folder`, with other values for the keys of `spec` in `sets`.
///
/// # Errors
/// Keys of other tables; cases that were not executed, or by another scenario; a file that cannot be read or written.
pub fn judge(folder: &Path, sets: &[Set]) -> Result<Judged, Problem> {
    let work = open_to_change(folder, sets, &["spec"], None)?;
    same_as_executed(&work.folder, &work.setup)?;
    let cases = work.folder.read_cases()?;
    let tally = work.folder.read_tally()?;
    let mut told: Vec<String> = Vec::new();
    let version = of_another_version(&work.folder)?;
    if !sets.is_empty() {
        if work.folder.read_baseline()?.is_some() && measures_otherwise(&work.setup, &open_to_read(folder)?.setup) {
            work.folder.forget_baseline()?;
            work.folder.forget_searched()?;
            told.push(format!(
                "the random feasible cases of {} were measured from another reference, and are removed: hairpin execute flies them anew",
                folder.display()
            ));
        }
        keep_changes(&work)?;
    }
    let judgement = judge_cases(&work, &cases, &tally, (&[], None))?;
    // What was removed just now is told already.
    if told.is_empty() {
        told.extend(missing(&work, &tally, &judgement.results)?);
    }
    told.extend(measured_anew(&judgement, cases.len()));
    told.extend(version);
    let keys: Vec<&str> = sets.iter().map(|(key, _)| key.as_str()).collect();
    let kept = (!sets.is_empty()).then(|| {
        let file = work.folder.file("scenario.toml");
        format!("{} has {} as it is given now: later judgements go by it", file.display(), keys.join(", "))
    });
    Ok(Judged { work, cases, tally, judgement, told, kept })
}

/// What was done for cases that were executed with another reference of deviations; `None` where there are none.
fn measured_anew(judgement: &Judgement, cases: usize) -> Option<String> {
    let runs = |count: usize| if count == 1 { "1 run".to_owned() } else { format!("{count} runs") };
    let (rows, anew) = (judgement.from_rows, judgement.flown_anew);
    let of_rows = format!(
        "deviations and overshoots of {} are measured of the rows that are kept, 0.1 mm from what was flown",
        runs(rows)
    );
    let by_flight = format!("{}, whose motion was not kept, flown anew", runs(anew));
    let done: Vec<String> =
        [(rows, of_rows), (anew, by_flight)].into_iter().filter(|(n, _)| *n > 0).map(|d| d.1).collect();
    (!done.is_empty()).then(|| {
        let done = done.join("; ");
        format!("{} of {cases} cases were executed with another reference of deviations: {done}", judgement.otherwise)
    })
}

/// Whether deviations are measured from another reference in `now` than `before`: what was measured of flights that are
/// not kept does not stand beside such.
fn measures_otherwise(now: &Setup, before: &Setup) -> bool {
    let reference = |setup: &Setup| {
        let terms = setup.scenario.head().terms;
        (terms.from, terms.corner)
    };
    let changed = differences(&before.scenario, &now.scenario);
    reference(now) != reference(before) || changed.iter().any(|key| key.ends_with(".from"))
}

/// A case that is judged.
struct JudgedCase {
    result: CaseResult,
    /// The deviations of its runs.
    deviations: Vec<RunDeviation>,
    /// The cells of the grid of motion that they met.
    met: BTreeSet<usize>,
    /// Whether a flight came without attitudes.
    lacks_attitude: bool,
    /// Runs that were measured of the rows that are kept, for another reference of deviations.
    from_rows: usize,
    /// Runs that were flown anew for that.
    flown_anew: usize,
    /// Runs that came to a flight.
    flown: usize,
}

impl JudgedCase {
    fn undone(case: &Case, what: Undone) -> Self {
        let result = CaseResult::undone(case.number, what);
        Self {
            result,
            deviations: Vec::new(),
            met: BTreeSet::new(),
            lacks_attitude: false,
            from_rows: 0,
            flown_anew: 0,
            flown: 0,
        }
    }
}

/// Judges every case and writes results, JUnit (with what was `replayed` before), repro files, and which parameter did
/// it. Where there is a `budget`, cases that it left no time for are told as such.
pub(crate) fn judge_cases(
    work: &Work,
    cases: &[Case],
    tally: &Tally,
    (replayed, budget): (&[Replayed], Option<&Budget>),
) -> Result<Judgement, Problem> {
    let (grid, told) = (Grid::of(&work.setup), work.told()?);
    // What a budget left undone is so until it was executed, whoever judges it anew.
    let cut = work.folder.read_results()?;
    let cut: BTreeSet<CaseNumber> =
        cut.iter().filter(|result| result.is_left_undone()).map(|result| result.case).collect();
    let missions_told = read_told(&work.folder)?;
    let asked = |case: &Case| missions_told.as_ref().and_then(|told| told.asked_of(case.number));
    let judged =
        cases.par_iter().map(|case| judge_case((work, &told), (case, asked(case)), tally, (&grid, budget, &cut)));
    let judged = judged.collect::<Result<Vec<JudgedCase>, Problem>>()?;
    let attitude_unknown = judged.iter().filter(|case| case.lacks_attitude).count();
    let otherwise = judged.iter().filter(|case| case.from_rows + case.flown_anew > 0).count();
    let (from_rows, flown_anew) =
        judged.iter().fold((0, 0), |(rows, anew), case| (rows + case.from_rows, anew + case.flown_anew));
    let flown = judged.iter().map(|case| case.flown).sum();
    let (mut results, mut deviations, mut met) = (Vec::new(), Vec::new(), Vec::new());
    for case in judged {
        results.push(case.result);
        deviations.extend(case.deviations);
        met.push(case.met);
    }
    let mut influences = campaign::influences(&work.setup.scenario, &deviations);
    influences.retain(|one| work.setup.unfelt(&one.key).is_none());
    let moves = work.setup.own::<ArmSetup>().map(|arm| arm.moves(cases, &deviations)).unwrap_or_default();
    let baseline = read_baseline(work)?;
    let verdict = campaign::verdict_on(&told, cases, (&results, baseline.as_ref()), tally, flown);
    let (verdict, regression) = with_moves(work, &moves, verdict)?;
    let missions = compare(work, &results)?;
    let verdict = with_compared(verdict, missions.as_ref());
    work.folder.write_results(cases, &results)?;
    if work.setup.has_programs() {
        work.folder.write_moves(&moves)?;
    }
    let suite = suite(work, tally, &verdict, &results, (regression.as_ref(), replayed));
    junit::write(&work.folder.file("junit.xml"), &suite, &results)?;
    write_repros(work, cases, (&results, replayed), missions_told.as_ref())?;
    work.folder.write_influences(&influences)?;
    work.folder.write_coverage(&grid.coverage(&met))?;
    Ok(Judgement {
        results,
        verdict,
        influences,
        attitude_unknown,
        otherwise,
        from_rows,
        flown_anew,
        moves,
        regression,
        baseline,
        missions,
    })
}

fn judge_case(
    (work, told): (&Work, &Setup),
    (case, asked): (&Case, Option<&Demands>),
    tally: &Tally,
    (grid, budget, cut): (&Grid, Option<&Budget>, &BTreeSet<CaseNumber>),
) -> Result<JudgedCase, Problem> {
    if budget.is_some_and(|budget| budget.end(Part::Judgement).passed()) {
        return Ok(JudgedCase::undone(case, Undone::NotJudged));
    }
    let ToJudge { runs, from_rows, flown_anew } = runs_to_judge(work, case)?;
    let is_cut = || cut.contains(&case.number) || budget.is_some_and(|budget| budget.end(Part::Search).passed());
    if runs.is_empty() && is_cut() {
        return Ok(JudgedCase::undone(case, Undone::NotExecuted));
    }
    if runs.is_empty() {
        return Err(Problem::input(format!(
            "case {} has not been executed: hairpin execute {}",
            case.id(),
            work.folder.path().display()
        )));
    }
    let (mut result, mut deviations) = campaign::judge_runs(told, case, &runs)?;
    // Missions that were made elsewhere were planned by other scenarios.
    if tally.missions.is_empty() {
        let of_plan = vary::draw_for_case(&work.setup.scenario, case.seed, case.number);
        let all = deviations.iter_mut().map(|run| &mut run.drawn).chain([&mut result.drawn]);
        all.for_each(|drawn| drawn.extend_from_slice(&of_plan));
    }
    let missing = (work.setup.scenario.executor().repeat as usize).saturating_sub(runs.len());
    if missing > 0 && work.setup.recordings().is_none() && matches!(result.status, Status::Pass | Status::Unjudged) {
        result.status = Status::Inconclusive;
        result.message = Some(format!("{missing} of {} runs not executed", missing + runs.len()));
    }
    let flown = runs.iter().filter(|run| run.outcome.is_ok()).count();
    let moved = || if flown > 0 { runs_with_motion(work, case) } else { Ok(Vec::new()) };
    missions::hold(asked, (told, case), moved, &mut result)?;
    if result.status == Status::Fail {
        result.reruns = reruns(work, case, asked)?;
    }
    let met = runs.iter().flat_map(|run| grid.met(&work.setup, &case.waypoints, run)).collect();
    let lacks_attitude = runs.iter().any(attitude_unknown);
    Ok(JudgedCase { result, deviations, met, lacks_attitude, from_rows, flown_anew, flown })
}

/// How often the violation of `case` came again; `None` where it was not run again.
fn reruns(work: &Work, case: &Case, asked: Option<&Demands>) -> Result<Option<Reruns>, Problem> {
    let mut counted = Reruns { violated: 0, of: 0 };
    let again = match asked {
        Some(_) => reruns_with_motion(work, case)?,
        None => reruns_to_judge(work, case)?,
    };
    for run in &again {
        let run = std::slice::from_ref(run);
        let mut result = campaign::judge(&work.setup, case, run)?;
        missions::hold(asked, (&work.setup, case), || Ok(run.to_vec()), &mut result)?;
        match result.status {
            Status::Fail => (counted.violated, counted.of) = (counted.violated + 1, counted.of + 1),
            Status::Pass | Status::Unjudged => counted.of += 1,
            // What was not flown, or cannot be judged, is no answer.
            Status::ExecutorFailed | Status::Inconclusive => {}
        }
    }
    Ok((!again.is_empty()).then_some(counted))
}

/// The verdict by the limits, with what an arm's baseline and the recordings' clocks say. The new release is called
/// after the campaign's folder.
pub(crate) fn with_moves(
    work: &Work,
    moves: &Moves,
    verdict: Verdict,
) -> Result<(Verdict, Option<Regression>), Problem> {
    let Some(arm) = work.setup.own::<ArmSetup>().filter(|_| !moves.cases.is_empty()) else {
        return Ok((verdict, None));
    };
    let path = std::fs::canonicalize(work.folder.path()).unwrap_or_else(|_| work.folder.path().to_owned());
    let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let regression = arm.regression(moves, &name);
    let regression = regression.map_err(|error| Problem::input(format!("`spec.regression`: {error}")))?;
    Ok((arm.verdict_with(verdict, moves, regression.as_ref()), regression))
}
