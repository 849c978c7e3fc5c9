//! Ctrl-C: the first one asks to stop and keeps what is done, the second one quits and takes the user's programs with it.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::{RecvTimeoutError, sync_channel};
use std::thread;
use std::time::{Duration, Instant};

use hairpin::campaign::LegScorer;

use crate::console;

/// Exit code of an interrupted command, as shells have it.
pub(crate) const INTERRUPTED: u8 = 130;

static ASKED: AtomicUsize = AtomicUsize::new(0);

/// Listens from now on.
pub(crate) fn listen() {
    // It fails only where the system has no signals to listen to; then Ctrl-C quits at once.
    let _ = ctrlc::set_handler(|| {
        if ASKED.fetch_add(1, Ordering::SeqCst) > 0 {
            hairpin_formats::executor::kill_all();
            std::process::exit(INTERRUPTED.into());
        }
        console::warn("stopping: what is done is kept (Ctrl-C again quits at once)");
    });
}

/// Whether the user wants to stop.
pub(crate) fn asked() -> bool {
    ASKED.load(Ordering::Relaxed) > 0
}

/// Between two looks at whether an answer of the user's score is still wanted.
const LOOK: Duration = Duration::from_millis(20);

/// Does `work`, which may ask `score`. What that takes for an answer is not up to us; what is waited for it is.
pub(crate) fn not_waiting_for<T>(score: Option<&dyn LegScorer>, deadline: Deadline, work: impl FnOnce() -> T) -> T {
    let Some(user) = score else { return work() };
    thread::scope(|scope| {
        // Closes with the work, however that ends.
        let (_at_work, done) = sync_channel::<()>(0);
        scope.spawn(move || {
            while done.recv_timeout(LOOK) == Err(RecvTimeoutError::Timeout) {
                if asked() || deadline.passed() {
                    return user.stop();
                }
            }
        });
        work()
    })
}

/// A time limit in wall-clock seconds.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Deadline(Option<Instant>);

impl Deadline {
    /// `seconds` from now; never without.
    pub(crate) fn after(seconds: Option<f64>) -> Self {
        let duration = seconds.and_then(|s| std::time::Duration::try_from_secs_f64(s).ok());
        Self(duration.and_then(|duration| Instant::now().checked_add(duration)))
    }

    /// Whether it is over.
    pub(crate) fn passed(self) -> bool {
        self.0.is_some_and(|end| Instant::now() >= end)
    }
}
