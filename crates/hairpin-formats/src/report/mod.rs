//! `report.html`: one file that opens offline in any browser, with a view of its own (`view/`). Without JavaScript it
//! still has the verdict, the table and the worst cases' top and side views.

mod cases;
mod column;
mod data;
mod day_card;
mod escape;
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

use std::path::Path;

use hairpin::campaign::report::{self, Drawn, Pieces, ReportData, shown, worst_first};
use hairpin::campaign::{Baseline, Case, CaseNumber, CaseResult, Run, Setup, Tally};
use hairpin::judgement::{JudgementError, Verdict};
use thiserror::Error;

use crate::atomic::{self, WriteError};
use crate::folder::{CampaignFolder, FolderError};
use crate::header::Header;

pub use day_card::{DayCard, FlightCard, day_card_html};
pub use page::html;

/// Cases that open at most: the file stays below 8 MB. Of more than that the worst, and the others evenly over what is
/// left, from bad to good.
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
    /// A run of a case, `None` where it was not executed or is not to be had any more.
    ///
    /// # Errors
    /// Why it cannot be read.
    fn run(&self, case: &Case, run: usize) -> Result<Option<Run>, String>;

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
    let mut in_full = Vec::new();
    for result in chosen(worst_first(&results), asked) {
        let Some(case) = cases.iter().find(|case| case.number == result.case) else { continue };
        // What is followed is planned from its witness, as the judge does it.
        let mut case = case.clone();
        folder.read_witness(&mut case)?;
        let planned = folder.read_planned(case.number)?;
        let run = motions.run(&case, result.run).map_err(ReportError::Run)?;
        let others = match setup.scenario.executor().repeat {
            1 => Vec::new(),
            _ => motions.kept(case.number).map_err(ReportError::Run)?,
        };
        let flight = |cause| ReportError::Flight { case: case.number, run: result.run, cause };
        in_full.push(shown(setup, &case, result, planned, run.as_ref().map(Drawn::from), &others).map_err(flight)?);
    }
    let (baseline, scenario) = (folder.read_baseline()?, &setup.scenario);
    let pieces = Pieces {
        setup,
        cases: &cases,
        results: &results,
        tally: Some(&tally),
        verdict,
        assumptions,
        shown: in_full,
        frame: Header::of(setup, &results).lines(),
        influences: folder.read_influences()?,
        coverage: folder.read_coverage()?,
        baseline: baseline
            .as_ref()
            .and_then(|measured| Baseline::of(scenario.search().sought(), scenario.executor().repeat, measured)),
        random: baseline.as_deref().unwrap_or_default(),
        asked: asked.first().copied(),
    };
    Ok(report::assemble(pieces))
}

/// The cases that open: all, or of too many the worst and the others from bad to good, with what was asked for.
fn chosen<'a>(ordered: Vec<&'a CaseResult>, asked: &[CaseNumber]) -> Vec<&'a CaseResult> {
    if ordered.len() <= SHOWN {
        return ordered;
    }
    let is_asked = |result: &&CaseResult| asked.contains(&result.case);
    let mut found: Vec<&CaseResult> = ordered.iter().copied().filter(is_asked).take(SHOWN).collect();
    let worst = WORST.min(SHOWN - found.len());
    found.extend(ordered[..worst].iter().copied().filter(|result| !is_asked(result)));
    let rest = &ordered[worst..];
    let places = SHOWN.saturating_sub(found.len());
    // The last of them is the best case.
    let evenly = (1..=places).filter_map(|i| rest.get((i * rest.len() / places).saturating_sub(1)).copied());
    found.extend(evenly.filter(|result| !is_asked(result)));
    found
}

/// Writes [`html`].
///
/// # Errors
/// The file cannot be written.
pub fn write(path: &Path, data: &ReportData) -> Result<(), WriteError> {
    atomic::write(path, html(data).as_bytes())
}
