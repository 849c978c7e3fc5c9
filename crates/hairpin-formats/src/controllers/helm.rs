//! A run's controller: asks its process at every turn.

use std::marker::PhantomData;
use std::sync::Arc;
use std::time::Instant;

use hairpin::simulation::{Controlled, Controller, Fault, Reference};
use serde_json::Value;

use super::steersman::Steersman;
use super::turn::{MissionLine, Planned, ReferenceLine, ToController};
use crate::executor::excerpt;
use crate::lockstep::Lockstep;

/// Longest piece of an answer that is quoted, characters.
const QUOTED: usize = 120;

/// A kind of robot as the user's code knows it.
pub(super) trait Steered: Controlled + 'static {
    /// Its numbers.
    fn numbers(&self) -> Value;

    /// When, s, and what is measured.
    fn state(state: &Self::State) -> (f64, Value);

    /// Where the planned motion is at `t` s.
    fn planned(plan: &Self::Plan, t: f64) -> Option<Planned>;

    /// How long the planned motion takes, s.
    fn planned_s(plan: &Self::Plan) -> f64;

    /// The command that an answer is.
    ///
    /// # Errors
    /// What it must be.
    fn command(answer: &[u8]) -> Result<Self::Command, String>;
}

/// See the file's first line.
pub(super) struct AtTheHelm<R> {
    steersman: Arc<Steersman>,
    robot: Value,
    waypoints: Vec<[f64; 3]>,
    process: Option<Lockstep>,
    /// The run has to be over by then.
    until: Option<Instant>,
    /// Whether `reset` may still be answered.
    may_answer: bool,
    kind: PhantomData<fn(R)>,
}

impl<R: Steered> AtTheHelm<R> {
    pub(super) fn new(steersman: &Arc<Steersman>, robot: &R) -> Self {
        Self {
            steersman: steersman.clone(),
            robot: robot.numbers(),
            waypoints: Vec::new(),
            process: None,
            until: None,
            may_answer: false,
            kind: PhantomData,
        }
    }

    /// The answer to `line`; where there is none, or one that is `wrong`, the process goes.
    fn asked<T>(
        &mut self,
        line: &ToController,
        mut understand: impl FnMut(&[u8]) -> Result<Option<T>, String>,
    ) -> Result<T, Fault> {
        let Some(mut process) = self.process.take() else { return Err("it has no process any more".into()) };
        let answer = process.tell(line).and_then(|()| {
            loop {
                let line = process.hear(self.steersman.stopped(), self.until)?;
                match understand(&line).transpose() {
                    Some(Ok(answer)) => return Ok(Ok(answer)),
                    Some(Err(bound)) => {
                        let said = excerpt(&String::from_utf8_lossy(&line), QUOTED);
                        return Ok(Err(format!("it answered `{said}`: {bound}")));
                    }
                    None => {}
                }
            }
        });
        match answer {
            Ok(Ok(answer)) => {
                self.process = Some(process);
                Ok(answer)
            }
            Ok(Err(why)) => Err(why.into()),
            Err(why) => Err(self.steersman.complaint(&process, why).into()),
        }
    }
}

impl<R: Steered> Controller<R> for AtTheHelm<R> {
    fn period(&self) -> Option<f64> {
        Some(self.steersman.period())
    }

    fn reset(&mut self, reference: &Reference<R>) -> Result<(), Fault> {
        self.until = Instant::now().checked_add(self.steersman.limit());
        self.process = Some(self.steersman.process()?);
        self.waypoints = reference.waypoints.iter().map(|point| point.coords.into()).collect();
        let mission = MissionLine {
            waypoints_m: &self.waypoints.clone(),
            accept_m: reference.accept,
            planned_s: reference.plan.map(R::planned_s),
            robot: &self.robot.clone(),
        };
        let line = ToController::Reset { mission };
        if self.steersman.remembers() {
            return self.asked(&line, |_| Ok(Some(())));
        }
        // A program need not answer; if it does, that comes before its first command.
        self.may_answer = true;
        let Some(process) = &mut self.process else { return Ok(()) };
        match process.tell(&line) {
            Ok(()) => Ok(()),
            Err(why) => Err(self.steersman.complaint(process, why).into()),
        }
    }

    fn control(&mut self, _dt: f64, now: &R::State, to: &Reference<R>) -> Result<R::Command, Fault> {
        let (t_s, state) = R::state(now);
        let waypoints = self.waypoints.clone();
        let reference = ReferenceLine {
            waypoints_m: (!self.steersman.remembers()).then_some(&*waypoints),
            next: to.next,
            planned: to.plan.and_then(|plan| R::planned(plan, t_s)).unwrap_or_default(),
        };
        let mut may_skip = std::mem::take(&mut self.may_answer);
        self.asked(&ToController::Control { t_s, state, reference: Box::new(reference) }, |answer| {
            let command = R::command(answer);
            // What is said to `reset` has no command in it.
            if command.is_err() && std::mem::take(&mut may_skip) && says_nothing(answer) {
                return Ok(None);
            }
            command.map(Some)
        })
    }
}

/// Whether an answer is a table without numbers, such as `{}` or `{"type":"ready"}`.
fn says_nothing(answer: &[u8]) -> bool {
    let fields = serde_json::from_slice::<serde_json::Map<String, Value>>(answer);
    fields.is_ok_and(|fields| fields.values().all(|value| !value.is_number() && !value.is_array()))
}

impl<R> Drop for AtTheHelm<R> {
    fn drop(&mut self) {
        if let Some(process) = self.process.take() {
            self.steersman.give_back(process);
        }
    }
}
