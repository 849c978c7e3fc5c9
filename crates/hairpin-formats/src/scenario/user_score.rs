//! Scores of the user's own: the Python file that `score = "python:FILE"` names.
//!
//! The file defines `score(leg)` and, if legs leave something to the next, `left(leg)`; `leg` is a dictionary. Both
//! must be functions of the leg alone. Python runs beside hairpin, one process for each thread that asks; nothing of
//! the file runs but where legs are to be scored.

use std::collections::HashMap;
use std::io::{BufRead, BufReader, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, sync_channel};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::Duration;

use hairpin::campaign::scenario::PYTHON;
use hairpin::campaign::user_score::{LegFacts, NAME};
use hairpin::campaign::{Attached, LegScorer};

use super::attached::{Wrong, attached};
use super::whole::read_file;
use crate::executor::{self, Tail};

/// Asks the user's functions.
const DRIVER: &str = include_str!("score.py");
/// Legs whose scores are kept, so that one that is asked for again costs no question.
const MOST_KNOWN: usize = 1 << 20;
/// What its last words are waited for, and what it is given to end.
const AFTERMATH: Duration = Duration::from_millis(300);
/// Between two looks at whether an answer is still wanted.
const LOOK: Duration = Duration::from_millis(20);

/// Reads the score of the user's own that `score` names, if it does; `key` is its key. A resolved scenario's is
/// [`NAME`]. One that stands `alone` finds no other Python files beside it.
pub(super) fn read(
    key: &str,
    score: &mut String,
    find: &dyn Fn(&str) -> PathBuf,
    alone: bool,
) -> Result<Option<Attached<dyn LegScorer>>, Wrong> {
    let Some(file) = score.strip_prefix(PYTHON) else { return Ok(None) };
    let path = find(file);
    let wrong = |bound: String| Wrong { key: key.to_owned(), value: score.clone(), bound };
    let bytes = read_file(&path).map_err(|why| wrong(format!("`{file}` cannot be read: {why}")))?;
    let user = attached(Arc::new(PythonScore::new(path, score, alone)) as Arc<dyn LegScorer>, bytes, NAME, score);
    *score = format!("{PYTHON}{NAME}");
    Ok(Some(user))
}

/// What is known of a leg, as bits.
type Key = [u64; 20];

struct PythonScore {
    path: PathBuf,
    /// Whether what it imports comes from Python's own places alone, not from beside it.
    alone: bool,
    /// As the scenario names it.
    given: String,
    /// Those that nobody asks just now.
    idle: Mutex<Vec<Worker>>,
    known: Mutex<HashMap<Key, [f64; 2]>>,
    trouble: Mutex<Option<String>>,
    stopped: AtomicBool,
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

impl PythonScore {
    fn new(path: PathBuf, given: &str, alone: bool) -> Self {
        let (idle, known, trouble) = (Mutex::default(), Mutex::default(), Mutex::default());
        Self { path, alone, given: given.to_owned(), idle, known, trouble, stopped: AtomicBool::new(false) }
    }

    fn ask(&self, legs: &[&LegFacts]) -> Result<Vec<[f64; 2]>, Unanswered> {
        let idle = held(&self.idle).pop();
        let mut worker = idle.map_or_else(|| Worker::start(&self.path, self.alone, &self.stopped), Ok)?;
        let answer = worker.ask(legs, &self.stopped)?;
        held(&self.idle).push(worker);
        Ok(answer)
    }

    fn complaint(&self, why: &str) -> String {
        format!("{}: {why}", self.given)
    }
}

impl Worker {
    /// When its functions are there.
    fn start(path: &Path, alone: bool, stopped: &AtomicBool) -> Result<Self, Unanswered> {
        let mut python = Command::new("python3");
        python.args(["-c", DRIVER]).arg(path).arg(if alone { "alone" } else { "beside" });
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

    fn ask(&mut self, legs: &[&LegFacts], stopped: &AtomicBool) -> Result<Vec<[f64; 2]>, Unanswered> {
        // A line at once: a pipe takes every write for itself.
        let spoken = serde_json::to_vec(legs).map_err(std::io::Error::from).and_then(|mut question| {
            question.push(b'\n');
            self.asked.write_all(&question)?;
            self.asked.flush()
        });
        let line = if spoken.is_ok() { self.answer(stopped)? } else { String::new() };
        match serde_json::from_str::<Vec<[f64; 2]>>(&line) {
            Ok(parts) if parts.len() == legs.len() => Ok(parts),
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

fn key(leg: &LegFacts) -> Key {
    let LegFacts { v_in_m_s, v_out_m_s, turn_rad, length_m, climb_m, slope_in, ground, duration_s, .. } = *leg;
    let places = [leg.from_m, leg.to_m, leg.start_m, leg.end_m];
    let mut key = [0; 20];
    let numbers = [v_in_m_s, v_out_m_s, turn_rad, length_m, climb_m, slope_in, ground, duration_s];
    for (bits, number) in key.iter_mut().zip(numbers.iter().chain(places.as_flattened())) {
        *bits = number.to_bits();
    }
    key
}

fn held<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

impl LegScorer for PythonScore {
    fn own_and_left(&self, legs: &[LegFacts]) -> Vec<[f64; 2]> {
        if held(&self.trouble).is_some() {
            return vec![[f64::NAN; 2]; legs.len()];
        }
        let keys: Vec<Key> = legs.iter().map(key).collect();
        let mut parts: Vec<Option<[f64; 2]>> = {
            let known = held(&self.known);
            keys.iter().map(|key| known.get(key).copied()).collect()
        };
        let unknown: Vec<usize> = (0..legs.len()).filter(|place| parts[*place].is_none()).collect();
        if !unknown.is_empty() {
            match self.ask(&unknown.iter().map(|place| &legs[*place]).collect::<Vec<_>>()) {
                Ok(answers) => {
                    let mut known = held(&self.known);
                    if known.len() + answers.len() > MOST_KNOWN {
                        known.clear();
                    }
                    for (place, answer) in unknown.into_iter().zip(answers) {
                        known.insert(keys[place], answer);
                        parts[place] = Some(answer);
                    }
                }
                Err(Unanswered::Failed(why)) => {
                    held(&self.trouble).get_or_insert(self.complaint(&why));
                }
                Err(Unanswered::Stopped) => {}
            }
        }
        parts.into_iter().map(|part| part.unwrap_or([f64::NAN; 2])).collect()
    }

    fn trouble(&self) -> Option<String> {
        held(&self.trouble).clone()
    }

    fn try_out(&self) -> Result<(), String> {
        match Worker::start(&self.path, self.alone, &self.stopped) {
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
