//! The runs of a case as the judge needs them: what was measured of them, or else their motion.

use hairpin::campaign::judge::is_at_full_rate;
use hairpin::campaign::{Case, Run};

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
    let runs = work.folder.read_measured(case.number)?;
    match are_measured(work, case, &runs)? {
        true => Ok(ToJudge { runs, from_rows: false }),
        false => Ok(ToJudge { runs: work.folder.read_runs(case.number)?, from_rows: true }),
    }
}

/// The same of those that were flown again.
pub(crate) fn reruns_to_judge(work: &Work, case: &Case) -> Result<Vec<Run>, Problem> {
    let runs = work.folder.read_measured_reruns(case.number)?;
    if are_measured(work, case, &runs)? { Ok(runs) } else { Ok(work.folder.read_reruns(case.number)?) }
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
