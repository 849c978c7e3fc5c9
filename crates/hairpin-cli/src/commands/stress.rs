//! `hairpin stress`: generate, execute, judge, report.

use std::path::Path;

use hairpin_jobs::stress::{Stressed, stress, stress_missions};
use hairpin_jobs::{Problem, Watch};

use super::answer::Answer;
use super::junit;
use crate::args::Stress;
use crate::settings;

/// Runs the command.
pub(crate) fn run(asked: &Stress, watch: &dyn Watch) -> Result<u8, Problem> {
    settings::take_threads(&asked.campaign.threads);
    let mut settings = settings::campaign(&asked.campaign, asked.executor.as_deref())?;
    settings.sets.extend(settings::record(&asked.kept));
    settings.budget_s = asked.budget;
    junit::check(asked.junit.path())?;
    let repro = asked.saved.repro.as_deref();
    let stressed = match &asked.missions {
        Some(missions) => stress_missions(&settings, missions, repro, watch)?,
        None => stress(&settings, repro, watch)?,
    };
    junit::keep(asked.junit.path(), &stressed.work)?;
    Ok(say(&stressed, asked.junit.path(), asked.campaign.json))
}

/// Says what came of a whole campaign, and gives the exit code.
pub(super) fn say(stressed: &Stressed, junit: Option<&Path>, json: bool) -> u8 {
    let Stressed { work, cases, tally, judgement, verdict, replayed, spent } = stressed;
    Answer { work, cases, tally, judgement, verdict, replayed, spent: spent.as_ref(), junit, reported: true }.say(json)
}
