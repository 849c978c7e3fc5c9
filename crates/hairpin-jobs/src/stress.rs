//! The main job: generate, execute, judge, report.

use std::path::Path;

use hairpin::campaign::{Case, Tally};
use hairpin::judgement::Verdict;

use crate::baseline::{fly_baseline, fly_searched};
use crate::budget::Part;
use crate::execute::{Flown, check_recordings, count_flown, fly_missing};
use crate::generate::find_cases;
use crate::judge::{Judgement, judge_cases};
use crate::missions::{self, adopt, cases_of};
use crate::report::write_report;
use crate::saved::{Replayed, replay_saved, with_saved, written_by};
use crate::work::{CampaignSettings, Planned, Work, plan};
use crate::{Budget, Problem, Spent, Watch};

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
    /// What came of the time for the whole of it, where that was limited.
    pub spent: Option<Spent>,
}

/// Runs a whole campaign, or goes on with it; the repro files of the folder `repro`, or else those of the campaign's
/// own, are run first.
///
/// # Errors
/// As of [`plan`]; saved cases that cannot be used; a file that cannot be written; it was asked to stop.
pub fn stress(settings: &CampaignSettings, repro: Option<&Path>, watch: &dyn Watch) -> Result<Stressed, Problem> {
    let budget = Budget::of(settings.budget_s, settings.time_limit_s);
    let planned = plan(settings, watch)?;
    // Before anything of an older campaign in the folder is replaced: a saved case may turn out to be none.
    let replayed = replay(&planned, repro, &budget, watch)?;
    stress_begun(planned.begin()?, &budget, replayed, watch)
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
    let budget = Budget::of(settings.budget_s, settings.time_limit_s);
    let planned = plan(settings, watch)?;
    let read = missions::read(&planned.setup, missions, watch)?;
    if !planned.resumes() {
        cases_of(&planned.setup, &[], &read)?;
    }
    let replayed = replay(&planned, repro, &budget, watch)?;
    let work = planned.begin()?;
    let names: Vec<&str> = read.iter().map(|leg| leg.name.as_str()).collect();
    let are_there = work.folder.has_tally() && work.folder.read_tally()?.missions == names;
    if !are_there {
        adopt(&work, &read)?;
        work.folder.forget_runs()?;
    }
    let (cases, tally) = (work.folder.read_cases()?, work.folder.read_tally()?);
    let flown = fly(&work, &cases, (Part::Search, &budget), watch)?;
    let searched =
        budget.within(Part::Runs, watch, |watch| fly_searched(&work, budget.end_of_search(Part::Runs), watch));
    let failed = match searched {
        Ok(Some(())) => None,
        Ok(None) => {
            budget.leave_undone("nothing was searched beside the missions");
            None
        }
        // What stands beside the missions is counted nowhere, and takes no verdict from them.
        Err(Problem::Executor(why)) => Some(why),
        Err(problem) => return Err(problem),
    };
    missions::keep_search_failed(&work, failed)?;
    judged((work, cases, tally), (flown, &budget), replayed, watch)
}

/// Runs saved cases first, in the time that the search has.
fn replay(
    planned: &Planned,
    repro: Option<&Path>,
    budget: &Budget,
    watch: &dyn Watch,
) -> Result<Vec<Replayed>, Problem> {
    // What a campaign that is gone on with saved itself is told by its own cases, as if it had not been stopped.
    let of_its_own = repro.is_none() && planned.resumes();
    let own = if of_its_own { written_by(&planned.setup, &planned.path) } else { Vec::new() };
    let replay = |watch: &dyn Watch| replay_saved(&planned.setup, &planned.path, (repro, &own), watch);
    let replayed = budget.within(Part::Search, watch, replay)?;
    if replayed.is_none() {
        budget.leave_undone("saved cases were not run");
    }
    Ok(replayed.unwrap_or_default())
}

/// Flies what is missing until `part` ends.
fn fly(work: &Work, cases: &[Case], (part, budget): (Part, &Budget), watch: &dyn Watch) -> Result<Flown, Problem> {
    let done = budget.within(part, watch, |watch| fly_missing(work, cases, watch))?;
    let flown = done.map_or_else(|| count_flown(work, cases), Ok)?;
    if done.is_none() {
        let executor = work.setup.scenario.executor();
        let all = cases.len() * executor.repeat as usize;
        match all.saturating_sub(flown.runs) {
            0 if all == 0 => {}
            0 => budget.leave_undone("not all violations were run again"),
            missing => budget.leave_undone_visibly(format!("{missing} of {all} runs were not executed")),
        }
    }
    Ok(flown)
}

/// The same in a folder that is open, after what was `replayed`, in the time that `budget` has.
///
/// # Errors
/// A file that cannot be written; it was asked to stop.
pub fn stress_begun(
    work: Work,
    budget: &Budget,
    replayed: Vec<Replayed>,
    watch: &dyn Watch,
) -> Result<Stressed, Problem> {
    let (cases, mut tally) = find_cases(&work, budget.end_of_search(Part::Search), budget.end(Part::Search), watch)?;
    let cut = budget.cut_of_search(&work.setup.scenario, &cases, &tally);
    if cut != tally.cut {
        tally.cut = cut;
        work.folder.write_tally(&tally)?;
    }
    check_recordings(&work, &cases)?;
    let flown = fly(&work, &cases, (Part::Runs, budget), watch)?;
    judged((work, cases, tally), (flown, budget), replayed, watch)
}

