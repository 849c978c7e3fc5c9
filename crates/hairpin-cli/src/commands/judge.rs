//! `hairpin judge`: the verdict on the flights of a campaign folder.

use hairpin_jobs::Problem;
use hairpin_jobs::judge::{Judged, judge};

use super::answer::Answer;
use crate::args::Judge;
use crate::{console, settings};

/// Runs the command.
pub(crate) fn run(asked: &Judge) -> Result<u8, Problem> {
    settings::take_threads(&asked.threads);
    let Judged { work, cases, tally, judgement, told } = &judge(&asked.folder, &settings::split(&asked.sets)?)?;
    told.iter().for_each(|line| console::warn(&format!("Warning: {line}")));
    let answer = Answer { work, cases, tally, judgement, verdict: &judgement.verdict, replayed: &[] };
    Ok(answer.say(asked.json))
}
