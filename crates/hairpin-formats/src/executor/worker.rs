//! One process of the user's program: what it is told and what it says, line by line, from handshake to a clean end.

use std::io::Write;
use std::process::{Child, ExitStatus, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::time::{Duration, Instant};

use super::command::Command;
use super::envelope::Envelope;
use super::failure::{Failed, Failure, excerpt};
use super::greeting::Greeting;
use super::heard::{ErrorMessage, FromExecutor, ReadyMessage};
use super::line::{after, is_an_answer, parse};
use super::lines::{LONGEST_LINE, Line, Lines, Tail};
use super::message::ToExecutor;
use super::process;
use super::wire::{Speaker, Wire};

/// Between looks at whether the user wants to stop.
const LOOK: Duration = Duration::from_millis(50);
/// How long a process that closed its stdout, or whose children hold stderr, is waited for.
const AFTERMATH: Duration = Duration::from_millis(300);

/// How long it is listened after an answer of protocol 1 before the next mission is told, for answers do not say what
/// they are of: whoever flies twice goes on at once. What has passed since the answer counts.
pub const QUIET: Duration = Duration::from_millis(20);

/// Wall-clock limits of a worker: all that a stranger's program may take.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limits {
    /// From the start of the process to `ready`: `execute.timeout_s` as well.
    pub handshake: Duration,
    /// From `mission`, in protocol 2 from its `reset`, to `end`: `execute.timeout_s`.
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
    lines: Lines,
    wire: Wire,
    line_number: u64,
    pub(super) stderr: Tail,
    stderr_closed: Receiver<()>,
    pub(super) limits: Limits,
    status: Option<ExitStatus>,
    greeting: Greeting,
    /// The protocol that it speaks.
    pub(super) protocol: u64,
    /// The mission that it answered last.
    pub(super) last: Option<Envelope>,
    /// When it gave its last answer, until the next mission is told.
    pub(super) ended: Option<Instant>,
}

impl Worker {
    /// Starts the program in the current folder and shakes hands: in protocol 2 first, unless it is known to speak
    /// `protocol` 1; one that answers with 1, with an error, or by ending is started again with protocol 1.
    ///
    /// # Errors
    /// It cannot be started, or does not say `ready` as it should; it is gone then.
    pub fn start(
        command: &Command,
        limits: Limits,
        protocol: u64,
        cancelled: &dyn Fn() -> bool,
    ) -> Result<Self, Failed> {
        Self::start_on(&Wire::default(), command, limits, protocol, cancelled)
    }

    /// The same on a wire that keeps what is said.
    ///
    /// # Errors
    /// As [`Self::start`].
    pub fn start_on(
        wire: &Wire,
        command: &Command,
        limits: Limits,
        protocol: u64,
        cancelled: &dyn Fn() -> bool,
    ) -> Result<Self, Failed> {
        match Self::begin(wire, command, limits, protocol, cancelled) {
            Err(Failed {
                failure:
                    Failure::Version { found: 1 }
                    | Failure::Reported { .. }
                    | Failure::Exited { .. }
                    | Failure::Silent { .. },
                ..
            }) if protocol > 1 => Self::begin(wire, command, limits, 1, cancelled),
            begun => begun,
        }
    }

