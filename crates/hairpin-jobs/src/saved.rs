//! Saved violations, run again before anything else: what failed once is what a change is most likely to have mended,
//! or not.

use std::path::{Path, PathBuf};

use hairpin::campaign::{self, Attachments, Case, CaseResult, Run, Setup, Status};
use hairpin::judgement::Verdict;
use hairpin_formats::folder::CampaignFolder;
use hairpin_formats::quote::on_one_line;
use hairpin_formats::repro::Repro;
use hairpin_formats::scenario;
use rayon::prelude::*;

use crate::execute::{fly_one, fly_together};
use crate::missions;
use crate::{Problem, Watch};

/// One saved case and what it comes to now.
#[derive(Debug, Clone)]
pub struct Replayed {
    /// Its repro file.
    pub file: PathBuf,
    /// Its result.
    pub result: CaseResult,
    /// Whether `spec.violation_share` allows its violation: the campaign saved it by itself, of those that it allows.
    pub allowed: bool,
}

/// Runs the repro files of `named`, or of the folder `campaign` where none is named, as robot, `execute` and `spec` of
/// `setup` now are, in the conditions in which they were saved; and tells the watch of them. Those that are `left_out`
/// are not run. Nothing in `campaign` changes.
///
/// # Errors
/// A folder that is named and has none; a file that is no repro file or, in a folder that is named, of another kind of
/// robot; recordings, which cannot be made again.
pub(crate) fn replay_saved(
    setup: &Setup,
    campaign: &Path,
    (named, left_out): (Option<&Path>, &[PathBuf]),
    watch: &dyn Watch,
) -> Result<Vec<Replayed>, Problem> {
    let own = campaign.join("repro");
    let mut files = files(named.unwrap_or(&own));
    files.retain(|file| !left_out.contains(file));
    if let Some(folder) = named {
        let refuse = |why: &str| Err(Problem::input(format!("--repro {}: {why}", folder.display())));
        if files.is_empty() {
            return refuse("there is no repro file (*.json) in it");
        }
        if setup.recordings().is_some() {
            return refuse("this campaign's runs are recordings (execute.logs), and none can be made of saved cases");
        }
    } else if setup.recordings().is_some() {
        return Ok(Vec::new());
    }
    let saved: Result<Vec<Saved>, Problem> = files.iter().map(|file| Saved::read(setup, file)).collect();
    let (ours, others): (Vec<Saved>, Vec<Saved>) = saved?.into_iter().partition(|saved| saved.setup.is_some());
    match (others.first(), named) {
        (None, _) => {}
        (Some(other), Some(_)) => {
            return Err(Problem::of_file(&other.file, "is of another kind of robot than this campaign"));
        }
        (Some(other), None) => watch.warn(&format!(
            "Warning: {} of {} saved cases are of another kind of robot and left out: {}",
            others.len(),
            files.len(),
            other.file.display()
        )),
    }
    let run = |saved: &Saved| if watch.stopped() { Ok(None) } else { saved.replay(watch) };
    let replayed: Result<Vec<Option<Replayed>>, Problem> = match setup.scenario.executor().command {
        None => ours.par_iter().map(run).collect(),
        Some(_) => replay_together(&ours, watch),
    };
    let mut replayed: Vec<Replayed> = replayed?.into_iter().flatten().collect();
    // Whoever names a folder wants of it that nothing violates any more; what a campaign saves are cases of its own.
    let allows = named.is_none() && setup.scenario.head().violation_share.is_some_and(|share| share > 0.0);
    replayed.iter_mut().for_each(|one| one.allowed = allows);
    if !replayed.is_empty() {
        tell(&replayed, watch);
    }
    Ok(replayed)
}

/// Repro files of the folder `campaign` that it wrote of its own violations when it was judged last, as it wrote them:
/// what is still to be said of them its own cases say. Where the folder cannot be read there are none.
pub(crate) fn written_by(setup: &Setup, campaign: &Path) -> Vec<PathBuf> {
    let Ok(folder) = CampaignFolder::open(campaign) else { return Vec::new() };
    let (Ok(cases), Ok(results)) = (folder.read_cases(), folder.read_results()) else { return Vec::new() };
    let is_own = |file: &PathBuf| {
        let saved = Repro::read(file).ok()?;
        let violates = |result: &&CaseResult| result.case.to_string() == saved.case && result.status == Status::Fail;
        let result = results.iter().find(violates)?;
        let case = cases.iter().find(|case| case.number == result.case)?;
        let has_its_name = file.file_stem().is_some_and(|name| name.to_str() == Some(&saved.case));
        // What was seen, and who flew, is nothing that it is run with.
        let (expected, flown_by, mission) = (saved.expected.clone(), saved.flown_by.clone(), saved.mission.clone());
        let written = Repro { expected, flown_by, mission, ..Repro::of(setup, case, result) };
        let as_read: Repro = serde_json::from_value(serde_json::to_value(written).ok()?).ok()?;
        (has_its_name && as_read == saved).then_some(())
    };
    files(&campaign.join("repro")).into_iter().filter(|file| is_own(file).is_some()).collect()
}

