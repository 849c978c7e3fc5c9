//! What logs were found to be, and what they came to.

use std::path::PathBuf;

use hairpin::campaign::missed::Missed;
use hairpin::campaign::{Flown, Status};
use hairpin::judgement::Verdict;

use super::arm::FoundProgram;
use super::cut::Cut;
use super::frame::FrameTold;
use super::left_out::LeftOut;
use super::legs::LegsBy;
use super::matching::Matched;
use super::sheet::Sheet;
use super::source::SourceTold;

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
    /// The status of a case that came to the same.
    pub(super) fn status(self) -> Status {
        match self {
            Self::Pass => Status::Pass,
            Self::Fail => Status::Fail,
            Self::Inconclusive | Self::Invalid => Status::Inconclusive,
            Self::Unjudged => Status::Unjudged,
        }
    }

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
    /// What it is called: the file's name, of a folder's its path in that.
    pub name: String,
    /// Its sentence.
    pub verdict: Verdict,
    /// Its word.
    pub outcome: Outcome,
    /// What it was found to be; `None` where it could not be read or was refused, and of arms.
    pub found: Option<Found>,
    /// The same of an arm's.
    pub program: Option<FoundProgram>,
    /// What its page has of it, where one was asked for.
    pub sheet: Option<Box<Sheet>>,
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
    /// Whether the whole mission was flown: every waypoint reached, in order, up to the last.
    pub finished: bool,
    /// Whether it was flown to its last waypoint, wherever the judged part begins.
    pub to_the_end: bool,
    /// The legs before the judged part, where the log's mission state tells of any.
    pub left_out: Option<LeftOut>,
    /// The first waypoint that was not; where an autopilot itself tells which it flew to, the first that it says it was
    /// at and was nowhere near.
    pub missed: Option<Missed>,
    /// When the mission is flown once more, which is not judged, s; `None` where a part was asked for.
    pub again_s: Option<f64>,
    /// The log's modes, where it tells them and none of them flies a mission: nothing of it is judged then.
    pub never_began: Option<String>,
    /// What it was measured to be; `None` where nothing is left to measure.
    pub flown: Option<Flown>,
    /// What its mission asks that it says nothing of, in words.
    pub asked: Option<String>,
    /// The largest deviation of the same case in simulation, m, where that was judged; of a log whose legs are assigned
    /// with its legs assigned as well, where its motion is to be had.
    pub simulated_m: Option<f64>,
    /// What else its reader should know.
    pub notes: Vec<String>,
}

/// Logs and what they came to.
#[derive(Debug)]
pub struct JudgedLogs {
    /// One a file, in the order of their paths in the folder, name by name.
    pub logs: Vec<JudgedLog>,
    /// The line with counts, of a folder.
    pub count: Option<Verdict>,
    /// Of a folder: files that by their names are no recordings but what was planned, and folders of campaigns.
    pub left_out: Vec<PathBuf>,
    /// Of a folder: files that are one recording, byte by byte, under several names.
    pub copies: Vec<Vec<PathBuf>>,
}

impl JudgedLog {
    /// What stands behind it: `hardware` of an arm, else `flown`.
    pub fn evidence(&self) -> &'static str {
        if self.program.is_some() { "hardware" } else { "flown" }
    }
}

impl JudgedLogs {
    /// Of all logs: a violation comes first, then what is open.
    pub fn exit_code(&self) -> u8 {
        self.count.as_ref().or(self.logs.first().map(|log| &log.verdict)).map_or(0, |verdict| verdict.exit_code)
    }
}
