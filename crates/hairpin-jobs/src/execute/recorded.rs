//! Where an arm ran elsewhere, its logs become the campaign's runs.

use std::collections::BTreeSet;
use std::path::PathBuf;

use hairpin::campaign::arm::ArmSetup;
use hairpin::campaign::{Case, CaseNumber, Run};
use hairpin_formats::folder::Landed;
use hairpin_formats::recordings::{self, RecordingError};
use rayon::prelude::*;

use crate::Problem;
use crate::work::Work;

/// Broken logs that are told one by one.
const LISTED: usize = 10;

/// Whether the logs that the scenario names, if it names any, are the runs of `cases`.
///
/// # Errors
/// Those that are missing, too many, or cannot be used.
pub(super) fn check(work: &Work, cases: &[Case]) -> Result<(), Problem> {
    match (work.setup.own::<ArmSetup>(), work.setup.recordings()) {
        (Some(arm), Some(pattern)) => read(work, arm, pattern, cases).map(drop),
        _ => Ok(()),
    }
}

/// Reads the logs that `pattern` names and writes them as runs: all of them, or none where one cannot be used.
pub(super) fn take_in(work: &Work, arm: &ArmSetup, pattern: &str, cases: &[Case]) -> Result<(), Problem> {
    let runs = read(work, arm, pattern, cases)?;
    let repeat = work.setup.scenario.executor().repeat as usize;
    let writer = work.folder.write_runs(repeat, runs.iter().map(|run| (run.case, run.run)));
    for run in &runs {
        let landed = Landed::of(run, &BTreeSet::new());
        writer.land(landed.map_err(|cause| writer.no_room(cause))?)?;
    }
    Ok(writer.finish()?)
}

fn read(work: &Work, arm: &ArmSetup, pattern: &str, cases: &[Case]) -> Result<Vec<Run>, Problem> {
    let repeat = work.setup.scenario.executor().repeat as usize;
    let files = recordings::find(work.folder.path(), pattern, cases, repeat).map_err(|wrong| refuse(&wrong))?;
    let jobs: Vec<((CaseNumber, usize), PathBuf)> = files.into_iter().collect();
    let read = |((number, run), path): &((CaseNumber, usize), PathBuf)| {
        let case = cases.iter().find(|case| case.number == *number);
        case.map(|case| recordings::read(path, arm, case, *run))
    };
    let read: Vec<Result<Run, RecordingError>> = jobs.par_iter().filter_map(read).collect();
    let (runs, wrong): (Vec<_>, Vec<_>) = read.into_iter().partition(Result::is_ok);
    let wrong: Vec<RecordingError> = wrong.into_iter().filter_map(Result::err).collect();
    if !wrong.is_empty() {
        return Err(refuse(&wrong));
    }
    Ok(runs.into_iter().flatten().collect())
}

fn refuse(wrong: &[RecordingError]) -> Problem {
    let mut lines: Vec<String> = wrong.iter().take(LISTED).map(ToString::to_string).collect();
    if wrong.len() > LISTED {
        lines.push(format!("and {} more", wrong.len() - LISTED));
    }
    Problem::input(lines.join("\n"))
}
