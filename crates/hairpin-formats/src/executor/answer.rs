//! One mission and the answer to it: what a program says counts for the mission that it is of, or for none.

use std::time::{Duration, Instant};

use hairpin::campaign::Mission;
use hairpin::trajectory::Flight;

use super::envelope::{Envelope, Whose};
use super::failure::{Failed, Failure, excerpt};
use super::heard::{EndMessage, EndReason, ErrorMessage, FromExecutor};
use super::line::{after, parse};
use super::message::{ToExecutor, mission_message};
use super::recording::Recording;
use super::worker::Worker;

/// What came of one mission.
#[derive(Debug)]
pub struct Answer {
    /// Its flight.
    pub result: Result<Flight, Failed>,
    /// What is now known to be wrong with the answer to the mission before: it went on after its `end`.
    pub before: Option<Failed>,
    /// The mission was not even begun, for what the process did after the one before: it is to be flown by another.
    pub not_begun: bool,
    /// The process, where it can fly on.
    pub worker: Option<Worker>,
}

impl Worker {
    /// Flies one mission, in protocol 1 when nothing has come for `quiet` since its last answer. After a failure the
    /// worker is usable again only if it is handed back.
    pub fn fly(mut self, mission: &Mission, quiet: Duration, cancelled: &dyn Fn() -> bool) -> Answer {
        let (mut before, asked) = (None, Envelope::of(mission));
        if let Some(failure) = self.unasked(quiet) {
            let failed = self.fail(failure);
            return Answer { result: Err(failed.clone()), before: Some(failed), not_begun: true, worker: None };
        }
        let deadline = Instant::now() + self.limits.mission;
        if self.protocol > 1
            && let Err(failure) = self.reset(&asked, deadline, cancelled, &mut before)
        {
            let ended = matches!(failure, Failure::Exited { .. } | Failure::Silent { .. } | Failure::TooLong { .. });
            let not_begun = self.last.is_some() && ended;
            return Answer { result: Err(self.fail(failure)), before, not_begun, worker: None };
        }
        self.stderr.clear();
        let result = self.record(mission, (&asked, deadline), cancelled, &mut before);
        self.last = Some(asked);
        let (result, worker) = match result {
            Ok(flight) => (Ok(flight), Some(self)),
            // It is in step with us: the next mission may go better.
            Err(failure @ Failure::Reported { .. }) => {
                (Err(Failed { failure, stderr: self.said_in_full() }), Some(self))
            }
            Err(failure) => (Err(self.fail(failure)), None),
        };
        Answer { result, before, not_begun: false, worker }
    }

    /// Protocol 2: asks for an end of all that was before. What still comes is of the mission before.
    fn reset(
        &mut self,
        asked: &Envelope,
        deadline: Instant,
        cancelled: &dyn Fn() -> bool,
        before: &mut Option<Failed>,
    ) -> Result<(), Failure> {
        self.say(&ToExecutor::Reset { case: asked.case.clone(), run: asked.run });
        let seconds = self.limits.mission.as_secs_f64();
        loop {
            let line = self.hear("ready", deadline, || Failure::TimeOut { awaited: "ready", seconds }, cancelled)?;
            match self.understand(&line) {
                Ok(message @ FromExecutor::Ready(_)) => match asked.whose(&message) {
                    Whose::This => return Ok(()),
                    Whose::Another { .. } => {}
                    Whose::Nobodys => return Err(Failure::Unnamed { found: message.kind() }),
                },
                Ok(FromExecutor::Error(ErrorMessage { message, .. })) if self.last.is_none() => {
                    return Err(Failure::Reported { message: excerpt(&message, 500) });
                }
                Ok(message) if self.last.is_none() => {
                    return Err(Failure::Unexpected { found: message.kind(), awaited: "ready" });
                }
                Err(failure) if self.last.is_none() => return Err(failure),
                _ => self.blame(&line, before),
            }
        }
    }

    /// The mission before went on after its end.
    fn blame(&self, line: &[u8], before: &mut Option<Failed>) {
        before.get_or_insert_with(|| Failed { failure: after(line), stderr: self.said_in_full() });
    }

    fn record(
        &mut self,
        mission: &Mission,
        (asked, deadline): (&Envelope, Instant),
        cancelled: &dyn Fn() -> bool,
        before: &mut Option<Failed>,
    ) -> Result<Flight, Failure> {
        self.say(&mission_message(mission, self.greeting()));
        let seconds = self.limits.mission.as_secs_f64();
        let mut astray: Option<(String, String)> = None;
        let mut recording = Recording::new(mission, self.protocol);
        loop {
            let late = || match &astray {
                None => Failure::TimeOut { awaited: "end", seconds },
                Some((case, run)) => Failure::Astray { seconds, case: case.clone(), run: run.clone() },
            };
            let line = self.hear("end", deadline, late, cancelled)?;
            let message = self.understand(&line)?;
            if self.protocol > 1 {
                match asked.whose(&message) {
                    Whose::This => {}
                    Whose::Nobodys if matches!(message, FromExecutor::Error(_)) => {}
                    Whose::Nobodys => return Err(Failure::Unnamed { found: message.kind() }),
                    Whose::Another { case, run } => {
                        if self.last.as_ref().is_some_and(|last| last.is(&case, &run)) {
                            self.blame(&line, before);
                        }
                        astray = Some((case, run));
                        continue;
                    }
                }
            }
            let taken = take(&mut recording, message, self.protocol);
            if matches!(taken, Ok(Some(_)) | Err(Failure::Reported { .. })) {
                self.ended = Some(Instant::now());
            }
            if let Some(reason) = taken? {
                return Ok(recording.finish(reason)?);
            }
        }
    }
}

/// Takes a message of the mission that is recorded. Gives why it is over, once it is.
fn take(recording: &mut Recording, message: FromExecutor, protocol: u64) -> Result<Option<EndReason>, Failure> {
    match message {
        FromExecutor::Pose(pose) => recording.push(&pose)?,
        FromExecutor::Poses(message) if protocol > 1 => {
            for (row, numbers) in message.poses.iter().enumerate() {
                let pose = numbers.pose().map_err(|what| Failure::Row { row, what })?;
                recording.push(&pose)?;
            }
        }
        FromExecutor::End(EndMessage { reason, assumed, .. }) => {
            recording.end_unsaid = assumed;
            return Ok(Some(reason));
        }
        FromExecutor::Error(ErrorMessage { message, .. }) => {
            return Err(Failure::Reported { message: excerpt(&message, 500) });
        }
        other => return Err(Failure::Unexpected { found: other.kind(), awaited: "pose" }),
    }
    Ok(None)
}

/// The flight of `mission` in what a program said of it in `protocol`, a line each, as a wire kept it.
///
/// `None` where nothing ends it; errors as of [`Worker::fly`].
pub fn read_flight(mission: &Mission, protocol: u64, lines: &[&str]) -> Option<Result<Flight, Failure>> {
    let mut recording = Recording::new(mission, protocol);
    for (number, line) in (1..).zip(lines) {
        match parse(line.as_bytes(), number).and_then(|message| take(&mut recording, message, protocol)) {
            Ok(None) => {}
            Ok(Some(reason)) => return Some(recording.finish(reason).map_err(Failure::from)),
            Err(failure) => return Some(Err(failure)),
        }
    }
    None
}