/// `*.json` in `folder`, by name.
fn files(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path());
    let mut files: Vec<PathBuf> =
        entries.filter(|path| path.extension().is_some_and(|ending| ending == "json")).collect();
    files.sort();
    files
}

/// A saved case, read and understood.
struct Saved {
    file: PathBuf,
    repro: Repro,
    case: Case,
    /// What it is run with now; `None` where it is of another kind of robot.
    setup: Option<Setup>,
}

impl Saved {
    fn read(now: &Setup, file: &Path) -> Result<Self, Problem> {
        let repro = Repro::read(file).map_err(Problem::input)?;
        let refuse = |why: String| Problem::of_file(file, why);
        let case = repro.case().map_err(refuse)?;
        // What is left out needs none of its files.
        if repro.scenario.clone().adopt(&*now.scenario).is_none() {
            return Ok(Self { file: file.into(), repro, case, setup: None });
        }
        let mut saved = scenario::attach(repro.scenario.clone(), file.parent().unwrap_or(Path::new("")))?;
        let adopted = saved.scenario.adopt(&*now.scenario);
        let Attachments { user_controller, baseline, .. } = &*now.attachments;
        (saved.attachments.user_controller, saved.attachments.baseline) = (user_controller.clone(), baseline.clone());
        let setup = Setup::new(saved).map_err(|mistake| refuse(format!("scenario.{mistake}")))?;
        Ok(Self { file: file.into(), repro, case, setup: adopted.map(|()| setup.with_simd(now.simd)) })
    }

    fn replay(&self, watch: &dyn Watch) -> Result<Option<Replayed>, Problem> {
        let Some(setup) = &self.setup else { return Ok(None) };
        self.judge(&fly_one(setup, &self.case, self.repro.run, watch)?)
    }

    fn judge(&self, flown: &Run) -> Result<Option<Replayed>, Problem> {
        let Some(setup) = &self.setup else { return Ok(None) };
        let flown = std::slice::from_ref(flown);
        let mut result = campaign::judge(setup, &self.case, flown)?;
        missions::hold(self.repro.mission.as_ref(), (setup, &self.case), || Ok(flown.to_vec()), &mut result)?;
        missions::doubt_lost_fence(&self.repro, &mut result);
        Ok(Some(Replayed { file: self.file.clone(), result, allowed: false }))
    }
}

/// The same of many by a program of the user's, which is as patient with it as with any other missions.
fn replay_together(all: &[Saved], watch: &dyn Watch) -> Result<Vec<Option<Replayed>>, Problem> {
    let with_setup = |saved: &'_ &Saved| saved.setup.is_some();
    let ours: Vec<&Saved> = all.iter().filter(with_setup).collect();
    let jobs = ours.iter().filter_map(|saved| Some((saved.setup.as_ref()?, &saved.case, saved.repro.run)));
    let flown = fly_together(&jobs.collect::<Vec<_>>(), watch)?;
    ours.iter().zip(&flown).map(|(saved, flown)| saved.judge(flown)).collect()
}

impl Replayed {
    /// Its file's name without the ending, and what it came to.
    pub(crate) fn named(&self) -> (String, CaseResult) {
        (self.file.file_stem().unwrap_or_default().to_string_lossy().into_owned(), self.result.clone())
    }
}

/// The verdict of a command that came to `verdict` and ran `replayed` before: a saved case that violates still is a
/// violation unless a share of violations allows it, one that was not flown or that nothing can be said of is no pass.
///
/// What is graver than what the campaign's own cases came to is the first that is read; the rest is told behind it.
pub fn with_saved(verdict: &Verdict, replayed: &[Replayed]) -> Verdict {
    let Verdict { sentence, exit_code } = verdict;
    let mut told = Verdict::clone(verdict);
    for (status, [outcome, they, behind], code, graver_than) in OUTCOMES {
        let such = || replayed.iter().filter(|one| one.result.status == status);
        let count = such().count();
        let words = format!("{count}/{} saved cases", replayed.len());
        let counts = such().any(|one| status != Status::Fail || !one.allowed);
        let leads = counts && told.exit_code == *exit_code && graver_than.contains(exit_code);
        match count {
            0 => {}
            _ if leads => told = Verdict { sentence: format!("{outcome} {words}{they}; {sentence}"), exit_code: code },
            _ => told.sentence += &format!("; {words} {behind}"),
        }
    }
    told
}

