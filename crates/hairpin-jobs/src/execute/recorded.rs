//! Where an arm ran elsewhere, its logs become the campaign's runs.

use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::path::{Path, PathBuf};

use hairpin::campaign::arm::ArmSetup;
use hairpin::campaign::{Case, CaseNumber, Run};
use hairpin_formats::folder::Landed;
use hairpin_formats::recordings::{self, RecordingError};
use rayon::prelude::*;

use crate::work::Work;
use crate::{Problem, Watch, copies};

/// A log of each case and run.
type Files = BTreeMap<(CaseNumber, usize), PathBuf>;

/// Broken logs that are told one by one.
const LISTED: usize = 10;

/// Whether the logs that the scenario names, if it names any, are the runs of `cases`.
///
/// # Errors
/// Those that are missing, too many, or cannot be used.
pub(crate) fn check_recordings(work: &Work, cases: &[Case]) -> Result<(), Problem> {
    match (work.setup.own::<ArmSetup>(), work.setup.recordings()) {
        (Some(arm), Some(pattern)) => read(&found(work, pattern, cases)?, arm, cases, &|_| Ok(())),
        _ => Ok(()),
    }
}

/// Reads the logs that `pattern` names and writes them as runs; those that are one recording are told.
pub(super) fn take_in(
    work: &Work,
    (arm, pattern): (&ArmSetup, &str),
    cases: &[Case],
    watch: &dyn Watch,
) -> Result<(), Problem> {
    let repeat = work.setup.scenario.executor().repeat as usize;
    let files = found(work, pattern, cases)?;
    let name = |file: &Path| file.file_name().unwrap_or_default().to_string_lossy().into_owned();
    copies::told(&copies::copies(files.values()), name).iter().for_each(|words| watch.warn(words));
    let all = cases.iter().flat_map(|case| (0..repeat).map(move |run| (case.number, run)));
    let writer = work.folder.write_runs(repeat, all);
    read(&files, arm, cases, &|run| {
        let landed = Landed::of(&run, &BTreeSet::new());
        Ok(writer.land(landed.map_err(|cause| writer.no_room(cause))?)?)
    })?;
    Ok(writer.finish()?)
}

/// The logs by case and run.
fn found(work: &Work, pattern: &str, cases: &[Case]) -> Result<Files, Problem> {
    let repeat = work.setup.scenario.executor().repeat as usize;
    recordings::find(work.folder.path(), pattern, cases, repeat).map_err(|wrong| refuse(&wrong))
}

/// Reads them one by one on all threads, and hands each on.
fn read(
    files: &Files,
    arm: &ArmSetup,
    cases: &[Case],
    landed: &(dyn Fn(Run) -> Result<(), Problem> + Sync),
) -> Result<(), Problem> {
    let by_number: HashMap<CaseNumber, &Case> = cases.iter().map(|case| (case.number, case)).collect();
    let read = |((number, run), path): (&(CaseNumber, usize), &PathBuf)| {
        let case = by_number.get(number)?;
        match recordings::read(path, arm, case, *run) {
            Ok(run) => landed(run).err().map(Err),
            Err(wrong) => Some(Ok(wrong)),
        }
    };
    let wrong = files.par_iter().filter_map(read).collect::<Result<Vec<RecordingError>, Problem>>()?;
    if wrong.is_empty() { Ok(()) } else { Err(refuse(&wrong)) }
}

fn refuse(wrong: &[RecordingError]) -> Problem {
    let mut lines: Vec<String> = wrong.iter().take(LISTED).map(ToString::to_string).collect();
    if wrong.len() > LISTED {
        lines.push(format!("and {} more", wrong.len() - LISTED));
    }
    Problem::input(lines.join("\n"))
}
