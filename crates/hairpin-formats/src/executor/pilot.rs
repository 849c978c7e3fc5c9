//! Mission after mission by one process at a time, each answer held back until nothing can follow it any more.

use std::sync::atomic::{AtomicU64, Ordering};

use hairpin::campaign::Mission;
use hairpin::trajectory::Flight;

use super::answer::Answer;
use super::command::Command;
use super::failure::{Failed, Failure};
use super::worker::{Limits, Worker};

/// A program that failed this often in a row to say `ready` is not started again.
const HOPELESS: usize = 3;

/// Who takes flights.
pub(super) type Landed<'a> = &'a (dyn Fn(usize, Result<Flight, Failed>) + Sync);

/// What all pilots of one program know of it.
pub(super) struct Program<'a> {
    command: &'a Command,
    limits: Limits,
    /// The protocol that it is first spoken to in.
    protocol: AtomicU64,
}

impl<'a> Program<'a> {
    /// Of which nothing is known yet.
    pub(super) fn new(command: &'a Command, limits: Limits) -> Self {
        Self { command, limits, protocol: AtomicU64::new(2) }
    }
}

/// One that flies.
pub(super) struct Pilot<'a> {
    program: &'a Program<'a>,
    landed: Landed<'a>,
    worker: Option<Worker>,
    /// The flight of the last mission, which its process may still spoil.
    held: Option<(usize, Flight)>,
    /// Failed starts since the last good one.
    misses: Vec<Failed>,
}

impl<'a> Pilot<'a> {
    /// Who flies with `program` and hands what comes of it to `landed`.
    pub(super) fn new(program: &'a Program<'a>, landed: Landed<'a>) -> Self {
        Self { program, landed, worker: None, held: None, misses: Vec::new() }
    }

    /// Flies mission number `index`. What comes of it is given back, and lands sooner or later; what is cancelled does
    /// not.
    pub(super) fn fly(
        &mut self,
        index: usize,
        mission: &Mission,
        cancelled: &dyn Fn() -> bool,
    ) -> Option<Result<(), Failure>> {
        let result = self.try_with(mission, cancelled);
        if let Err(Failed { failure: Failure::Cancelled, .. }) = result {
            return None;
        }
        self.settle(Ok(()));
        let told = result.as_ref().map(drop).map_err(|failed| failed.failure.clone());
        match result {
            Ok(flight) if self.worker.is_some() => self.held = Some((index, flight)),
            landed => (self.landed)(index, landed),
        }
        Some(told)
    }

    /// The flight of `mission`; by a fresh process where the one at hand was out of step after the mission before.
    fn try_with(&mut self, mission: &Mission, cancelled: &dyn Fn() -> bool) -> Result<Flight, Failed> {
        let first = self.ask(mission, cancelled)?;
        let doubtful = self.held.is_some()
            && first.before.is_none()
            && first.result.as_ref().is_err_and(|failed| failed.failure.is_out_of_step());
        let Answer { result, before, not_begun, worker } = first;
        self.worker = worker;
        if let Some(failed) = before {
            self.settle(Err(failed));
        }
        if not_begun {
            let again = self.ask(mission, cancelled)?;
            self.worker = again.worker;
            return again.result;
        }
        let Err(failed) = &result else { return result };
        if doubtful {
            // Whose fault it is shows where nothing was flown before it.
            let again = self.ask(mission, cancelled)?;
            self.worker = again.worker;
            if !again.result.as_ref().is_err_and(|failed| failed.failure.is_out_of_step()) {
                self.settle(Err(failed.clone()));
            }
            return again.result;
        }
        result
    }

    fn ask(&mut self, mission: &Mission, cancelled: &dyn Fn() -> bool) -> Result<Answer, Failed> {
        let worker = match self.worker.take() {
            Some(worker) => worker,
            None => self.start(cancelled)?,
        };
        Ok(worker.fly(mission, cancelled))
    }

    /// The mission before is over: what was held lands, unless something was wrong with it.
    fn settle(&mut self, outcome: Result<(), Failed>) {
        if let Some((index, flight)) = self.held.take() {
            (self.landed)(index, outcome.map(|()| flight));
        }
    }

    /// Ends the process in order, and what was held lands.
    pub(super) fn stop(mut self) {
        let wrong = self.worker.take().and_then(Worker::stop);
        self.settle(wrong.map_or(Ok(()), Err));
    }

    fn start(&mut self, cancelled: &dyn Fn() -> bool) -> Result<Worker, Failed> {
        if self.misses.len() >= HOPELESS {
            return Err(self.misses[HOPELESS - 1].clone());
        }
        let Program { command, limits, protocol } = self.program;
        let started = Worker::start(command, *limits, protocol.load(Ordering::Relaxed), cancelled);
        match &started {
            Ok(worker) => {
                protocol.store(worker.protocol, Ordering::Relaxed);
                self.misses.clear();
            }
            Err(failed) => self.misses.push(failed.clone()),
        }
        started
    }
}
