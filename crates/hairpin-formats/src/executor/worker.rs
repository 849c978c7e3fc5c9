//! One process of the user's program: handshake, mission after mission, a clean end.

use std::io::Write;
use std::process::{Child, ExitStatus, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::time::{Duration, Instant};

use hairpin::campaign::Mission;
use hairpin::trajectory::Flight;
use thiserror::Error;

use super::failure::{Failed, Failure, excerpt};
use super::lines::{LONGEST_LINE, Line, Tail, read_lines};
use super::message::{FromExecutor, ToExecutor, mission_message};
use super::process;
use super::recording::Recording;

/// Between looks at whether the user wants to stop.
const LOOK: Duration = Duration::from_millis(50);
/// How long a process that closed its stdout, or whose children hold stderr, is waited for.
const AFTERMATH: Duration = Duration::from_millis(300);

/// A command line, split as a shell splits it; nothing is expanded.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Command {
    program: String,
    arguments: Vec<String>,
}

/// Why a text is no command.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum CommandError {
    /// No word in it.
    #[error("is empty")]
    Empty,
    /// A quote that never ends, or a trailing backslash.
    #[error("has a quote that never ends")]
    Quotes,
}

impl Command {
    /// The program and its arguments.
    pub fn words(&self) -> impl Iterator<Item = &str> {
        std::iter::once(&self.program).chain(&self.arguments).map(String::as_str)
    }
}

impl std::str::FromStr for Command {
    type Err = CommandError;

    fn from_str(text: &str) -> Result<Self, CommandError> {
        let mut words = shlex::split(text).ok_or(CommandError::Quotes)?.into_iter();
        let program = words.next().filter(|program| !program.is_empty()).ok_or(CommandError::Empty)?;
        Ok(Self { program, arguments: words.collect() })
    }
}

/// Wall-clock limits of a worker: all that a stranger's program may take.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limits {
    /// From the start of the process to `ready`.
    pub handshake: Duration,
    /// From `mission` to `end`: `execute.timeout_s`.
    pub mission: Duration,
    /// From `bye` to the exit, and from the terminate signal to the kill signal.
    pub grace: Duration,
}

impl Default for Limits {
    fn default() -> Self {
        Self { handshake: Duration::from_secs(60), mission: Duration::from_secs(60), grace: Duration::from_secs(2) }
    }
}

/// A running process that has said `ready`. Dropping it ends it at once; [`Worker::stop`] says `bye` first.
#[derive(Debug)]
pub struct Worker {
    child: Child,
    outgoing: Option<Sender<Vec<u8>>>,
    lines: Receiver<Line>,
    line_number: u64,
    stderr: Tail,
    stderr_closed: Receiver<()>,
    limits: Limits,
    status: Option<ExitStatus>,
    name: String,
}

impl Worker {
    /// Starts the program in the current folder and shakes hands.
    ///
    /// # Errors
    /// It cannot be started, or does not say `ready` as it should; it is gone then.
    pub fn start(command: &Command, limits: Limits, cancelled: &dyn Fn() -> bool) -> Result<Self, Failed> {
        let mut starter = std::process::Command::new(&command.program);
        starter.args(&command.arguments).stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = process::start(&mut starter).map_err(|cause| Failed {
            failure: Failure::Start { program: command.program.clone(), cause: cause.to_string() },
            stderr: String::new(),
        })?;
        let (Some(stdin), Some(stdout), Some(stderr)) = (child.stdin.take(), child.stdout.take(), child.stderr.take())
        else {
            unreachable!("all three streams were asked to be pipes")
        };
        let (stderr, stderr_closed) = Tail::follow(stderr);
        let mut worker = Self {
            child,
            outgoing: Some(write_lines(stdin)),
            lines: read_lines(stdout),
            line_number: 0,
            stderr,
            stderr_closed,
            limits,
            status: None,
            name: String::new(),
        };
        match worker.shake_hands(cancelled) {
            Ok(()) => Ok(worker),
            Err(failure) => Err(worker.fail(failure)),
        }
    }

    /// What the program calls itself.
    pub fn name(&self) -> &str {
        &self.name
    }

    fn shake_hands(&mut self, cancelled: &dyn Fn() -> bool) -> Result<(), Failure> {
        self.say(&ToExecutor::Hello { hairpin: 1 });
        let limit = self.limits.handshake;
        let late = || Failure::NoReady { seconds: limit.as_secs_f64() };
        match self.hear("ready", Instant::now() + limit, late, cancelled)? {
            FromExecutor::Ready { protocol: 1, name } => {
                self.name = excerpt(&name, 100);
                Ok(())
            }
            FromExecutor::Ready { protocol: found, .. } => Err(Failure::Version { found }),
            FromExecutor::Error { message } => Err(Failure::Reported { message: excerpt(&message, 500) }),
            other => Err(Failure::Unexpected { found: other.kind(), awaited: "ready" }),
        }
    }

