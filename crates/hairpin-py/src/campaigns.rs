//! Jobs that begin from a scenario.

use std::path::PathBuf;

use hairpin::campaign;
use hairpin_cli::commands::answer::Answer;
use hairpin_formats::scenario::setup_for;
use hairpin_jobs::explain::ExplainSettings;
use hairpin_jobs::generate::Generated;
use hairpin_jobs::sets::Set;
use hairpin_jobs::stress::{Stressed, stress_missions};
use pyo3::prelude::*;
use serde_json::json;

use crate::plain::object;
use crate::problem::raised;
use crate::settings::{Begun, Means};
use crate::wait::Waiting;

/// A whole campaign; gives what `stress --json` says.
#[pyfunction]
pub(crate) fn stress<'py>(
    py: Python<'py>,
    begun: Begun,
    given: (Option<PathBuf>, Option<PathBuf>),
    means: Means,
    waiting: Waiting,
) -> PyResult<Bound<'py, PyAny>> {
    let ((missions, repro), settings) = (given, begun.settings(&means));
    let said = waiting.wait(py, |watch| {
        let stressed = match &missions {
            Some(missions) => stress_missions(&settings, missions, repro.as_deref(), watch)?,
            None => hairpin_jobs::stress::stress(&settings, repro.as_deref(), watch)?,
        };
        let Stressed { work, cases, tally, judgement, verdict, replayed, spent } = &stressed;
        Ok(Answer {
            work,
            cases,
            tally,
            judgement,
            verdict,
            replayed,
            spent: spent.as_ref(),
            junit: None,
            reported: true,
        }
        .object())
    })?;
    object(py, &said)
}

/// The cases alone; gives their number, and the verdict where there are none.
#[pyfunction]
pub(crate) fn generate(py: Python<'_>, begun: Begun, means: Means, waiting: Waiting) -> PyResult<Bound<'_, PyAny>> {
    let settings = begun.settings(&means);
    let said = waiting.wait(py, |watch| {
        let Generated { work, cases, tally } = hairpin_jobs::generate::generate(&settings, watch)?;
        let none = cases.is_empty() && !tally.stopped;
        let verdict = none.then(|| campaign::verdict(&work.setup, &cases, (&[], None), &tally));
        Ok(json!({
            "folder": work.folder.path(),
            "cases": cases.len(),
            "verdict": verdict.as_ref().map(|verdict| &verdict.sentence),
            "exit_code": verdict.as_ref().map_or(0, |verdict| verdict.exit_code),
        }))
    })?;
    object(py, &said)
}

/// Why nothing, or little, is feasible; gives what `explain --json` says.
#[pyfunction]
pub(crate) fn explain<'py>(
    py: Python<'py>,
    asked: (String, Vec<Set>),
    effort: (u64, Option<f64>),
    means: Means,
    waiting: Waiting,
) -> PyResult<Bound<'py, PyAny>> {
    let ((scenario, sets), (graphs, time_limit_s)) = (asked, effort);
    let (simd, consent) = (means.simd(), means.consent());
    let settings = ExplainSettings { scenario, sets, graphs, time_limit_s, simd, consent };
    let said = waiting.wait(py, |watch| {
        let (found, verdict) = hairpin_jobs::explain::explain(&settings, watch)?;
        let mut said = json!(found);
        said["verdict"] = json!(verdict.sentence);
        said["exit_code"] = json!(verdict.exit_code);
        Ok(said)
    })?;
    object(py, &said)
}

/// Of what `scenario` is about the key of its score, and how many processes fly, if it says so.
#[pyfunction]
pub(crate) fn facts(py: Python<'_>, scenario: &str, sets: Vec<Set>) -> PyResult<(&'static str, Option<u64>)> {
    let setup = py.detach(|| setup_for(scenario, &sets));
    let found = setup.map(|setup| (setup.scenario.score_key(), setup.scenario.executor().processes));
    found.map_err(|report| raised(py, &report.into()))
}
