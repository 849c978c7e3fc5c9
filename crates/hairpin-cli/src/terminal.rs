//! Whoever sits at the terminal, as jobs know them: Ctrl-C stops, bars and warnings stand on stderr.

use std::sync::{Mutex, MutexGuard, PoisonError};

use hairpin_jobs::Watch;
use indicatif::ProgressBar;

use crate::{console, interrupt};

/// The terminal that a command runs in.
#[derive(Default)]
pub(crate) struct Terminal {
    /// The bar that is seen, and what of.
    bar: Mutex<Option<(&'static str, ProgressBar)>>,
}

impl Terminal {
    fn bar(&self) -> MutexGuard<'_, Option<(&'static str, ProgressBar)>> {
        self.bar.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Watch for Terminal {
    fn stopped(&self) -> bool {
        interrupt::asked()
    }

    fn progress(&self, what: &'static str, done: usize, of: usize) {
        let mut seen = self.bar();
        if seen.as_ref().is_none_or(|(of_what, _)| *of_what != what) {
            *seen = Some((what, console::progress(what, of)));
        }
        if let Some((_, bar)) = seen.as_ref() {
            bar.set_length(of as u64);
            // Threads tell out of order.
            bar.set_position(bar.position().max(done as u64));
        }
    }

    fn finished(&self, _: &'static str) {
        if let Some((_, bar)) = self.bar().take() {
            bar.finish_and_clear();
        }
    }

    fn warn(&self, line: &str) {
        console::warn(line);
    }
}
