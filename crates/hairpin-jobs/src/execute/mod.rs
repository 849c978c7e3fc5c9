//! Execution: the flights of a campaign whose trajectories are there, or of waypoint files made elsewhere.

mod before;
mod beside;
mod by_case;
mod fly;
mod in_loop;
mod job;
mod kept;
mod missing;
mod recorded;
mod settings;
#[cfg(test)]
mod tests;
mod to_judge;
mod worst;

use std::path::Path;

use hairpin::campaign::Tally;
use hairpin::judgement::Chosen;
use hairpin_formats::folder::CampaignFolder;

use crate::baseline::fly_baseline;
use crate::consent::Wish;
use crate::missions::{self, adopt};
use crate::saved::replay_saved;
use crate::work::{
    IfThere, changed, check_tables, keep_changes, open_to_change, open_to_read, same_as_executed, tell_share, try_out,
};
use crate::{Deadline, Problem, Watch};
use before::{CHANGED, failed_before, searched_before, tell_edited, tell_failed, unchanged};
use beside::beside;
pub(crate) use by_case::fly_by_case;
use fly::first_trouble;
pub use fly::fly_each;
pub(crate) use fly::{command_of, fly_one, fly_together, fly_told};
pub(crate) use in_loop::{Asked, in_the_loop};
pub(crate) use job::comes_again;
pub(crate) use kept::{reruns_with_motion, run_with_motion, runs_with_motion, why_lost};
pub use missing::Flown;
use missing::{all_flown, count_reruns};
pub(crate) use missing::{attitude_unknown, count_flown, fly_missing};
pub(crate) use recorded::check_recordings;
pub use settings::{ExecuteSettings, Executed};
pub(crate) use to_judge::{ToJudge, measured_runs, reruns_to_judge, runs_to_judge};
pub(crate) use worst::WORST;

