//! The worst violations as files that can be run again, beside those that stand there.

use std::path::{Path, PathBuf};

use hairpin::campaign::report::worst_first;
use hairpin::campaign::{Case, CaseResult, Setup, Status};
use hairpin_formats::atomic;
use hairpin_formats::bounds::{self, MOST_BYTES};
use hairpin_formats::repro::Repro;

use crate::Problem;
use crate::execute::WORST;
use crate::missions::MissionsTold;
use crate::saved::Replayed;
use crate::work::Work;

/// Writes `repro/CASE.json` of the ten worst violations anew.
///
/// Only what is judged anew goes: shrunk cases, those of a larger campaign before, and files of the users' own are
/// there to be run again. So is what stands under a case's name and is another case, of a campaign that was here
/// before, unless it was `replayed` and passes: it gets a name of its own.
pub(super) fn write_repros(
    work: &Work,
    cases: &[Case],
    (results, replayed): (&[CaseResult], &[Replayed]),
    told: Option<&MissionsTold>,
) -> Result<(), Problem> {
    let folder = work.folder.file("repro");
    for case in cases {
        let file = folder.join(format!("{}.json", case.id()));
        if !file.is_file() {
            continue;
        }
        let result = results.iter().find(|result| result.case == case.number);
        let is_own = || result.is_some_and(|result| is_of(&file, &work.setup, case, result));
        let passes = |one: &&Replayed| one.result.status == Status::Pass && is_same(&one.file, &file);
        if is_own() || replayed.iter().any(|one| passes(&one)) {
            std::fs::remove_file(&file).map_err(|error| refused("remove", &file, &error))?;
        } else {
            keep(&file, &folder, &case.id())?;
        }
    }
    let flown_by = work.folder.read_executor()?;
    let violating = worst_first(results).into_iter().filter(|result| result.status == Status::Fail);
    // Of every other `hairpin replay OUT --case` makes one.
    for result in violating.take(WORST) {
        atomic::make_folder(&folder)?;
        if let Some(case) = cases.iter().find(|case| case.number == result.case) {
            let mission = told.and_then(|told| told.asked_of(case.number)).cloned();
            let repro = Repro { flown_by: flown_by.clone(), mission, ..Repro::of(&work.setup, case, result) };
            repro.write(&folder.join(format!("{}.json", case.id())))?;
        }
    }
    Ok(())
}

/// Whether `file` is `case`, whatever limits it is held to now and whoever executes it; what is no repro file is not.
fn is_of(file: &Path, setup: &Setup, case: &Case, result: &CaseResult) -> bool {
    let as_now = |mut repro: Repro| {
        repro.scenario.adopt(&*setup.scenario)?;
        Some(repro)
    };
    let read = |own: &Repro| serde_json::from_value::<Repro>(serde_json::to_value(own).ok()?).ok();
    let (Ok(saved), Some(own)) = (Repro::read(file), read(&Repro::of(setup, case, result))) else { return false };
    // What was seen of which run, and who flew, is nothing that makes it another case.
    let Repro { run, expected, flown_by, mission, .. } = saved.clone();
    let own = Repro { run, expected, flown_by, mission, ..own };
    as_now(saved).is_some_and(|saved| as_now(own).is_some_and(|own| own == saved))
}

fn is_same(one: &Path, other: &Path) -> bool {
    match (std::fs::canonicalize(one), std::fs::canonicalize(other)) {
        (Ok(one), Ok(other)) => one == other,
        _ => one == other,
    }
}

/// Gives `file` the first name beside it that nothing has, or leaves the one that holds the same.
fn keep(file: &Path, folder: &Path, case: &str) -> Result<(), Problem> {
    let names = (1_u32..).map(|number| match number {
        1 => format!("{case}-kept.json"),
        _ => format!("{case}-kept-{number}.json"),
    });
    let told = bounds::read(file, MOST_BYTES).map_err(|error| refused("read", file, &error))?;
    for there in names.map(|name: String| -> PathBuf { folder.join(name) }) {
        if !there.exists() {
            return std::fs::rename(file, &there).map_err(|error| refused("rename", file, &error));
        }
        if bounds::read(&there, MOST_BYTES).is_ok_and(|kept| kept == told) {
            return std::fs::remove_file(file).map_err(|error| refused("remove", file, &error));
        }
    }
    Ok(())
}

fn refused(what: &str, file: &Path, error: &std::io::Error) -> Problem {
    Problem::input(format!("cannot {what} {}: {error}", file.display()))
}
