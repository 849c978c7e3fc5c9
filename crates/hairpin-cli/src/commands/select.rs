//! `hairpin select`: a few of many cases, in a campaign folder of their own.

use std::collections::{BTreeSet, HashMap};
use std::path::Path;

use hairpin::campaign::digits::number;
use hairpin::campaign::learn::NAME;
use hairpin::campaign::select::{self, By, Candidate, Choice, Measured};
use hairpin::campaign::{Case, CaseResult, Grid, Tally, vary};
use hairpin_formats::folder::{ARCS, BEST_SO_FAR, CampaignFolder, GRAPH, OPTIMUM, REASONS};
use rayon::prelude::*;
use serde_json::json;

use super::parts;
use crate::args::{Select, SelectBy};
use crate::console;
use crate::folder::{self, Work};
use crate::problem::Problem;

/// Runs the command: 0 when the folder is written.
pub(crate) fn run(asked: &Select) -> Result<u8, Problem> {
    folder::take_threads(&asked.threads);
    let work = folder::look(&asked.folder)?;
    if same_place(&asked.folder, &asked.out) {
        return Err(Problem::input("--out: must be another folder than OUT"));
    }
    let all = work.folder.read_cases()?;
    let results = work.folder.read_results()?;
    let measured = measured(&results);
    let (cases, unmeasured): (Vec<Case>, Vec<Case>) =
        all.iter().cloned().partition(|case| measured.is_empty() || measured.contains_key(&case.number));
    let count = asked.cases as usize;
    if count > cases.len() {
        let whose = if unmeasured.is_empty() { "cases" } else { "cases that were executed and measured" };
        return Err(Problem::input(format!("--cases {count}: {} has {} {whose}", asked.folder.display(), cases.len())));
    }
    if !unmeasured.is_empty() {
        console::warn(&format!(
            "Warning: {} of {} cases were not executed, or not measured, and are left out: {}",
            unmeasured.len(),
            all.len(),
            console::some(&unmeasured.iter().map(Case::id).collect::<Vec<_>>())
        ));
    }
    let candidates = candidates(&work, &cases, &measured)?;
    let by = match asked.by {
        SelectBy::Stress => By::Stress,
        SelectBy::Diverse => By::Diverse,
        SelectBy::Coverage if candidates.iter().all(|candidate| candidate.cells.is_empty()) => {
            return Err(Problem::input(format!(
                "--by coverage: what was exercised is known of executed cases: hairpin execute {}",
                asked.folder.display()
            )));
        }
        SelectBy::Coverage => By::Coverage,
    };
    let choice = Choice::new(&candidates);
    let places = choice.best(count, by);
    let every: Vec<usize> = (0..candidates.len()).collect();
    let measured = [choice.measure(&places), choice.measure(&choice.best(count, By::Stress)), choice.measure(&every)];
    let mut chosen: Vec<Case> = places.iter().map(|place| cases[*place].clone()).collect();
    chosen.sort_by_key(|case| case.number);
    let folder = write(&work, asked, (&all, &results), &chosen)?;
    let names: Vec<String> = places.iter().map(|place| cases[*place].id()).collect();
    let cells = Grid::of(&work.setup).cells();
    let [found, stressful, whole] = &measured;
    let stress = Stress::of(&work, &candidates);
    let sentence = format!(
        "SELECTED {count} of {} cases: stress {}, spread {:.2}, {} of {cells} cells; the {count} most stressful: {}, {:.2}, {}",
        cases.len(),
        stress.with_unit(found.stress),
        found.spread,
        found.cells,
        stress.with_unit(stressful.stress),
        stressful.spread,
        stressful.cells,
    );
    if asked.json {
        let object = json!({
            "verdict": sentence, "exit_code": 0, "by": by, "guarantee": by.guarantee(), "cases": names,
            "selected": found, "most_stressful": stressful, "all": whole, "cells": cells,
            "paths": { "folder": folder.path() },
        });
        console::say(&object.to_string());
    } else {
        tell(&measured, by, &stress);
        console::say(&format!("in the order of choice: {}", names.join(", ")));
        console::say(&sentence);
        console::warn(&format!("folder: {}", folder.path().display()));
    }
    Ok(0)
}

/// How stress is told: deviations in m, those of arms in mm as everywhere; scores, of cases that were not executed, have no unit.
struct Stress {
    factor: f64,
    unit: &'static str,
}

impl Stress {
    fn of(work: &Work, candidates: &[Candidate]) -> Self {
        let (factor, unit) = match (select::measured(candidates), work.setup.arm().is_some()) {
            (false, _) => (1.0, ""),
            (true, false) => (1.0, "m"),
            (true, true) => (1e3, "mm"),
        };
        Self { factor, unit }
    }

    fn number(&self, value: f64) -> String {
        number(Some(self.factor * value))
    }

    fn with_unit(&self, value: f64) -> String {
        self.headed(&self.number(value))
    }

    /// `words` with the unit behind them, if there is one.
    fn headed(&self, words: &str) -> String {
        format!("{words} {}", self.unit).trim_end().to_owned()
    }
}

