//! What logs are judged against, and how.

use std::path::PathBuf;

use super::frame::FrameSettings;
use crate::Problem;
use crate::sets::Set;

/// No robot is farther from where it began, m.
const FARTHEST_M: f64 = 1e7;
/// No stamp of a log is later, s: thirty thousand years after 1970.
const LATEST_S: f64 = 1e12;
/// Nobody turns a log by more, °.
const MOST_DEG: f64 = 1e6;

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
    /// Where a page goes with what was planned, simulated and flown.
    pub page: Option<PathBuf>,
}

impl LogSettings {
    /// The log or folder `path` as it is, against `against`.
    pub fn new(path: PathBuf, against: Against) -> Self {
        Self {
            path,
            against,
            world: None,
            sets: Vec::new(),
            case: None,
            frame: FrameSettings::default(),
            source: None,
            from_s: None,
            to_s: None,
            page: None,
        }
    }

    /// Nothing, where all numbers are such as logs have.
    ///
    /// # Errors
    /// One that no log has.
    pub(super) fn in_bounds(&self) -> Result<(), Problem> {
        let offsets = self.frame.offset_m.map(|m| ("--offset", m, FARTHEST_M, "m"));
        let times = [("--from", self.from_s), ("--to", self.to_s)];
        let times = times.into_iter().filter_map(|(flag, s)| Some((flag, s?, LATEST_S, "s")));
        let turn = ("--turn", self.frame.turn_deg, MOST_DEG, "°");
        for (flag, value, most, unit) in offsets.into_iter().chain(times).chain([turn]) {
            // Written out, a number of 300 digits says nothing.
            if value.is_nan() || value.abs() > most {
                return Err(Problem::input(format!("{flag} {value:e}: must be within {most:e} {unit} either way")));
            }
        }
        Ok(())
    }

    /// Nothing, where logs are an arm's.
    ///
    /// # Errors
    /// What is asked of logs that say nothing of an arm's frame.
    pub(super) fn of_an_arm(&self) -> Result<(), Problem> {
        let named = self.frame != FrameSettings::default();
        let (world, frames) = (self.world.is_some(), "an arm's log is in its base's frame");
        for (asked, what) in [(world, "--world: what an arm must not meet is its cell's"), (named, frames)] {
            if asked {
                return Err(Problem::input(format!("{what}; leave --world, --turn, --offset and --altitude out")));
            }
        }
        Ok(())
    }
}
