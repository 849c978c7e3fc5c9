//! The runs of a case as the judge needs them: what was measured of them, or else their motion.

use hairpin::campaign::judge::is_at_full_rate;
use hairpin::campaign::{Case, Run};

use super::kept::{reruns_with_motion, runs_with_motion};
use crate::Problem;
use crate::work::Work;

/// The runs of a case.
pub(crate) struct ToJudge {
    pub(crate) runs: Vec<Run>,
    /// How many of them have their deviations measured of the rows that are kept, for the scenario measures otherwise
    /// than it did when they were flown.
    pub(crate) from_rows: usize,
    /// How many were flown anew for that, their motion not being kept.
    pub(crate) flown_anew: usize,
}

/// The runs of `case` with what was measured of them; with their motion where that is asked for otherwise.
pub(crate) fn runs_to_judge(work: &Work, case: &Case) -> Result<ToJudge, Problem> {
    let measured = work.folder.read_measured(case.number)?;
    let otherwise = measured.is_some();
    if let Some(runs) = measured
        && are_measured(work, case, &runs)?
    {
        return Ok(ToJudge { runs, from_rows: 0, flown_anew: 0 });
    }
    let runs = runs_with_motion(work, case)?;
    let left_out = || Ok::<_, Problem>(work.folder.facts_of(case.number)?.iter().filter(|run| !run.is_kept()).count());
    let flown_anew = if otherwise { left_out()? } else { 0 };
    Ok(ToJudge { from_rows: measured_otherwise(work, case, &runs)?, flown_anew, runs })
}

/// The runs of `case` with what was measured of them when they were flown; with their motion where nothing was.
pub(crate) fn measured_runs(work: &Work, case: &Case) -> Result<Vec<Run>, Problem> {
    work.folder.read_measured(case.number)?.map_or_else(|| runs_with_motion(work, case), Ok)
}

/// As [`runs_to_judge`] those that were flown again.
pub(crate) fn reruns_to_judge(work: &Work, case: &Case) -> Result<Vec<Run>, Problem> {
    match work.folder.read_measured_reruns(case.number)? {
        Some(runs) if are_measured(work, case, &runs)? => Ok(runs),
        _ => reruns_with_motion(work, case),
    }
}

/// Whether what was measured of `runs`, where it was, is what the scenario asks for.
fn are_measured(work: &Work, case: &Case, runs: &[Run]) -> Result<bool, Problem> {
    Ok(measured_otherwise(work, case, runs)? == 0)
}

/// How many of `runs` were measured otherwise than the scenario asks for.
fn measured_otherwise(work: &Work, case: &Case, runs: &[Run]) -> Result<usize, Problem> {
    let mut count = 0;
    for run in runs.iter().filter(|run| run.full_rate.is_some()) {
        count += usize::from(!is_at_full_rate(&work.setup, case, run)?);
    }
    Ok(count)
}
