//! Runs carried out by whoever executes, each written as soon as it has landed.

use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;

use hairpin::campaign::{Case, Run, Setup, Status, at_full_rate, execute_run, judge, mission};
use hairpin_formats::executor::{Command, Failed, Failure, Greeting, Limits, fly_all, fly_all_if};
use hairpin_formats::folder::{Landed, RunWriter};
use rayon::prelude::*;

use super::job::Job;
use crate::program::Executing;
use crate::watch::{Steps, not_waiting_for};
use crate::work::Work;
use crate::{Deadline, Problem, Seen, Watch};

/// Where runs land.
pub(super) struct Landing<'f, 'k> {
    /// How many there are once all have landed.
    pub(super) of: usize,
    pub(super) writer: RunWriter<'f>,
    /// Whether the motion of one, with what was measured of it, is kept.
    pub(super) keeps: &'k (dyn Fn(&Run) -> bool + Sync),
}

/// Flies `missing`, the rest of those that land there.
pub(super) fn fly(work: &Work, missing: &[Job], there: Landing, watch: &dyn Watch) -> Result<(), Problem> {
    let Landing { of, writer, keeps } = there;
    let executing = Executing::within(&work.folder)?;
    let steps = Steps::new(watch, "execute", of - missing.len(), of);
    let trouble = Mutex::new(None);
    let landed = |job: &Job, mut run: Run| {
        // Measured while all of its rows are there: only those where it bends are kept.
        let (full_rate, marked) = at_full_rate(&work.setup, job.case, &run).unzip();
        run.full_rate = full_rate.map(Box::new);
        watch.seen(seen(&work.setup, job.case, &run));
        let marked = marked.unwrap_or_default();
        let packed = match job.again {
            again if !keeps(&run) => Ok(Landed::bare(&run, again.unwrap_or(job.run))),
            None => Landed::of(&run, &marked),
            Some(again) => Landed::again(&run, again, &marked),
        };
        let land = || {
            executing.keep()?;
            writer.land(packed.map_err(|cause| writer.no_room(cause))?)
        };
        if let Err(error) = land() {
            trouble.lock().unwrap_or_else(std::sync::PoisonError::into_inner).get_or_insert(error);
        }
        steps.step();
    };
    let broken = || trouble.lock().is_ok_and(|trouble| trouble.is_some());
    let stop = || watch.stopped() || broken();
    match command_of(&work.setup)? {
        None => {
            let fly = |job: &Job| {
                if !stop()
                    && let Some(run) = unless_stopped(job.simulate(&work.setup), watch)
                {
                    landed(job, run);
                }
            };
            // In order, so that few parts are open at a time, and without waiting for each other at a part's end.
            let next = AtomicUsize::new(0);
            let fly_on = || {
                while let Some(job) = missing.get(next.fetch_add(1, Ordering::Relaxed)) {
                    fly(job);
                }
            };
            let threads = 0..rayon::current_num_threads();
            while_wanted(&work.setup, watch, || threads.into_par_iter().for_each(|_| fly_on()));
        }
        Some((command, limits)) => {
            fly_with(work, missing, (&command, limits, &executing), &landed, &stop, watch);
        }
    }
    drop(steps);
    let kept = writer.finish();
    if let Some(error) = trouble.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner) {
        return Err(error.into());
    }
    kept?;
    if let Some(refused) = executing.refusal() {
        return Err(refused);
    }
    if watch.stopped() {
        return Err(Problem::Interrupted("stopped; the runs that have landed are kept, --resume goes on".into()));
    }
    Ok(())
}

/// Whether verdicts are told in millimetres: the limits are.
pub(super) fn in_mm(setup: &Setup) -> bool {
    setup.scenario.head().limits.iter().any(|limit| limit.ends_with("_mm"))
}

