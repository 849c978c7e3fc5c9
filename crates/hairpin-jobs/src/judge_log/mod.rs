//! The verdict on logs of robots that really moved: each against the mission that it flew. Nothing is aligned, neither
//! in space nor in time: what is done to a log's frame its user names, and what is not done is told.
//!
//! ```text
//! file ─ logs::read ─▶ Logged ─ source, frame ─▶ samples in the world's frame ─ matching ─▶ case
//!        ─ span, legs, cut ─▶ Log ─ campaign::judge_flown ─▶ Flown ─ told ─▶ one sentence
//! ```

mod against;
mod cut;
mod frame;
mod legs;
mod matching;
mod one;
mod remedy;
mod source;
mod told;

#[cfg(test)]
mod tests;

use std::path::{Path, PathBuf};

use hairpin::campaign::Flown;
use hairpin::judgement::Verdict;

use crate::sets::Set;
use crate::{Problem, Watch};

pub use cut::Cut;
pub use frame::{Altitude, FrameSettings, FrameTold};
pub use legs::LegsBy;
pub use matching::Matched;
pub use source::SourceTold;

/// What a log is judged against.
#[derive(Debug, Clone)]
pub enum Against {
    /// The cases of a campaign's folder.
    Campaign(PathBuf),
    /// A file of waypoints, and the robot that flew it, where the world's file does not say.
    Mission {
        /// The file.
        file: PathBuf,
        /// A robot's name or file.
        robot: Option<String>,
    },
}

/// How logs are judged.
#[derive(Debug, Clone)]
pub struct LogSettings {
    /// A log, or a folder of them.
    pub path: PathBuf,
    /// What it is judged against.
    pub against: Against,
    /// A scenario or a file with a world: its obstacles and bounds in the place of the campaign's.
    pub world: Option<String>,
    /// Keys of `spec` with other values.
    pub sets: Vec<Set>,
    /// The case that was flown, where nobody has to find it out.
    pub case: Option<String>,
    /// What is done to the log's frame.
    pub frame: FrameSettings,
    /// The topic that poses are from; else the best.
    pub source: Option<String>,
    /// From when on it is judged, in the log's own time, s.
    pub from_s: Option<f64>,
    /// Until when, s.
    pub to_s: Option<f64>,
}

/// What a log is told to have come to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outcome {
    /// Within spec.
    Pass,
    /// A violation.
    Fail,
    /// Open.
    Inconclusive,
    /// Its data allow no judgement.
    Invalid,
    /// Nothing was asked for.
    Unjudged,
}

impl Outcome {
    /// The word in JSON.
    pub fn word(self) -> &'static str {
        match self {
            Self::Pass => "pass",
            Self::Fail => "fail",
            Self::Inconclusive => "inconclusive",
            Self::Invalid => "invalid",
            Self::Unjudged => "unjudged",
        }
    }
}

/// A log and what it came to.
#[derive(Debug)]
pub struct JudgedLog {
    /// The file.
    pub file: PathBuf,
    /// Its sentence.
    pub verdict: Verdict,
    /// Its word.
    pub outcome: Outcome,
    /// What it was found to be; `None` where it could not be read or was refused.
    pub found: Option<Found>,
}

/// What a log was found to be.
#[derive(Debug)]
pub struct Found {
    /// The case, or the mission's name.
    pub case: String,
    /// How that was found out.
    pub matched: Option<Matched>,
    /// Where its poses and times are from.
    pub source: SourceTold,
    /// Its frame, and what was done to it.
    pub frame: FrameTold,
    /// First and last moment that is judged, s of the log; `None` where nothing is.
    pub span_s: Option<[f64; 2]>,
    /// Who tells the leg.
    pub legs_by: LegsBy,
    /// What was cut out, in the order of time.
    pub cuts: Vec<Cut>,
    /// What ended the judged part, in words; `None`: the end of the log.
    pub ended: Option<String>,
    /// Whether the last waypoint was reached.
    pub finished: bool,
    /// What it was measured to be; `None` where nothing is left to measure.
    pub flown: Option<Flown>,
    /// The largest deviation of the same case in simulation, m, where that was judged.
    pub simulated_m: Option<f64>,
    /// What else its reader should know.
    pub notes: Vec<String>,
}

/// Logs and what they came to.
#[derive(Debug)]
pub struct JudgedLogs {
    /// One a file, in the order of their names.
    pub logs: Vec<JudgedLog>,
    /// The line with counts, of a folder.
    pub count: Option<Verdict>,
}

impl JudgedLogs {
    /// Of all logs: a violation comes first, then what is open.
    pub fn exit_code(&self) -> u8 {
        self.count.as_ref().or(self.logs.first().map(|log| &log.verdict)).map_or(0, |verdict| verdict.exit_code)
    }
}

/// Judges a log, or all that are in a folder. In a folder one that cannot be judged is told, and the others are judged.
///
/// # Errors
/// A campaign, mission, world or robot that cannot be read; keys of other tables than `spec`; a mission nothing is
/// asked of; a single log that cannot be read, fits no case, or does not lie where its mission begins; a folder without
/// a file.
pub fn judge_log(settings: &LogSettings, watch: &dyn Watch) -> Result<JudgedLogs, Problem> {
    if settings.path.join("scenario.toml").is_file() {
        return Err(Problem::of_file(
            &settings.path,
            "a campaign's folder, whose own flights `hairpin judge` judges without --campaign and --mission; logs lie in \
             another",
        ));
    }
    let against = against::Ready::of(settings)?;
    against.notes.iter().for_each(|note| watch.warn(note));
    if !settings.path.is_dir() {
        return Ok(JudgedLogs { logs: vec![one::judge_file(&settings.path, &against, settings)?], count: None });
    }
    let mut logs = Vec::new();
    for file in files_in(&settings.path)? {
        if watch.stopped() {
            return Err(Problem::Interrupted(format!("stopped after {} logs", logs.len())));
        }
        logs.push(match one::judge_file(&file, &against, settings) {
            Ok(judged) => judged,
            Err(problem) => told::unreadable(&file, &problem),
        });
    }
    let count = told::count(&settings.path, &logs);
    Ok(JudgedLogs { logs, count: Some(count) })
}

/// Endings of what lies beside logs and is none.
const NO_LOGS: &[&str] =
    &["md", "json", "toml", "html", "xml", "plan", "waypoints", "params", "png", "svg", "pdf", "zip"];

/// The files of a folder, but for hidden ones and what is no log by its ending.
fn files_in(folder: &Path) -> Result<Vec<PathBuf>, Problem> {
    let refuse = |cause| Problem::of_file(folder, cause);
    let entries = std::fs::read_dir(folder).map_err(refuse)?;
    let paths = entries.map(|entry| entry.map(|e| e.path())).collect::<Result<Vec<_>, _>>().map_err(refuse)?;
    let is_log = |path: &PathBuf| {
        let part = |part: Option<&std::ffi::OsStr>| part.unwrap_or_default().to_string_lossy().to_lowercase();
        let (name, ending) = (part(path.file_name()), part(path.extension()));
        path.is_file() && !name.starts_with('.') && !NO_LOGS.contains(&ending.as_str())
    };
    let mut logs: Vec<PathBuf> = paths.into_iter().filter(is_log).collect();
    logs.sort();
    if logs.is_empty() {
        return Err(Problem::of_file(folder, "no log in it"));
    }
    Ok(logs)
}
