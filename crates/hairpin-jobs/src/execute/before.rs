//! What a folder was before its cases are executed: searched, edited, begun with other settings.

use std::path::Path;

use hairpin::campaign::{Case, CaseResult, Failures, Status, Tally};
use hairpin_formats::folder::CampaignFolder;

use super::missing::Flown;
use crate::program::fingerprint;
use crate::sets::Set;
use crate::work::{Work, changed_by};
use crate::{Problem, Watch};

/// Tables of a scenario that may change once there are trajectories.
pub(super) const CHANGED: &[&str] = &["execute", "vary", "spec"];

/// `tally` of cases that were all executed anew: where another has executed the search, what failed then is past.
pub(super) fn failed_before(work: &Work, tally: Tally) -> Result<Tally, Problem> {
    if tally.failures.is_none() {
        return Ok(tally);
    }
    let now = fingerprint(&work.setup, work.folder.read_executor()?.as_ref());
    let is_past = tally.failures.by.as_ref().is_some_and(|by| *by != now);
    let tally = Tally { failures: Failures { is_past, ..tally.failures.clone() }, ..tally };
    work.folder.write_tally(&tally)?;
    Ok(tally)
}

/// Tells that what failed in the search stays a failure, though all cases were flown, and how it would not.
pub(super) fn tell_failed(tally: &Tally, flown: Flown, watch: &dyn Watch) {
    if let Some(failed) = tally.failures_in_words().filter(|_| flown.failed == 0 && !tally.failures.is_past) {
        watch.warn(&format!(
            "{failed}, and who executes is the same since, by its command, its files and what it says of itself: the verdict stays EXECUTOR FAILED. \
             One that was repaired elsewhere says another `version` in its `ready`; hairpin stress … --force searches anew"
        ));
    }
}

/// Tells that cases are flown by what they were not made with: once it is flown so, nothing in the folder tells it.
pub(super) fn tell_edited(edited: &[String], are_of_the_folder: bool, watch: &dyn Watch) {
    let of_the_cases = |key: &&String| {
        let table = key.trim_matches('`').split('.').next().unwrap_or_default();
        key.starts_with('`') && !CHANGED.contains(&table)
    };
    let keys: Vec<&str> = edited.iter().filter(of_the_cases).map(String::as_str).collect();
    if !keys.is_empty() && are_of_the_folder {
        watch.warn(&format!(
            "{} of the folder's scenario.toml {} changed by hand: its trajectories were made with what stood there before, and are flown by what stands \
             there now",
            keys.join(", "),
            if keys.len() == 1 { "was" } else { "were" }
        ));
    }
}

/// The cases of a search, and what was measured of them.
pub(super) type Searched = (Vec<Case>, Vec<CaseResult>);

/// What the folder's own search found and was judged, for missions to be compared with; of missions before them, what
/// those were compared with.
pub(super) fn searched_before(work: &Work) -> Result<Option<Searched>, Problem> {
    if !work.folder.has_cases() || !work.folder.has_tally() {
        return Ok(None);
    }
    let (cases, tally) = (work.folder.read_cases()?, work.folder.read_tally()?);
    let own = tally.missions.is_empty();
    let results = if own { Some(work.folder.read_results()?) } else { work.folder.read_searched()? };
    let Some(mut results) = results.filter(|results| !results.is_empty()) else { return Ok(None) };
    for result in &mut results {
        // Measured, not judged: nothing of them is counted.
        (result.violations, result.elsewhere, result.draws) = (Vec::new(), Vec::new(), None);
        if result.status != Status::ExecutorFailed {
            result.status = Status::Unjudged;
        }
    }
    let cases = if own { cases } else { results.iter().map(|one| Case::bare(one.case, 0, Vec::new())).collect() };
    Ok(Some((cases, results)))
}

/// Who resumes goes on with the same settings, or runs of two kinds would stand side by side.
pub(super) fn unchanged(folder: &Path, sets: &[Set]) -> Result<(), Problem> {
    let before = CampaignFolder::open(folder)?;
    match changed_by(&before, sets)? {
        None => Ok(()),
        Some(key) => {
            Err(Problem::input(format!("--resume: `{key}` is not what it was; without --resume all is flown anew")))
        }
    }
}
