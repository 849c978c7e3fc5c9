//! Mission after mission by one process at a time, which is started anew where it failed; what a process says after its
//! last answer is told with the next one.

use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::Duration;

use hairpin::campaign::Mission;
use hairpin::trajectory::Flight;

use super::answer::Answer;
use super::command::Command;
use super::failure::{Failed, Failure};
use super::greeting::Greeting;
use super::worker::{Limits, QUIET, Worker};

/// A program that failed this often in a row to say `ready` is not started again.
const HOPELESS: usize = 3;
/// After so many answers that nothing followed, a program is trusted to answer once, where it may be.
const TRIED: u64 = 8;

/// What all pilots of one program know of it.
#[derive(Debug)]
pub(super) struct Program {
    command: Command,
    limits: Limits,
    /// The protocol that it is first spoken to in.
    protocol: AtomicU64,
    /// Whether it may be trusted: where a mistake costs no more than a guess.
    trusting: bool,
    /// Answers that nothing followed.
    clean: AtomicU64,
    /// Whether it ever went on after an answer.
    unruly: AtomicBool,
    /// What the first of its processes said of itself.
    greeting: OnceLock<Greeting>,
}

impl Program {
    /// Of which nothing is known yet.
    pub(super) fn new(command: &Command, limits: Limits, trusting: bool) -> Self {
        Self {
            command: command.clone(),
            limits,
            protocol: AtomicU64::new(2),
            trusting,
            clean: AtomicU64::new(0),
            unruly: AtomicBool::new(false),
            greeting: OnceLock::new(),
        }
    }

    /// What it says of itself, once it has.
    pub(super) fn greeting(&self) -> Option<&Greeting> {
        self.greeting.get()
    }

    /// How long it is listened after an answer of protocol 1 before the next mission is told.
    fn quiet(&self) -> Duration {
        let tried = self.clean.load(Ordering::Relaxed) >= TRIED && !self.unruly.load(Ordering::Relaxed);
        if self.trusting && tried { Duration::ZERO } else { QUIET }
    }
}

/// What came of a mission.
#[derive(Debug)]
pub(super) struct Told {
    pub(super) result: Result<Flight, Failed>,
    /// What is known now to be wrong with the answer before, by the same process.
    pub(super) before: Option<Failed>,
}

/// One that flies.
#[derive(Debug, Default)]
pub(super) struct Pilot {
    worker: Option<Worker>,
    /// Whether the last mission has a flight that its process may still spoil.
    flew: bool,
    /// Failed starts since the last good one.
    misses: Vec<Failed>,
}

impl Pilot {
    /// Flies a mission.
    pub(super) fn fly(&mut self, program: &Program, mission: &Mission, cancelled: &dyn Fn() -> bool) -> Told {
        let told = self.try_with(program, mission, cancelled);
        if self.flew {
            match &told.before {
                Some(_) => program.unruly.store(true, Ordering::Relaxed),
                None => drop(program.clean.fetch_add(1, Ordering::Relaxed)),
            }
        }
        self.flew = told.result.is_ok() && self.worker.is_some();
        told
    }

    /// Whether its last flight may still be spoilt by its process.
    pub(super) fn may_go_on(&self) -> bool {
        self.flew
    }

    /// Whether its program is not started any more.
    pub(super) fn is_hopeless(&self) -> bool {
        self.misses.len() >= HOPELESS
    }

    /// The flight of `mission`; by a fresh process where the one at hand was out of step after the mission before.
    fn try_with(&mut self, program: &Program, mission: &Mission, cancelled: &dyn Fn() -> bool) -> Told {
        let first = match self.ask(program, mission, cancelled) {
            Ok(first) => first,
            Err(failed) => return Told { result: Err(failed), before: None },
        };
        let Answer { result, before, not_begun, worker } = first;
        self.worker = worker;
        let doubtful =
            self.flew && before.is_none() && result.as_ref().is_err_and(|failed| failed.failure.is_out_of_step());
        if !not_begun && !doubtful {
            return Told { result, before };
        }
        let again = self.ask(program, mission, cancelled).and_then(|again| {
            self.worker = again.worker;
            again.result
        });
        // Whose fault it is shows where nothing was flown before it.
        let own_fault = again.as_ref().is_err_and(|failed| failed.failure.is_out_of_step());
        let blamed = result.err().filter(|_| doubtful && !own_fault);
        Told { result: again, before: before.or(blamed) }
    }

    fn ask(&mut self, program: &Program, mission: &Mission, cancelled: &dyn Fn() -> bool) -> Result<Answer, Failed> {
        let worker = match self.worker.take() {
            Some(worker) => worker,
            None => self.start(program, cancelled)?,
        };
        Ok(worker.fly(mission, program.quiet(), cancelled))
    }

    /// Ends the process in order. Gives what is wrong with its last answer, where it went on after that.
    pub(super) fn stop(&mut self) -> Option<Failed> {
        self.worker.take().and_then(Worker::stop)
    }

    fn start(&mut self, program: &Program, cancelled: &dyn Fn() -> bool) -> Result<Worker, Failed> {
        if let Some(last) = self.misses.get(HOPELESS - 1) {
            return Err(last.clone());
        }
        let Program { command, limits, protocol, .. } = program;
        let started = Worker::start(command, *limits, protocol.load(Ordering::Relaxed), cancelled);
        match &started {
            Ok(worker) => {
                protocol.store(worker.protocol, Ordering::Relaxed);
                program.greeting.get_or_init(|| worker.greeting().clone());
                self.misses.clear();
                // What it says of itself may be why it is to fly nothing: then it is told of no mission.
                if cancelled() {
                    return Err(Failed { failure: Failure::Cancelled, stderr: String::new() });
                }
            }
            // Whoever is stopped has not missed.
            Err(Failed { failure: Failure::Cancelled, .. }) => {}
            Err(failed) => self.misses.push(failed.clone()),
        }
        started
    }
}
