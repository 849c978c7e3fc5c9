//! What logs are judged against, and how.

use std::path::PathBuf;

use super::frame::FrameSettings;
use crate::Problem;
use crate::sets::Set;

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

    /// Nothing, where logs are an arm's.
    ///
    /// # Errors
    /// What is asked of logs that say nothing of an arm's frame.
    pub(super) fn of_an_arm(&self) -> Result<(), Problem> {
        let named = self.frame.turn_deg != 0.0 || self.frame.offset_m != [0.0; 3];
        let (world, frames) = (self.world.is_some(), "an arm's log is in its base's frame");
        for (asked, what) in [(world, "--world: what an arm must not meet is its cell's"), (named, frames)] {
            if asked {
                return Err(Problem::input(format!("{what}; leave --world, --turn and --offset out")));
            }
        }
        Ok(())
    }
}
