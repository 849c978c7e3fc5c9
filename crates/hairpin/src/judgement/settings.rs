//! How a track is judged, and why it cannot be.

use nalgebra::Point3;
use thiserror::Error;

use super::resolution::Resolution;
use crate::trajectory::Track;

/// What the deviation is the distance from.
///
/// `Leg` is the paper's (Hildebrandt et al., ISSTA 2020); `NearestLeg` spares controllers that advance early or late;
/// `Path` is for motions whose corners were programmed round.
#[derive(Debug, Clone, Copy, Default)]
pub enum Reference<'a> {
    /// The segment of the leg being flown.
    #[default]
    Leg,
    /// The nearest of the previous and the current leg's segments.
    NearestLeg,
    /// A programmed path: the line through the track's positions, straight between them or as the track has it.
    Path(&'a Track),
}

/// Signed distance of a position to the nearest obstacle, m, the robot's radius subtracted; +∞: none.
///
/// The same function that claims and plants ask (`world`), or one over obstacles that were not there when it was flown.
pub type Clearance<'a> = dyn Fn(&Point3<f64>) -> f64 + Sync + 'a;

/// How a track is judged.
///
/// The default judges every sample against its leg.
#[derive(Clone, Copy, Default)]
pub struct Settings<'a> {
    /// What the deviation is the distance from.
    pub reference: Reference<'a>,
    /// Samples within this distance (m) of one of the two waypoints of the leg being flown do not count in the
    /// deviation: there overshoot judges. Not used with [`Reference::Path`], which says itself how corners are flown.
    pub corner: f64,
    /// Distance to obstacles; without it clearance is not measured.
    pub clearance: Option<&'a Clearance<'a>>,
    /// The steps in which the recording tells its numbers: what they can make of an acceleration is part of it.
    pub resolution: Resolution,
    /// Samples, rising, before which the recording has a gap or a jump: nothing is differenced across one, and no time
    /// of it counts. The first sample is none.
    pub breaks: &'a [usize],
}

impl Settings<'_> {
    /// The samples before and after sample `index` of the `len` that a track has, itself where there is none or a break
    /// lies between.
    pub(super) fn neighbours(&self, index: usize, len: usize) -> (usize, usize) {
        let begins = |sample: usize| sample == 0 || self.breaks.binary_search(&sample).is_ok();
        let before = if begins(index) { index } else { index - 1 };
        let after = if index + 1 >= len || begins(index + 1) { index } else { index + 1 };
        (before, after)
    }
}

/// Why a track cannot be judged.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum JudgementError {
    /// No sample.
    #[error("the track has no sample")]
    NoSamples,
    /// A leg needs two waypoints.
    #[error("{found} waypoints: must be at least 2")]
    Waypoints {
        /// How many there are.
        found: usize,
    },
    /// A programmed path without a segment.
    #[error("the programmed path has {found} positions: must be at least 2")]
    Path {
        /// How many there are.
        found: usize,
    },
    /// A number that is not finite.
    #[error("{field} = {value}: must be finite{bound}")]
    NotFinite {
        /// `waypoints[3]`, `corner_m`.
        field: String,
        /// As given.
        value: String,
        /// What else it must be.
        bound: &'static str,
    },
    /// A distance to obstacles that is none.
    #[error("clearance = NaN at sample {index}: must be a distance, +∞ where there is no obstacle")]
    Clearance {
        /// Sample.
        index: usize,
    },
    /// What is measured is larger than numbers are.
    #[error("{what} = {value}: must be finite; the samples are too far apart for it, or follow too soon on each other")]
    Overflow {
        /// `max_acceleration_m_s2`.
        what: &'static str,
        /// What came out.
        value: f64,
    },
    /// The executor told of a leg that there is not.
    #[error("leg = {value} at sample {index}: must be a whole number from 0 to {last}")]
    Leg {
        /// Sample.
        index: usize,
        /// Value of the channel `leg`.
        value: f64,
        /// Number of the last leg.
        last: usize,
    },
}