/// Executes a campaign; runs that fail are told in numbers.
///
/// # Errors
/// Settings that do not fit the folder, or a folder that asks to run what its user has not allowed; missions,
/// recordings or saved cases that cannot be used; a file that cannot be written; it was asked to stop.
pub fn execute(settings: &ExecuteSettings, watch: &dyn Watch) -> Result<Executed, Problem> {
    let ExecuteSettings { folder, sets, .. } = settings;
    let path = settings.out.as_ref().unwrap_or(folder);
    // What the cases of another folder are flown by is told as of this one's.
    let mut edited_there = Vec::new();
    // Who resumes goes on where the cases are already.
    if settings.out.is_some() && !(settings.resume && CampaignFolder::open(path).is_ok()) {
        let if_there = if settings.replaces { IfThere::Replace } else { IfThere::Refuse };
        check_tables(sets, CHANGED)?;
        if let Some(missions) = &settings.missions {
            // What is in `out` makes room only for what can take its place.
            missions::of_files(&open_to_read(folder)?.setup, missions)?;
        }
        if !sets.is_empty() {
            let setup = changed(&CampaignFolder::open(folder)?, sets)?.answered_by(&settings.consent.code)?;
            // What is typed runs anyway: what does not load makes no room.
            if Wish::of_execution(&setup).iter().all(|wish| wish.is_typed(sets)) {
                try_out(setup.steering_code(), Deadline::after(None), watch)?;
            }
        }
        edited_there = beside((folder, sets), path, if_there, &settings.consent)?;
    }
    if settings.resume && !sets.is_empty() {
        unchanged(path, sets)?;
    }
    let work = open_to_change(path, sets, CHANGED, Some(settings.simd))?.answered_by(&settings.consent.code)?;
    if settings.resume {
        same_as_executed(&work.folder, &work.setup)?;
    }
    let wishes = Wish::of_execution(&work.setup);
    settings.consent.ask_of_scenario((&path.to_string_lossy(), Some(path)), &wishes, sets, watch)?;
    let read = |path: &Path| missions::read(&work.setup, path, watch);
    let missions = settings.missions.as_deref().map(read).transpose()?;
    if missions.is_none() && !work.folder.has_cases() {
        let path = path.display();
        return Err(Problem::input(format!("{path} has no cases yet: hairpin generate, or --missions DIR")));
    }
    let kept = missions.is_none().then(|| work.folder.read_cases()).transpose()?;
    let cases = missions.as_ref().map_or(kept.as_ref().map_or(0, Vec::len), Vec::len);
    let mut tally =
        if missions.is_none() && work.folder.has_tally() { work.folder.read_tally()? } else { Tally::default() };
    let chosen = if missions.is_some() { Chosen::Given } else { tally.chosen(&work.setup.scenario.search()) };
    tell_share(&work.setup.scenario, (cases as u64, chosen), watch);
    // Whatever can be refused is refused before anything is lost.
    try_out(work.setup.steering_code(), Deadline::after(None), watch)?;
    let replayed = replay_saved(&work.setup, work.folder.path(), (settings.repro.as_deref(), &[]), watch)?;
    check_recordings(&work, kept.as_deref().unwrap_or_default())?;
    // What the user wrote into the scenario is what is flown from here on.
    let edited = work.folder.edited(&work.setup)?;
    edited_there.extend(edited.iter().cloned());
    tell_edited(&edited_there, missions.is_none(), watch);
    if !sets.is_empty() || !edited.is_empty() {
        keep_changes(&work)?;
        let typed: Vec<Wish> = wishes.into_iter().filter(|wish| wish.is_typed(sets)).collect();
        settings.consent.mark(path, &typed);
    }
    let searched = if missions.is_some() { searched_before(&work)? } else { None };
    let cases = match (&missions, kept) {
        (None, Some(cases)) => cases,
        (missions, _) => {
            adopt(&work, missions.as_deref().unwrap_or_default())?;
            work.folder.read_cases()?
        }
    };
    let before = if settings.resume { count_flown(&work, &cases).ok() } else { None };
    let all_there = settings.resume && missions.is_none() && all_flown(&work, &cases);
    let reruns = if all_there { count_reruns(&work, &cases)? } else { 0 };
    let judged = if before.is_some() { work.folder.read_results()? } else { Vec::new() };
    // What was judged was judged on other runs, or on fewer. Where this cannot be written, the runs stay with it.
    work.folder.write_results(&cases, &[])?;
    if !settings.resume {
        work.folder.forget_runs()?;
        if !sets.is_empty() || work.setup.scenario.executor().command.is_some() {
            // Of a search that was stopped: who flies now may be another than who flew then.
            work.folder.write_executed(None)?;
        }
    }
    if let Some((cases, results)) = searched {
        work.folder.write_searched(&cases, &results)?;
    }
    let flown = fly_missing(&work, &cases, watch).inspect_err(|_| {
        // Where nothing has landed, what was judged is what it was; where that cannot be written it is judged anew.
        if before.is_some() && before == count_flown(&work, &cases).ok() {
            drop(work.folder.write_results(&cases, &judged));
        }
    })?;
    if !settings.resume && missions.is_none() {
        tally = failed_before(&work, tally)?;
    }
    tell_failed(&tally, flown, watch);
    if all_there && !judged.is_empty() && reruns == count_reruns(&work, &cases)? {
        // Nothing was executed: what was judged is what it was.
        work.folder.write_results(&cases, &judged)?;
    }
    let tally = if work.folder.has_tally() { work.folder.read_tally()? } else { tally };
    fly_baseline(&work, &tally, flown, watch)?;
    let missions = missions.into_iter().flatten().map(|mission| mission.name).collect();
    let trouble = if flown.failed > 0 { first_trouble(&work, &cases)? } else { None };
    Ok(Executed { folder: work.folder.path().to_owned(), cases: cases.len(), flown, trouble, missions, replayed })
}
