//! Who executes what a search asks for: our own simulator, with whoever steers there, or the user's program. What fails
//! is counted and told alike, whoever it was.

use std::sync::{Mutex, PoisonError};

use hairpin::campaign::answers::Answer;
use hairpin::campaign::{Batch, Case, Executor, Mission, OwnSimulator, Setup};
use hairpin::judgement::Measures;
use hairpin::trajectory::Flight;
use hairpin_formats::executor::{Greeting, InLoop};
use rayon::ThreadPoolBuilder;

use super::fly::{command_of, processes, while_wanted};
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
    told: &'a Mutex<Told>,
}

/// What came of all executions that a search asked for.
#[derive(Debug, Clone, Default)]
struct Told {
    /// Those that came to a flight.
    flown: u64,
    /// Those that did not.
    failed: u64,
    /// Why the last of these did not.
    last: Option<String>,
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
        self.watch.seen(Seen { deviation: Some(measures.max_deviation), violates });
    }

    fn ended(&self, outcome: Result<(), &str>) {
        let mut told = self.told.lock().unwrap_or_else(PoisonError::into_inner);
        match outcome {
            Ok(()) => told.flown += 1,
            // Who is not waited for has failed at nothing.
            Err(_) if (self.stop)() => {}
            Err(why) => (told.failed, told.last) = (told.failed + 1, Some(why.into())),
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
pub(crate) fn in_the_loop<T: Send>(
    setup: &Setup,
    stopped: &(dyn Fn() -> bool + Sync),
    (rounds, executing): (Option<&Rounds>, &Executing),
    watch: &dyn Watch,
    search: impl FnOnce(Asked) -> T + Send,
) -> Result<(T, Option<Problem>), Problem> {
    let apart = || rounds.is_some_and(Rounds::is_in_trouble);
    let told = &Mutex::new(Told::default());
    let all = || told.lock().unwrap_or_else(PoisonError::into_inner).clone();
    // What others have flown was not flown in vain, and whoever stopped it did not ask. That its time is over says
    // nothing for who executed, and came to no flight in it.
    let goes_on = || watch.stopped() || rounds.is_some_and(Rounds::any_flown);
    let program = if setup.scenario.executes() { command_of(setup)? } else { None };
    let Some((command, limits)) = program else {
        let steers = setup.steering_code();
        let trouble = || steers.and_then(|(_, code)| code.trouble());
        let stop = || stopped() || trouble().is_some() || apart();
        // The limit of a search's time is none of who steers: what was found is executed after it.
        let executor = &Seeing { executor: &OwnSimulator, watch, rounds, stop: &stop, told };
        let found = while_wanted(setup, watch, || search(Asked { executor, stop: &stop }));
        let told = all();
        tell(&told, "", watch);
        let in_vain = || told.in_vain().filter(|_| !goes_on());
        return Ok((found, trouble().or_else(in_vain).map(Problem::Executor).or_else(|| rounds?.trouble())));
    };
    let processes = processes(setup);
    let may = |now: &Greeting| executing.may(now) && rounds.is_none_or(|rounds| rounds.may(now));
    let program = InLoop::new(&command, limits, processes, stopped).only_if(&may);
    let stop = || stopped() || program.trouble().is_some() || program.is_unwanted() || apart();
    let executor = &Seeing { executor: &program, watch, rounds, stop: &stop, told };
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
    let of_program = program.all();
    let last = of_program.last.as_ref();
    let mut told = all();
    told.failed = told.failed.max(of_program.failed);
    told.last = last.map(|last| last.in_full()).or(told.last);
    tell(&told, last.map_or("", |last| &last.stderr), watch);
    let in_vain = || told.in_vain().filter(|_| !goes_on()).map(|why| program.by_name(why));
    let trouble = of_program.trouble.clone().or_else(in_vain).map(Problem::Executor);
    Ok((found, trouble.or_else(|| rounds?.trouble())))
}

/// What was not flown, with the end of what a program wrote to stderr the last time.
fn tell(Told { flown, failed, last }: &Told, stderr: &str, watch: &dyn Watch) {
    tracing::info!("{flown} executions in the loop, {failed} failed");
    let Some(last) = last else { return };
    watch.warn(&format!("Warning: {failed} of {} executions in the loop failed; the last: {last}", flown + failed));
    if !stderr.trim().is_empty() {
        watch.warn(stderr.trim_end());
    }
}

impl Told {
    /// Why the search was in vain: nothing that it asked for was flown.
    fn in_vain(&self) -> Option<String> {
        let Self { flown, failed, last } = self;
        let last = last.as_ref().map_or(String::new(), |last| format!("; the last: {last}"));
        let none = *flown == 0 && *failed > 0;
        none.then(|| format!("none of {failed} executions in the loop came to a flight{last}"))
    }
}
