//! `hairpin judge`: the verdict on the flights of a campaign folder, or on logs of real ones.

use hairpin_jobs::judge::{Judged, judge};
use hairpin_jobs::judge_log::Against;
use hairpin_jobs::{Problem, Watch};

use super::answer::Answer;
use super::{judge_log, junit};
use crate::args::{AltitudeName, Judge};
use crate::{console, settings};

/// Runs the command.
pub(crate) fn run(asked: &Judge, watch: &dyn Watch) -> Result<u8, Problem> {
    settings::take_threads(&asked.threads);
    junit::check(asked.junit.path())?;
    if let Some(against) = against(asked)? {
        return judge_log::run(asked, against, watch);
    }
    let Judged { work, cases, tally, judgement, told, kept } = &judge(&asked.path, &settings::split(&asked.sets)?)?;
    told.iter().for_each(|line| console::warn(&format!("Warning: {line}")));
    junit::keep(asked.junit.path(), work)?;
    let (verdict, junit) = (&judgement.verdict, asked.junit.path());
    let answer = Answer { work, cases, tally, judgement, verdict, replayed: &[], spent: None, junit, reported: false };
    let code = answer.say(asked.json);
    // Of the folder, not of the verdict, which comes first.
    kept.iter().for_each(|line| console::warn(line));
    Ok(code)
}

/// What logs are judged against; `None` where a campaign's folder is judged.
fn against(asked: &Judge) -> Result<Option<Against>, Problem> {
    let against = match (&asked.campaign, &asked.mission) {
        (Some(folder), _) => Some(Against::Campaign(folder.clone())),
        (None, Some(file)) => Some(Against::Mission { file: file.clone(), robot: asked.robot.clone() }),
        (None, None) => None,
    };
    let of_logs = asked.world.is_some() || asked.source.is_some() || asked.from.is_some() || asked.to.is_some();
    if against.is_none() && asked.page.is_some() && !asked.path.is_file() {
        return Err(Problem::input(format!(
            "--page is of logs; hairpin report {} writes a campaign's",
            asked.path.display()
        )));
    }
    let named = asked.turn != 0.0 || asked.offset != [0.0; 3] || asked.altitude != AltitudeName::Relative;
    if against.is_none() && (asked.path.is_file() || of_logs || named) {
        return Err(Problem::input(format!(
            "{} is not a campaign folder; a log is judged against a campaign's cases, --campaign OUT, or one mission, --mission M",
            asked.path.display()
        )));
    }
    Ok(against)
}
