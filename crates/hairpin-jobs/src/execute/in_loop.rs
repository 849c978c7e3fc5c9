//! Who executes what a search asks for: our own simulator, with whoever steers there, or the user's program. What fails
//! is told alike, whoever it was; its number is the search's own, which the verdict has.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};

use hairpin::campaign::answers::Answer;
use hairpin::campaign::{Batch, Case, Executor, Mission, OwnSimulator, Setup, Tally};
use hairpin::judgement::Measures;
use hairpin::trajectory::Flight;
use hairpin_formats::executor::{Greeting, InLoop};
use rayon::ThreadPoolBuilder;

use super::fly::{command_of, in_mm, processes, while_wanted};
use crate::program::Executing;
use crate::rounds::Rounds;
use crate::{Problem, Seen, Watch};

/// Who executes, and whether the search is to stop.
pub(crate) struct Asked<'a> {
    pub(crate) executor: &'a dyn Executor,
    /// Asked often: the caller wants it to, or nothing more can be executed.
    pub(crate) stop: &'a (dyn Fn() -> bool + Sync),
}

/// Who executes, with each run told to whoever watches, and rounds shared with other machines.
struct Seeing<'a> {
    executor: &'a dyn Executor,
    watch: &'a dyn Watch,
    rounds: Option<&'a Rounds>,
    stop: &'a (dyn Fn() -> bool + Sync),
    heard: &'a Heard,
    /// Whether verdicts are told in millimetres.
    in_mm: bool,
}

/// What came of the executions that a search asked for, as far as no tally has it: those of work that was stopped and
/// is done anew are in none.
#[derive(Default)]
struct Heard {
    /// Whether one came to a flight.
    any_flown: AtomicBool,
    /// Why the last that came to none did not.
    last: Mutex<Option<String>>,
}

impl Executor for Seeing<'_> {
    fn fly(&self, nominal: &Setup, case: &Case, mission: &Mission) -> Result<Flight, String> {
        self.executor.fly(nominal, case, mission)
    }

    fn carry_out(&self, batch: &Batch) -> Vec<Option<Answer>> {
        match self.rounds {
            Some(rounds) => rounds.carry_out(batch, self.stop),
            None => self.executor.carry_out(batch),
        }
    }

    fn measured(&self, measures: &Measures, violates: bool) {
        self.watch.seen(Seen { deviation: Some(measures.max_deviation), violates, in_mm: self.in_mm });
    }

    fn ended(&self, outcome: Result<(), &str>) {
        match outcome {
            Ok(()) => self.heard.any_flown.store(true, Ordering::Relaxed),
            // Who is not waited for has failed at nothing.
            Err(_) if (self.stop)() => {}
            Err(why) => *self.heard.last.lock().unwrap_or_else(PoisonError::into_inner) = Some(why.into()),
        }
    }

    fn is_ours(&self) -> bool {
        self.executor.is_ours()
    }
}

/// Does `search` with whoever executes for `setup` and may by `executing`, its `rounds` shared where others search with
/// this machine. Gives what it found, and what went wrong with the user's program, or between the machines, where that
/// was the end of it.
///
/// Where there are more processes than threads, the search has a thread for each: who waits for a program does nothing
/// else.
///
/// # Errors
/// A command that is none; a program that is another than before; no threads.
pub(crate) fn in_the_loop(
    setup: &Setup,
    stopped: &(dyn Fn() -> bool + Sync),
    (rounds, executing): (Option<&Rounds>, &Executing),
    watch: &dyn Watch,
    search: impl FnOnce(Asked) -> Tally + Send,
) -> Result<(Tally, Option<Problem>), Problem> {
    let apart = || rounds.is_some_and(Rounds::is_in_trouble);
    let (heard, in_mm) = (&Heard::default(), in_mm(setup));
    // What others have flown was not flown in vain, and whoever stopped it did not ask. That its time is over says
    // nothing for who executed, and came to no flight in it.
    let goes_on = || watch.stopped() || rounds.is_some_and(Rounds::any_flown);
    let program = if setup.scenario.executes() { command_of(setup)? } else { None };
    let Some((command, limits)) = program else {
        let steers = setup.steering_code();
        let trouble = || steers.and_then(|(_, code)| code.trouble());
        let stop = || stopped() || trouble().is_some() || apart();
        // The limit of a search's time is none of who steers: what was found is executed after it.
        let executor = &Seeing { executor: &OwnSimulator, watch, rounds, stop: &stop, heard, in_mm };
        let found = while_wanted(setup, watch, || search(Asked { executor, stop: &stop }));
        let last = heard.last();
        tell(&found, last.as_deref(), "", watch);
        let in_vain = || heard.in_vain(last.as_deref()).filter(|_| !goes_on());
        return Ok((found, trouble().or_else(in_vain).map(Problem::Executor).or_else(|| rounds?.trouble())));
    };
    let processes = processes(setup);
    let may = |now: &Greeting| executing.may(now) && rounds.is_none_or(|rounds| rounds.may(now));
    let program = InLoop::new(&command, limits, processes, stopped).only_if(&may);
    let stop = || stopped() || program.trouble().is_some() || program.is_unwanted() || apart();
    let executor = &Seeing { executor: &program, watch, rounds, stop: &stop, heard, in_mm };
    let asked = Asked { executor, stop: &stop };
    let found = if processes > rayon::current_num_threads() {
        let threads = ThreadPoolBuilder::new().num_threads(processes).build().map_err(Problem::input)?;
        threads.install(|| search(asked))
    } else {
        search(asked)
    };
    if let Some(refused) = executing.refusal() {
        return Err(refused);
    }
    // The last of what it did not answer is what ended the search, and was told to nobody yet.
    let (trouble, last) = (program.trouble(), program.last());
    let stderr = last.as_ref().map_or("", |last| &last.stderr);
    let last = last.as_ref().map(|last| last.in_full()).or_else(|| heard.last());
    tell(&found, last.as_deref(), stderr, watch);
    let in_vain = || heard.in_vain(last.as_deref()).filter(|_| !goes_on()).map(|why| program.by_name(why));
    let trouble = trouble.or_else(in_vain).map(Problem::Executor);
    Ok((found, trouble.or_else(|| rounds?.trouble())))
}

/// That executions failed, why the last did, and the end of what a program wrote to stderr then. Their number is the
/// tally's; where it has none, they are of work that was stopped.
fn tell(tally: &Tally, last: Option<&str>, stderr: &str, watch: &dyn Watch) {
    let (failed, all) = (tally.failures.failed, tally.executed());
    tracing::info!("{all} executions in the loop, {failed} failed");
    let Some(last) = last else { return };
    let many = if failed > 0 { format!("{failed} of {all} executions") } else { "executions".to_owned() };
    watch.warn(&format!("Warning: {many} in the loop failed; the last: {last}"));
    if !stderr.trim().is_empty() {
        watch.warn(stderr.trim_end());
    }
}

impl Heard {
    fn last(&self) -> Option<String> {
        self.last.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// Why the search was in vain, of which `last` failed as the last: nothing that it asked for was flown.
    fn in_vain(&self, last: Option<&str>) -> Option<String> {
        let last = last.filter(|_| !self.any_flown.load(Ordering::Relaxed))?;
        Some(format!("none of the executions in the loop came to a flight; the last: {last}"))
    }
}
