//! Every case flown as often as the scenario asks for, each flight written as soon as it has landed.

use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;

use hairpin::campaign::arm::ArmSetup;
use hairpin::campaign::{
    self, Case, Mission, Mistake, Run, Setup, Status, execute_again, execute_run, mission, mission_again,
};
use hairpin::trajectory::ATTITUDE_UNKNOWN;
use hairpin_formats::executor::{Command, Failed, Failure, Limits, fly_all};
use hairpin_formats::folder::{CampaignFolder, FolderError};
use hairpin_formats::parquet::runs::RunFacts;
use rayon::prelude::*;

use super::recorded;
use crate::watch::Steps;
use crate::work::Work;
use crate::{Problem, Watch};

/// What the runs of a campaign are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Flown {
    /// All runs.
    pub runs: usize,
    /// Of these, runs that the executor failed to fly.
    pub failed: usize,
    /// Of these, runs of which the executor sent no attitudes.
    pub attitude_unknown: usize,
}

/// What is flown: run number `run` of a case or, where it violated, that run for the time number `again`.
#[derive(Debug, Clone, Copy)]
struct Job<'a> {
    case: &'a Case,
    run: usize,
    again: Option<usize>,
}

impl Job<'_> {
    fn mission(&self, setup: &Setup) -> Result<Mission, Mistake> {
        match self.again {
            None => mission(setup, self.case, self.run),
            Some(again) => mission_again(setup, self.case, self.run, again),
        }
    }

    fn simulate(&self, setup: &Setup) -> Run {
        match self.again {
            None => execute_run(setup, self.case, self.run),
            Some(again) => execute_again(setup, self.case, self.run, again),
        }
    }
}

/// Flies all runs of `cases` that are not in the folder yet, and violations as often again as the scenario asks for.
pub(crate) fn fly_missing(work: &Work, cases: &[Case], watch: &dyn Watch) -> Result<Flown, Problem> {
    let repeat = work.setup.scenario.executor().repeat as usize;
    if let (Some(arm), Some(pattern)) = (work.setup.own::<ArmSetup>(), work.setup.recordings()) {
        recorded::take_in(work, arm, pattern, cases)?;
        return write_table(&work.folder, cases.iter().flat_map(|case| (0..repeat).map(move |run| (case, run))));
    }
    let all = || cases.iter().flat_map(|case| (0..repeat).map(move |run| (case, run)));
    let missing: Vec<Job> = all()
        .filter(|(case, run)| !work.folder.has_valid_run(case.number, *run))
        .map(|(case, run)| Job { case, run, again: None })
        .collect();
    fly(work, &missing, all().count(), watch)?;
    let flown = write_table(&work.folder, all())?;
    let again = violations_again(work, cases)?;
    fly(work, &again, again.len(), watch)?;
    if flown.attitude_unknown > 0 {
        watch.warn(&format!(
            "Warning: {} runs came without q_wxyz: their attitude is unknown (column {ATTITUDE_UNKNOWN}); qw … qz mean nothing",
            flown.attitude_unknown
        ));
    }
    Ok(flown)
}

/// The worst run of every violating case, as often as it is to be flown again and was not yet.
fn violations_again<'a>(work: &Work, cases: &'a [Case]) -> Result<Vec<Job<'a>>, Problem> {
    let wanted = work.setup.scenario.executor().reruns as usize;
    if wanted == 0 {
        return Ok(Vec::new());
    }
    let table = work.folder.read_runs_table()?;
    let jobs: Result<Vec<Vec<Job>>, Problem> = cases
        .par_iter()
        .map(|case| {
            let result = campaign::judge(&work.setup, case, &work.folder.read_runs(case.number, &table)?)?;
            let known =
                if result.status == Status::Fail { work.folder.read_reruns(case.number)?.len() } else { wanted };
            Ok((known..wanted).map(|again| Job { case, run: result.run, again: Some(again) }).collect())
        })
        .collect();
    Ok(jobs?.into_iter().flatten().collect())
}

