//! `hairpin replay`: a recorded violation, flown again.

use hairpin::campaign::Status;
use hairpin::campaign::report::violation;
use hairpin_jobs::replay::{replay, replay_case};
use hairpin_jobs::{Problem, Watch};
use serde_json::json;

use crate::args::Replay;
use crate::exit::{DONE, EXECUTOR_FAILED, FINDING, INCONCLUSIVE};
use crate::{console, settings};

/// Runs the command: 1 when it violates again, 0 when it does not, 4 when the executor failed.
pub(crate) fn run(asked: &Replay, watch: &dyn Watch) -> Result<u8, Problem> {
    let consent = settings::consent(&asked.commands);
    let simd = settings::simd(&asked.kernels);
    let replayed = match &asked.case {
        None => replay(&asked.file, simd, &consent, watch)?,
        Some(case) => {
            let number =
                case.parse().map_err(|_| Problem::input(format!("--case {case}: must be a case such as 0007")))?;
            replay_case((&asked.file, number), simd, &consent, watch)?
        }
    };
    let (repro, result) = (&replayed.repro, &replayed.result);
    let again: Vec<String> = result.violations.iter().map(violation).collect();
    let message = result.message.as_deref().unwrap_or_default();
    let was = match &repro.expected.violations[..] {
        [] => "no violation".to_owned(),
        violations => violations.join("; "),
    };
    let (code, sentence) = match result.status {
        Status::Fail if replayed.same => (FINDING, format!("FAIL 1/1: reproduces: {}", again.join("; "))),
        Status::Fail if replayed.was_fine() => {
            (FINDING, format!("FAIL 1/1: violates now: {} (was: {was})", again.join("; ")))
        }
        Status::Fail => {
            (FINDING, format!("FAIL 1/1: violates again, but not equally: {} (was: {was})", again.join("; ")))
        }
        Status::Pass if replayed.reproduces() => (DONE, "PASS 1/1: as before: no violation".into()),
        Status::Pass if replayed.was_fine() => (DONE, "PASS 1/1: not equally, but no violation as before".into()),
        Status::Unjudged if replayed.reproduces() => {
            (DONE, "UNJUDGED 1: as before: no crash, and no more was asked for".into())
        }
        Status::Pass => (DONE, format!("PASS 1/1: does not reproduce: no violation now (was: {was})")),
        Status::Unjudged => {
            (DONE, format!("UNJUDGED 1: does not reproduce: no crash now, and no more was asked for (was: {was})"))
        }
        Status::ExecutorFailed => (EXECUTOR_FAILED, format!("EXECUTOR FAILED 1/1: {message}")),
        Status::Inconclusive => (INCONCLUSIVE, format!("INCONCLUSIVE 1/1: {message}")),
    };
    let sentence = match &replayed.another {
        Some(another) => format!("{sentence}; {another}"),
        None => sentence,
    };
    if asked.json {
        let object = json!({
            "verdict": sentence, "exit_code": code, "case": repro.case, "run": repro.run,
            "reproduces": replayed.reproduces(), "violates": result.status == Status::Fail,
            "max_deviation_m": result.measures.as_ref().map(|measures| measures.max_deviation),
            "expected_max_deviation_m": repro.expected.max_deviation_m,
        });
        console::say(&object.to_string());
    } else {
        console::say(&sentence);
    }
    Ok(code)
}