fn same_place(a: &Path, b: &Path) -> bool {
    matches!((a.canonicalize(), b.canonicalize()), (Ok(a), Ok(b)) if a == b)
}

/// The results that have measures, by case.
fn measured(results: &[CaseResult]) -> HashMap<usize, &CaseResult> {
    results.iter().filter(|result| result.measures.is_some()).map(|result| (result.case, result)).collect()
}

/// Every case with its result and the cells that its runs met, where it has them.
fn candidates(work: &Work, cases: &[Case], measured: &HashMap<usize, &CaseResult>) -> Result<Vec<Candidate>, Problem> {
    let table = work.folder.read_runs_table()?;
    let grid = Grid::of(&work.setup);
    cases
        .par_iter()
        .map(|case| {
            let runs = work.folder.read_runs(case.number, &table)?;
            let met: BTreeSet<usize> =
                runs.iter().flat_map(|run| grid.met(&work.setup, &case.waypoints, run)).collect();
            Ok(Candidate::new(case, measured.get(&case.number).copied(), met))
        })
        .collect()
}

/// The new folder: the chosen cases with their plans and runs, judged if the old one was.
fn write(
    work: &Work,
    asked: &Select,
    (all, results): (&[Case], &[CaseResult]),
    chosen: &[Case],
) -> Result<CampaignFolder, Problem> {
    let key = if work.setup.arm().is_some() { "generate.search.programs" } else { "generate.search.cases" };
    let varied = work.setup.scenario.vary().clone();
    let mut changes = vec![(key.into(), chosen.len().into())];
    if work.setup.attachments.baseline.is_some() {
        // Some of the programs are no release that another one could be held against.
        changes.push(("spec.regression".into(), serde_json::Value::Null));
    }
    let scenario = vary::apply(&work.setup.scenario, &changes)?;
    let setup = work.setup.changed(scenario.with_vary(varied))?;
    let new = Work { folder: folder::make(&asked.out, &setup, false, asked.force)?, setup };
    let (old, there) = (&work.folder, &new.folder);
    let numbers: BTreeSet<usize> = chosen.iter().map(|case| case.number).collect();
    let copy = |from: &Path, to: &Path| {
        let copied = if from.exists() { std::fs::copy(from, to).map(drop) } else { Ok(()) };
        copied.map_err(|error| Problem::input(format!("cannot copy {} to {}: {error}", from.display(), to.display())))
    };
    let table = old.read_runs_table()?;
    for case in chosen {
        copy(&old.trajectory_path(case.number), &there.trajectory_path(case.number))?;
        for run in 0.. {
            if !old.run_path(case.number, run).exists() {
                break;
            }
            copy(&old.run_path(case.number, run), &there.run_path(case.number, run))?;
        }
        for again in 0..old.read_reruns(case.number)?.len() {
            copy(&old.rerun_path(case.number, again), &there.rerun_path(case.number, again))?;
        }
    }
    let whole = [NAME, BEST_SO_FAR, GRAPH, REASONS, ARCS].into_iter();
    // What is proven of the first program is of no use without it.
    for name in whole.chain(numbers.contains(&0).then_some(OPTIMUM)) {
        copy(&old.file(name), &there.file(name))?;
    }
    there.write_new_cases(chosen, 0)?;
    let old_tally = old.read_tally()?;
    // Missions are those of the cases in their order: a choice keeps numbers, and may be chosen from again.
    let missions = all.iter().zip(&old_tally.missions);
    let names = missions.filter(|(case, _)| numbers.contains(&case.number)).map(|(_, name)| name.clone()).collect();
    let tally = Tally { complete: true, missions: names, ..old_tally };
    there.write_tally(&tally)?;
    let facts: Vec<_> =
        table.into_iter().filter(|((case, _), _)| numbers.contains(case)).map(|(_, facts)| facts).collect();
    if !facts.is_empty() {
        there.write_runs_table(&facts)?;
    }
    let judged = results.iter().filter(|result| numbers.contains(&result.case)).count() == chosen.len();
    if judged && !facts.is_empty() {
        let judgement = parts::judge(&new, chosen, &tally, &[])?;
        parts::report(&new, chosen, &tally, &judgement.verdict, (&judgement.moves, judgement.regression.as_ref()))?;
    }
    Ok(new.folder)
}

fn tell(measured: &[Measured; 3], by: By, stress: &Stress) {
    let header = ["", "cases", "mean stress", "worst", "spread", "nearest pair", "cells"];
    let header = header
        .map(|name| if name == "mean stress" || name == "worst" { stress.headed(name) } else { name.into() })
        .to_vec();
    let rows = ["chosen", "most stressful", "all"].iter().zip(measured).map(|(name, one)| {
        vec![
            (*name).to_owned(),
            one.cases.to_string(),
            stress.number(one.stress),
            stress.number(one.worst),
            format!("{:.3}", one.spread),
            format!("{:.3}", one.nearest),
            one.cells.to_string(),
        ]
    });
    console::say(&console::table(&std::iter::once(header).chain(rows).collect::<Vec<_>>()));
    console::say(&format!("{}; distances are 0 … 1, over waypoints and over behaviour\n", by.guarantee()));
}
