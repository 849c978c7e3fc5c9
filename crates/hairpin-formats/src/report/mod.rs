//! `report.html`: one file that opens offline in any browser, with plotly.js inside. Without JavaScript it still has
//! the verdict, the table and the worst case's top and side view.

mod cases;
mod data;
mod day_card;
mod escape;
mod more;
mod page;
mod progress;
mod regression;
mod relief;
mod setup;
mod spread;
mod svg;
mod worst;

use std::path::Path;

use hairpin::campaign::report::{self, Pieces, ReportData, shown, worst_first};
use hairpin::campaign::{Baseline, Case, CaseNumber, Run, Setup, Tally};
use hairpin::judgement::{JudgementError, Verdict};
use thiserror::Error;

use crate::atomic::{self, WriteError};
use crate::folder::{CampaignFolder, FolderError};
use crate::header::Header;

pub use day_card::{DayCard, FlightCard, day_card_html};
pub use page::html;

/// Cases shown in full at most: the file stays below 8 MB.
pub const SHOWN: usize = 20;

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

/// Gives a run of a case, `None` where it was not executed or is not to be had any more, or says why it cannot be read.
pub type Runs<'a> = dyn Fn(&Case, usize) -> Result<Option<Run>, String> + 'a;

/// Gathers a report from a judged campaign folder; `run` gives those that are shown.
///
/// # Errors
/// Files that are missing or broken; as `run`, in words.
pub fn from_folder(
    folder: &CampaignFolder,
    setup: &Setup,
    verdict: Verdict,
    assumptions: Vec<String>,
    run: &Runs,
) -> Result<ReportData, ReportError> {
    let cases = folder.read_cases_without_profiles()?;
    let results = folder.read_results()?;
    // Older parts of the folder may have been deleted by hand: the tally only adds two numbers.
    let tally = folder.read_tally().unwrap_or_else(|_| Tally { solved: cases.len() as u64, ..Tally::default() });
    let mut in_full = Vec::new();
    for result in worst_first(&results).into_iter().take(SHOWN) {
        let Some(case) = cases.iter().find(|case| case.number == result.case) else { continue };
        let planned = folder.read_planned(case.number)?;
        let run = run(case, result.run).map_err(ReportError::Run)?;
        let flight = |cause| ReportError::Flight { case: case.number, run: result.run, cause };
        in_full.push(shown(setup, case, result, planned, run.as_ref()).map_err(flight)?);
    }
    let (baseline, scenario) = (folder.read_baseline()?, &setup.scenario);
    let pieces = Pieces {
        setup,
        cases: &cases,
        results: &results,
        tally: &tally,
        verdict,
        assumptions,
        shown: in_full,
        frame: Header::of(setup, &results).lines(),
        influences: folder.read_influences()?,
        coverage: folder.read_coverage()?,
        baseline: baseline
            .and_then(|measured| Baseline::of(scenario.search().sought(), scenario.executor().repeat, &measured)),
    };
    Ok(report::assemble(pieces))
}

/// Writes [`html`].
///
/// # Errors
/// The file cannot be written.
pub fn write(path: &Path, data: &ReportData) -> Result<(), WriteError> {
    atomic::write(path, html(data).as_bytes())
}
