//! Jobs that begin from a campaign's folder.

use std::collections::HashMap;
use std::path::PathBuf;

use hairpin::campaign::report::{violation, worst_first};
use hairpin::campaign::{CaseNumber, CaseResult};
use hairpin::judgement::Stress;
use hairpin_cli::commands::answer::Answer;
use hairpin_cli::commands::verify as said_of;
use hairpin_jobs::Problem;
use hairpin_jobs::compare::Compared;
use hairpin_jobs::execute::ExecuteSettings;
use hairpin_jobs::judge::Judged;
use hairpin_jobs::learn::Learned;
use hairpin_jobs::sets::Set;
use hairpin_jobs::shrink::{ShrinkSettings, Shrinking};
use hairpin_jobs::work::open_to_read;
use pyo3::prelude::*;
use serde_json::{Value, json};

use crate::plain::object;
use crate::problem::{raised, wrong};
use crate::settings::Means;
use crate::wait::Waiting;

/// What is executed.
#[derive(FromPyObject)]
pub(crate) struct Flights {
    folder: PathBuf,
    out: Option<PathBuf>,
    replaces: bool,
    sets: Vec<Set>,
    missions: Option<PathBuf>,
    repro: Option<PathBuf>,
    resume: bool,
}

/// Executes the cases of a folder; gives counts, and why the first run that was not carried out was not.
#[pyfunction]
pub(crate) fn execute(py: Python<'_>, flights: Flights, means: Means, waiting: Waiting) -> PyResult<Bound<'_, PyAny>> {
    let Flights { folder, out, replaces, sets, missions, repro, resume } = flights;
    let (simd, consent) = (means.simd(), means.consent());
    let settings = ExecuteSettings { folder, out, replaces, sets, missions, repro, resume, simd, consent };
    let said = waiting.wait(py, |watch| {
        let executed = hairpin_jobs::execute::execute(&settings, watch)?;
        let flown = executed.flown;
        Ok(json!({
            "folder": executed.folder, "cases": executed.cases, "runs": flown.runs, "executor_failed": flown.failed,
            "attitude_unknown": flown.attitude_unknown, "trouble": executed.trouble, "missions": executed.missions,
        }))
    })?;
    object(py, &said)
}

/// Judges an executed folder; gives what `judge --json` says, and beside it what its user has to know.
#[pyfunction]
pub(crate) fn judge(py: Python<'_>, folder: PathBuf, sets: Vec<Set>, waiting: Waiting) -> PyResult<Bound<'_, PyAny>> {
    let said = waiting.wait(py, |watch| {
        let Judged { work, cases, tally, judgement, told, kept } = &hairpin_jobs::judge::judge(&folder, &sets)?;
        told.iter().chain(kept).for_each(|line| watch.warn(line));
        let answer = Answer {
            work,
            cases,
            tally,
            judgement,
            verdict: &judgement.verdict,
            replayed: &[],
            spent: None,
            junit: None,
            reported: false,
        };
        Ok(answer.object())
    })?;
    object(py, &said)
}

/// Integrates every witness by independent code; gives what `verify --json` says.
#[pyfunction]
pub(crate) fn verify(py: Python<'_>, folder: PathBuf, waiting: Waiting) -> PyResult<Bound<'_, PyAny>> {
    let said = waiting.wait(py, |_| {
        let verified = hairpin_jobs::verify::verify(&folder)?;
        Ok(said_of::object(&verified, u8::from(verified.has_findings())))
    })?;
    object(py, &said)
}

/// Reduces a violating case; gives both numbers, the repro file, and whether it is finished.
#[pyfunction]
pub(crate) fn shrink<'py>(
    py: Python<'py>,
    asked: (PathBuf, usize),
    effort: (u64, Option<f64>, Option<PathBuf>),
    means: Means,
    waiting: Waiting,
) -> PyResult<Bound<'py, PyAny>> {
    let ((folder, case), (budget, time_limit_s, out)) = (asked, effort);
    let (simd, consent) = (means.simd(), means.consent());
    let settings = ShrinkSettings { folder, case: CaseNumber(case), budget, time_limit_s, out, simd, consent };
    let said = waiting.wait(py, |watch| {
        let shrinking = Shrinking::open(settings)?;
        let found = shrinking.search(watch)?;
        if watch.stopped() {
            let target = found.target.display();
            return Err(Problem::Interrupted(format!("stopped; {target} is kept, the same call goes on")));
        }
        let small = &found.shrunk;
        let points = |case: &hairpin::campaign::Case| -> Vec<[f64; 3]> {
            case.waypoints.iter().map(|point| point.coords.into()).collect()
        };
        let told = |result: &CaseResult| result.violations.iter().map(violation).collect::<Vec<_>>();
        Ok(json!({
            "case": small.case.id(), "repro": found.target, "runs": found.runs, "runs_now": found.fresh,
            "waypoints_before_m": points(&shrinking.case), "waypoints_m": points(&small.case),
            "violations_before": told(&shrinking.result), "violations": told(&small.result),
            "evidence": small.case.evidence.word(), "simplified": small.simplified, "finished": small.finished,
        }))
    })?;
    object(py, &said)
}

/// Pairs two judged folders by case and seed; gives what `compare --json` says.
#[pyfunction]
pub(crate) fn compare<'py>(
    py: Python<'py>,
    folders: (PathBuf, PathBuf),
    tolerance_m: f64,
    waiting: Waiting,
) -> PyResult<Bound<'py, PyAny>> {
    let said = waiting.wait(py, |_| {
        let Compared { comparison, differences, told } =
            hairpin_jobs::compare::compare(&folders.0, &folders.1, tolerance_m)?;
        let mut said = json!(comparison);
        said["verdict"] = json!(comparison.sentence());
        said["regression"] = json!(comparison.regresses());
        said["inconclusive"] = json!(comparison.inconclusive());
        said["scenario_differences"] = json!(differences);
        said["notes"] = json!(told);
        Ok(said)
    })?;
    object(py, &said)
}

