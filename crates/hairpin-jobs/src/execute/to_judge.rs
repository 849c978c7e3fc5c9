//! The runs of a case as the judge needs them: what was measured of them, or else their motion.

use hairpin::campaign::judge::is_at_full_rate;
use hairpin::campaign::{Case, Run};

use super::kept::{reruns_with_motion, runs_with_motion};
use crate::Problem;
use crate::work::Work;

/// The runs of a case.
pub(crate) struct ToJudge {
    pub(crate) runs: Vec<Run>,
    /// Whether the scenario measures otherwise than it did when they were flown, so that they are measured of the
    /// rows that are kept.
    pub(crate) from_rows: bool,
}

/// The runs of `case` with what was measured of them; with their motion where that is asked for otherwise.
pub(crate) fn runs_to_judge(work: &Work, case: &Case) -> Result<ToJudge, Problem> {
    if let Some(runs) = work.folder.read_measured(case.number)?
        && are_measured(work, case, &runs)?
    {
        return Ok(ToJudge { runs, from_rows: false });
    }
    let runs = runs_with_motion(work, case)?;
    Ok(ToJudge { from_rows: !are_measured(work, case, &runs)?, runs })
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
    for run in runs.iter().filter(|run| run.full_rate.is_some()) {
        if !is_at_full_rate(&work.setup, case, run)? {
            return Ok(false);
        }
    }
    Ok(true)
}
