//! A Python file of the user's that answers questions: Python runs beside hairpin, one process for each thread that
//! asks; nothing of the file runs but where something is asked.

use std::io::{BufRead, BufReader, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, sync_channel};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::Duration;

use hairpin::campaign::UserCode;
use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::executor::{self, Tail};

/// Asks the user's functions.
const DRIVER: &str = include_str!("user.py");
/// What its last words are waited for, and what it is given to end.
const AFTERMATH: Duration = Duration::from_millis(300);
/// Between two looks at whether an answer is still wanted.
const LOOK: Duration = Duration::from_millis(20);

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
struct Worker {
    child: Child,
    asked: ChildStdin,
    answers: Receiver<String>,
    log: Tail,
    log_closed: Receiver<()>,
}

impl Drop for Worker {
    fn drop(&mut self) {
        let _ = executor::end(&mut self.child, Duration::ZERO, AFTERMATH);
    }
}

impl Worker {
    /// When its functions are there.
    fn start((path, alone): (&Path, bool), what: &str, stopped: &AtomicBool) -> Result<Self, Unanswered> {
        let mut python = Command::new("python3");
        python.args(["-c", DRIVER]).arg(path).args([if alone { "alone" } else { "beside" }, what]);
        python.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = executor::start(&mut python)
            .map_err(|error| Unanswered::Failed(format!("python3 cannot be started: {error}")))?;
        let (Some(asked), Some(answers), Some(log)) = (child.stdin.take(), child.stdout.take(), child.stderr.take())
        else {
            unreachable!("all three streams were asked to be pipes")
        };
        let (log, log_closed) = Tail::follow(log);
        let (said, heard) = sync_channel(1);
        // Ends with the stream, or when nobody listens any more.
        thread::spawn(move || {
            BufReader::new(answers).lines().map_while(Result::ok).try_for_each(|line| said.send(line))
        });
        let mut worker = Self { child, asked, answers: heard, log, log_closed };
        match worker.answer(stopped)?.as_str() {
            "ready" => Ok(worker),
            _ => Err(worker.last_words()),
        }
    }

    fn ask<A: DeserializeOwned>(
        &mut self,
        question: &impl Serialize,
        count: usize,
        stopped: &AtomicBool,
    ) -> Result<Vec<A>, Unanswered> {
        // A line at once: a pipe takes every write for itself.
        let spoken = serde_json::to_vec(question).map_err(std::io::Error::from).and_then(|mut question| {
            question.push(b'\n');
            self.asked.write_all(&question)?;
            self.asked.flush()
        });
        let line = if spoken.is_ok() { self.answer(stopped)? } else { String::new() };
        match serde_json::from_str::<Vec<A>>(&line) {
            Ok(parts) if parts.len() == count => Ok(parts),
            _ => Err(self.last_words()),
        }
    }

    /// Its next line; an empty one where it ended.
    fn answer(&self, stopped: &AtomicBool) -> Result<String, Unanswered> {
        while !stopped.load(Ordering::Relaxed) {
            match self.answers.recv_timeout(LOOK) {
                Ok(line) => return Ok(line),
                Err(RecvTimeoutError::Disconnected) => return Ok(String::new()),
                Err(RecvTimeoutError::Timeout) => {}
            }
        }
        Err(Unanswered::Stopped)
    }

    /// What it wrote to stderr before it ended.
    fn last_words(&mut self) -> Unanswered {
        // It closes when all is read, or the process is not going to end.
        let _ = self.log_closed.recv_timeout(AFTERMATH);
        let text = self.log.text();
        let last = text.lines().next_back().unwrap_or_default().replace(|c: char| c.is_control(), " ");
        Unanswered::Failed(if last.is_empty() { "it ended without an answer".into() } else { last })
    }
}

/// What a lock holds, whatever befell who held it last.
pub(super) fn held<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
