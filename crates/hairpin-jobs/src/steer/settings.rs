//! What all questions to one vehicle have in common.

use std::path::PathBuf;
use std::time::Duration;

use hairpin::campaign::scenario::KeepOutSection;
use hairpin::feasibility::steering::shooting::rough::GroundCost;
use hairpin::robot::rover::Kinematics;
use hairpin_formats::terrain::Georeference;

use super::Pace;

/// What drives, where, and how drives are looked for.
#[derive(Debug, Clone, Default)]
pub struct SteerSettings {
    /// Vehicle: a shipped rover's name, such as `generic`, a robot file, or a scenario, of which the robot alone is
    /// taken.
    pub rover: String,
    /// What moves the body on the ground.
    pub kinematics: Kinematics,
    /// Speeds, and what curvature is a function of.
    pub pace: Pace,
    /// Elevation map to drive on, and what its file does not say of itself; the plane without one.
    pub terrain: Option<(PathBuf, Georeference)>,
    /// File of places to keep out of, as scenarios have them.
    pub keep_out: Option<PathBuf>,
    /// Further places to keep out of.
    pub places: Vec<KeepOutSection>,
    /// What becomes small along the drive once it meets its goal.
    pub cost: GroundCost,
    /// How exactly and how long is looked.
    pub effort: Effort,
    /// Time for each question; none gives the solver's start value.
    pub time_limit: Option<Duration>,
    /// Whether the direction of travel may change.
    pub reversals: bool,
    /// Whether the vehicle may turn in place.
    pub turns: bool,
}

/// How exactly and how long is looked for drives; what is not given is as usual.
#[derive(Debug, Clone, PartialEq)]
pub struct Effort {
    /// Difference from the goal's heading that counts as there, rad.
    pub tolerance_yaw: Option<f64>,
    /// Difference from the goal's curvature that counts as there, 1/m.
    pub tolerance_curvature: Option<f64>,
    /// Steps of each search at most.
    pub iterations: Option<u32>,
    /// Share of each step that is taken, from 0.01 to 1.
    pub step_scale: f64,
    /// File of start values of quintics and cubics, made for the vehicle.
    pub start_table: Option<PathBuf>,
}

impl Default for Effort {
    fn default() -> Self {
        let (tolerance_yaw, tolerance_curvature, iterations, start_table) = (None, None, None, None);
        Self { tolerance_yaw, tolerance_curvature, iterations, step_scale: 1.0, start_table }
    }
}
