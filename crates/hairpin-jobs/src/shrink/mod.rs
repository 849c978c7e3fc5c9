//! A violating case reduced to the shortest feasible one that still violates.

mod answers;
mod settings;

use std::path::PathBuf;
use std::time::{Duration, Instant};

use hairpin::campaign::report::violation;
use hairpin::campaign::{Case, CaseResult, Shrunk};
use hairpin_formats::atomic;
use hairpin_formats::folder::refuse_own;
use hairpin_formats::repro::{Repro, ShrunkFrom};

use crate::consent::Wish;
use crate::missions::FENCE;
use crate::names::named;
use crate::work::{Work, open_to_change, same_as_made};
use crate::{Problem, Watch};
use answers::Answers;

pub use settings::ShrinkSettings;

/// A violating case that is to be shrunk.
pub struct Shrinking {
    work: Work,
    settings: ShrinkSettings,
    began: Instant,
    /// The case.
    pub case: Case,
    /// Its result.
    pub result: CaseResult,
}

/// The smaller case, written as a repro file.
#[derive(Debug)]
pub struct ShrunkCase {
    /// The case and how it was found.
    pub shrunk: Shrunk,
    /// Its repro file.
    pub target: PathBuf,
    /// Executions in all, those of earlier searches included.
    pub runs: u64,
    /// Executions of this one.
    pub fresh: u64,
    /// What it took.
    pub time: Duration,
}

impl Shrinking {
    /// The case that is asked for.
    ///
    /// # Errors
    /// No such case, or one that does not violate or is not judged; a folder that is no campaign's, whose scenario was
    /// edited, or that asks to run what its user has not allowed.
    pub fn open(settings: ShrinkSettings) -> Result<Self, Problem> {
        if let Some(out) = &settings.out {
            refuse_own(out)?;
        }
        let work = open_to_change(&settings.folder, &[], &[], Some(settings.simd))?;
        let work = work.answered_by(&settings.consent.code)?;
        same_as_made(&work.folder, &work.setup, &[])?;
        settings.consent.ask(&settings.folder, &Wish::of_campaign(&work.setup))?;
        let (case, result) = violating(&work, &settings)?;
        Ok(Self { work, settings, began: Instant::now(), case, result })
    }

    /// Shrinks it as far as budget, time and watch allow; the same again goes on where it stopped.
    ///
    /// # Errors
    /// The executor failed; a file cannot be written; nothing of the case can be planned anew.
    pub fn search(&self, watch: &dyn Watch) -> Result<ShrunkCase, Problem> {
        let Self { work, settings, began, case, result } = self;
        let target = match &settings.out {
            Some(out) => out.clone(),
            None => {
                atomic::make_folder(&work.folder.file("repro"))?;
                work.folder.file(&format!("repro/{}-shrunk.json", case.id()))
            }
        };
        let mut answers = Answers::take_up(work, case, result, settings, watch)?;
        let shrunk = answers.search(&work.setup, case, result)?;
        let repro = Repro { flown_by: answers.flown_by(), ..self.repro(&shrunk, answers.runs())? };
        repro.write(&target)?;
        Ok(ShrunkCase { shrunk, target, runs: answers.runs(), fresh: answers.fresh(), time: began.elapsed() })
    }

    fn repro(&self, shrunk: &Shrunk, runs: u64) -> Result<Repro, Problem> {
        let setup = self.work.setup.changed(shrunk.scenario.clone())?;
        Ok(Repro {
            shrunk: Some(ShrunkFrom {
                waypoints: self.case.waypoints.len(),
                violations: self.result.violations.iter().map(violation).collect(),
                simplified: shrunk.simplified.clone(),
                finished: shrunk.finished,
                runs,
            }),
            ..Repro::of(&setup, &shrunk.case, &shrunk.result)
        })
    }
}

/// The case that was asked for, with its witness, and its result.
fn violating(work: &Work, settings: &ShrinkSettings) -> Result<(Case, CaseResult), Problem> {
    let folder = settings.folder.display();
    let cases = work.folder.read_cases()?;
    let there = named(&cases.iter().map(Case::id).collect::<Vec<_>>(), "case");
    let case = cases.into_iter().find(|case| case.number == settings.case);
    let case = case.ok_or_else(|| Problem::input(format!("--case {}: {folder} has {there}", settings.case.0)))?;
    let result = work.folder.read_results()?.into_iter().find(|result| result.case == case.number);
    let result = result.ok_or_else(|| Problem::input(format!("not judged yet: hairpin judge {folder}")))?;
    if result.violations.is_empty() {
        return Err(Problem::input(format!("case {} does not violate: there is nothing to shrink", case.id())));
    }
    if result.violations[0].what == FENCE {
        let what = "what it violates is its mission's fence, which a shorter flight is not the mission's to break";
        return Err(Problem::input(format!("case {}: {what}: hairpin replay flies it again", case.id())));
    }
    Ok((case, result))
}

#[cfg(test)]
mod tests {
    use hairpin::campaign::CaseNumber;

    use super::*;
    use crate::Unwatched;
    use crate::consent::Consent;
    use crate::execute::{ExecuteSettings, execute};
    use crate::judge::judge;
    use crate::testing::{Told, generated, program, violating};

    #[test]
    fn a_violating_case_gets_smaller_and_its_answers_stay_known() {
        let (_place, folder) = violating();
        let settings = ShrinkSettings { folder, budget: 5, ..ShrinkSettings::default() };
        let shrinking = Shrinking::open(settings.clone()).unwrap();
        let before = shrinking.case.waypoints.len();
        let found = shrinking.search(&Unwatched).unwrap();
        assert!(found.shrunk.case.waypoints.len() < before && found.fresh <= 5 && found.target.is_file());
        let again = shrinking.search(&Unwatched).unwrap();
        assert!(again.runs >= found.runs && again.runs == found.runs + again.fresh);
        drop(shrinking);
        let refused =
            Shrinking::open(ShrinkSettings { case: CaseNumber(7), ..settings }).map(|_| ()).unwrap_err().to_string();
        assert!(refused.ends_with("has the cases 0000, 0001"), "{refused}");
    }

    #[test]
    fn what_another_program_shrinks_is_told_and_written_as_its_own() {
        let (place, folder) = generated();
        let file = place.path().join("sim.py");
        let sets = vec![program(&file, "name=\"sim 1\"")];
        execute(&ExecuteSettings { folder: folder.clone(), sets, ..ExecuteSettings::default() }, &Unwatched).unwrap();
        judge(&folder, &[("spec.total_time.max_s".to_owned(), "0.01".to_owned())]).unwrap();
        let consent = Consent { allow_commands: true, ..Consent::default() };
        let settings = ShrinkSettings { folder, budget: 2, consent, ..ShrinkSettings::default() };
        let shrunk = || {
            let told = Told::default();
            let found = Shrinking::open(settings.clone()).unwrap().search(&told).unwrap();
            (told.0.into_inner().unwrap(), Repro::read(&found.target).unwrap().flown_by.unwrap().name)
        };
        assert_eq!(shrunk(), (Vec::new(), "sim 1".to_owned()));
        program(&file, "name=\"sim 2\"");
        let (told, name) = shrunk();
        assert!(told.len() == 1 && told[0].contains("before it was `sim 1`") && name == "sim 2", "{told:?} {name}");
    }
}
