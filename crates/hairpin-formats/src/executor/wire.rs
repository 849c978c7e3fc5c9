//! What goes over the wire, line by line, for whoever wants to see it.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Instant;

/// Lines that are kept, at most, and bytes in them: what is more is counted.
const MOST_LINES: usize = 20_000;
const MOST_BYTES: usize = 32 << 20;

/// Who says a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Speaker {
    /// We.
    Hairpin,
    /// The program.
    Program,
}

/// One line.
#[derive(Debug, Clone, PartialEq)]
pub struct Said {
    /// Whose it is.
    pub by: Speaker,
    /// When it was sent or heard.
    pub at: Instant,
    /// Without its end; what is not UTF-8 is replaced.
    pub line: String,
}

/// All that was said.
#[derive(Debug, Default)]
pub struct Transcript {
    /// In the order in which it was.
    pub said: Vec<Said>,
    /// Lines beyond those that are kept.
    pub left_out: usize,
    bytes: usize,
}

/// Keeps what is said, if anybody wants to see it.
#[derive(Debug, Clone, Default)]
pub struct Wire(Option<Arc<Mutex<Transcript>>>);

impl Wire {
    /// One that keeps it.
    pub fn kept() -> Self {
        Self(Some(Arc::default()))
    }

    /// Takes out what was said until now.
    pub fn take(&self) -> Transcript {
        self.open().map(|mut transcript| std::mem::take(&mut *transcript)).unwrap_or_default()
    }

    /// Whether the program has said something since.
    pub fn has_heard(&self, what: &str) -> bool {
        self.open().is_some_and(|transcript| {
            transcript.said.iter().rev().any(|said| said.by == Speaker::Program && said.line.contains(what))
        })
    }

    pub(super) fn note(&self, by: Speaker, line: &[u8]) {
        let Some(mut transcript) = self.open() else { return };
        if transcript.said.len() >= MOST_LINES || transcript.bytes + line.len() > MOST_BYTES {
            transcript.left_out += 1;
            return;
        }
        transcript.bytes += line.len();
        let line = String::from_utf8_lossy(line).trim_end_matches(['\n', '\r']).to_owned();
        transcript.said.push(Said { by, at: Instant::now(), line });
    }

    fn open(&self) -> Option<MutexGuard<'_, Transcript>> {
        Some(self.0.as_ref()?.lock().unwrap_or_else(PoisonError::into_inner))
    }
}
