//! What is said of a robot, its world and its runs, and what runs are measured against.
//!
//! Words are parts of sentences, in lower case and without a full stop, unless they are said to be sentences. Nothing
//! here computes a verdict.

use std::borrow::Cow;

use nalgebra::Point3;
use serde::Serialize;
use serde_json::Value;

use super::{Axis, Drawing, Footing, Programs, Returning, Room};
use crate::campaign::{Case, Tally};
use crate::judgement::{Clearance, Swiftness};
use crate::robot::battery::Battery;
use crate::trajectory::{Flight, Track};

/// The robot in words.
///
/// Borrowed from the setup; put together by the report, the verdict and the assumptions.
#[derive(Debug, Clone)]
pub(in crate::campaign) struct RobotWords<'a> {
    /// Its name.
    pub(in crate::campaign) name: &'a str,
    /// What must be said wherever it is named; empty if nothing.
    pub(in crate::campaign) caveat: &'a str,
    /// Names of its numbers that were derived, not given.
    pub(in crate::campaign) estimated: Vec<&'a str>,
    /// Whether its attitude has a front and a left side that people know.
    pub(in crate::campaign) has_sides: bool,
    /// What of its shape or stand a claim rests on that is not known, or leaves out, in a few words of the verdict.
    pub(in crate::campaign) unknown_shapes: Option<Cow<'static, str>>,
    /// What of ours carries out what a stranger's controller asks for.
    pub(in crate::campaign) loops: Option<&'static str>,
    /// How long it goes on a charge, where its file says so.
    pub(in crate::campaign) battery: Option<Battery>,
}

/// "Assumptions and limits of this run", by what they are about.
///
/// Each entry is a whole sentence; empty lists are left out of the report.
#[derive(Debug, Clone, Default)]
pub(in crate::campaign) struct Assumptions {
    /// What stands behind the plans.
    pub(in crate::campaign) claim: Vec<String>,
    /// How they were found, where that is not how graphs are usually searched.
    pub(in crate::campaign) search: Option<Vec<String>>,
    /// What was searched beside the waypoints.
    pub(in crate::campaign) beside: Option<String>,
    /// Who carried them out.
    pub(in crate::campaign) act: Vec<String>,
    /// What deviation is.
    pub(in crate::campaign) verdict: Vec<String>,
}

/// How a campaign was set up, in the words of its report.
///
/// Each a sentence's part, with numbers in the units that people use.
#[derive(Debug, Clone)]
pub(in crate::campaign) struct Facts {
    /// The world.
    pub(in crate::campaign) world: String,
    /// The task.
    pub(in crate::campaign) task: String,
    /// The search, where it is not one of graphs by a method.
    pub(in crate::campaign) search: Option<String>,
    /// What the word of the reach set is the answer to.
    pub(in crate::campaign) proven: &'static str,
    /// What is not there where nothing is feasible: `no chain of 10 waypoints from start to end`.
    pub(in crate::campaign) nothing: String,
}

/// What places are relative to, in words.
///
/// Kinds differ in what has an origin: a cage, a map, an arm's base, a harbour chart.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FrameWords {
    /// What positions and z are relative to: `cage origin`, `map origin`, `arm's base`.
    pub relative_to: &'static str,
    /// What has that origin: `cage`, `map`.
    pub world: &'static str,
    /// Where its axes point if it is not placed on Earth.
    pub axes: &'static str,
    /// All that there is to say, where it cannot be placed on Earth.
    pub nowhere: Option<&'static str>,
}

/// What an executor of the user's is handed, and how its answer is read.
///
/// Robot, world and limits as executors are told them, in SI units.
#[derive(Debug, Clone, PartialEq)]
pub struct Handed {
    /// The robot's numbers: a table of the scenario.
    pub robot: Value,
    /// Its world: a table of the scenario.
    pub world: Value,
    /// Steady force on it, east, north, up, N, where there is one.
    pub external_force: Option<[f64; 3]>,
    /// What plans keep to beside the robot's own limits: `generate.limits`, the keys that are in force.
    pub limits: Value,
    /// What places are relative to.
    pub frame: FrameWords,
    /// The first waypoint, world frame, m.
    pub start: Point3<f64>,
    /// How far from the origin a place may be, m: beyond is another unit or a slip.
    /// An answer with a position beyond is refused rather than judged.
    pub farthest: f64,
}

/// Where a waypoint counts as reached, `accept` (m) being the radius, in a sentence; a program of the user's, which has
/// the cylinder from protocol 2 on, does with it what it wants.
pub(in crate::campaign) fn reached_within(accept: f64, by_command: bool) -> String {
    let more =
        if by_command { "; of programs that speak protocol 2 within as much from above and in height" } else { "" };
    format!("A waypoint counts as reached within {accept} m{more}.")
}

