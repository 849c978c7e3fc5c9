//! Why there is no fit.

use thiserror::Error;

/// See the file's first line.
///
/// In the order in which they are looked for: what is fitted and whether there are logs, then each log by itself,
/// then what the robot as given does, then all logs together.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum FitError {
    /// The kind of robots, or who steers it.
    #[error("nothing to fit: {0}")]
    NotFittable(String),
    /// No logs.
    #[error("no logs to fit to")]
    NoLogs,
    /// Too little in one log.
    #[error("{log}: {found:.1} s of motion, at least {least} s are needed")]
    Short {
        /// Its name.
        log: String,
        /// s.
        found: f64,
        /// s.
        least: f64,
    },
    /// Too few samples in it.
    #[error("{log}: {found:.1} samples in a second, at least {least} are needed")]
    Sparse {
        /// Its name.
        log: String,
        /// 1/s.
        found: f64,
        /// 1/s.
        least: f64,
    },
    /// Nothing in it that is compared.
    #[error("{log}: it has no {what} is fitted by")]
    Outputs {
        /// Its name.
        log: String,
        /// What is missing, and of whom.
        what: &'static str,
    },
    /// Too little in all logs together.
    #[error(
        "{stretches} stretches of {stretch_s} s in all logs, at least {least} are needed to tell {numbers} numbers and \
         their intervals: give more logs"
    )]
    Few {
        /// As good as independent stretches.
        stretches: usize,
        /// Length of each, s.
        stretch_s: f64,
        /// Needed.
        least: usize,
        /// Numbers.
        numbers: usize,
    },
    /// It begins elsewhere.
    #[error(
        "{log} is no flight of {mission}: it begins at {begins}, {away:.2} m from waypoint 0 at {start}; {within} m at most \
         are understood, in the world's frame"
    )]
    Start {
        /// The log.
        log: String,
        /// The mission.
        mission: String,
        /// Where it begins.
        begins: String,
        /// m.
        away: f64,
        /// Where the mission begins.
        start: String,
        /// m.
        within: f64,
    },
    /// A waypoint that was not passed.
    #[error(
        "{log} is no flight of {mission}: after waypoint {} it comes no nearer to waypoint {waypoint} than {nearest:.2} m, \
         where {within:.2} m are a passage",
        waypoint - 1
    )]
    Missed {
        /// The log.
        log: String,
        /// The mission.
        mission: String,
        /// Number of the waypoint.
        waypoint: usize,
        /// m.
        nearest: f64,
        /// m.
        within: f64,
    },
    /// The robot as it is given does not fly one of the missions.
    #[error("{mission}: the robot as given does not fly it in simulation ({why}), so nothing can be compared")]
    Simulated {
        /// The mission.
        mission: String,
        /// Why.
        why: String,
    },
    /// Nothing that is adjusted acts on what was flown.
    #[error("none of the numbers acts on what was flown: the logs tell nothing of the robot")]
    NoEffect,
    /// Of what is simulated again and again too much ends early.
    #[error(
        "with numbers near to what the logs say, more than one simulation in four does not come to its end: nothing can \
         be compared"
    )]
    Unfinished,
    /// It was asked to stop.
    #[error("stopped")]
    Stopped,
}