/// What of a campaign comes after its runs.
fn judged(
    (work, cases, tally): (Work, Vec<Case>, Tally),
    (flown, budget): (Flown, &Budget),
    replayed: Vec<Replayed>,
    watch: &dyn Watch,
) -> Result<Stressed, Problem> {
    if budget.within(Part::Beside, watch, |watch| fly_baseline(&work, &tally, flown, watch))?.is_none() {
        budget.leave_undone("no random cases were flown beside them");
    }
    let judgement = judge_cases(&work, &cases, &tally, (&replayed, Some(budget)))?;
    let verdict = budget.told_in(with_saved(&judgement.verdict, &replayed));
    write_report(&work, &cases, &tally, &verdict, (&judgement.moves, judgement.regression.as_ref()))?;
    Ok(Stressed { work, cases, tally, judgement, verdict, replayed, spent: budget.spent() })
}

#[cfg(test)]
mod tests {
    use hairpin_formats::repro::Repro;

    use super::*;
    use crate::Unwatched;
    use crate::testing::small;
    use crate::work::IfThere;

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

    /// To go on with a campaign that is finished changes nothing: what it saved itself counts no second time. What was
    /// changed since, or is another's, is run first, and so is all in a later run.
    #[test]
    fn a_finished_campaign_that_is_gone_on_with_comes_to_the_same() {
        let place = tempfile::tempdir().unwrap();
        let mut settings = small(&place);
        settings.sets.push(("spec.deviation.max_m".into(), "0.0001".into()));
        let first = stress(&settings, None, &Unwatched).unwrap().verdict;
        let suites = || {
            let text = std::fs::read_to_string(place.path().join("out/junit.xml")).unwrap();
            text.matches("<testsuite ").count()
        };
        assert_eq!((first.exit_code, suites()), (1, 1));
        let with = |if_there| {
            let stressed = stress(&CampaignSettings { if_there, ..settings.clone() }, None, &Unwatched).unwrap();
            let names = stressed.replayed.iter().map(|one| one.named().0);
            (stressed.verdict.sentence.clone(), names.collect::<Vec<_>>())
        };
        let resumed = with(IfThere::Resume);
        assert_eq!((resumed, suites()), ((first.sentence, Vec::new()), 1));
        let repro = place.path().join("out/repro");
        std::fs::copy(repro.join("0000.json"), repro.join("mine.json")).unwrap();
        let changed = Repro::read(&repro.join("0001.json")).unwrap();
        Repro { seed: changed.seed + 1, ..changed }.write(&repro.join("0001.json")).unwrap();
        assert_eq!(with(IfThere::Resume).1, ["0001", "mine"]);
        // What stood under a case's name and is another case has a name of its own now.
        assert_eq!(with(IfThere::Replace).1, ["0000", "0001-kept", "0001", "mine"]);
    }

    /// The run that showed that a saved case still violates took it away, and the next one passed.
    #[test]
    fn what_still_violates_stays_where_later_runs_find_it() {
        let place = tempfile::tempdir().unwrap();
        let settings = small(&place);
        let with = |most: &str, seed: &str| {
            let sets = [("spec.deviation.max_m", most), ("seed", seed)].map(|(key, value)| (key.into(), value.into()));
            let sets = settings.sets.iter().cloned().chain(sets).collect();
            let stressed =
                stress(&CampaignSettings { if_there: IfThere::Replace, sets, ..settings.clone() }, None, &Unwatched);
            let stressed = stressed.unwrap();
            let violate = stressed.replayed.iter().filter(|one| one.result.status == hairpin::campaign::Status::Fail);
            (stressed.verdict.exit_code, violate.count(), stressed.replayed.len())
        };
        let names = || {
            let files = std::fs::read_dir(place.path().join("out/repro")).unwrap();
            let mut names: Vec<String> =
                files.map(|file| file.unwrap().file_name().to_string_lossy().into_owned()).collect();
            names.sort();
            names
        };
        assert_eq!((with("0.0001", "1"), names()), ((1, 0, 0), vec!["0000.json".into(), "0001.json".to_owned()]));
        let kept = ["0000-kept.json", "0000.json", "0001-kept.json", "0001.json"].map(str::to_owned).to_vec();
        assert_eq!((with("0.0001", "2"), names()), ((1, 2, 2), kept.clone()));
        // The same campaign again: what it saved of its own cases is written anew, under the same names.
        assert_eq!((with("0.0001", "2"), names()), ((1, 4, 4), kept.clone()));
        // Mended, all of them: the campaign's own go.
        assert_eq!(with("50", "3"), (0, 0, 4));
        assert_eq!((with("0.0001", "1"), names()), ((1, 2, 2), kept));
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
