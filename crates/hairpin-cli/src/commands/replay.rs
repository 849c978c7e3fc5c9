//! `hairpin replay`: a recorded violation, flown again.

use std::path::Path;

use hairpin::campaign::{self, Setup, Status};
use hairpin_formats::scenario;
use serde_json::json;

use super::parts::{Repro, fly_one};
use crate::args::Replay;
use crate::problem::Problem;
use crate::{console, folder};

/// Our own simulator repeats a run to the bit, at any SIMD level; executors of the users' need not.
const SAME_M: f64 = 1e-6;

/// Runs the command: 1 when it violates again, 0 when it does not, 4 when the executor failed.
pub(crate) fn run(replay: &Replay) -> Result<u8, Problem> {
    let repro = Repro::read(&replay.file)?;
    let refuse = |why: String| Problem::input(format!("{}: {why}", replay.file.display()));
    let resolved = scenario::attach(repro.scenario.clone(), replay.file.parent().unwrap_or(Path::new("")))?;
    let setup = Setup::new(resolved).map_err(|mistake| refuse(format!("scenario.{mistake}")))?;
    let setup = setup.with_simd(folder::simd(&replay.kernels));
    let case = repro.case().map_err(refuse)?;
    let flown = fly_one(&setup, &case, repro.run)?;
    let result = campaign::judge(&setup, &case, std::slice::from_ref(&flown))?;
    let deviation = result.measures.as_ref().map(|measures| measures.max_deviation);
    let expected = repro.expected.max_deviation_m;
    let same = deviation.is_some_and(|deviation| (deviation - expected).abs() <= SAME_M);
    let again: Vec<String> = result.violations.iter().map(campaign::report::violation).collect();
    let was = repro.expected.violations.join("; ");
    let (code, sentence) = match result.status {
        Status::Fail if same => (1, format!("FAIL 1/1: reproduces: {}", again.join("; "))),
        Status::Fail => (1, format!("FAIL 1/1: violates again, but not equally: {} (was: {was})", again.join("; "))),
        Status::Pass => (0, format!("PASS 1/1: does not reproduce: no violation now (was: {was})")),
        Status::ExecutorFailed => (4, format!("EXECUTOR FAILED 1/1: {}", result.message.clone().unwrap_or_default())),
        Status::Inconclusive => (5, format!("INCONCLUSIVE 1/1: {}", result.message.clone().unwrap_or_default())),
    };
    if replay.json {
        let object = json!({
            "verdict": sentence, "exit_code": code, "case": repro.case, "run": repro.run,
            "reproduces": result.status == Status::Fail && same, "violates": result.status == Status::Fail,
            "max_deviation_m": deviation, "expected_max_deviation_m": expected,
        });
        console::say(&object.to_string());
    } else {
        console::say(&sentence);
    }
    Ok(code)
}
