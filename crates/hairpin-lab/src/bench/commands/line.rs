//! A command line as it is typed, run as a process of this binary.

use std::fs::{self, File};
use std::path::Path;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::time::{Duration, Instant};
use std::{io, thread};

use hairpin_jobs::{Problem, Watch};
use serde_json::Value;

use super::size::Size;
use crate::clock::children_time;
use crate::memory::resident_of;

/// Between two looks at the memory of a process. The system keeps its peak, so that only what comes after the last look
/// is missed.
const LOOK: Duration = Duration::from_millis(5);
/// Exit codes of commands that did what they were asked: within spec, a violation, inconclusive.
const ANSWERS: [i32; 3] = [0, 1, 5];
/// Where a process writes what it says.
const SAID: [&str; 2] = ["said.json", "complaints.txt"];

/// What is typed.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Line {
    /// From `hairpin` on, its words separated by blanks.
    pub(super) typed: String,
    /// What it makes, which is removed before it runs.
    pub(super) makes: Option<&'static str>,
    /// Whether its memory is looked at.
    pub(super) looked_at: bool,
}

/// What running it took, and what came of it.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Measured {
    /// User and system time of the process; wall-clock time where the system does not tell.
    pub(super) cpu_s: f64,
    pub(super) wall_s: f64,
    /// Peak of its resident memory.
    pub(super) peak_mb: Option<f64>,
    /// Of what it makes.
    pub(super) size: Option<Size>,
    pub(super) exit_code: i32,
    /// The object that it says; null where it says none.
    pub(super) told: Value,
}

impl Line {
    pub(super) fn new(typed: impl Into<String>) -> Self {
        Self { typed: typed.into(), makes: None, looked_at: false }
    }

    /// That makes the file or folder `what`.
    pub(super) fn making(self, what: &'static str) -> Self {
        Self { makes: Some(what), ..self }
    }

    /// Whose memory is looked at.
    pub(super) fn looked_at(self) -> Self {
        Self { looked_at: true, ..self }
    }

    pub(super) fn words(&self) -> impl Iterator<Item = &str> {
        self.typed.split_whitespace()
    }

    /// Runs it in `folder`, to its end.
    ///
    /// # Errors
    /// It cannot be started, or ends as no command does that did what it was asked; `watch` was stopped meanwhile.
    pub(super) fn run(&self, folder: &Path, watch: &dyn Watch) -> Result<Measured, Problem> {
        let made = self.makes.map(|made| folder.join(made));
        made.as_deref().map_or(Ok(()), remove).map_err(Problem::input)?;
        let said = SAID.map(|name| folder.join(name));
        let mut command = self.command(folder, &said.each_ref().map(|path| path.as_path())).map_err(Problem::input)?;
        let (before, begun) = (children_time(), Instant::now());
        let mut child = command.spawn().map_err(Problem::input)?;
        let (status, peak_mb) = self.wait(&mut child).map_err(Problem::input)?;
        let wall_s = begun.elapsed().as_secs_f64();
        let cpu_s = before.zip(children_time()).map_or(wall_s, |(before, after)| after - before);
        if watch.stopped() {
            return Err(Problem::Interrupted("interrupted: what was measured is not told".into()));
        }
        let [told, complaints] = said.map(|path| fs::read_to_string(path).unwrap_or_default());
        let Some(exit_code) = status.code().filter(|code| ANSWERS.contains(code)) else {
            let why = complaints.lines().last().unwrap_or_default();
            return Err(Problem::input(format!("`{}` ended with {status}: {why}", self.typed)));
        };
        let size = made.map(|made| Size::of(&made)).transpose().map_err(Problem::input)?;
        let told = serde_json::from_str(&told).unwrap_or_default();
        Ok(Measured { cpu_s, wall_s, peak_mb, size, exit_code, told })
    }

    fn command(&self, folder: &Path, [told, complaints]: &[&Path; 2]) -> io::Result<Command> {
        let mut command = Command::new(std::env::current_exe()?);
        command.args(self.words().skip(1)).current_dir(folder).stdin(Stdio::null());
        // Files, not pipes: nobody has to read while it runs.
        command.stdout(File::create(told)?).stderr(File::create(complaints)?);
        Ok(command)
    }

    /// How it ended, and its memory's peak in MB where that is looked at.
    fn wait(&self, child: &mut Child) -> io::Result<(ExitStatus, Option<f64>)> {
        if !self.looked_at {
            return Ok((child.wait()?, None));
        }
        let process = child.id().to_string();
        let mut peak = f64::NAN;
        loop {
            peak = peak.max(resident_of(&process, "VmHWM:"));
            if let Some(status) = child.try_wait()? {
                return Ok((status, Some(peak)));
            }
            thread::sleep(LOOK);
        }
    }
}

fn remove(made: &Path) -> io::Result<()> {
    let gone = if made.is_dir() { fs::remove_dir_all(made) } else { fs::remove_file(made) };
    gone.or_else(|error| if error.kind() == io::ErrorKind::NotFound { Ok(()) } else { Err(error) })
}
