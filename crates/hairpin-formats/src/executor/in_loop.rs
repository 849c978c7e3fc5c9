//! A program of the user's in the loop of a search: each mission is flown when it is asked for, by whichever process is
//! free, and the same mission once.

use std::collections::HashMap;
use std::sync::{Mutex, MutexGuard, PoisonError};

use hairpin::campaign::{Case, Executor, Mission, Setup};
use hairpin::trajectory::Flight;

use super::command::Command;
use super::failure::{Failed, Failure};
use super::greeting::Greeting;
use super::message::mission_key;
use super::pool::Pool;
use super::worker::Limits;

/// So many executions in a row without an answer, in the order in which they end, are the end: a program that hangs
/// costs three times its limit.
const MOST: usize = 3;
/// Poses of flights that are kept, at most: some hundred bytes each.
const KEPT_POSES: usize = 2_000_000;

/// A program that flies what a search asks for. Dropping it ends its processes.
///
/// A failed execution is none of a trajectory's, and the search goes on; one that the program leaves without an answer
/// three times in a row, or a program that cannot be started, is the end of it.
pub struct InLoop<'a> {
    pool: Pool,
    cancelled: &'a (dyn Fn() -> bool + Sync),
    is_wanted: &'a (dyn Fn(&Greeting) -> bool + Sync),
    limits: Limits,
    kept: Mutex<Kept>,
    unflown: Mutex<Unflown>,
}

/// Flights by what was asked for.
#[derive(Default)]
struct Kept {
    flights: HashMap<[u8; 32], Flight>,
    poses: usize,
}

/// What was not flown: whoever asks counts it.
#[derive(Default)]
struct Unflown {
    /// The last failure.
    last: Option<Failed>,
    /// Executions without an answer since the last one with.
    unanswered: usize,
    /// Why nothing more is asked for, in a sentence.
    trouble: Option<String>,
}

impl<'a> InLoop<'a> {
    /// At most `processes` of `command`, none of them started yet; `cancelled` is asked often.
    pub fn new(command: &Command, limits: Limits, processes: usize, cancelled: &'a (dyn Fn() -> bool + Sync)) -> Self {
        let pool = Pool::new(command, limits, processes, true);
        Self { pool, cancelled, is_wanted: &|_| true, limits, kept: Mutex::default(), unflown: Mutex::default() }
    }

    /// The same where the program `is_wanted` by what it says of itself; one that is not flies nothing.
    #[must_use]
    pub fn only_if(self, is_wanted: &'a (dyn Fn(&Greeting) -> bool + Sync)) -> Self {
        Self { is_wanted, ..self }
    }

    /// Whether it is started, and is not to fly by what it says of itself.
    pub fn is_unwanted(&self) -> bool {
        self.greeting().is_some_and(|greeting| !(self.is_wanted)(greeting))
    }

    /// Why the search is to end, in a sentence: three executions in a row had no answer, or the program does not start.
    pub fn trouble(&self) -> Option<String> {
        self.unflown().trouble.clone()
    }

    /// The last execution that came to no flight, of those that were not stopped.
    pub fn last(&self) -> Option<Failed> {
        self.unflown().last.clone()
    }

    /// What the program says of itself, once it has.
    pub fn greeting(&self) -> Option<&Greeting> {
        self.pool.program.greeting()
    }

    /// A sentence about it, with its name where it has one.
    pub fn by_name(&self, sentence: String) -> String {
        match self.greeting() {
            Some(Greeting { name, .. }) if !name.is_empty() => format!("{name}: {sentence}"),
            _ => sentence,
        }
    }

    fn unflown(&self) -> MutexGuard<'_, Unflown> {
        self.unflown.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn kept(&self) -> MutexGuard<'_, Kept> {
        self.kept.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The flight of `mission` by a process that is free.
    fn ask(&self, mission: &Mission) -> Result<Flight, Failed> {
        let stop = || (self.cancelled)() || self.unflown().trouble.is_some() || self.is_unwanted();
        let cancelled = || Failed { failure: Failure::Cancelled, stderr: String::new() };
        let mut pilot = self.pool.check_out(&stop).ok_or_else(cancelled)?;
        // What a process says after its answer is the judgement's business, which flies again.
        let result = pilot.fly(&self.pool.program, mission, &stop).result;
        let hopeless = pilot.is_hopeless();
        self.pool.give_back(pilot);
        let mut unflown = self.unflown();
        match &result {
            Ok(_) => unflown.unanswered = 0,
            Err(Failed { failure: Failure::Cancelled, .. }) => {}
            Err(failed) => {
                unflown.unanswered = if failed.failure.is_time_out() { unflown.unanswered + 1 } else { 0 };
                unflown.last = Some(failed.clone());
                let seconds = self.limits.mission.as_secs_f64();
                if hopeless {
                    unflown.trouble.get_or_insert_with(|| self.by_name(failed.in_full()));
                } else if unflown.unanswered >= MOST {
                    let stderr = failed.last_line().map_or(String::new(), |line| format!("; {line}"));
                    unflown.trouble.get_or_insert_with(|| {
                        self.by_name(format!(
                            "it left {MOST} executions in a row without an answer (execute.timeout_s = {seconds}){stderr}"
                        ))
                    });
                }
            }
        }
        result
    }
}

impl Executor for InLoop<'_> {
    fn fly(&self, _nominal: &Setup, _case: &Case, mission: &Mission) -> Result<Flight, String> {
        let key = mission_key(mission);
        if let Some(flight) = self.kept().flights.get(&key) {
            return Ok(flight.clone());
        }
        // Cases have no numbers before the search is over, and an answer says which mission it is of.
        let [a, b, c, d, e, f, g, h, ..] = key;
        let named = Mission {
            case: format!("search-{:016x}", u64::from_be_bytes([a, b, c, d, e, f, g, h])),
            ..mission.clone()
        };
        let flight = self.ask(&named).map_err(|failed| failed.to_string())?;
        self.kept().keep(key, &flight);
        Ok(flight)
    }
}

impl Kept {
    /// Where there is no room for `flight`, those that are there go: what is flown again costs time, no more.
    fn keep(&mut self, key: [u8; 32], flight: &Flight) {
        let poses = flight.track.len();
        if self.poses + poses > KEPT_POSES {
            *self = Self::default();
        }
        if poses <= KEPT_POSES && self.flights.insert(key, flight.clone()).is_none() {
            self.poses += poses;
        }
    }
}
