//! Saved violations, run again before anything else: what failed once is what a change is most likely to have mended, or not.

use std::path::{Path, PathBuf};

use hairpin::campaign::{self, CaseResult, Scenario, Setup, Status};
use hairpin_formats::scenario;
use rayon::prelude::*;
use serde_json::{Value, json};

use super::{Repro, fly_one};
use crate::console;
use crate::folder::Work;
use crate::interrupt;
use crate::problem::Problem;

/// One saved case and what it comes to now.
pub(crate) struct Replayed {
    file: PathBuf,
    result: CaseResult,
}

/// Runs the repro files of `folder`, or of the campaign's own folder where none is named, as robot, `execute` and `spec` of the campaign
/// now are, in the conditions in which they were saved; and tells of them on stderr.
///
/// # Errors
/// A folder that is named and has none; a file that is no repro file, or of another kind of robot.
pub(crate) fn replay_saved(work: &Work, folder: Option<&Path>) -> Result<Vec<Replayed>, Problem> {
    let own = work.folder.file("repro");
    let files = files(folder.unwrap_or(&own));
    if let (Some(folder), true) = (folder, files.is_empty()) {
        return Err(Problem::input(format!("--repro {}: there is no repro file (*.json) in it", folder.display())));
    }
    let run = |file: &PathBuf| if interrupt::asked() { Ok(None) } else { replay(work, file).map(Some) };
    // One executor of the user's at a time, as each keeps its own.
    let replayed: Result<Vec<Option<Replayed>>, Problem> = match work.setup.scenario.executor().command {
        None => files.par_iter().map(run).collect(),
        Some(_) => files.iter().map(run).collect(),
    };
    let replayed: Vec<Replayed> = replayed?.into_iter().flatten().collect();
    if !replayed.is_empty() {
        tell(&replayed);
    }
    Ok(replayed)
}

/// `*.json` in `folder`, by name.
fn files(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path());
    let mut files: Vec<PathBuf> =
        entries.filter(|path| path.extension().is_some_and(|ending| ending == "json")).collect();
    files.sort();
    files
}

fn replay(work: &Work, file: &Path) -> Result<Replayed, Problem> {
    let repro = Repro::read(file)?;
    let refuse = |why: String| Problem::input(format!("{}: {why}", file.display()));
    let mut scenario = repro.scenario.clone();
    scenario::attach(&mut scenario, file.parent().unwrap_or(Path::new("")))?;
    if !adopt(&mut scenario, &work.setup.scenario) {
        return Err(refuse("is of another kind of robot than this campaign".into()));
    }
    let setup = Setup::new(scenario).map_err(|mistake| refuse(format!("scenario.{mistake}")))?;
    let setup = setup.with_simd(work.setup.simd);
    let case = repro.case().map_err(refuse)?;
    let flown = fly_one(&setup, &case, repro.run)?;
    let result = campaign::judge(&setup, &case, std::slice::from_ref(&flown))?;
    Ok(Replayed { file: file.into(), result })
}

/// Takes over who executes and what is within spec; the noise stays that of the saved run. Whether both are of one kind.
fn adopt(saved: &mut Scenario, now: &Scenario) -> bool {
    match (saved, now) {
        (Scenario::Flight(saved), Scenario::Flight(now)) => {
            let noise = saved.execute.noise;
            (saved.robot, saved.execute, saved.spec) = (now.robot.clone(), now.execute.clone(), now.spec.clone());
            saved.execute.noise = noise;
        }
        (Scenario::Drive(saved), Scenario::Drive(now)) => {
            let noise = saved.execute.noise;
            (saved.robot, saved.execute, saved.spec) = (now.robot.clone(), now.execute.clone(), now.spec.clone());
            saved.execute.noise = noise;
        }
        (Scenario::Arm(saved), Scenario::Arm(now)) => {
            (saved.robot, saved.execute, saved.spec) = (now.robot.clone(), now.execute.clone(), now.spec.clone());
        }
        _ => return false,
    }
    true
}

impl Replayed {
    /// For machines.
    pub(crate) fn object(&self) -> Value {
        json!({
            "file": self.file,
            "status": self.result.status.word(),
            "max_deviation_m": self.result.measures.as_ref().map(|measures| measures.max_deviation),
            "violations": self.result.violations.iter().map(campaign::report::violation).collect::<Vec<_>>(),
        })
    }
}

/// The exit code of a command that came to `code` and ran `replayed` before: a saved case that violates still is a violation.
pub(crate) fn with_saved(code: u8, replayed: &[Replayed]) -> u8 {
    let any = |status: Status| replayed.iter().any(|one| one.result.status == status);
    match code {
        0 | 3 | 5 if any(Status::Fail) => 1,
        0 if any(Status::ExecutorFailed) => 4,
        code => code,
    }
}

fn tell(replayed: &[Replayed]) {
    let violating = replayed.iter().filter(|one| one.result.status == Status::Fail).count();
    console::warn(&format!("saved cases first: {violating} of {} violate", replayed.len()));
    for one in replayed {
        let what = match one.result.status {
            Status::Fail => one.result.violations.first().map(campaign::report::violation).unwrap_or_default(),
            Status::Pass => continue,
            _ => one.result.message.clone().unwrap_or_default(),
        };
        console::warn(&format!("  {}: {what}", one.file.display()));
    }
}
