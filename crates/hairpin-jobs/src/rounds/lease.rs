//! Who executes what: a file that only one can make says who, and one that says nothing new for long has died.
//!
//! Clocks of machines differ, so no time is ever read from a file: each looks by its own clock how long a word has been
//! the same.

use std::collections::HashMap;
use std::fs::File;
use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use hairpin_formats::atomic::WriteError;
use hairpin_formats::bounds;
use hairpin_formats::folder::ALIVE;

use crate::Problem;

/// A word has less than that, bytes.
const MOST: u64 = 1 << 12;

/// The leases in a folder, seen by one of those who take them.
pub(super) struct Leases {
    folder: PathBuf,
    /// The file that says that this one is alive.
    own: String,
    patience: Duration,
    /// What each of the others has said last, and since when.
    heard: Mutex<HashMap<String, (String, Instant)>>,
}

impl Leases {
    pub(super) fn new(folder: &Path, own: &str, patience: Duration) -> Self {
        Self { folder: folder.into(), own: own.into(), patience, heard: Mutex::default() }
    }

    /// Takes the piece called `name`, if nobody has it who is alive; whether it is this one's now.
    pub(super) fn claim(&self, name: &str) -> Result<bool, Problem> {
        let mut times = 0;
        let mut before = None;
        while let Some(holder) = self.word(&self.lease(name, times)) {
            (times, before) = (times + 1, Some(holder));
        }
        match before {
            Some(holder) if !self.is_dead(&holder, &self.lease(name, times - 1)) => Ok(false),
            _ => self.take(&self.lease(name, times)),
        }
    }

    fn lease(&self, name: &str, times: usize) -> PathBuf {
        self.folder.join(format!("{name}.{times}.lease"))
    }

    fn take(&self, path: &Path) -> Result<bool, Problem> {
        let refuse = |cause| WriteError { path: path.into(), cause };
        match File::create_new(path) {
            Err(cause) if cause.kind() == ErrorKind::AlreadyExists => Ok(false),
            file => {
                file.and_then(|mut file| file.write_all(self.own.as_bytes())).map_err(refuse)?;
                Ok(true)
            }
        }
    }

    /// What a file says; `None` where there is none.
    fn word(&self, path: &Path) -> Option<String> {
        bounds::read_text(path, MOST).ok()
    }

    /// Whether the holder of `lease` is gone, or has said nothing new for too long.
    fn is_dead(&self, holder: &str, lease: &Path) -> bool {
        if holder == self.own {
            // It was at it, and was stopped.
            return true;
        }
        // A lease whose word is not written yet, or never was, stands for its holder.
        let is_name = holder.starts_with(ALIVE) && !holder.contains(['/', '\\']);
        let path = if is_name { &self.folder.join(holder) } else { lease };
        let Some(word) = self.word(path) else { return true };
        let mut heard = self.heard.lock().unwrap_or_else(PoisonError::into_inner);
        let (last, since) =
            heard.entry(path.to_string_lossy().into_owned()).or_insert_with(|| (word.clone(), Instant::now()));
        if *last != word {
            (*last, *since) = (word, Instant::now());
        }
        since.elapsed() > self.patience
    }
}
