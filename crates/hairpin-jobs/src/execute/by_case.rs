//! Cases flown for what comes of them, of which no run is kept: each is handed on when its last run has landed, so that
//! no more flights are in memory than are in the air.

use std::sync::{Mutex, PoisonError};

use hairpin::campaign::{Case, Run, Setup, execute_run, mission};
use hairpin_formats::executor::{Failed, fly_all_if};
use hairpin_formats::folder::CampaignFolder;
use rayon::prelude::*;

use super::fly::{as_run, command_of, processes, unless_stopped, while_wanted};
use crate::program::Executing;
use crate::watch::Steps;
use crate::{Problem, Watch};

/// What `made` makes of all runs of each of `cases`, in their order; `what` is told of as it goes on. Where they stand
/// beside what was executed in a folder, `beside`, it is by the same program.
///
/// # Errors
/// A command that is none; a program that is another than the folder's; it was asked to stop.
pub(crate) fn fly_by_case<T: Send>(
    (setup, beside): (&Setup, Option<&CampaignFolder>),
    cases: &[Case],
    made: &(dyn Fn(&Case, &[Run]) -> T + Sync),
    (what, watch): (&'static str, &dyn Watch),
) -> Result<Vec<T>, Problem> {
    let repeat = setup.scenario.executor().repeat as usize;
    let steps = Steps::new(watch, what, 0, cases.len() * repeat);
    let stopped = || Problem::Interrupted("stopped; --resume goes on".into());
    let Some((command, limits)) = command_of(setup)? else {
        let fly = |case: &Case| {
            let run = |run| {
                let flown = (!watch.stopped()).then(|| execute_run(setup, case, run));
                steps.step();
                unless_stopped(flown?, watch)
            };
            let runs: Option<Vec<Run>> = (0..repeat).map(run).collect();
            runs.map(|runs| made(case, &runs))
        };
        let flown = while_wanted(setup, watch, || cases.par_iter().map(fly).collect::<Option<_>>());
        return flown.ok_or_else(stopped);
    };
    let landed: Mutex<Vec<Vec<Run>>> = Mutex::new(vec![Vec::new(); cases.len()]);
    let all: Mutex<Vec<Option<T>>> = Mutex::new(cases.iter().map(|_| None).collect());
    let make =
        |index: usize| mission(setup, &cases[index / repeat], index % repeat).map_err(|mistake| mistake.to_string());
    let land = |index: usize, result: Result<_, Failed>| {
        let (place, number) = (index / repeat, index % repeat);
        let case = &cases[place];
        let run = as_run(setup, case, number, result);
        let mut runs = {
            let mut landed = landed.lock().unwrap_or_else(PoisonError::into_inner);
            landed[place].push(run);
            if landed[place].len() < repeat { Vec::new() } else { std::mem::take(&mut landed[place]) }
        };
        if !runs.is_empty() {
            runs.sort_by_key(|run| run.run);
            let one = made(case, &runs);
            all.lock().unwrap_or_else(PoisonError::into_inner)[place] = Some(one);
        }
        steps.step();
    };
    let executing = beside.map(Executing::within).transpose()?;
    let may = |now: &_| executing.as_ref().is_none_or(|executing| executing.may(now));
    let (processes, count) = (processes(setup), cases.len() * repeat);
    fly_all_if((&command, limits), &may, processes, count, &make, &land, &|| watch.stopped());
    if let Some(refused) = executing.as_ref().and_then(Executing::refusal) {
        return Err(refused);
    }
    let all = all.into_inner().unwrap_or_else(PoisonError::into_inner);
    all.into_iter().collect::<Option<_>>().ok_or_else(stopped)
}
