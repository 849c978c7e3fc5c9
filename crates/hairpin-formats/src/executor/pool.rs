//! Several workers fly many missions; one that fails costs its own mission and no other.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

use hairpin::campaign::Mission;
use hairpin::trajectory::Flight;

use super::failure::{Failed, Failure};
use super::worker::{Command, Limits, Worker};

/// A program that failed this often in a row to say `ready` is not started again.
const HOPELESS: usize = 3;

/// Flies missions `0..count` by `workers` processes of `command`; `mission(i)` makes the i-th (or says why it cannot be
/// flown), `landed(i, …)` takes its flight, both from any thread and in any order. What was being flown when
/// `cancelled` became true is not reported.
///
/// A program that cannot even be started fails every mission with the same sentence.
pub fn fly_all(
    command: &Command,
    limits: Limits,
    workers: usize,
    count: usize,
    mission: &(dyn Fn(usize) -> Result<Mission, String> + Sync),
    landed: &(dyn Fn(usize, Result<Flight, Failed>) + Sync),
    cancelled: &(dyn Fn() -> bool + Sync),
) {
    let next = AtomicUsize::new(0);
    thread::scope(|scope| {
        for _ in 0..workers.clamp(1, count.max(1)) {
            scope.spawn(|| {
                let mut pilot = Pilot { command, limits, worker: None, misses: Vec::new() };
                while !cancelled() {
                    let index = next.fetch_add(1, Ordering::Relaxed);
                    if index >= count {
                        break;
                    }
                    let flown = match mission(index) {
                        Ok(mission) => pilot.fly(&mission, cancelled),
                        Err(cause) => Err(Failed { failure: Failure::NoMission { cause }, stderr: String::new() }),
                    };
                    match flown {
                        Err(Failed { failure: Failure::Cancelled, .. }) => break,
                        result => landed(index, result),
                    }
                }
                if let Some(worker) = pilot.worker {
                    worker.stop();
                }
            });
        }
    });
}

struct Pilot<'a> {
    command: &'a Command,
    limits: Limits,
    worker: Option<Worker>,
    /// Failed starts since the last good one.
    misses: Vec<Failed>,
}

impl Pilot<'_> {
    fn fly(&mut self, mission: &Mission, cancelled: &dyn Fn() -> bool) -> Result<Flight, Failed> {
        let worker = match self.worker.take() {
            Some(worker) => worker,
            None => self.start(cancelled)?,
        };
        let (result, worker) = worker.fly(mission, cancelled);
        self.worker = worker;
        result
    }

    fn start(&mut self, cancelled: &dyn Fn() -> bool) -> Result<Worker, Failed> {
        if self.misses.len() >= HOPELESS {
            return Err(self.misses[HOPELESS - 1].clone());
        }
        let started = Worker::start(self.command, self.limits, cancelled);
        match &started {
            Ok(_) => self.misses.clear(),
            Err(failed) => self.misses.push(failed.clone()),
        }
        started
    }
}
