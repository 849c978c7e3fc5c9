//! The steps, one after the other: a process that fell is started anew for the next.

use std::cell::RefCell;

use hairpin::campaign::Mission;
use hairpin::judgement::Verdict;
use hairpin_formats::executor::{Answer, Command, Failed, Greeting, Limits, QUIET, Wire, Worker};

use super::checked::Checked;
use super::step::Step;
use crate::Watch;
use crate::watch::Steps;

/// What the watch is told of.
pub(super) const WHAT: &str = "check";
/// In the order in which they are taken.
const STEPS: [&str; 7] = ["handshake", "mission", "again", "refusal", "cancelled", "speed", "bye"];

/// A program being checked.
pub(super) struct Session<'a> {
    command: &'a Command,
    pub(super) limits: Limits,
    watch: &'a dyn Watch,
    pub(super) wire: Wire,
    /// The process at hand.
    pub(super) worker: RefCell<Option<Worker>>,
}

impl<'a> Session<'a> {
    /// Nothing is started yet.
    pub(super) fn new(command: &'a Command, limits: Limits, watch: &'a dyn Watch) -> Self {
        Self { command, limits, watch, wire: Wire::kept(), worker: RefCell::new(None) }
    }

    /// All steps. Where the program was not greeted or did not fly, those that need it are left out.
    pub(super) fn run(&self, mission: &Mission) -> Checked {
        let progress = Steps::new(self.watch, WHAT, 0, STEPS.len());
        let (first, greeting) = self.handshake();
        let mut steps = vec![first];
        let (mut again, mut speed) = ([None; 2], None);
        if let Some(greeting) = &greeting {
            let (step, flight) = self.mission(mission);
            steps.push(step);
            progress.step();
            if let Some(flight) = flight {
                let (step, both) = self.again(mission, &flight, greeting);
                steps.push(step);
                again = both;
                progress.step();
                steps.push(self.refusal(mission));
                let same = again.iter().all(|one| one.is_some_and(|one| one.same));
                steps.push(self.cancelled(mission, &flight, same));
                progress.step();
                let (step, found) = self.speed(mission, &flight, greeting);
                steps.push(step);
                speed = found;
                progress.step();
            }
        }
        // What needs a flight is not asked of a program that does not fly.
        steps.extend(STEPS[steps.len()..STEPS.len() - 1].iter().map(|name| Step::new(name)));
        steps.push(self.bye());
        let verdict = verdict(&steps, greeting.as_ref());
        Checked { greeting, steps, again, speed, verdict }
    }

    fn stop(&self) -> bool {
        self.watch.stopped()
    }

    /// A new process, greeted.
    pub(super) fn start(&self) -> Result<Worker, Failed> {
        Worker::start_on(&self.wire, self.command, self.limits, 2, &|| self.stop())
    }

    /// The answer to a mission, by the process at hand or a new one; the process stays, if it can fly on.
    pub(super) fn fly(&self, mission: &Mission, cancelled: &dyn Fn() -> bool) -> Answer {
        let at_hand = self.worker.borrow_mut().take();
        let worker = match at_hand.map_or_else(|| self.start(), Ok) {
            Ok(worker) => worker,
            Err(failed) => return Answer { result: Err(failed), before: None, not_begun: false, worker: None },
        };
        let mut answer = worker.fly(mission, QUIET, &|| self.stop() || cancelled());
        *self.worker.borrow_mut() = answer.worker.take();
        answer
    }

    /// What was said in a step, and the end of stderr.
    pub(super) fn close(&self, step: &mut Step) {
        step.transcript = self.wire.take();
        if let (Some(worker), true) = (&*self.worker.borrow(), step.stderr.is_empty()) {
            step.stderr = worker.stderr();
        }
    }
}

pub(super) fn name_of(greeting: &Greeting) -> &str {
    if greeting.name.is_empty() { "the program" } else { &greeting.name }
}

fn verdict(steps: &[Step], greeting: Option<&Greeting>) -> Verdict {
    let program = greeting.map_or("the program", name_of);
    let mistakes: Vec<(&str, &str)> =
        steps.iter().flat_map(|step| step.mistakes().map(|mistake| (step.name, mistake))).collect();
    match mistakes.first() {
        None => {
            let taken = steps.iter().filter(|step| !step.findings.is_empty()).count();
            Verdict::of(&format!("PASS {taken}/{} steps ({program})", steps.len()), 0)
        }
        Some((step, first)) => {
            let more = if mistakes.len() > 1 { format!("; {} mistakes in all", mistakes.len()) } else { String::new() };
            Verdict::of(&format!("EXECUTOR FAILED ({program}, {step}): {first}{more}"), 4)
        }
    }
}
