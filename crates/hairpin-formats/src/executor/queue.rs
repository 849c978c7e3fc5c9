//! Many missions that are known from the start, flown by several processes; one that fails costs its own mission and no
//! other, and each answer is held back until nothing can follow it any more.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

use hairpin::campaign::Mission;
use hairpin::trajectory::Flight;

use super::command::Command;
use super::failure::{Failed, Failure};
use super::greeting::Greeting;
use super::patience::{Heard, Patience};
use super::pilot::{Pilot, Program, Told};
use super::pool::Pool;
use super::worker::Limits;

/// Who takes flights.
type Landed<'a> = &'a (dyn Fn(usize, Result<Flight, Failed>) + Sync);

/// Flies missions `0..count` by `workers` processes of `command`; `mission(i)` makes the i-th (or says why it cannot be
/// flown), `landed(i, …)` takes its flight, both from any thread and in any order. What was being flown when
/// `cancelled` became true is not reported.
///
/// A program that cannot even be started fails every mission with the same sentence. Where three in a row, in their
/// order, were left without an answer, those that were not asked for yet fail at once. Gives what the program says of
/// itself, if it was asked and has said it.
pub fn fly_all(
    command: &Command,
    limits: Limits,
    workers: usize,
    count: usize,
    mission: &(dyn Fn(usize) -> Result<Mission, String> + Sync),
    landed: &(dyn Fn(usize, Result<Flight, Failed>) + Sync),
    cancelled: &(dyn Fn() -> bool + Sync),
) -> Option<Greeting> {
    fly_all_if((command, limits), &|_| true, workers, count, mission, landed, cancelled)
}

/// The same where the program `is_wanted` by what it says of itself; of one that is not, nothing lands.
pub fn fly_all_if(
    (command, limits): (&Command, Limits),
    is_wanted: &(dyn Fn(&Greeting) -> bool + Sync),
    workers: usize,
    count: usize,
    mission: &(dyn Fn(usize) -> Result<Mission, String> + Sync),
    landed: &(dyn Fn(usize, Result<Flight, Failed>) + Sync),
    cancelled: &(dyn Fn() -> bool + Sync),
) -> Option<Greeting> {
    let workers = workers.clamp(1, count.max(1));
    let (next, patience) = (AtomicUsize::new(0), Patience::new(count));
    let pool = Pool::new(command, limits, workers, false);
    let cancelled = || cancelled() || pool.program.greeting().is_some_and(|greeting| !is_wanted(greeting));
    let stop = || cancelled() || patience.is_over();
    thread::scope(|scope| {
        for _ in 0..workers {
            scope.spawn(|| {
                let Some(pilot) = pool.check_out(&stop) else { return };
                let mut held = Held { pilot, program: &pool.program, landed, flight: None };
                while !stop() {
                    let index = next.fetch_add(1, Ordering::Relaxed);
                    if index >= count {
                        break;
                    }
                    match mission(index) {
                        Ok(mission) => match held.fly(index, &mission, &stop) {
                            Some(told) => patience.note(index, heard(&told)),
                            None => break,
                        },
                        Err(cause) => {
                            patience.note(index, Heard::NotAsked);
                            landed(index, Err(Failed { failure: Failure::NoMission { cause }, stderr: String::new() }));
                        }
                    }
                }
                held.stop();
            });
        }
    });
    if patience.is_over() && !cancelled() {
        let failure = Failure::NotAsked { seconds: limits.mission.as_secs_f64() };
        for index in patience.unheard() {
            landed(index, Err(Failed { failure: failure.clone(), stderr: String::new() }));
        }
    }
    pool.program.greeting().cloned()
}

fn heard(told: &Result<(), Failure>) -> Heard {
    match told {
        // A program that never starts is not started again and again in the first place.
        Err(Failure::NoReady { .. }) => Heard::NotAsked,
        Err(failure) if failure.is_time_out() => Heard::TimedOut,
        _ => Heard::Answered,
    }
}

/// One that flies, and the flight of its last mission, which its process may still spoil.
struct Held<'a> {
    pilot: Pilot,
    program: &'a Program,
    landed: Landed<'a>,
    flight: Option<(usize, Flight)>,
}

impl Held<'_> {
    /// Flies mission number `index`. What comes of it is given back, and lands sooner or later; what is cancelled does
    /// not.
    fn fly(&mut self, index: usize, mission: &Mission, cancelled: &dyn Fn() -> bool) -> Option<Result<(), Failure>> {
        let Told { result, before } = self.pilot.fly(self.program, mission, cancelled);
        if let Err(Failed { failure: Failure::Cancelled, .. }) = result {
            before.into_iter().for_each(|failed| self.settle(Err(failed)));
            return None;
        }
        self.settle(before.map_or(Ok(()), Err));
        let told = result.as_ref().map(drop).map_err(|failed| failed.failure.clone());
        match result {
            Ok(flight) if self.pilot.may_go_on() => self.flight = Some((index, flight)),
            landed => (self.landed)(index, landed),
        }
        Some(told)
    }

    /// The mission before is over: what was held lands, unless something was wrong with it.
    fn settle(&mut self, outcome: Result<(), Failed>) {
        if let Some((index, flight)) = self.flight.take() {
            (self.landed)(index, outcome.map(|()| flight));
        }
    }

    /// Ends the process in order, and what was held lands.
    fn stop(mut self) {
        let wrong = self.pilot.stop();
        self.settle(wrong.map_or(Ok(()), Err));
    }
}
