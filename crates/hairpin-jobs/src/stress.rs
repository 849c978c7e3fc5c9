//! The main job: generate, execute, judge, report.

use std::path::Path;

use hairpin::campaign::{Case, Tally};
use hairpin::judgement::Verdict;

use crate::baseline::{fly_baseline, fly_searched};
use crate::execute::{Flown, check_recordings, fly_missing};
use crate::generate::find_cases;
use crate::judge::{Judgement, judge_cases};
use crate::missions::{self, adopt};
use crate::report::write_report;
use crate::saved::{Replayed, replay_saved, with_saved};
use crate::work::{CampaignSettings, Work, plan};
use crate::{Deadline, Problem, Watch};

/// A campaign from its search to its report.
pub struct Stressed {
    /// The campaign.
    pub work: Work,
    /// Its cases.
    pub cases: Vec<Case>,
    /// What the search did.
    pub tally: Tally,
    /// What judging came to.
    pub judgement: Judgement,
    /// The judgement's verdict, with what saved cases came to.
    pub verdict: Verdict,
    /// Saved cases that were run first.
    pub replayed: Vec<Replayed>,
}

/// Runs a whole campaign, or goes on with it; the repro files of the folder `repro`, or else those of the campaign's
/// own, are run first.
///
/// # Errors
/// As of [`plan`]; saved cases that cannot be used; a file that cannot be written; it was asked to stop.
pub fn stress(settings: &CampaignSettings, repro: Option<&Path>, watch: &dyn Watch) -> Result<Stressed, Problem> {
    let planned = plan(settings, watch)?;
    let deadline = Deadline::after(settings.time_limit_s);
    // Before anything of an older campaign in the folder is replaced: a saved case may turn out to be none.
    let replayed = replay_saved(&planned.setup, &planned.path, repro, watch)?;
    stress_begun(planned.begin()?, deadline, replayed, watch)
}

/// The same of missions made elsewhere, of a folder or file: they are the cases, and beside them what the scenario's
/// search finds is run, measured and compared with, as random feasible cases are. Nothing of either is judged or
/// counted.
///
/// # Errors
/// As of [`stress`]; a file that is no mission, or has something that changes the motion and is not followed.
pub fn stress_missions(
    settings: &CampaignSettings,
    missions: &Path,
    repro: Option<&Path>,
    watch: &dyn Watch,
) -> Result<Stressed, Problem> {
    let planned = plan(settings, watch)?;
    let deadline = Deadline::after(settings.time_limit_s);
    let read = missions::read(&planned.setup, missions, watch)?;
    let replayed = replay_saved(&planned.setup, &planned.path, repro, watch)?;
    let work = planned.begin()?;
    let names: Vec<&str> = read.iter().map(|leg| leg.name.as_str()).collect();
    let are_there = work.folder.has_tally() && work.folder.read_tally()?.missions == names;
    if !are_there {
        adopt(&work, &read)?;
        work.folder.forget_runs()?;
    }
    let (cases, tally) = (work.folder.read_cases()?, work.folder.read_tally()?);
    let flown = fly_missing(&work, &cases, watch)?;
    fly_searched(&work, deadline, watch)?;
    judged((work, cases, tally), flown, replayed, watch)
}

/// The same in a folder that is open, after what was `replayed`; generation ends at `deadline`.
///
/// # Errors
/// A file that cannot be written; it was asked to stop.
pub fn stress_begun(
    work: Work,
    deadline: Deadline,
    replayed: Vec<Replayed>,
    watch: &dyn Watch,
) -> Result<Stressed, Problem> {
    let (cases, tally) = find_cases(&work, deadline, watch)?;
    check_recordings(&work, &cases)?;
    let flown = fly_missing(&work, &cases, watch)?;
    judged((work, cases, tally), flown, replayed, watch)
}

/// What of a campaign comes after its runs.
fn judged(
    (work, cases, tally): (Work, Vec<Case>, Tally),
    flown: Flown,
    replayed: Vec<Replayed>,
    watch: &dyn Watch,
) -> Result<Stressed, Problem> {
    fly_baseline(&work, &tally, flown, watch)?;
    let judgement = judge_cases(&work, &cases, &tally, &replayed)?;
    let verdict = with_saved(&judgement.verdict, &replayed);
    write_report(&work, &cases, &tally, &verdict, (&judgement.moves, judgement.regression.as_ref()))?;
    Ok(Stressed { work, cases, tally, judgement, verdict, replayed })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Unwatched;
    use crate::testing::small;

    #[test]
    fn a_campaign_runs_from_its_scenario_to_its_report() {
        let place = tempfile::tempdir().unwrap();
        let mut settings = small(&place);
        settings.sets.push(("spec.deviation.max_m".into(), "0.0001".into()));
        let stressed = stress(&settings, None, &Unwatched).unwrap();
        assert_eq!((stressed.verdict.exit_code, stressed.cases.len()), (1, 2), "{:?}", stressed.verdict);
        for name in ["scenario.toml", "results.parquet", "junit.xml", "report.html", "repro/0000.json"] {
            assert!(stressed.work.folder.file(name).is_file(), "{name}");
        }
    }

    #[test]
    fn what_was_saved_is_run_first() {
        let (_violating, folder) = crate::testing::violating();
        let place = tempfile::tempdir().unwrap();
        let mut settings = small(&place);
        settings.sets.push(("spec.deviation.max_m".into(), "50".into()));
        let stressed = stress(&settings, Some(&folder.join("repro")), &Unwatched).unwrap();
        assert_eq!((stressed.replayed.len(), stressed.verdict.exit_code), (2, 0), "{:?}", stressed.verdict);
    }
}
