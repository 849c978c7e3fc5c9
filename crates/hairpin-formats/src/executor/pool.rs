//! The processes of one program: whoever has missions to fly checks one out and gives it back.

use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::Duration;

use super::command::Command;
use super::pilot::{Pilot, Program};
use super::worker::Limits;

/// Between looks at whether whoever waits for a process is still to have one.
const LOOK: Duration = Duration::from_millis(50);

/// Processes of one program. None is started before it is needed; all are ended, in order, when this is dropped.
#[derive(Debug)]
pub(super) struct Pool {
    pub(super) program: Program,
    /// Those that nobody has; the last one flew last.
    free: Mutex<Vec<Pilot>>,
    given_back: Condvar,
}

impl Pool {
    /// Of at most `processes`, one at least.
    pub(super) fn new(command: &Command, limits: Limits, processes: usize, trusting: bool) -> Self {
        let free = std::iter::repeat_with(Pilot::default).take(processes.max(1)).collect();
        let program = Program::new(command, limits, trusting);
        Self { program, free: Mutex::new(free), given_back: Condvar::new() }
    }

    /// One that flies, as soon as one is free: the one that flew last. `None` where `cancelled` comes first.
    pub(super) fn check_out(&self, cancelled: &dyn Fn() -> bool) -> Option<Pilot> {
        let mut free = self.free();
        loop {
            if cancelled() {
                return None;
            }
            if let Some(pilot) = free.pop() {
                return Some(pilot);
            }
            free = self.given_back.wait_timeout(free, LOOK).unwrap_or_else(PoisonError::into_inner).0;
        }
    }

    /// Takes it back.
    pub(super) fn give_back(&self, pilot: Pilot) {
        self.free().push(pilot);
        self.given_back.notify_one();
    }

    fn free(&self) -> MutexGuard<'_, Vec<Pilot>> {
        self.free.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Drop for Pool {
    /// All at once: each may take its grace.
    fn drop(&mut self) {
        let pilots = std::mem::take(self.free.get_mut().unwrap_or_else(PoisonError::into_inner));
        thread::scope(|scope| {
            for mut pilot in pilots {
                scope.spawn(move || pilot.stop());
            }
        });
    }
}
