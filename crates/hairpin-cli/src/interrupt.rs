//! Ctrl-C: the first one asks to stop and keeps what is done, the second one quits and takes the user's programs with
//! it.

#[cfg(unix)]
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use crate::console;
use crate::exit::INTERRUPTED;

static ASKED: AtomicUsize = AtomicUsize::new(0);

/// Listens from now on to what asks to stop. What whoever started hairpin has it ignore, as `nohup` does, it ignores.
#[cfg(unix)]
pub(crate) fn listen() {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM, SIGXFSZ};
    // A file that may not grow further ends the process without a word; heard, the write fails, and is told.
    let _ = signal_hook::flag::register(SIGXFSZ, Arc::default());
    let heard = [SIGHUP, SIGINT, SIGTERM].into_iter().filter(|signal| !is_ignored(*signal));
    // It fails only where the system has no signals to listen to; then Ctrl-C quits at once.
    let Ok(mut signals) = signal_hook::iterator::Signals::new(heard) else { return };
    std::thread::spawn(move || signals.forever().for_each(|_| stop()));
}

/// Listens from now on.
#[cfg(not(unix))]
pub(crate) fn listen() {
    let _ = ctrlc::set_handler(stop);
}

fn stop() {
    if ASKED.fetch_add(1, Ordering::SeqCst) > 0 {
        hairpin_formats::executor::kill_all();
        std::process::exit(INTERRUPTED.into());
    }
    console::warn("stopping: what is done is kept (Ctrl-C again quits at once)");
}

/// Whether the process was started with a signal ignored; where the system does not say, it was not.
#[cfg(unix)]
fn is_ignored(signal: i32) -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| u64::from_str_radix(line.strip_prefix("SigIgn:")?.trim(), 16).ok());
    mask.is_some_and(|mask| mask >> (signal - 1) & 1 == 1)
}

/// Whether the user wants to stop.
pub(crate) fn asked() -> bool {
    ASKED.load(Ordering::Relaxed) > 0
}