/// Learns a score from executed folders into the file `out`.
#[pyfunction]
pub(crate) fn learn<'py>(
    py: Python<'py>,
    files: (Vec<PathBuf>, PathBuf),
    stress: &str,
    waiting: Waiting,
) -> PyResult<Bound<'py, PyAny>> {
    let (folders, out) = files;
    let Some(stress) = Stress::from_word(stress) else {
        let bound = Stress::ALL.map(Stress::word).join(", ");
        return Err(wrong(py, &format!("`stress` = {stress:?}, must be one of {bound}"), "stress", stress, &bound));
    };
    let said = waiting.wait(py, |_| {
        let Learned { model, score_key, .. } = hairpin_jobs::learn::learn(&folders, &out, stress)?;
        Ok(json!({
            "model": out, "score_key": score_key, "unit": model.unit, "trajectories": model.trajectories,
            "legs": model.legs, "validation": model.validation, "held_out": model.held_out,
        }))
    })?;
    object(py, &said)
}

/// Writes the report of a judged folder anew, and gives the place of the file.
#[pyfunction]
pub(crate) fn report(
    py: Python<'_>,
    folder: PathBuf,
    asked: Vec<usize>,
    waiting: Waiting,
) -> PyResult<Bound<'_, PyAny>> {
    let said = waiting.wait(py, |_| Ok(json!(hairpin_jobs::report::report(&folder, &asked, None)?.path)))?;
    object(py, &said)
}

/// What a folder holds of its cases, as far as it goes: a dictionary each.
#[pyfunction]
pub(crate) fn read(py: Python<'_>, folder: PathBuf) -> PyResult<Bound<'_, PyAny>> {
    let found = py.detach(|| -> Result<Value, Problem> {
        let work = open_to_read(&folder)?;
        let rows: HashMap<_, _> = work.folder.read_rows()?.into_iter().map(|row| (row.case.number, row)).collect();
        let results: Vec<CaseResult> = rows.values().filter_map(|row| row.result.clone()).collect();
        let cases = work.folder.read_cases_without_profiles()?;
        let limits: Vec<String> = work.setup.scenario.head().limits.iter().map(ToString::to_string).collect();
        let of_case = |case: &hairpin::campaign::Case| {
            let result = rows.get(&case.number).and_then(|row| row.result.as_ref());
            let measures = result.and_then(|result| result.measures.as_ref());
            let waypoints: Vec<[f64; 3]> = case.waypoints.iter().map(|point| point.coords.into()).collect();
            json!({
                "case": case.id(), "seed": case.seed, "evidence": case.claim(), "score": case.score,
                "waypoints_m": waypoints,
                "status": result.map_or("generated", |result| result.status.word()),
                "run": result.map(|result| result.run), "ended": result.map(|result| &result.ended),
                "message": result.and_then(|result| result.message.as_ref()),
                "max_deviation_m": measures.map(|m| m.max_deviation),
                "mean_deviation_m": measures.map(|m| m.mean_deviation),
                "t_worst_s": measures.map(|m| m.t_worst), "leg_worst": measures.map(|m| m.leg_worst),
                "violations": result.map_or_else(Vec::new, |result| result.violations.iter().map(|found| json!({
                    "what": found.what, "value": found.value, "limit": found.limit, "told": violation(found),
                })).collect()),
            })
        };
        Ok(json!({
            "folder": folder, "robot": work.setup.robot_name(), "controller": work.setup.controller(),
            "limits": limits, "repeat": work.setup.scenario.executor().repeat, "judged": !rows.is_empty() && rows.values().all(|row| row.result.is_some()),
            "cases": cases.iter().map(of_case).collect::<Vec<_>>(),
            "worst_first": worst_first(&results).iter().map(|result| result.case.0).collect::<Vec<_>>(),
        }))
    });
    object(py, &found.map_err(|problem| raised(py, &problem))?)
}
