//! `hairpin execute`: the flights of a campaign whose trajectories are there, or of waypoint files made elsewhere.

use hairpin_formats::{folder::CampaignFolder, waypoints};
use serde_json::json;

use super::parts::{self, Flown, Replayed};
use crate::args::Execute;
use crate::problem::Problem;
use crate::{console, folder};

/// Runs the command: 0 when everything was flown, 4 when the executor failed in any run.
pub(crate) fn run(execute: &Execute) -> Result<u8, Problem> {
    folder::take_threads(&execute.threads);
    let mut sets = folder::split(&execute.sets)?;
    sets.extend(execute.executor.as_deref().map(folder::as_command));
    sets.extend(execute.logs.as_deref().map(|logs| folder::as_logs(&execute.folder, logs)));
    sets.extend(execute.rerun_violations.map(|n| ("execute.flaky.reruns".to_owned(), n.to_string())));
    let missions = execute.missions.as_deref().map(waypoints::read_folder).transpose().map_err(Problem::input)?;
    if execute.resume && !sets.is_empty() {
        unchanged(execute, &sets)?;
    }
    let work = folder::open(&execute.folder, &sets, &["execute", "vary", "spec"], Some(&execute.kernels))?;
    if missions.is_none() && !work.folder.has_cases() {
        let path = execute.folder.display();
        return Err(Problem::input(format!("{path} has no cases yet: hairpin generate, or --missions DIR")));
    }
    // Whatever can be refused is refused before anything is lost.
    let replayed = parts::replay_saved(&work.setup, work.folder.path(), execute.saved.repro.as_deref())?;
    let kept = missions.is_none().then(|| work.folder.read_cases()).transpose()?;
    parts::check_recordings(&work, kept.as_deref().unwrap_or_default())?;
    if !sets.is_empty() {
        folder::keep_changes(&work)?;
    }
    let cases = match (&missions, kept) {
        (None, Some(cases)) => cases,
        (missions, _) => {
            parts::adopt(&work, missions.as_deref().unwrap_or_default())?;
            work.folder.read_cases()?
        }
    };
    // What was judged was judged on other runs, or on fewer. Where this cannot be written, the runs stay with it.
    work.folder.write_results(&cases, &[])?;
    if !execute.resume {
        work.folder.forget_runs()?;
    }
    let Flown { runs, failed, attitude_unknown } = parts::execute(&work, &cases)?;
    let (sentence, code) = if failed == 0 {
        (format!("EXECUTED {runs} runs of {} cases", cases.len()), 0)
    } else {
        (format!("EXECUTOR FAILED {failed}/{runs} runs (stderr kept in executor-CASE-RUN.log)"), 4)
    };
    if execute.json {
        let replayed: Vec<_> = replayed.iter().map(Replayed::object).collect();
        let counts = json!({
            "cases": cases.len(), "runs": runs, "executor_failed": failed, "attitude_unknown": attitude_unknown,
        });
        let missions: Vec<&String> = missions.iter().flatten().map(|mission| &mission.name).collect();
        let paths = json!({ "folder": work.folder.path(), "executions": work.folder.file("executions") });
        let object = json!({
            "verdict": sentence, "exit_code": code, "counts": counts, "missions": missions, "paths": paths,
            "replayed": replayed,
        });
        console::say(&object.to_string());
    } else {
        console::say(&sentence);
    }
    Ok(code)
}

/// `--resume` goes on with the same settings, or runs of two kinds would stand side by side.
fn unchanged(execute: &Execute, sets: &[(String, String)]) -> Result<(), Problem> {
    let before = CampaignFolder::open(&execute.folder)?;
    match folder::changed_by(&before, sets)? {
        None => Ok(()),
        Some(key) => {
            Err(Problem::input(format!("--resume: `{key}` is not what it was; without --resume all is flown anew")))
        }
    }
}
