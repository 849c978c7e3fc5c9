//! `report.html`: one file that opens offline in any browser, with a view of its own (`view/`). Without JavaScript it
//! still has the verdict, the table and the worst cases' top and side views.

mod cases;
mod column;
mod data;
mod day_card;
mod decimated;
mod escape;
mod layout;
mod more;
mod page;
mod panels;
mod progress;
mod regression;
mod relief;
mod setup;
mod solids;
mod spread;
mod svg;
mod worst;

use std::collections::{BTreeSet, HashMap};
use std::path::Path;

use hairpin::campaign::report::{self, Drawn, Pieces, ReportData, shown, worst_first};
use hairpin::campaign::select::{By, Candidate, Choice};
use hairpin::campaign::{Baseline, Case, CaseNumber, CaseResult, Run, Setup, Tally};
use hairpin::judgement::{JudgementError, Verdict};
use thiserror::Error;

use crate::atomic::{self, WriteError};
use crate::folder::{CampaignFolder, FolderError};
use crate::header::Header;

pub use day_card::{DayCard, FlightCard, day_card_html};
pub use page::html;
pub use worst::picture;

/// Cases that open at most: the file stays below 8 MB. Of more than that the worst, and of the others the most
/// different.
pub const SHOWN: usize = 200;
/// Of more cases, so many of the worst.
const WORST: usize = 150;

/// Why a report cannot be made.
#[derive(Debug, Error)]
pub enum ReportError {
    /// The campaign folder cannot be read.
    #[error(transparent)]
    Folder(#[from] FolderError),
    /// A flight in it is none that could be judged.
    #[error("case {case}, run {run}: {cause}")]
    Flight {
        /// The case.
        case: CaseNumber,
        /// The run.
        run: usize,
        /// What the judge says.
        cause: JudgementError,
    },
    /// A run cannot be had.
    #[error("{0}")]
    Run(String),
}

/// Where the motion of runs comes from.
pub trait Motions {
    /// A run of a case, `None` where it was not executed or is not to be had any more; `place`: the how-manieth of
    /// those that are shown it is, from 0, what is asked for and the worst first.
    ///
    /// # Errors
    /// Why it cannot be read.
    fn run(&self, case: &Case, run: usize, place: usize) -> Result<Option<Run>, String>;

