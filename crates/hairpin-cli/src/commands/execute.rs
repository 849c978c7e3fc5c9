//! `hairpin execute`: the flights of a campaign whose trajectories are there, or of waypoint files made elsewhere.

use hairpin_jobs::execute::{ExecuteSettings, Flown, execute};
use hairpin_jobs::{Problem, Watch, sets};
use serde_json::json;

use super::answer::replayed_object;
use crate::args::Execute;
use crate::exit::{DONE, EXECUTOR_FAILED};
use crate::{console, settings};

/// Runs the command: 0 when everything was flown, 4 when the executor failed in any run.
pub(crate) fn run(asked: &Execute, watch: &dyn Watch) -> Result<u8, Problem> {
    settings::take_threads(&asked.threads);
    let mut all = settings::split(&asked.sets)?;
    all.extend(asked.executor.as_deref().map(sets::executor));
    all.extend(asked.logs.as_deref().map(|logs| sets::logs(&asked.folder, logs)));
    all.extend(settings::record(&asked.kept));
    all.extend(asked.rerun_violations.map(|n| ("execute.flaky.reruns".to_owned(), n.to_string())));
    let settings = ExecuteSettings {
        folder: asked.folder.clone(),
        out: asked.out.clone(),
        replaces: asked.force,
        sets: all,
        missions: asked.missions.clone(),
        repro: asked.saved.repro.clone(),
        resume: asked.resume,
        simd: settings::simd(&asked.kernels),
        consent: settings::consent(&asked.commands),
    };
    let executed = execute(&settings, watch)?;
    let (cases, flown) = (executed.cases, executed.flown);
    let Flown { runs, failed, never_asked, attitude_unknown, end_unsaid, heights_by_map } = flown;
    let (sentence, code) = if failed == 0 {
        (format!("EXECUTED {runs} runs of {cases} cases"), DONE)
    } else {
        let why = executed.trouble.as_ref().map_or(String::new(), |why| format!("{why}; "));
        let sentence = format!("EXECUTOR FAILED {failed}/{runs} runs ({why}stderr kept in executor-CASE-RUN.log)");
        (sentence, EXECUTOR_FAILED)
    };
    if asked.json {
        let counts = json!({
            "cases": cases, "runs": runs, "executor_failed": failed, "never_asked": never_asked,
            "attitude_unknown": attitude_unknown, "end_unsaid": end_unsaid, "heights_by_map": heights_by_map,
        });
        let replayed: Vec<_> = executed.replayed.iter().map(replayed_object).collect();
        let paths = json!({ "folder": executed.folder, "executions": executed.folder.join("executions") });
        let object = json!({
            "verdict": sentence, "exit_code": code, "counts": counts, "missions": executed.missions, "paths": paths,
            "replayed": replayed,
        });
        console::say(&object.to_string());
    } else {
        console::say(&sentence);
    }
    Ok(code)
}
