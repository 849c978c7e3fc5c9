//! A process beside hairpin that answers a line with a line.

use std::io::{self, Write};
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError};
use std::time::{Duration, Instant};

use serde::Serialize;

use crate::executor::{self, Line, Lines, Tail};

/// What its last words are waited for, and what it is given to end.
const AFTERMATH: Duration = Duration::from_millis(300);
/// Between two looks at whether an answer is still wanted.
const LOOK: Duration = Duration::from_millis(20);

/// Why there is no answer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Silence {
    /// Nobody waits for it any more.
    Stopped,
    /// It was not there in time.
    Late,
    /// A line without an end.
    Endless,
    /// The process, or its stdout, is gone.
    Gone,
}

/// The process.
pub(crate) struct Lockstep {
    child: Child,
    asked: ChildStdin,
    answers: Lines,
    log: Tail,
    log_closed: Receiver<()>,
}

impl Drop for Lockstep {
    fn drop(&mut self) {
        let _ = executor::end(&mut self.child, Duration::ZERO, AFTERMATH);
    }
}

impl Lockstep {
    /// Starts `command`, of which all three streams are ours.
    ///
    /// # Errors
    /// It cannot be started.
    pub(crate) fn start(command: &mut Command) -> io::Result<Self> {
        command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = executor::start(command)?;
        let (Some(asked), Some(answers), Some(log)) = (child.stdin.take(), child.stdout.take(), child.stderr.take())
        else {
            unreachable!("all three streams were asked to be pipes")
        };
        let (log, log_closed) = Tail::follow(log);
        Ok(Self { child, asked, answers: Lines::of(answers), log, log_closed })
    }

    /// Tells it `line`.
    pub(crate) fn tell(&mut self, line: &impl Serialize) -> Result<(), Silence> {
        // A line at once: a pipe takes every write for itself.
        let spoken = serde_json::to_vec(line).map_err(io::Error::from).and_then(|mut line| {
            line.push(b'\n');
            self.asked.write_all(&line)?;
            self.asked.flush()
        });
        spoken.map_err(|_| Silence::Gone)
    }

    /// Its next line, if that comes before the time `until`.
    pub(crate) fn hear(&mut self, stopped: &AtomicBool, until: Option<Instant>) -> Result<Vec<u8>, Silence> {
        while !stopped.load(Ordering::Relaxed) {
            // Looked at before what is there: who answers each line a little late is late in the end.
            if until.is_some_and(|until| Instant::now() >= until) {
                return Err(Silence::Late);
            }
            match self.answers.next(LOOK) {
                Ok(Line::Text(line)) => return Ok(line),
                Ok(Line::TooLong) => return Err(Silence::Endless),
                Err(RecvTimeoutError::Disconnected) => return Err(Silence::Gone),
                Err(RecvTimeoutError::Timeout) => {}
            }
        }
        Err(Silence::Stopped)
    }

    /// A line that is there before anything was asked; none where there is nothing to read.
    pub(crate) fn unasked(&mut self) -> Option<Vec<u8>> {
        match self.answers.next(Duration::ZERO) {
            Ok(Line::Text(line)) => Some(line),
            Ok(Line::TooLong) => Some(Vec::new()),
            Err(_) => None,
        }
    }

    /// The last line that it wrote to stderr before it ended; empty where it wrote none.
    pub(crate) fn last_words(&self) -> String {
        // It closes when all is read, or the process is not going to end.
        let _ = self.log_closed.recv_timeout(AFTERMATH);
        let text = self.log.text();
        text.lines().next_back().unwrap_or_default().replace(|c: char| c.is_control(), " ")
    }
}
