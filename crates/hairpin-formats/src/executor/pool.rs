//! Several workers fly many missions; one that fails costs its own mission and no other.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

use hairpin::campaign::Mission;
use hairpin::trajectory::Flight;

use super::command::Command;
use super::failure::{Failed, Failure};
use super::patience::{Heard, Patience};
use super::pilot::{Pilot, Program};
use super::worker::Limits;

/// Flies missions `0..count` by `workers` processes of `command`; `mission(i)` makes the i-th (or says why it cannot be
/// flown), `landed(i, …)` takes its flight, both from any thread and in any order. What was being flown when
/// `cancelled` became true is not reported.
///
/// A program that cannot even be started fails every mission with the same sentence. Where three in a row, in their
/// order, were left without an answer, those that were not asked for yet fail at once.
pub fn fly_all(
    command: &Command,
    limits: Limits,
    workers: usize,
    count: usize,
    mission: &(dyn Fn(usize) -> Result<Mission, String> + Sync),
    landed: &(dyn Fn(usize, Result<Flight, Failed>) + Sync),
    cancelled: &(dyn Fn() -> bool + Sync),
) {
    let (next, patience, program) = (AtomicUsize::new(0), Patience::new(count), Program::new(command, limits));
    let stop = || cancelled() || patience.is_over();
    thread::scope(|scope| {
        for _ in 0..workers.clamp(1, count.max(1)) {
            scope.spawn(|| {
                let mut pilot = Pilot::new(&program, landed);
                while !stop() {
                    let index = next.fetch_add(1, Ordering::Relaxed);
                    if index >= count {
                        break;
                    }
                    match mission(index) {
                        Ok(mission) => match pilot.fly(index, &mission, &stop) {
                            Some(told) => patience.note(index, heard(&told)),
                            None => break,
                        },
                        Err(cause) => {
                            patience.note(index, Heard::NotAsked);
                            landed(index, Err(Failed { failure: Failure::NoMission { cause }, stderr: String::new() }));
                        }
                    }
                }
                pilot.stop();
            });
        }
    });
    if patience.is_over() && !cancelled() {
        let failure = Failure::NotAsked { seconds: limits.mission.as_secs_f64() };
        for index in patience.unheard() {
            landed(index, Err(Failed { failure: failure.clone(), stderr: String::new() }));
        }
    }
}

fn heard(told: &Result<(), Failure>) -> Heard {
    match told {
        // A program that never starts is not started again and again in the first place.
        Err(Failure::NoReady { .. }) => Heard::NotAsked,
        Err(failure) if failure.is_time_out() => Heard::TimedOut,
        _ => Heard::Answered,
    }
}