    fn begin(
        wire: &Wire,
        command: &Command,
        limits: Limits,
        protocol: u64,
        cancelled: &dyn Fn() -> bool,
    ) -> Result<Self, Failed> {
        let mut starter = std::process::Command::from(command);
        starter.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
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
            lines: Lines::of(stdout),
            wire: wire.clone(),
            line_number: 0,
            stderr,
            stderr_closed,
            limits,
            status: None,
            greeting: Greeting::default(),
            protocol,
            last: None,
            ended: None,
        };
        match worker.shake_hands(cancelled) {
            Ok(()) => Ok(worker),
            Err(failure) => Err(worker.fail(failure)),
        }
    }

    /// What the program says of itself.
    pub fn greeting(&self) -> &Greeting {
        &self.greeting
    }

    /// The end of what it has written to stderr since its last mission began.
    pub fn stderr(&self) -> String {
        self.stderr.text()
    }

    /// The same, once what it wrote before its last line of stdout is there: two pipes are read by two threads.
    pub(super) fn said_in_full(&self) -> String {
        self.stderr.settle(LOOK, AFTERMATH);
        self.stderr.text()
    }

    fn shake_hands(&mut self, cancelled: &dyn Fn() -> bool) -> Result<(), Failure> {
        self.say(&ToExecutor::Hello { hairpin: self.protocol });
        let limit = self.limits.handshake;
        let late = || Failure::NoReady { seconds: limit.as_secs_f64() };
        let line = self.hear("ready", Instant::now() + limit, late, cancelled)?;
        match self.understand(&line)? {
            FromExecutor::Ready(ready) if ready.protocol == Some(self.protocol) => {
                self.greeting = Greeting::of(&ready, self.protocol);
                Ok(())
            }
            FromExecutor::Ready(ReadyMessage { protocol: Some(found), .. }) => Err(Failure::Version { found }),
            FromExecutor::Ready(ReadyMessage { protocol: None, .. }) => Err(Failure::NoVersion),
            FromExecutor::Error(ErrorMessage { message, .. }) => {
                Err(Failure::Reported { message: excerpt(&message, 500) })
            }
            other => Err(Failure::Unexpected { found: other.kind(), awaited: "ready" }),
        }
    }

    /// What is wrong with a line that it sent within `patience` after its last answer, if it did: protocol 1 alone,
    /// where an answer does not say what it is of.
    pub(super) fn unasked(&mut self, patience: Duration) -> Option<Failure> {
        let until = self.ended.take().filter(|_| self.protocol == 1)? + patience;
        loop {
            match self.next_line(until.saturating_duration_since(Instant::now())) {
                Ok(Line::Text(bytes)) if bytes.iter().all(u8::is_ascii_whitespace) => self.line_number += 1,
                Ok(Line::Text(bytes)) => return Some(after(&bytes)),
                Ok(Line::TooLong) => return Some(after(b"a line without end")),
                Err(_) => return None,
            }
        }
    }

    fn next_line(&mut self, timeout: Duration) -> Result<Line, RecvTimeoutError> {
        let line = self.lines.next(timeout);
        match &line {
            Ok(Line::Text(bytes)) => self.wire.note(Speaker::Program, bytes),
            Ok(Line::TooLong) => self.wire.note(Speaker::Program, b"(a line without end)"),
            Err(_) => {}
        }
        line
    }

    /// Hands a line to the thread that writes: a program that never reads must not hold us up.
    pub(super) fn say(&mut self, message: &ToExecutor) {
        if let Some(outgoing) = &self.outgoing {
            let line = message.line();
            self.wire.note(Speaker::Hairpin, &line);
            // It fails only where the program closed its stdin; what it says next decides.
            let _ = outgoing.send(line);
        }
    }

    /// Its next line that is not blank.
    pub(super) fn hear(
        &mut self,
        awaited: &'static str,
        deadline: Instant,
        late: impl Fn() -> Failure,
        cancelled: &dyn Fn() -> bool,
    ) -> Result<Vec<u8>, Failure> {
        loop {
            let now = Instant::now();
            if cancelled() {
                return Err(Failure::Cancelled);
            }
            if now >= deadline {
                return Err(late());
            }
            let line = match self.next_line(LOOK.min(deadline - now)) {
                Ok(line) => line,
                Err(RecvTimeoutError::Timeout) => continue,
                Err(RecvTimeoutError::Disconnected) => return Err(self.gone(awaited)),
            };
            self.line_number += 1;
            match line {
                Line::Text(bytes) if bytes.iter().all(u8::is_ascii_whitespace) => {}
                Line::Text(bytes) => return Ok(bytes),
                Line::TooLong => return Err(Failure::TooLong { number: self.line_number, limit: LONGEST_LINE }),
            }
        }
    }

    /// The message in the line that was heard last.
    pub(super) fn understand(&self, line: &[u8]) -> Result<FromExecutor, Failure> {
        parse(line, self.line_number)
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
    pub(super) fn fail(mut self, failure: Failure) -> Failed {
        self.end(Duration::ZERO);
        // The receiver closes when the stream does; a child in another session may hold it open for ever.
        let _ = self.stderr_closed.recv_timeout(AFTERMATH);
        Failed { failure, stderr: self.stderr.text() }
    }

    /// Says `bye`, waits for the exit as long as the grace is, then ends the process with all its children. Gives what
    /// is wrong with its last answer, where it went on after that.
    pub fn stop(mut self) -> Option<Failed> {
        let mut wrong = self.unasked(QUIET);
        self.say(&ToExecutor::Bye);
        self.outgoing = None;
        let until = Instant::now() + self.limits.grace;
        // Who still talks is heard, so that whoever waits for a reader can exit; words of farewell are no answers.
        let mut exited = false;
        loop {
            match self.next_line(LOOK) {
                Ok(Line::Text(bytes)) => wrong = wrong.or_else(|| is_an_answer(&bytes).then(|| after(&bytes))),
                Ok(Line::TooLong) | Err(RecvTimeoutError::Disconnected) => break,
                Err(RecvTimeoutError::Timeout) if exited => break,
                Err(RecvTimeoutError::Timeout) => exited = process::exits_within(&mut self.child, Duration::ZERO),
            }
            if Instant::now() >= until {
                break;
            }
        }
        self.end(until.saturating_duration_since(Instant::now()));
        wrong.map(|failure| Failed { failure, stderr: self.stderr.text() })
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