    /// Flies one mission. After a failure the worker is usable again only if it is handed back.
    ///
    /// # Errors
    /// What went wrong, with the end of stderr; the worker is gone unless the program itself reported the error.
    pub fn fly(mut self, mission: &Mission, cancelled: &dyn Fn() -> bool) -> (Result<Flight, Failed>, Option<Self>) {
        self.stderr.clear();
        match self.record(mission, cancelled) {
            Ok(flight) => (Ok(flight), Some(self)),
            // It is in step with us: the next mission may go better.
            Err(failure @ Failure::Reported { .. }) => {
                (Err(Failed { failure, stderr: self.stderr.text() }), Some(self))
            }
            Err(failure) => (Err(self.fail(failure)), None),
        }
    }

    fn record(&mut self, mission: &Mission, cancelled: &dyn Fn() -> bool) -> Result<Flight, Failure> {
        self.say(&mission_message(mission));
        let limit = self.limits.mission;
        let deadline = Instant::now() + limit;
        let late = || Failure::TimeOut { seconds: limit.as_secs_f64() };
        let mut recording = Recording::new(mission);
        loop {
            match self.hear("end", deadline, late, cancelled)? {
                FromExecutor::Pose(pose) => recording.push(&pose)?,
                FromExecutor::End { reason } => return Ok(recording.finish(reason)?),
                FromExecutor::Error { message } => {
                    return Err(Failure::Reported { message: excerpt(&message, 500) });
                }
                ready @ FromExecutor::Ready { .. } => {
                    return Err(Failure::Unexpected { found: ready.kind(), awaited: "pose" });
                }
            }
        }
    }

    /// Hands a line to the thread that writes: a program that never reads must not hold us up.
    fn say(&mut self, message: &ToExecutor) {
        let mut line = serde_json::to_vec(message).expect("messages are trees of strings and finite numbers");
        line.push(b'\n');
        if let Some(outgoing) = &self.outgoing {
            // It fails only where the program closed its stdin; what it says next decides.
            let _ = outgoing.send(line);
        }
    }

    fn hear(
        &mut self,
        awaited: &'static str,
        deadline: Instant,
        late: impl Fn() -> Failure,
        cancelled: &dyn Fn() -> bool,
    ) -> Result<FromExecutor, Failure> {
        loop {
            let now = Instant::now();
            if cancelled() {
                return Err(Failure::Cancelled);
            }
            if now >= deadline {
                return Err(late());
            }
            let line = match self.lines.recv_timeout(LOOK.min(deadline - now)) {
                Ok(line) => line,
                Err(RecvTimeoutError::Timeout) => continue,
                Err(RecvTimeoutError::Disconnected) => return Err(self.gone(awaited)),
            };
            self.line_number += 1;
            match line {
                Line::Text(bytes) if bytes.iter().all(u8::is_ascii_whitespace) => {}
                Line::Text(bytes) => return parse(&bytes, self.line_number),
                Line::TooLong => return Err(Failure::TooLong { number: self.line_number, limit: LONGEST_LINE }),
            }
        }
    }

    /// Its stdout is closed: has it exited, and how?
    fn gone(&mut self, awaited: &'static str) -> Failure {
        if !process::exits_within(&mut self.child, AFTERMATH) {
            return Failure::Silent { awaited };
        }
        self.end(Duration::ZERO);
        let status = self.status.map_or("status unknown".into(), |status| status.to_string());
        Failure::Exited { awaited, status }
    }

    /// Ends the process and gathers what it said on stderr.
    fn fail(mut self, failure: Failure) -> Failed {
        self.end(Duration::ZERO);
        // The receiver closes when the stream does; a child in another session may hold it open for ever.
        let _ = self.stderr_closed.recv_timeout(AFTERMATH);
        Failed { failure, stderr: self.stderr.text() }
    }

    /// Says `bye`, waits for the exit as long as the grace is, then ends the process with all its children.
    pub fn stop(mut self) {
        self.say(&ToExecutor::Bye);
        self.end(self.limits.grace);
    }

    fn end(&mut self, patience: Duration) {
        // Closes the child's stdin once all is written: the end for those who never heard of `bye`.
        self.outgoing = None;
        if self.status.is_none() {
            self.status = process::end(&mut self.child, patience, self.limits.grace);
        }
    }
}

impl Drop for Worker {
    fn drop(&mut self) {
        self.end(Duration::ZERO);
    }
}

fn write_lines(mut stdin: impl Write + Send + 'static) -> Sender<Vec<u8>> {
    let (sender, receiver) = channel::<Vec<u8>>();
    std::thread::spawn(move || {
        for line in receiver {
            if stdin.write_all(&line).and_then(|()| stdin.flush()).is_err() {
                return;
            }
        }
    });
    sender
}

fn parse(bytes: &[u8], number: u64) -> Result<FromExecutor, Failure> {
    let garbage =
        |cause: String| Failure::Garbage { number, cause, line: excerpt(&String::from_utf8_lossy(bytes), 120) };
    let text = std::str::from_utf8(bytes).map_err(|error| garbage(format!("not UTF-8: {error}")))?;
    serde_json::from_str(text).map_err(|error| {
        // Python's json writes these; they are no JSON.
        let infinite = ["NaN", "Infinity"].into_iter().find(|word| text.contains(word));
        garbage(infinite.map_or_else(|| error.to_string(), |word| format!("{word} is no JSON number: must be finite")))
    })
}
