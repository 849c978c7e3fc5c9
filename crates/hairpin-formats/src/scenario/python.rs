//! A Python file of the user's that answers questions: Python runs beside hairpin, one process for each thread that
//! asks; nothing of the file runs but where something is asked.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

use hairpin::campaign::UserCode;
use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::lockstep::{Lockstep, Silence};

/// Asks the user's functions.
const DRIVER: &str = include_str!("user.py");

/// A file, and the Pythons that run it.
pub(super) struct Python {
    path: PathBuf,
    /// Whether what it imports comes from Python's own places alone, not from beside it.
    alone: bool,
    /// As the scenario names it.
    given: String,
    /// What it is asked for: `score` or `target`.
    what: &'static str,
    /// Those that nobody asks just now.
    idle: Mutex<Vec<Worker>>,
    trouble: Mutex<Option<String>>,
    stopped: AtomicBool,
}

impl Python {
    pub(super) fn new((path, alone): (PathBuf, bool), given: &str, what: &'static str) -> Self {
        let (idle, trouble, stopped) = (Mutex::default(), Mutex::default(), AtomicBool::new(false));
        Self { path, alone, given: given.to_owned(), what, idle, trouble, stopped }
    }

    /// Its answers to a question of `count` parts; `None` from when there is trouble on, and where nobody waits for
    /// them any more.
    pub(super) fn ask<A: DeserializeOwned>(&self, question: &impl Serialize, count: usize) -> Option<Vec<A>> {
        if held(&self.trouble).is_some() {
            return None;
        }
        let answer = self.worker().and_then(|mut worker| {
            let answer = worker.ask(question, count, &self.stopped)?;
            held(&self.idle).push(worker);
            Ok(answer)
        });
        match answer {
            Ok(answer) => Some(answer),
            Err(Unanswered::Failed(why)) => {
                held(&self.trouble).get_or_insert(self.complaint(&why));
                None
            }
            Err(Unanswered::Stopped) => None,
        }
    }

    fn worker(&self) -> Result<Worker, Unanswered> {
        let idle = held(&self.idle).pop();
        idle.map_or_else(|| Worker::start((&self.path, self.alone), self.what, &self.stopped), Ok)
    }

    fn complaint(&self, why: &str) -> String {
        format!("{}: {why}", self.given)
    }
}

impl UserCode for Python {
    fn trouble(&self) -> Option<String> {
        held(&self.trouble).clone()
    }

    fn try_out(&self) -> Result<(), String> {
        match self.worker() {
            Ok(worker) => {
                held(&self.idle).push(worker);
                Ok(())
            }
            Err(Unanswered::Failed(why)) => Err(self.complaint(&why)),
            Err(Unanswered::Stopped) => Err(self.complaint("was not loaded in time")),
        }
    }

    fn stop(&self) {
        self.stopped.store(true, Ordering::Relaxed);
    }
}

/// Why there is no answer.
enum Unanswered {
    /// Nobody waits for it any more.
    Stopped,
    /// What went wrong.
    Failed(String),
}

/// A running Python.
struct Worker(Lockstep);

impl Worker {
    /// When its functions are there.
    fn start((path, alone): (&Path, bool), what: &str, stopped: &AtomicBool) -> Result<Self, Unanswered> {
        let started = Lockstep::start(&mut driver(path, alone, what));
        let mut worker =
            Self(started.map_err(|error| Unanswered::Failed(format!("python3 cannot be started: {error}")))?);
        match &*worker.answer(stopped)? {
            b"ready" => Ok(worker),
            _ => Err(worker.last_words()),
        }
    }

    fn ask<A: DeserializeOwned>(
        &mut self,
        question: &impl Serialize,
        count: usize,
        stopped: &AtomicBool,
    ) -> Result<Vec<A>, Unanswered> {
        let line = if self.0.tell(question).is_ok() { self.answer(stopped)? } else { Vec::new() };
        match serde_json::from_slice::<Vec<A>>(&line) {
            Ok(parts) if parts.len() == count => Ok(parts),
            _ => Err(self.last_words()),
        }
    }

    /// Its next line; an empty one where it ended.
    fn answer(&mut self, stopped: &AtomicBool) -> Result<Vec<u8>, Unanswered> {
        match self.0.hear(stopped, None) {
            Err(Silence::Stopped) => Err(Unanswered::Stopped),
            answer => Ok(answer.unwrap_or_default()),
        }
    }

    /// What it wrote to stderr before it ended.
    fn last_words(&self) -> Unanswered {
        let last = self.0.last_words();
        Unanswered::Failed(if last.is_empty() { "it ended without an answer".into() } else { last })
    }
}

/// Python with the file at `path`, of which it asks `what`; one that stands `alone` finds no others beside it.
pub(crate) fn driver(path: &Path, alone: bool, what: &str) -> Command {
    let mut python = Command::new("python3");
    python.args(["-c", DRIVER]).arg(path).args([if alone { "alone" } else { "beside" }, what]);
    python
}

/// What a lock holds, whatever befell who held it last.
pub(crate) fn held<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
