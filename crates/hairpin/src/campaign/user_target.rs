//! Targets of the user's own: whatever tells runs apart outside of hairpin.

use std::collections::BTreeMap;
use std::fmt;

use nalgebra::Point3;
use serde::Serialize;

use super::user_code::UserCode;
use crate::trajectory::Flight;

/// Name of the target's file in a campaign folder.
pub const NAME: &str = "target.py";

/// A run as a target of the user's sees it; the names are those that the user's function knows. One entry a stamp.
///
/// World frame; SI. `reached_s` has one entry a waypoint.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct RunFacts<'a> {
    /// Stamps.
    pub t_s: &'a [f64],
    /// Positions in the world.
    pub p_m: Vec<[f64; 3]>,
    /// Attitudes, `world_from_body`.
    pub q_wxyz: Vec<[f64; 4]>,
    /// All else that was recorded, by the names of the columns of `executions/*.parquet`.
    pub channels: BTreeMap<&'a str, &'a [f64]>,
    /// The waypoints of its mission.
    pub waypoints_m: Vec<[f64; 3]>,
    /// When each was reached; none: never.
    pub reached_s: &'a [Option<f64>],
    /// Why it ended, in the word of files.
    pub ended: &'static str,
}

impl<'a> RunFacts<'a> {
    /// What is known of `flight` over `waypoints`.
    pub(super) fn of(flight: &'a Flight, waypoints: &[Point3<f64>]) -> Self {
        let attitude = |pose: &nalgebra::Isometry3<f64>| {
            let [x, y, z, w] = pose.rotation.coords.into();
            [w, x, y, z]
        };
        let track = &flight.track;
        Self {
            t_s: track.times(),
            p_m: track.poses().iter().map(|pose| pose.translation.vector.into()).collect(),
            q_wxyz: track.poses().iter().map(attitude).collect(),
            channels: track.channels().iter().map(|channel| (channel.name.as_str(), &*channel.values)).collect(),
            waypoints_m: waypoints.iter().map(|point| point.coords.into()).collect(),
            reached_s: &flight.reached,
            ended: flight.ended.word(),
        }
    }
}

/// Measures runs. The same run must get the same number whenever it is asked for.
pub trait RunMeter: UserCode {
    /// How bad the run is, more is worse; NaN where it is not measured, and where there is
    /// [trouble](UserCode::trouble).
    fn measure(&self, run: &RunFacts) -> f64;
}

impl fmt::Debug for dyn RunMeter + '_ {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("RunMeter")
    }
}
