//! Executes missions: all of a campaign's in our own simulator, or one wherever it is carried out.

use rayon::prelude::*;

use super::{Case, CaseNumber, Executor, Mission, Mistake, OwnSimulator, Run, Setup, Stop, mission, mission_again};

/// Runs of `cases` that `wanted(case, run)` asks for, in our own simulator, on all threads of the current pool.
///
/// `sink` gets each run when it is done, in no particular order and from any thread. Runs are pure functions of the
/// scenario, the case's seed and the run's number.
///
/// Runs are asked for in the order of cases, then of runs, and land in any. `stop.cancelled` is looked at before each
/// run: what was begun is finished. `stop.progress` counts runs, those that are not wanted as done.
pub fn execute(
    setup: &Setup,
    cases: &[Case],
    wanted: &(dyn Fn(CaseNumber, usize) -> bool + Sync),
    stop: &Stop,
    sink: &(dyn Fn(Run) + Sync),
) {
    let repeat = setup.scenario.executor().repeat as usize;
    let total = cases.len() * repeat;
    let todo: Vec<(&Case, usize)> = cases
        .iter()
        .flat_map(|case| (0..repeat).map(move |run| (case, run)))
        .filter(|(case, run)| wanted(case.number, *run))
        .collect();
    let done = std::sync::atomic::AtomicUsize::new(total - todo.len());
    (stop.progress)(total - todo.len(), total);
    todo.into_par_iter().for_each(|(case, run)| {
        if (stop.cancelled)() {
            return;
        }
        sink(execute_run(setup, case, run));
        (stop.progress)(1 + done.fetch_add(1, std::sync::atomic::Ordering::Relaxed), total);
    });
}

/// Run number `run` of `case` in our own simulator.
///
/// An error of the mission (a draw that no robot has) is a run whose outcome says so, as a failed execution is.
pub fn execute_run(setup: &Setup, case: &Case, run: usize) -> Run {
    run_of(setup, &OwnSimulator, case, run, mission(setup, case, run))
}

/// The same with other noise, for the time number `again`: [`mission_again`].
///
/// `again` counts from 0; draws for `[vary]` stay those of `run`.
pub fn execute_again(setup: &Setup, case: &Case, run: usize, again: usize) -> Run {
    run_of(setup, &OwnSimulator, case, run, mission_again(setup, case, run, again))
}

/// What becomes of `mission`, run number `run` of `case`, where `executor` carries it out.
pub(super) fn run_of(
    setup: &Setup,
    executor: &dyn Executor,
    case: &Case,
    run: usize,
    mission: Result<Mission, Mistake>,
) -> Run {
    match mission {
        Ok(mission) => {
            let outcome = executor.fly(setup, case, &mission);
            Run { case: case.number, run, drawn: mission.drawn, outcome, full_rate: None }
        }
        Err(mistake) => {
            Run { case: case.number, run, drawn: Vec::new(), outcome: Err(mistake.to_string()), full_rate: None }
        }
    }
}