    /// All runs of a case whose motion was kept.
    ///
    /// # Errors
    /// Why they cannot be read.
    fn kept(&self, case: CaseNumber) -> Result<Vec<Run>, String>;
}

/// Gathers a report from a judged campaign folder; `motions` gives the runs that are shown, `asked` are cases that are
/// shown whatever came of them, the first of which is opened.
///
/// # Errors
/// Files that are missing or broken; as `motions`, in words.
pub fn from_folder(
    folder: &CampaignFolder,
    setup: &Setup,
    verdict: Verdict,
    assumptions: Vec<String>,
    motions: &dyn Motions,
    asked: &[CaseNumber],
) -> Result<ReportData, ReportError> {
    let cases = folder.read_cases_without_profiles()?;
    let results = folder.read_results()?;
    // Older parts of the folder may have been deleted by hand: the tally only adds two numbers.
    let tally = folder.read_tally().unwrap_or_else(|_| Tally { solved: cases.len() as u64, ..Tally::default() });
    // Neighbours lie in one part of the tables: they are read one after another.
    let mut by_number: Vec<_> = chosen(worst_first(&results), &cases, asked).into_iter().enumerate().collect();
    by_number.sort_by_key(|(_, result)| result.case);
    let mut in_full = Vec::new();
    for (place, result) in by_number {
        let Some(case) = cases.iter().find(|case| case.number == result.case) else { continue };
        // What is followed is planned from its witness, as the judge does it.
        let mut case = case.clone();
        folder.read_witness(&mut case)?;
        let planned = folder.read_planned(case.number)?;
        let run = motions.run(&case, result.run, place).map_err(ReportError::Run)?;
        let others = match setup.scenario.executor().repeat {
            1 => Vec::new(),
            _ => motions.kept(case.number).map_err(ReportError::Run)?,
        };
        let flight = |cause| ReportError::Flight { case: case.number, run: result.run, cause };
        let shown = shown(setup, &case, result, planned, run.as_ref().map(Drawn::from), &others).map_err(flight)?;
        in_full.push((place, shown));
    }
    in_full.sort_by_key(|(place, _)| *place);
    let (baseline, scenario) = (folder.read_baseline()?, &setup.scenario);
    let pieces = Pieces {
        setup,
        cases: &cases,
        results: &results,
        tally: Some(&tally),
        verdict,
        assumptions,
        shown: in_full.into_iter().map(|(_, shown)| shown).collect(),
        frame: Header::of(setup, (&cases, &results), &tally).lines(),
        influences: folder.read_influences()?,
        coverage: folder.read_coverage()?,
        baseline: baseline
            .as_ref()
            .and_then(|measured| Baseline::of(scenario.sought(), scenario.executor().repeat, measured)),
        random: baseline.as_deref().unwrap_or_default(),
        asked: asked.first().copied(),
    };
    Ok(report::assemble(pieces))
}

/// The cases that open: all, or of too many what was asked for, the worst, and of the others those that are the most
/// different from each other, as `select` measures it.
fn chosen<'a>(ordered: Vec<&'a CaseResult>, cases: &[Case], asked: &[CaseNumber]) -> Vec<&'a CaseResult> {
    if ordered.len() <= SHOWN {
        return ordered;
    }
    let (mut found, mut others): (Vec<&CaseResult>, Vec<&CaseResult>) =
        ordered.into_iter().partition(|result| asked.contains(&result.case));
    found.truncate(SHOWN);
    let rest = others.split_off(WORST.min(SHOWN - found.len()).min(others.len()));
    found.extend(others);
    let by_number: HashMap<CaseNumber, &Case> = cases.iter().map(|case| (case.number, case)).collect();
    // All are as stressful as each other: how far they are apart decides alone.
    let candidate = |result: &CaseResult| {
        let mut candidate = Candidate::new(by_number.get(&result.case)?, Some(result), BTreeSet::new());
        candidate.stress = 0.0;
        Some(candidate)
    };
    let (rest, candidates): (Vec<&CaseResult>, Vec<Candidate>) =
        rest.into_iter().filter_map(|result| Some((result, candidate(result)?))).unzip();
    let places = Choice::new(&candidates).best(SHOWN - found.len(), By::Diverse);
    found.extend(places.into_iter().map(|place| rest[place]));
    found
}

/// Writes [`html`].
///
/// # Errors
/// The file cannot be written.
pub fn write(path: &Path, data: &ReportData) -> Result<(), WriteError> {
    atomic::write(path, html(data).as_bytes())
}

#[cfg(test)]
mod tests {
    use hairpin::campaign::Undone;
    use nalgebra::Point3;

    use super::*;

    #[test]
    fn of_many_cases_the_worst_open_what_is_asked_for_and_what_is_unlike_the_rest() {
        // Near copies of one way, but for seven of the good ones.
        let unlike = 230..237;
        let way = |number: usize| {
            let far = if unlike.contains(&number) { 10.0 * (number - 225) as f64 } else { 1e-6 * number as f64 };
            vec![Point3::origin(), Point3::new(5.0, far, 0.0), Point3::new(10.0, 0.0, 0.0)]
        };
        let cases: Vec<Case> = (0..300).map(|n| Case::bare(CaseNumber(n), 0, way(n))).collect();
        let results: Vec<CaseResult> =
            (0..300).map(|n| CaseResult::undone(CaseNumber(n), Undone::NotExecuted)).collect();
        let open = |asked: &[CaseNumber]| {
            let found = chosen(worst_first(&results), &cases, asked);
            found.iter().map(|result| result.case.0).collect::<Vec<usize>>()
        };
        let found = open(&[CaseNumber(299)]);
        assert!(found[0] == 299 && found[1..=WORST].iter().copied().eq(0..WORST), "{found:?}");
        assert!(unlike.clone().all(|n| found.contains(&n)), "{found:?}");
        assert_eq!((found.len(), found.iter().collect::<BTreeSet<_>>().len()), (SHOWN, SHOWN));
        let all: Vec<CaseNumber> = (0..250).map(CaseNumber).collect();
        assert_eq!(open(&all).len(), SHOWN);
    }
}
