//! `hairpin stress`: generate, execute, judge, report.

use hairpin_jobs::stress::{Stressed, stress, stress_missions};
use hairpin_jobs::{Problem, Watch};

use super::answer::Answer;
use crate::args::Stress;
use crate::settings;

/// Runs the command.
pub(crate) fn run(asked: &Stress, watch: &dyn Watch) -> Result<u8, Problem> {
    settings::take_threads(&asked.campaign.threads);
    let mut settings = settings::campaign(&asked.campaign, asked.executor.as_deref())?;
    settings.sets.extend(settings::record(&asked.kept));
    let repro = asked.saved.repro.as_deref();
    let stressed = match &asked.missions {
        Some(missions) => stress_missions(&settings, missions, repro, watch)?,
        None => stress(&settings, repro, watch)?,
    };
    Ok(say(&stressed, asked.campaign.json))
}

/// Says what came of a whole campaign, and gives the exit code.
pub(super) fn say(stressed: &Stressed, json: bool) -> u8 {
    let Stressed { work, cases, tally, judgement, verdict, replayed } = stressed;
    Answer { work, cases, tally, judgement, verdict, replayed }.say(json)
}
