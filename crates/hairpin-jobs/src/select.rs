//! A few of many cases, in a campaign folder of their own.

use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::fs;
use std::path::PathBuf;

use hairpin::campaign::select::{self, By, Candidate, Choice, Measured};
use hairpin::campaign::{Case, CaseNumber, CaseResult, Grid, Tally, vary};
use rayon::prelude::*;

use crate::consent::{Consent, Wish};
use crate::execute::measured_runs;
use crate::judge::judge_cases;
use crate::names::listed;
use crate::report::write_report;
use crate::work::{IfThere, Work, make, open_as_made, same_place, saying_what_is_asked};
use crate::{Problem, Watch};

/// What is chosen, and where it goes.
#[derive(Debug, Clone)]
pub struct SelectSettings {
    /// Campaign folder.
    pub folder: PathBuf,
    /// How many cases.
    pub cases: usize,
    /// What for.
    pub by: By,
    /// The new campaign folder.
    pub out: PathBuf,
    /// What happens to a campaign that is in it already.
    pub if_there: IfThere,
    /// Whose marks the new folder gets: what may run in the old one may run there.
    pub consent: Consent,
}

/// A choice that was made and written.
#[derive(Debug)]
pub struct Selected {
    /// The new campaign folder.
    pub folder: PathBuf,
    /// Names of the chosen cases in the order of choice.
    pub names: Vec<String>,
    /// How many cases there were to choose from.
    pub of: usize,
    /// What the chosen cases come to.
    pub selected: Measured,
    /// What as many of the most stressful ones come to.
    pub most_stressful: Measured,
    /// What all come to.
    pub all: Measured,
    /// Cells of the grid of motion.
    pub cells: usize,
    /// How their stress is told.
    pub stress: StressUnit,
}

/// How stress is told: deviations in m, those of arms in mm as everywhere; scores, of cases that were not executed,
/// have no unit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StressUnit {
    /// By what numbers in SI are multiplied.
    pub factor: f64,
    /// The unit's sign.
    pub unit: &'static str,
}

/// Chooses cases and writes them as a campaign of their own.
///
/// # Errors
/// Too few cases, or none that were executed where that is asked for; a file that cannot be read or written.
pub fn select(settings: &SelectSettings, watch: &dyn Watch) -> Result<Selected, Problem> {
    let work = open_as_made(&settings.folder)?;
    let by = settings.by;
    if same_place(&settings.folder, &settings.out) {
        return Err(Problem::input("--out: must be another folder than OUT"));
    }
    // Plans and runs are read of those that are chosen: they are nearly all of a campaign.
    let (all, results) = work.folder.read_cases_and_results()?;
    let measured = measured(&results);
    let (cases, unmeasured): (Vec<&Case>, Vec<&Case>) =
        all.iter().partition(|case| measured.is_empty() || measured.contains_key(&case.number));
    let count = settings.cases;
    if count > cases.len() {
        let whose = if unmeasured.is_empty() { "cases" } else { "cases that were executed and measured" };
        return Err(Problem::input(format!(
            "--cases {count}: {} has {} {whose}",
            settings.folder.display(),
            cases.len()
        )));
    }
    if !unmeasured.is_empty() {
        watch.warn(&format!(
            "Warning: {} of {} cases were not executed, or not measured, and are left out: {}",
            unmeasured.len(),
            all.len(),
            listed(&unmeasured.iter().map(|case| case.id()).collect::<Vec<_>>())
        ));
    }
    let met = Met::new(&work, &cases, !measured.is_empty() && unmeasured.is_empty())?;
    let of_all = (0..cases.len()).collect::<Vec<_>>();
    let mut known = if by == By::Coverage { met.by_case(&of_all.iter().copied().collect())? } else { Cells::new() };
    let candidate = |(place, case): (usize, &&Case)| {
        Candidate::new(case, measured.get(&case.number).copied(), known.remove(&place).unwrap_or_default())
    };
    let candidates: Vec<Candidate> = cases.iter().enumerate().map(candidate).collect();
    if by == By::Coverage && candidates.iter().all(|candidate| candidate.cells.is_empty()) {
        return Err(Problem::input(format!(
            "--by coverage: what was exercised is known of executed cases: hairpin execute {}",
            settings.folder.display()
        )));
    }
    let choice = Choice::new(&candidates);
    let places = choice.best(count, by);
    let stressful = choice.best(count, By::Stress);
    let mut chosen: Vec<Case> = places.iter().map(|place| Case::clone(cases[*place])).collect();
    chosen.sort_by_key(|case| case.number);
    chosen.iter_mut().try_for_each(|case| work.folder.read_witness(case))?;
    if work.setup.attachments.baseline.is_some() {
        watch.warn(
            "Warning: spec.regression compares all programs of a release, and is left out: the choice is judged without \
             it",
        );
    }
    if work.folder.has_runs() {
        // What is not to be had is told of the folder that lacks it, and before another is made.
        chosen.par_iter().try_for_each(|case| work.folder.read_runs(case.number).map(drop))?;
    }
    let is_new = !settings.out.exists();
    let folder = write(&work, settings, (&all, &results), &chosen).inspect_err(|_| {
        // Half a choice would be taken for one.
        if is_new {
            let _ = fs::remove_dir_all(&settings.out);
        }
    })?;
    // What was read to choose by is not read again, and what two choices share is read once.
    let asked: BTreeSet<usize> =
        if met.judged.is_some() { [&*places, &*stressful].concat() } else { of_all.clone() }.into_iter().collect();
    let known: Option<Cells> = match by {
        By::Coverage => Some(asked.iter().map(|place| (*place, candidates[*place].cells.clone())).collect()),
        _ if work.folder.has_runs() => Some(met.by_case(&asked)?),
        _ => None,
    };
    let cells = |places: &[usize]| known.as_ref().map(|known| together(places.iter().map(|place| &known[place])));
    Ok(Selected {
        folder,
        names: places.iter().map(|place| cases[*place].id()).collect(),
        of: cases.len(),
        selected: choice.measure(&places, cells(&places)),
        most_stressful: choice.measure(&stressful, cells(&stressful)),
        all: choice.measure(&of_all, met.judged.or_else(|| cells(&of_all))),
        cells: met.grid.cells(),
        stress: StressUnit::of(&work, &candidates),
    })
}

