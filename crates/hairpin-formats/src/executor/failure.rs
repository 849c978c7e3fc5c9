//! Why an executor gave no flight. The sentences go into results, so they hold nothing that depends on the clock.

use hairpin::judgement::is_command;
use thiserror::Error;

use super::recording::PoseError;

/// A mission without a flight, and what its program had to say.
#[derive(Debug, Clone, PartialEq, Error)]
#[error("{failure}")]
pub struct Failed {
    /// What went wrong.
    pub failure: Failure,
    /// The end of what the program wrote to stderr since the mission began.
    pub stderr: String,
}

/// What went wrong.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum Failure {
    /// What `[vary]` drew makes no mission.
    #[error("not flown: {cause}")]
    NoMission {
        /// Why.
        cause: String,
    },
    /// The operating system cannot start the program.
    #[error("cannot start `{program}`: {cause}")]
    Start {
        /// The program's name.
        program: String,
        /// The system's answer.
        cause: String,
    },
    /// The program speaks another version of the protocol.
    #[error("speaks protocol {found}; this hairpin speaks 1 and 2")]
    Version {
        /// Its version.
        found: u64,
    },
    /// It does not say which.
    #[error("\"ready\" without \"protocol\"")]
    NoVersion,
    /// No `ready` in time.
    #[error("no \"ready\" within {seconds} s of \"hello\"")]
    NoReady {
        /// The limit.
        seconds: f64,
    },
    /// No answer in time.
    #[error("time-out: no \"{awaited}\" within {seconds} s (execute.timeout_s)")]
    TimeOut {
        /// The message that was due.
        awaited: &'static str,
        /// The limit.
        seconds: f64,
    },
    /// No answer in time but one to something else.
    #[error("time-out: no \"end\" within {seconds} s (execute.timeout_s): it answered for case {case}, run {run}")]
    Astray {
        /// The limit.
        seconds: f64,
        /// The case that it named.
        case: String,
        /// Its run.
        run: String,
    },
    /// Not asked for, because the program had left three missions in a row without an answer.
    #[error("{NOT_ASKED} (execute.timeout_s = {seconds}); --resume flies it")]
    NotAsked {
        /// The limit.
        seconds: f64,
    },
    /// It went on after the end.
    #[error("sent more after its \"end\", where one mission has one answer: `{line}`")]
    After {
        /// The first line, its beginning.
        line: String,
    },
    /// Protocol 2: an answer that does not say what it is of.
    #[error("sent \"{found}\" without the case and the run that it is of, as protocol 2 has it")]
    Unnamed {
        /// Its type.
        found: &'static str,
    },
    /// A row of `poses` that is none.
    #[error("row {row} of \"poses\" {what}")]
    Row {
        /// Counted from 0.
        row: usize,
        /// What is wrong with it.
        what: String,
    },
    /// The process ended in the middle.
    #[error("ended without \"{awaited}\" ({status})")]
    Exited {
        /// The message that was due.
        awaited: &'static str,
        /// Exit status or signal.
        status: String,
    },
    /// The process goes on but closed its stdout.
    #[error("closed its stdout without \"{awaited}\"")]
    Silent {
        /// The message that was due.
        awaited: &'static str,
    },
    /// A line that is no message.
    #[error("line {number} of its stdout is no message: {cause}; it reads `{line}` (log to stderr, not to stdout)")]
    Garbage {
        /// Counted from 1 since the process started.
        number: u64,
        /// What is wrong.
        cause: String,
        /// Its beginning.
        line: String,
    },
    /// A message that says what cannot be.
    #[error("line {number} of its stdout is a message that is not understood: {cause}; it reads `{line}`")]
    NotUnderstood {
        /// Counted from 1 since the process started.
        number: u64,
        /// What is wrong.
        cause: String,
        /// Its beginning.
        line: String,
    },
    /// A line without end.
    #[error("line {number} of its stdout is longer than {limit} bytes")]
    TooLong {
        /// Counted from 1 since the process started.
        number: u64,
        /// The limit.
        limit: usize,
    },
    /// A message that is not due.
    #[error("sent \"{found}\" where \"{awaited}\" was due")]
    Unexpected {
        /// Its type.
        found: &'static str,
        /// What was due.
        awaited: &'static str,
    },
    /// A pose that is none.
    #[error(transparent)]
    Pose(#[from] PoseError),
    /// The program said so itself.
    #[error("reports: {message}")]
    Reported {
        /// Its words, without control characters.
        message: String,
    },
    /// The user stopped the campaign: not a result, nothing to record.
    #[error("stopped")]
    Cancelled,
}

/// What a mission is told with that was not asked for.
const NOT_ASKED: &str = "not flown: the program had left three missions in a row unanswered";

impl Failed {
    /// The sentence, and the last line that the program wrote to stderr, where it wrote one.
    pub fn in_full(&self) -> String {
        let last = self.last_line().map_or(String::new(), |line| format!("; {line}"));
        format!("{}{last}", self.failure)
    }

    /// The last line of stderr, in a sentence's part.
    pub(super) fn last_line(&self) -> Option<String> {
        let last = self.stderr.lines().rev().map(str::trim).find(|line| !line.is_empty())?;
        Some(format!("the last line of its stderr: {}", excerpt(last, 200)))
    }
}

impl Failure {
    /// Whether the program was waited for until its time was over.
    pub(super) fn is_time_out(&self) -> bool {
        matches!(self, Self::TimeOut { .. } | Self::Astray { .. } | Self::NoReady { .. })
    }

    /// Whether a process that flew another mission before may have come out of step there: what it says is no answer to
    /// what it was asked last.
    pub(super) fn is_out_of_step(&self) -> bool {
        matches!(
            self,
            Self::After { .. }
                | Self::Unexpected { .. }
                | Self::Pose(
                    PoseError::Start { .. }
                        | PoseError::Place(_)
                        | PoseError::Time { .. }
                        | PoseError::Empty
                        | PoseError::Leg { .. }
                )
        )
    }
}

/// Whether a run that failed with this sentence was never handed to a program: to go on is to fly it.
pub fn was_never_asked(sentence: &str) -> bool {
    [NOT_ASKED, "cannot start `", "no \"ready\" within "].iter().any(|beginning| sentence.starts_with(beginning))
}

/// Room for a stranger's words in one line of a table: no control characters, at most `limit` characters.
pub(crate) fn excerpt(text: &str, limit: usize) -> String {
    let mut clean: String = text.chars().map(|c| if is_command(c) { ' ' } else { c }).take(limit).collect();
    if text.chars().nth(limit).is_some() {
        clean.push('…');
    }
    clean
}
