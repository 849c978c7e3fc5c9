//! `hairpin judge`: the verdict on the flights of a campaign folder.

use super::parts::{self, Answer};
use crate::args::Judge;
use crate::folder;
use crate::problem::Problem;

/// Runs the command.
pub(crate) fn run(judge: &Judge) -> Result<u8, Problem> {
    folder::take_threads(&judge.threads);
    let sets = folder::split(&judge.sets)?;
    let work = folder::open(&judge.folder, &sets, &["spec"], None)?;
    let cases = work.folder.read_cases()?;
    let tally = work.folder.read_tally()?;
    if !sets.is_empty() {
        folder::keep_changes(&work)?;
    }
    let judgement = parts::judge(&work, &cases, &tally, &[])?;
    let asked = tally.asked(work.setup.scenario.search().cases);
    let verdict = &judgement.verdict;
    let answer = Answer { work: &work, asked, cases: &cases, judgement: &judgement, verdict, replayed: &[] };
    Ok(answer.say(judge.json))
}
