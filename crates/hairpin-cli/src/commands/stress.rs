//! `hairpin stress`: generate, execute, judge, report.

use super::parts::{self, Answer, Replayed};
use crate::args::Stress;
use crate::folder::{self, Work};
use crate::interrupt::Deadline;
use crate::problem::Problem;

/// Runs the command.
pub(crate) fn run(stress: &Stress) -> Result<u8, Problem> {
    let planned = folder::plan(&stress.campaign, stress.executor.as_deref())?;
    let deadline = Deadline::after(stress.campaign.time_limit);
    // Before anything of an older campaign in the folder is replaced: a saved case may turn out to be none.
    let replayed = parts::replay_saved(&planned.setup, &planned.path, stress.saved.repro.as_deref())?;
    let work = planned.begin()?;
    campaign(&work, deadline, &replayed, stress.campaign.json)
}

/// The whole campaign in an open folder, after what was `replayed`.
pub(crate) fn campaign(work: &Work, deadline: Deadline, replayed: &[Replayed], json: bool) -> Result<u8, Problem> {
    let (cases, tally) = parts::generate(work, deadline)?;
    parts::execute(work, &cases)?;
    let judgement = parts::judge(work, &cases, &tally, replayed)?;
    let verdict = parts::with_saved(&judgement.verdict, replayed);
    parts::report(work, &cases, &tally, &verdict, (&judgement.moves, judgement.regression.as_ref()))?;
    let asked = tally.asked(work.setup.scenario.search().cases);
    let answer = Answer { work, asked, cases: &cases, judgement: &judgement, verdict: &verdict, replayed };
    Ok(answer.say(json))
}