/// Calls its last argument with the values, one an axis, of whatever a run over waypoints met.
///
/// Values are in the order of [`Motion::axes`], one call for each sample that counts.
pub(in crate::campaign) type Meet<'a> = Box<dyn Fn(&[Point3<f64>], &Flight, &mut dyn FnMut(&[f64])) + 'a>;

/// How motion is counted.
///
/// The grid of coverage: which speeds, turns, climbs or joints runs came to.
pub(in crate::campaign) struct Motion<'a> {
    /// Axes of a grid.
    pub(in crate::campaign) axes: Vec<Axis>,
    /// What of them is met.
    pub(in crate::campaign) meet: Meet<'a>,
}

/// What is told, and what is measured.
pub(in crate::campaign) trait Say {
    /// The robot.
    fn robot_words(&self) -> RobotWords<'_>;

    /// What claim, execution and limits rest on.
    ///
    /// Made of the run's own settings and numbers: what did not happen is not said.
    fn assumptions(&self, cases: &[Case], tally: &Tally) -> Assumptions;

    /// How the campaign was set up.
    fn facts(&self) -> Facts;

    /// What executors are handed.
    fn handed(&self) -> Handed;

    /// Which legs of `track`, a motion over the mission of `case`, were gone backwards, in words; `None` where none
    /// was, and of what has no back.
    fn backwards(&self, _case: &Case, _track: &Track) -> Option<String> {
        None
    }

    /// Whether a place lies where the robot cannot be: outside of its world.
    ///
    /// `place` in m, world frame; the origin of the robot, without its radius.
    fn is_outside(&self, place: &Point3<f64>) -> bool;

    /// Distance (m) of `place` from the nearest one that is outside, for what may hide between the samples of a log;
    /// +∞ where the world has no end.
    ///
    /// Signed: below 0 outside. Exact up to `within` m, and never less than that beyond. Changes by no more than the
    /// way that the robot moves.
    fn edge_distance(&self, _place: &Point3<f64>, _within: f64) -> f64 {
        f64::INFINITY
    }

    /// What stands around `places`; what only a case's environment has is last of its obstacles.
    fn drawing(&self, places: &[Point3<f64>]) -> Drawing;

    /// The plan of `case` with what the robot is posed by where it is drawn, if places and attitudes are not enough.
    fn posed(&self, _: &Case, planned: Track) -> Track {
        planned
    }

    /// How its motion is counted.
    fn motion(&self) -> Motion<'_>;

    /// Distance (m) of the robot, a ball or a disc about its origin, from what it must not meet; `None` where there is
    /// nothing.
    ///
    /// Signed: below 0 inside. Changes by no more than the way that the robot moves (Lipschitz with constant 1), on
    /// which bounds between samples rest.
    fn clearance(&self) -> Option<Box<Clearance<'_>>>;

    /// How fast it can be and become, for what may hide between the samples of a log; nothing where nothing bounds it.
    ///
    /// Top speed, m/s, and acceleration, m/s²; bounds of the model, not of a run.
    fn swiftness(&self) -> Swiftness {
        Swiftness::default()
    }

    /// A mean speed, m/s, over `span` s that no robot of its file comes to, by a factor of [`BEYOND`] in what the file
    /// says and with any wind or current besides; `None` where the file bounds nothing.
    fn ceiling(&self, _span: f64) -> Option<f64> {
        None
    }

    /// Angle of its up axis from the vertical beyond which the vehicle has fallen over, rad, where its file says one.
    fn most_tilt(&self) -> Option<f64> {
        None
    }

    /// Where its vehicle may be; `None` of what is none.
    fn room(&self) -> Option<Room> {
        None
    }

    /// The height (m, world frame) at which an autopilot that flies it may come home from anywhere on a mission, or why
    /// there is none; `None` of what does not fly.
    fn homeward(&self, _: &Returning) -> Option<Result<f64, &'static str>> {
        None
    }

    /// What stands under it; `None` of what does not drive.
    fn footing(&self) -> Option<&dyn Footing> {
        None
    }

    /// What it has where its motion is a program.
    fn programs(&self) -> Option<&dyn Programs> {
        None
    }
}

/// So many times what a robot's file says is beyond any robot of it.
pub(in crate::campaign) const BEYOND: f64 = 10.0;

/// A key's word, as it stands in scenario files.
///
/// The serialised name of a unit variant; empty of anything that is not written as a string.
pub(in crate::campaign) fn word(value: &impl Serialize) -> String {
    serde_json::to_value(value).ok().and_then(|value| value.as_str().map(str::to_owned)).unwrap_or_default()
}
