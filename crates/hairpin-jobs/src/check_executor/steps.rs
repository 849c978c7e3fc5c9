//! What each step asks of a program, and what is to be said of its answer.

use std::cell::RefCell;
use std::time::{Duration, Instant};

use hairpin::campaign::Mission;
use hairpin::trajectory::Flight;
use hairpin_formats::executor::{Answer, Failed, Failure, Greeting, Transcript};

use super::compared::Difference;
use super::flown::tell;
use super::session::{Session, name_of};
use super::speed::{self, Speed};
use super::step::Step;

/// A program that shows nothing of a mission for so long is ended amid it all the same.
const UNSEEN: Duration = Duration::from_secs(1);

impl Session<'_> {
    pub(super) fn handshake(&self) -> (Step, Option<Greeting>) {
        let mut step = Step::new("handshake");
        let begun = Instant::now();
        let started = self.start();
        let seconds = begun.elapsed().as_secs_f64();
        let greeting = started.as_ref().ok().map(|worker| worker.greeting().clone());
        match (&started, &greeting) {
            (Ok(_), Some(greeting)) => {
                let version = greeting.version.as_ref().map_or(String::new(), |version| format!(" {version}"));
                let word = match greeting.deterministic {
                    Some(true) => ", says that it is deterministic",
                    Some(false) => ", says that it is not deterministic",
                    None => "",
                };
                let name = name_of(greeting);
                step.fact(format!("{name}{version}, protocol {}{word}; ready after {seconds:.2} s", greeting.protocol));
                if greeting.name.is_empty() {
                    step.remark("\"ready\" has no \"name\": verdict and report will say its command");
                }
                if greeting.protocol == 1 {
                    step.remark(
                        "in protocol 1 answers do not say which mission they are of, missions have no yaw_rad, limits and accept, and 20 ms are \
                         waited after each: protocol 2 has none of this",
                    );
                }
            }
            (Err(failed), _) => step.failed(failed),
            (Ok(_), None) => {}
        }
        *self.worker.borrow_mut() = started.ok();
        self.close(&mut step);
        (step, greeting)
    }

    pub(super) fn mission(&self, mission: &Mission) -> (Step, Option<Flight>) {
        let mut step = Step::new("mission");
        let begun = Instant::now();
        let answer = self.fly(mission, &|| false);
        let seconds = begun.elapsed().as_secs_f64();
        let flight = match answer.result {
            Ok(flight) => {
                tell(&mut step, mission, &flight, seconds);
                Some(flight)
            }
            Err(failed) => {
                step.failed(&failed);
                None
            }
        };
        self.close(&mut step);
        (step, flight)
    }

    /// The same mission by the same process, and by a new one.
    pub(super) fn again(
        &self,
        mission: &Mission,
        flight: &Flight,
        greeting: &Greeting,
    ) -> (Step, [Option<Difference>; 2]) {
        let mut step = Step::new("again");
        let mut found = [None; 2];
        for (place, (who, one)) in ["by the same process", "by a new one"].into_iter().zip(&mut found).enumerate() {
            if place == 1
                && let Some(worker) = self.worker.borrow_mut().take()
                && let Some(failed) = worker.stop()
            {
                step.failed(&failed);
            }
            let Answer { result, before, .. } = self.fly(mission, &|| false);
            before.iter().for_each(|failed| step.failed(failed));
            match result {
                Ok(other) => *one = Some(Difference::between(flight, &other)),
                // Told already: it is of the mission before.
                Err(failed) if before.as_ref() == Some(&failed) => {}
                Err(failed) => step.mistake(format!("the same mission again, {who}: {}", failed.in_full())),
            }
            if let Some(difference) = one {
                let sentence = format!("the same mission {who}: {}", difference.in_words());
                match (difference.same, greeting.deterministic) {
                    (true, _) => step.fact(sentence),
                    (false, Some(true)) => step.mistake(format!("{sentence}, though it says that it is deterministic")),
                    (false, _) => step.remark(format!(
                        "{sentence}: a campaign cannot be repeated; draw all noise from the mission's \"seed\", and keep nothing of missions before"
                    )),
                }
            }
        }
        self.close(&mut step);
        (step, found)
    }

    /// A mission without waypoints: nobody can fly it.
    pub(super) fn refusal(&self, mission: &Mission) -> Step {
        let mut step = Step::new("refusal");
        let none = Mission { waypoints: Vec::new(), yaws: Vec::new(), timed: Vec::new(), ..mission.clone() };
        let Answer { result, before, .. } = self.fly(&none, &|| false);
        before.iter().for_each(|failed| step.failed(failed));
        match result {
            Ok(flight) => step.mistake(format!(
                "answered a mission without waypoints by {} poses and \"end\": \"error\" is for what cannot be flown",
                flight.track.len()
            )),
            Err(Failed { failure: Failure::Reported { message }, .. }) => {
                step.fact(format!("a mission without waypoints is refused: {message}"));
            }
            Err(failed) if before.as_ref() == Some(&failed) => {}
            Err(failed) if matches!(failed.failure, Failure::Exited { .. } | Failure::Pose(_)) => step.remark(format!(
                "a mission without waypoints: {}; \"error\" would say why, and spare a new process",
                failed.in_full()
            )),
            Err(failed) => step.mistake(format!("a mission without waypoints: {}", failed.in_full())),
        }
        self.close(&mut step);
        step
    }

    /// Ended while it flies, as on a time-out or Ctrl-C; and another one after that.
    pub(super) fn cancelled(&self, mission: &Mission, flight: &Flight, same: bool) -> Step {
        let mut step = Step::new("cancelled");
        let begun = Instant::now();
        let asked = RefCell::new(None);
        let amid = || {
            let now = self.wire.has_heard("\"pose") || begun.elapsed() > UNSEEN;
            if now {
                asked.borrow_mut().get_or_insert_with(Instant::now);
            }
            now
        };
        // So that what was said before is not taken for poses of this one.
        drop(self.wire.take());
        let result = self.fly(mission, &amid).result;
        let took = asked.borrow().map(|asked| asked.elapsed());
        match (result, took) {
            (Err(Failed { failure: Failure::Cancelled, .. }), Some(took)) => {
                let seconds = took.as_secs_f64();
                if took >= self.limits.grace {
                    step.remark(format!("amid a mission it does not mind SIGTERM: it was killed after {seconds:.1} s"));
                } else {
                    step.fact(format!("amid a mission it ends {seconds:.2} s after it was asked to (SIGTERM)"));
                }
            }
            (Ok(_), _) => step.fact("the mission was over before it could be ended"),
            (Err(failed), _) => step.failed(&failed),
        }
        // A new one, whatever the other left behind.
        *self.worker.borrow_mut() = None;
        match self.fly(mission, &|| false).result {
            Err(failed) => step.mistake(format!("after one was ended amid a mission, a new one: {}", failed.in_full())),
            Ok(other) => match Difference::between(flight, &other) {
                Difference { same: true, .. } => step.fact("a new one flies as before"),
                difference if same => step.mistake(format!(
                    "after one was ended amid a mission, a new one flies otherwise, {}: something outlives the process",
                    difference.in_words()
                )),
                _ => step.fact("a new one flies"),
            },
        }
        self.close(&mut step);
        step
    }

    pub(super) fn speed(&self, mission: &Mission, flight: &Flight, greeting: &Greeting) -> (Step, Option<Speed>) {
        let mut step = Step::new("speed");
        let mut all = Vec::new();
        let mut elapsed = Duration::ZERO;
        while all.len() < speed::MOST && (all.is_empty() || elapsed < speed::LONGEST) {
            drop(self.wire.take());
            let begun = Instant::now();
            let Answer { result, before, .. } = self.fly(mission, &|| false);
            elapsed += begun.elapsed();
            before.iter().for_each(|failed| step.failed(failed));
            if before.is_some() {
                break;
            }
            if let Err(failed) = result {
                step.mistake(format!("the same mission for the time number {}: {}", all.len() + 1, failed.in_full()));
                break;
            }
            all.push(speed::timed(mission, greeting, &self.wire.take()));
        }
        let found = (!all.is_empty()).then(|| Speed::of(flight, elapsed, &all));
        if let Some(found) = found {
            step.fact(format!(
                "{:.1} executions a second by one process, {:.0} × real time; of that the protocol takes {:.2} ms a mission and {:.1} µs a pose (of {})",
                found.executions_per_s, found.real_time, found.protocol_ms_per_mission, found.protocol_us_per_pose, found.poses
            ));
        }
        self.close(&mut step);
        // What was said is the mission's again.
        step.transcript = Transcript::default();
        (step, found)
    }

    pub(super) fn bye(&self) -> Step {
        let mut step = Step::new("bye");
        let at_hand = self.worker.borrow_mut().take();
        let Some(worker) = at_hand else { return step };
        let begun = Instant::now();
        if let Some(failed) = worker.stop() {
            step.failed(&failed);
        }
        let took = begun.elapsed();
        if took >= self.limits.grace {
            let seconds = self.limits.grace.as_secs_f64();
            step.mistake(format!("does not exit within {seconds} s of \"bye\" and the end of its stdin: each process of a campaign is waited for"));
        } else {
            step.fact(format!("exits {:.2} s after \"bye\"", took.as_secs_f64()));
        }
        step.transcript = self.wire.take();
        step
    }
}
