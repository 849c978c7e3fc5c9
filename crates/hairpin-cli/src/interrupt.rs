//! Ctrl-C: the first one asks to stop and keeps what is done, the second one quits and takes the user's programs with
//! it.

use std::sync::atomic::{AtomicUsize, Ordering};

use crate::console;
use crate::exit::INTERRUPTED;

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