/// What saved cases come to beside a pass, gravest first: the words of it where the verdict begins with them and where
/// they stand behind, the exit code, and those that give way to it.
const OUTCOMES: [(Status, [&str; 3], u8, &[u8]); 3] = [
    (Status::Fail, ["FAIL", " violate", "violate"], 1, &[0, 3, 4, 5]),
    (Status::ExecutorFailed, ["EXECUTOR FAILED", "", "not flown"], 4, &[0, 5]),
    (Status::Inconclusive, ["INCONCLUSIVE", "", "inconclusive"], 5, &[0]),
];

fn tell(replayed: &[Replayed], watch: &dyn Watch) {
    let violating = replayed.iter().filter(|one| one.result.status == Status::Fail).count();
    watch.warn(&format!("saved cases first: {violating} of {} violate", replayed.len()));
    for one in replayed {
        let what = match one.result.status {
            Status::Fail => one.result.violations.first().map(campaign::report::violation).unwrap_or_default(),
            Status::Pass | Status::Unjudged => continue,
            _ => one.result.message.clone().unwrap_or_default(),
        };
        watch.warn(&on_one_line(&format!("  {}: {what}", one.file.display())));
    }
}

#[cfg(test)]
mod tests {
    use hairpin::campaign::CaseNumber;

    use super::*;

    fn saved(status: Status) -> Replayed {
        Replayed { file: "0000.json".into(), result: CaseResult::bare(CaseNumber(0), status), allowed: false }
    }

    /// The gravest leads, nothing that is no pass is left out, and the campaign's own violation stays first.
    #[test]
    fn whatever_saved_cases_come_to_is_told() {
        use Status::{ExecutorFailed, Fail, Inconclusive, Pass};
        for (code, cases, sentence, told) in [
            (0, vec![Pass, Pass], "own", 0),
            (0, vec![Pass, Inconclusive], "INCONCLUSIVE 1/2 saved cases; own", 5),
            (0, vec![ExecutorFailed, Pass], "EXECUTOR FAILED 1/2 saved cases; own", 4),
            (
                0,
                vec![ExecutorFailed, Inconclusive],
                "EXECUTOR FAILED 1/2 saved cases; own; 1/2 saved cases inconclusive",
                4,
            ),
            (1, vec![ExecutorFailed, Fail], "own; 1/2 saved cases violate; 1/2 saved cases not flown", 1),
            (3, vec![Fail, Inconclusive], "FAIL 1/2 saved cases violate; own; 1/2 saved cases inconclusive", 1),
            (3, vec![ExecutorFailed], "own; 1/1 saved cases not flown", 3),
            (4, vec![Fail], "FAIL 1/1 saved cases violate; own", 1),
            (5, vec![Inconclusive], "own; 1/1 saved cases inconclusive", 5),
        ] {
            let replayed: Vec<Replayed> = cases.iter().map(|status| saved(*status)).collect();
            let found = with_saved(&Verdict::of("own", code), &replayed);
            assert_eq!((found.sentence.as_str(), found.exit_code), (sentence, told), "{code} {cases:?}");
        }
    }

    /// The violations that a share allows are told, and decide nothing; what was not flown is no pass all the same.
    #[test]
    fn allowed_violations_of_saved_cases_are_told_behind() {
        let allowed = |status| Replayed { allowed: true, ..saved(status) };
        let found = with_saved(&Verdict::of("PASS", 0), &[allowed(Status::Fail), allowed(Status::Pass)]);
        assert_eq!((found.sentence.as_str(), found.exit_code), ("PASS; 1/2 saved cases violate", 0));
        let found = with_saved(&Verdict::of("PASS", 0), &[allowed(Status::Fail), saved(Status::Fail)]);
        assert_eq!((found.sentence.as_str(), found.exit_code), ("FAIL 2/2 saved cases violate; PASS", 1));
        assert_eq!(with_saved(&Verdict::of("PASS", 0), &[allowed(Status::ExecutorFailed)]).exit_code, 4);
    }

    /// A campaign that passes within its share passes when it is run again beside what it saved itself.
    #[test]
    fn a_share_holds_for_what_the_campaign_saved_itself() {
        let (place, folder) = crate::testing::violating();
        let mut settings = crate::testing::small(&place);
        settings.if_there = crate::work::IfThere::Replace;
        let sets = [("spec.violation_share", "0.5"), ("spec.deviation.max_m", "0.0001")];
        settings.sets.extend(sets.map(|(key, value)| (key.to_owned(), value.to_owned())));
        let setup = crate::work::plan(&settings, &crate::Unwatched).unwrap().setup;
        let allowed = |named| {
            let replayed = replay_saved(&setup, &folder, (named, &[]), &crate::Unwatched).unwrap();
            replayed.iter().map(|one| (one.result.status, one.allowed)).collect::<Vec<_>>()
        };
        assert_eq!(allowed(None), [(Status::Fail, true); 2]);
        assert_eq!(allowed(Some(folder.join("repro").as_path())), [(Status::Fail, false); 2]);
    }
}
