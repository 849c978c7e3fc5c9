//! Whoever steers, for all runs of a campaign: processes, one for each run that is under way.

use std::path::PathBuf;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::time::Duration;

use hairpin::campaign::UserCode;

use crate::executor::Command;
use crate::lockstep::{Lockstep, Silence};
use crate::scenario::{driver, held};

/// So many runs in a row that were left without an answer are the end: what hangs costs three times its limit.
const MOST_LATE: usize = 3;

/// What answers.
#[derive(Debug, Clone)]
pub(crate) enum Source {
    /// A Python file; whether it finds no others beside it.
    Python {
        /// The file.
        path: PathBuf,
        /// No others beside it.
        alone: bool,
    },
    /// A program.
    Command(Command),
}

/// See the file's first line.
pub(crate) struct Steersman {
    source: Source,
    name: String,
    /// Wall-clock limit of a run.
    limit: Duration,
    /// Time between two turns, s.
    period: f64,
    /// Processes that steer nothing just now.
    idle: Mutex<Vec<Lockstep>>,
    late: AtomicUsize,
    trouble: Mutex<Option<String>>,
    stopped: AtomicBool,
}

impl Steersman {
    /// Called `name` in reports, with `period` s from turn to turn and `limit` for a run.
    pub(crate) fn new(source: Source, name: &str, period: f64, limit: Duration) -> Self {
        let (idle, late, trouble, stopped) = Default::default();
        Self { source, name: name.to_owned(), limit, period, idle, late, trouble, stopped }
    }

    pub(super) fn name(&self) -> &str {
        &self.name
    }

    pub(super) fn limit(&self) -> Duration {
        self.limit
    }

    pub(super) fn period(&self) -> f64 {
        self.period
    }

    pub(super) fn stopped(&self) -> &AtomicBool {
        &self.stopped
    }

    /// Whether it is told the waypoints once a run; a program is told them every time.
    pub(super) fn remembers(&self) -> bool {
        matches!(self.source, Source::Python { .. })
    }

    /// A process for a run.
    ///
    /// # Errors
    /// Why there is none.
    pub(super) fn process(&self) -> Result<Lockstep, String> {
        if let Some(trouble) = self.trouble() {
            return Err(trouble);
        }
        match held(&self.idle).pop() {
            Some(process) => Ok(process),
            None => self.start(),
        }
    }

    /// Takes one back whose run has ended.
    pub(super) fn give_back(&self, process: Lockstep) {
        self.late.store(0, Ordering::Relaxed);
        held(&self.idle).push(process);
    }

    /// Why `process`, which goes, did not answer.
    pub(super) fn complaint(&self, process: &Lockstep, why: Silence) -> String {
        let seconds = self.limit.as_secs_f64();
        match why {
            Silence::Stopped => "stopped".into(),
            Silence::Endless => "it answered a line that does not end".into(),
            Silence::Gone => match process.last_words() {
                last if last.is_empty() => "it ended without an answer".into(),
                last => last,
            },
            Silence::Late => {
                if self.late.fetch_add(1, Ordering::Relaxed) + 1 >= MOST_LATE {
                    let why = format!("it left {MOST_LATE} runs in a row unfinished (execute.timeout_s = {seconds})");
                    held(&self.trouble).get_or_insert(why);
                }
                format!("its run was not over after {seconds} s on the clock (execute.timeout_s)")
            }
        }
    }

    fn start(&self) -> Result<Lockstep, String> {
        let (mut command, program) = match &self.source {
            Source::Python { path, alone } => (driver(path, *alone, "controller"), "python3".to_owned()),
            Source::Command(command) => (command.into(), command.words().next().unwrap_or_default().to_owned()),
        };
        let mut process = Lockstep::start(&mut command).map_err(|error| {
            let why = format!("`{program}` cannot be started: {error}");
            held(&self.trouble).get_or_insert(why.clone());
            why
        })?;
        if self.remembers() {
            match process.hear(&self.stopped, None) {
                Ok(line) if line == b"ready" => {}
                Ok(_) => return Err(self.complaint(&process, Silence::Gone)),
                Err(why) => return Err(self.complaint(&process, why)),
            }
        }
        Ok(process)
    }
}

impl UserCode for Steersman {
    fn trouble(&self) -> Option<String> {
        held(&self.trouble).clone()
    }

    fn try_out(&self) -> Result<(), String> {
        let process = self.process().map_err(|why| format!("{}: {why}", self.name))?;
        held(&self.idle).push(process);
        Ok(())
    }

    fn stop(&self) {
        self.stopped.store(true, Ordering::Relaxed);
    }
}