/// Flies `missing`, the rest of `of` runs.
fn fly(work: &Work, missing: &[Job], of: usize, watch: &dyn Watch) -> Result<(), Problem> {
    let steps = Steps::new(watch, "execute", of - missing.len(), of);
    let trouble = Mutex::new(None);
    let landed = |job: &Job, run: Run| {
        let written = match job.again {
            None => work.folder.write_run(&run),
            Some(again) => work.folder.write_rerun(&run, again),
        };
        if let Err(error) = written {
            trouble.lock().unwrap_or_else(std::sync::PoisonError::into_inner).get_or_insert(error);
        }
        steps.step();
    };
    let broken = || trouble.lock().is_ok_and(|trouble| trouble.is_some());
    let stop = || watch.stopped() || broken();
    match command_of(&work.setup)? {
        None => missing.par_iter().for_each(|job| {
            if !stop() {
                landed(job, job.simulate(&work.setup));
            }
        }),
        Some((command, limits)) => fly_with(work, missing, (&command, limits), &landed, &stop, watch),
    }
    drop(steps);
    if let Some(error) = trouble.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner) {
        return Err(error.into());
    }
    if watch.stopped() {
        return Err(Problem::Interrupted("stopped; the runs that have landed are kept, --resume goes on".into()));
    }
    Ok(())
}

/// The table of all runs, in order; it says that execution is complete.
fn write_table<'a>(folder: &CampaignFolder, all: impl Iterator<Item = (&'a Case, usize)>) -> Result<Flown, Problem> {
    let jobs: Vec<_> = all.collect();
    let none = Default::default();
    let read: Result<Vec<Option<(RunFacts, bool)>>, FolderError> = jobs
        .par_iter()
        .map(|(case, run)| {
            let run = folder.read_run(case.number, *run, &none)?;
            Ok(run.map(|run| (RunFacts::of(&run), attitude_unknown(&run))))
        })
        .collect();
    let (facts, unknown): (Vec<_>, Vec<_>) = read?.into_iter().flatten().unzip();
    folder.write_runs_table(&facts)?;
    Ok(Flown {
        runs: facts.len(),
        failed: facts.iter().filter(|facts| facts.message.is_some()).count(),
        attitude_unknown: unknown.into_iter().filter(|unknown| *unknown).count(),
    })
}

/// Whether the executor flew and sent no attitudes.
pub(crate) fn attitude_unknown(run: &Run) -> bool {
    run.outcome.as_ref().is_ok_and(|flight| flight.track.channel(ATTITUDE_UNKNOWN).is_some())
}

fn fly_with(
    work: &Work,
    missing: &[Job],
    (command, limits): (&Command, Limits),
    landed: &(dyn Fn(&Job, Run) + Sync),
    stop: &(dyn Fn() -> bool + Sync),
    watch: &dyn Watch,
) {
    let workers = workers(&work.setup);
    let make = |index: usize| missing[index].mission(&work.setup).map_err(|mistake| mistake.to_string());
    let land = |index: usize, result: Result<_, Failed>| {
        let job = &missing[index];
        let (case, run) = (job.case.number, job.run);
        let log = match &result {
            // Of what was not asked for there is none.
            Err(Failed { failure: Failure::NotAsked { .. }, .. }) => Ok(()),
            Err(failed) => work.folder.write_executor_log(case, run, failed),
            Ok(_) if job.again.is_none() => work.folder.remove_executor_log(case, run),
            Ok(_) => Ok(()),
        };
        // A log that cannot be written stops nothing.
        if let Err(error) = log {
            watch.warn(&format!("Warning: {error}"));
        }
        landed(job, as_run(&work.setup, job.case, job.run, result));
    };
    let flown = AtomicUsize::new(0);
    let counted = |index, result| {
        flown.fetch_add(1, Ordering::Relaxed);
        land(index, result);
    };
    fly_all(command, limits, workers, missing.len(), &make, &counted, stop);
    tracing::info!("{} missions by {workers} workers", flown.into_inner());
}