/// What `run` came to, where it was measured as it landed.
fn seen(setup: &Setup, case: &Case, run: &Run) -> Seen {
    let measured = run.full_rate.as_ref();
    let judged = measured.and_then(|_| judge(setup, case, std::slice::from_ref(run)).ok());
    Seen {
        deviation: measured.map(|measured| measured.measures.max_deviation),
        violates: judged.is_some_and(|judged| judged.status == Status::Fail),
        in_mm: in_mm(setup),
    }
}

/// Which case of `cases` has the first run that was not flown, why it was not, and by which program.
pub(super) fn first_trouble(work: &Work, cases: &[Case]) -> Result<Option<String>, Problem> {
    for case in cases {
        let facts = work.folder.facts_of(case.number)?;
        if let Some((run, message)) = facts.iter().find_map(|facts| Some((facts.run, facts.message.as_ref()?))) {
            return Ok(Some(format!("{}, {}", case.number, work.told()?.by_program(run, message))));
        }
    }
    Ok(None)
}

fn fly_with(
    work: &Work,
    missing: &[Job],
    (command, limits, executing): (&Command, Limits, &Executing),
    landed: &(dyn Fn(&Job, Run) + Sync),
    stop: &(dyn Fn() -> bool + Sync),
    watch: &dyn Watch,
) {
    let processes = processes(&work.setup);
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
    let may = |now: &_| executing.may(now);
    fly_all_if((command, limits), &may, processes, missing.len(), &make, &counted, stop);
    tracing::info!("{} missions by {processes} processes", flown.into_inner());
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
        outcome: result.map_err(|failed| failed.in_full()),
        full_rate: None,
    }
}

/// The user's program, where one flies.
pub(crate) fn command_of(setup: &Setup) -> Result<Option<(Command, Limits)>, Problem> {
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
    fly_told(jobs, watch).map(|(runs, _)| runs)
}

/// The same, with what the program says of itself, where one was started.
pub(crate) fn fly_told(
    jobs: &[(&Setup, &Case, usize)],
    watch: &dyn Watch,
) -> Result<(Vec<Run>, Option<Greeting>), Problem> {
    let Some((setup, case, _)) = jobs.first() else { return Ok((Vec::new(), None)) };
    if let Some(logs) = setup.recordings() {
        return Err(Problem::input(format!(
            "`execute.logs` = \"{logs}\": case {} was recorded, and a recording cannot be made again here; leave the key out for the virtual \
             controller",
            case.id()
        )));
    }
    let stopped = || Problem::Interrupted("stopped".into());
    let Some((command, limits)) = command_of(setup)? else {
        let fly = |(setup, case, run): &(&Setup, &Case, usize)| unless_stopped(execute_run(setup, case, *run), watch);
        let flown = while_wanted(setup, watch, || jobs.par_iter().map(fly).collect::<Option<_>>());
        return Ok((flown.ok_or_else(stopped)?, None));
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
    let greeting = fly_all(&command, limits, processes(setup), jobs.len(), &make, &landed, &|| watch.stopped());
    let runs = flown.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner);
    Ok((runs.into_iter().collect::<Option<_>>().ok_or_else(stopped)?, greeting))
}

/// Does `work`, which simulates runs of `setup`; where code of the user's steers them it is not waited for once it was
/// asked to stop.
pub(super) fn while_wanted<T>(setup: &Setup, watch: &dyn Watch, work: impl FnOnce() -> T) -> T {
    let steers: Vec<_> = setup.steering_code().into_iter().collect();
    not_waiting_for(&steers, watch, Deadline::after(None), work)
}

/// `run`, unless it may have failed because nobody waited for who steers: it is none then, and flown another time.
pub(super) fn unless_stopped(run: Run, watch: &dyn Watch) -> Option<Run> {
    (run.outcome.is_ok() || !watch.stopped()).then_some(run)
}

/// How many programs of the user's run side by side.
pub(super) fn processes(setup: &Setup) -> usize {
    setup.scenario.executor().processes.map_or_else(rayon::current_num_threads, |n| n as usize)
}