impl StressUnit {
    fn of(work: &Work, candidates: &[Candidate]) -> Self {
        let (factor, unit) = match (select::measured(candidates), work.setup.has_programs()) {
            (false, _) => (1.0, ""),
            (true, false) => (1.0, "m"),
            (true, true) => (1e3, "mm"),
        };
        Self { factor, unit }
    }
}

/// The results that have measures, by case.
fn measured(results: &[CaseResult]) -> HashMap<CaseNumber, &CaseResult> {
    results.iter().filter(|result| result.measures.is_some()).map(|result| (result.case, result)).collect()
}

/// Which cells cases met, by their places in the list.
type Cells = BTreeMap<usize, BTreeSet<usize>>;

/// The cells that cases met, where they were executed.
struct Met<'a> {
    work: &'a Work,
    cases: &'a [&'a Case],
    grid: Grid,
    /// How many all of them met, if that was told when they were judged.
    judged: Option<usize>,
}

impl<'a> Met<'a> {
    /// Of `cases`; `judged`: they are those of the campaign's judgement.
    fn new(work: &'a Work, cases: &'a [&'a Case], judged: bool) -> Result<Self, Problem> {
        let grid = Grid::of(&work.setup);
        let told = if judged { work.folder.read_coverage()? } else { None };
        let judged = told.filter(|told| told.grid == grid).map(|told| told.hit);
        Ok(Self { work, cases, grid, judged })
    }

    /// Those that each of these cases met, in the order of their numbers: neighbours lie in one part of the tables.
    fn by_case(&self, places: &BTreeSet<usize>) -> Result<Cells, Problem> {
        let met = |place: &usize| {
            let case = self.cases[*place];
            let runs = measured_runs(self.work, case)?;
            let met = runs.iter().flat_map(|run| self.grid.met(&self.work.setup, &case.waypoints, run)).collect();
            Ok((*place, met))
        };
        places.par_iter().map(met).collect()
    }
}

/// How many cells cases met together.
fn together<'a>(each: impl Iterator<Item = &'a BTreeSet<usize>>) -> usize {
    each.flatten().collect::<BTreeSet<_>>().len()
}