pub(super) fn as_run(
    setup: &Setup,
    case: &Case,
    number: usize,
    result: Result<hairpin::trajectory::Flight, Failed>,
) -> Run {
    Run {
        case: case.number,
        run: number,
        drawn: hairpin::campaign::vary::draw(&setup.scenario, case.seed, number),
        outcome: result.map_err(|failed| failed.to_string()),
    }
}

/// The user's program, where one flies.
pub(super) fn command_of(setup: &Setup) -> Result<Option<(Command, Limits)>, Problem> {
    let execute = setup.scenario.executor();
    let Some(text) = execute.command else { return Ok(None) };
    let command = text.parse().map_err(|error| Problem::input(format!("`execute.command` = {text:?} {error}")))?;
    let mission = Duration::try_from_secs_f64(execute.timeout)
        .map_err(|_| Problem::input(format!("`execute.timeout_s` = {}: must be a time", execute.timeout)))?;
    Ok(Some((command, Limits { mission, handshake: mission, ..Limits::default() })))
}

/// Flies one run, without a folder.
pub(crate) fn fly_one(setup: &Setup, case: &Case, run: usize, watch: &dyn Watch) -> Result<Run, Problem> {
    let runs = fly_each(setup, std::slice::from_ref(case), run, watch)?;
    runs.into_iter().next().ok_or_else(|| Problem::Interrupted("stopped".into()))
}

/// Flies run number `run` of each of `cases`, in their order, without a folder.
///
/// # Errors
/// Recordings, which cannot be made again; a command that is none; it was asked to stop.
pub fn fly_each(setup: &Setup, cases: &[Case], run: usize, watch: &dyn Watch) -> Result<Vec<Run>, Problem> {
    fly_together(&cases.iter().map(|case| (setup, case, run)).collect::<Vec<_>>(), watch)
}

/// Flies the run of each case under its setup, in their order, without a folder: all by the program of the first setup,
/// where it has one.
pub(crate) fn fly_together(jobs: &[(&Setup, &Case, usize)], watch: &dyn Watch) -> Result<Vec<Run>, Problem> {
    let Some((setup, case, _)) = jobs.first() else { return Ok(Vec::new()) };
    if let Some(logs) = setup.recordings() {
        return Err(Problem::input(format!(
            "`execute.logs` = \"{logs}\": case {} was recorded, and a recording cannot be made again here; leave the key out for the virtual \
             controller",
            case.id()
        )));
    }
    let Some((command, limits)) = command_of(setup)? else {
        return Ok(jobs.par_iter().map(|(setup, case, run)| execute_run(setup, case, *run)).collect());
    };
    let flown = Mutex::new(vec![None; jobs.len()]);
    let make = |index: usize| {
        let (setup, case, run) = jobs[index];
        mission(setup, case, run).map_err(|mistake| mistake.to_string())
    };
    let landed = |index: usize, result: Result<_, Failed>| {
        if let Err(failed) = &result
            && !failed.stderr.trim().is_empty()
        {
            watch.warn(failed.stderr.trim_end());
        }
        let (setup, case, run) = jobs[index];
        flown.lock().unwrap_or_else(std::sync::PoisonError::into_inner)[index] = Some(as_run(setup, case, run, result));
    };
    fly_all(&command, limits, workers(setup), jobs.len(), &make, &landed, &|| watch.stopped());
    let runs = flown.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner);
    runs.into_iter().collect::<Option<_>>().ok_or_else(|| Problem::Interrupted("stopped".into()))
}

/// How many programs of the user's run side by side.
pub(super) fn workers(setup: &Setup) -> usize {
    setup.scenario.executor().workers.map_or_else(rayon::current_num_threads, |n| n as usize)
}
