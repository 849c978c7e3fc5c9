//! `hairpin stress`: generate, execute, judge, report.

use hairpin::judgement::Verdict;

use super::parts::{self, Answer};
use crate::args::Stress;
use crate::folder::{self, Work};
use crate::interrupt::Deadline;
use crate::problem::Problem;

/// Runs the command.
pub(crate) fn run(stress: &Stress) -> Result<u8, Problem> {
    let work = folder::begin(&stress.campaign, stress.executor.as_deref())?;
    campaign(&work, Deadline::after(stress.campaign.time_limit), stress.campaign.json)
}

/// The whole campaign in an open folder.
pub(crate) fn campaign(work: &Work, deadline: Deadline, json: bool) -> Result<u8, Problem> {
    let (cases, tally) = parts::generate(work, deadline)?;
    parts::execute(work, &cases)?;
    let (results, verdict): (_, Verdict) = parts::judge(work, &cases, &tally)?;
    parts::report(work, &cases, &tally, &verdict)?;
    let asked = work.setup.scenario.generate.search.cases as usize;
    let answer = Answer { folder: work.folder.path(), asked, cases: &cases, results: &results, verdict: &verdict };
    Ok(answer.say(json))
}
