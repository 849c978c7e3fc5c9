//! A motion as it was executed: its track and why it ended.
//!
//! What a run says beside its track cannot be had from poses: which leg was being flown, what was reached, and what
//! ended it.

use super::Track;

/// Why a run ended.
///
/// `Done` and `Time` are ends, all others crashes to a judge. A crash is a finding about the controller, not a failure
/// of the run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ended {
    /// The last waypoint was reached, and the time judged after it is over.
    Done,
    /// The time limit came first.
    Time,
    /// Hit the ground.
    Ground,
    /// Hit an obstacle.
    Obstacle,
    /// Hit a wall (`execute.walls`).
    Wall,
    /// Turned over and could not recover.
    Tumble,
    /// Tipped over its wheels.
    TipOver,
    /// Set its underside on the ground.
    BellyContact,
    /// Came no further, or its wheels found no rest.
    Stuck,
    /// An arm that could not go on: out of reach, at a joint's bound, in a singularity.
    Halted,
    /// Had no ground below it any more: the map's edge, or cells without data.
    OffMap,
    /// An executor of the user's reported a crash without saying which.
    Crash,
}

impl Ended {
    /// The word in files: `done`, `time`, `ground`, `obstacle`, `wall`, `tumble`, `tip-over`, `belly-contact`, `stuck`,
    /// `halted`, `off-map`, `crash`.
    pub fn word(self) -> &'static str {
        match self {
            Ended::Done => "done",
            Ended::Time => "time",
            Ended::Ground => "ground",
            Ended::Obstacle => "obstacle",
            Ended::Wall => "wall",
            Ended::Tumble => "tumble",
            Ended::TipOver => "tip-over",
            Ended::BellyContact => "belly-contact",
            Ended::Stuck => "stuck",
            Ended::Halted => "halted",
            Ended::OffMap => "off-map",
            Ended::Crash => "crash",
        }
    }

    /// The reason whose word in files is `word`.
    pub fn from_word(word: &str) -> Option<Self> {
        use Ended::{BellyContact, Crash, Done, Ground, Halted, Obstacle, OffMap, Stuck, Time, TipOver, Tumble, Wall};
        [Done, Time, Ground, Obstacle, Wall, Tumble, TipOver, BellyContact, Stuck, Halted, OffMap, Crash]
            .into_iter()
            .find(|ended| ended.word() == word)
    }

    /// Whether the run ended in a crash of any kind.
    pub fn is_crash(self) -> bool {
        !matches!(self, Ended::Done | Ended::Time)
    }
}

/// One executed run. The track has the channels `leg` (number of the leg being flown, from 0), `vx_m_s`, `vy_m_s`,
/// `vz_m_s`, and, from our own simulators, `rotor1_rad_s`… and `saturated` (share of the rotors at a limit) or those of
/// `simulation::ground::drive`.
#[derive(Debug, Clone, PartialEq)]
pub struct Flight {
    /// Poses in time, world frame.
    pub track: Track,
    /// Why it ended.
    pub ended: Ended,
    /// First time outside the world's volume, s: a recorded violation, not an end.
    pub left_world: Option<f64>,
    /// Time at which each waypoint was reached, s; `None`: never. Index 0 is the start.
    pub reached: Vec<Option<f64>>,
}