/// The new folder: the chosen cases with their plans and runs, judged if the old one was.
fn write(
    work: &Work,
    settings: &SelectSettings,
    (all, results): (&[Case], &[CaseResult]),
    chosen: &[Case],
) -> Result<PathBuf, Problem> {
    let key = work.setup.scenario.head().cases_key;
    let varied = work.setup.scenario.vary().clone();
    let mut changes = vec![(key.into(), chosen.len().into())];
    if work.setup.attachments.baseline.is_some() {
        // Some of the programs are no release that another one could be held against.
        changes.push(("spec.regression".into(), serde_json::Value::Null));
    }
    let scenario = vary::apply(&work.setup.scenario, &changes)?;
    let wishes = Wish::of_campaign(&work.setup);
    let setup = saying_what_is_asked(work.setup.changed(scenario.with_vary(varied))?)?;
    let new = make(&settings.out, setup, settings.if_there)?;
    if settings.consent.has_marked(&settings.folder, &wishes) {
        settings.consent.mark(&settings.out, &wishes);
    }
    let (old, there) = (&work.folder, &new.folder);
    let numbers: BTreeSet<CaseNumber> = chosen.iter().map(|case| case.number).collect();
    old.copy_cases(&numbers.iter().copied().collect::<Vec<_>>(), there)?;
    there.write_new_cases(chosen, 0)?;
    // Who flew the runs that go along is named in what is said of them.
    if let Some(greeting) = old.read_executor()? {
        there.write_executor(&greeting)?;
    }
    let old_tally = old.read_tally()?;
    // Missions are those of the cases in their order: a choice keeps numbers, and may be chosen from again.
    let missions = all.iter().zip(&old_tally.missions);
    let names = missions.filter(|(case, _)| numbers.contains(&case.number)).map(|(_, name)| name.clone()).collect();
    let tally = Tally { complete: true, missions: names, selected: true, ..old_tally };
    there.write_tally(&tally)?;
    let judged = results.iter().filter(|result| numbers.contains(&result.case)).count() == chosen.len();
    if judged && there.has_runs() {
        let judgement = judge_cases(&new, chosen, &tally, (&[], None))?;
        write_report(&new, chosen, &tally, &judgement.verdict, (&judgement.moves, judgement.regression.as_ref()))?;
    }
    Ok(new.folder.path().to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Unwatched;
    use crate::testing::{generated, violating};

    #[test]
    fn cells_that_several_met_count_once() {
        let met = [[0, 1, 2], [2, 3, 0]].map(BTreeSet::from);
        assert_eq!((together(met.iter()), together([].iter())), (4, 0));
    }

    #[test]
    fn what_was_not_executed_met_no_number_of_cells() {
        let (place, folder) = generated();
        let out = place.path().join("few");
        let (if_there, consent) = (IfThere::Refuse, Consent::default());
        let settings = SelectSettings { folder, cases: 1, by: By::Stress, out, if_there, consent };
        let selected = select(&settings, &Unwatched).unwrap();
        assert_eq!([selected.selected.cells, selected.most_stressful.cells, selected.all.cells], [None; 3]);
    }

    #[test]
    fn a_choice_that_cannot_be_written_leaves_no_folder() {
        let (place, folder) = violating();
        fs::remove_dir_all(folder.join("executions")).unwrap();
        let out = place.path().join("few");
        let (if_there, consent) = (IfThere::Refuse, Consent::default());
        let settings = SelectSettings { folder, cases: 1, by: By::Stress, out, if_there, consent };
        let told = select(&settings, &Unwatched).unwrap_err().to_string();
        assert!(told.contains(&settings.folder.display().to_string()) && !settings.out.exists(), "{told}");
    }

    #[test]
    fn chosen_cases_are_a_judged_campaign_of_their_own() {
        let (place, folder) = violating();
        let out = place.path().join("few");
        let settings = SelectSettings {
            folder,
            cases: 1,
            by: By::Stress,
            out: out.clone(),
            if_there: IfThere::Refuse,
            consent: Consent::default(),
        };
        let selected = select(&settings, &Unwatched).unwrap();
        assert_eq!((selected.names.len(), selected.of, selected.stress.unit), (1, 2, "m"));
        assert_eq!(selected.selected, selected.most_stressful);
        assert_eq!(open_as_made(&out).unwrap().folder.read_results().unwrap().len(), 1);
        let refused = select(&SelectSettings { cases: 3, ..settings }, &Unwatched).unwrap_err().to_string();
        assert!(refused.contains("has 2 cases"), "{refused}");
    }
}
