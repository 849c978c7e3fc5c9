//! Drives as C has them: states, segments, and what a search came to.

use std::ffi::c_char;

use hairpin::feasibility::steering::shooting::solve::Method;
use hairpin::trajectory::drive::{Gear, MOST_SEGMENTS, Motion, Planar, Segment, SegmentList};

use crate::refusal::{HAIRPIN_INVALID, Refused};

/// Where a vehicle is and how it bends: x forward or east, y left or north, yaw counter-clockwise from x.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct State {
    /// x, m.
    pub x_m: f64,
    /// y, m.
    pub y_m: f64,
    /// Heading, rad; equal modulo a turn.
    pub yaw_rad: f64,
    /// Curvature of the path, 1/m, left positive.
    pub curvature_1_m: f64,
}

impl State {
    pub(crate) fn planar(&self) -> Planar {
        Planar { x: self.x_m, y: self.y_m, yaw: self.yaw_rad, curvature: self.curvature_1_m }
    }
}

/// Segments of a drive at most.
pub const HAIRPIN_MOST_SEGMENTS: usize = 40;
const _: () = assert!(HAIRPIN_MOST_SEGMENTS == MOST_SEGMENTS);

/// One piece of a drive: an arc whose curvature is a polynomial of the metres driven on it, or a turn in place.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct DrivenSegment {
    /// 1 forward, -1 in reverse, 0 a turn in place.
    pub direction: i32,
    /// Metres; 0 of a turn in place.
    pub length_m: f64,
    /// Change of heading in place, rad, left positive; 0 of an arc.
    pub angle_rad: f64,
    /// a0 ... a5: curvature a0 + a1 s + ... + a5 s^5 after s metres, 1/m^(i + 1).
    pub curvature: [f64; 6],
}

/// The drive meets its goal and keeps all bounds.
pub const HAIRPIN_SOLVED: i32 = 0;
/// What was found breaks `limit` by `excess`.
pub const HAIRPIN_INFEASIBLE: i32 = 1;
/// The goal was not met.
pub const HAIRPIN_NOT_CONVERGED: i32 = 2;
/// The ground lets it go no further than `stopped_after_m`: `limit` says why.
pub const HAIRPIN_BLOCKED: i32 = 3;
/// The budget was spent first; the drive is the best so far, if there is one.
pub const HAIRPIN_BUDGET_SPENT: i32 = 4;

/// A single arc, or a chain of clothoids, in one gear.
pub const HAIRPIN_BY_ARC: i32 = 0;
/// Turn, drive, turn.
pub const HAIRPIN_BY_TURNS: i32 = 1;
/// Lines, arcs and clothoids in closed form.
pub const HAIRPIN_BY_CLOTHOIDS: i32 = 2;

/// Bytes of a limit's name, the closing NUL included.
pub const HAIRPIN_NAME: usize = 32;

/// What a question is answered with. A start that lies within the tolerances of its goal is answered with no segment.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct Drive {
    /// HAIRPIN_SOLVED, or what it lacks.
    pub status: i32,
    /// One of HAIRPIN_BY_...
    pub method: i32,
    /// Segments.
    pub count: u32,
    /// Steps in the plane, predictions on a map.
    pub iterations: u32,
    /// Looks at the map, where they are counted.
    pub looks: u64,
    /// Metres driven.
    pub length_m: f64,
    /// By how much the drive misses the goal's place, m: replayed by other equations in the plane, as predicted on a
    /// map.
    pub miss_m: f64,
    /// The same of the heading, rad.
    pub miss_yaw_rad: f64,
    /// The same of the curvature, 1/m.
    pub miss_curvature_1_m: f64,
    /// Largest angle of the body from the vertical on a map, rad.
    pub tilt_rad: f64,
    /// Metres after which a blocked drive stops.
    pub stopped_after_m: f64,
    /// What is broken, as `curvature_1_m`, `position_m`, `tilt_rad`, `map_edge`; empty where nothing is.
    pub limit: [c_char; HAIRPIN_NAME],
    /// By how much, in the unit of its name; NaN where that is no number.
    pub excess: f64,
    /// The drive, the first `count` of them.
    pub segments: [DrivenSegment; HAIRPIN_MOST_SEGMENTS],
}

impl Drive {
    /// Without a drive.
    pub(crate) fn none(status: i32) -> Self {
        let nothing = DrivenSegment { direction: 0, length_m: 0.0, angle_rad: 0.0, curvature: [0.0; 6] };
        Self {
            status,
            method: HAIRPIN_BY_ARC,
            count: 0,
            iterations: 0,
            looks: 0,
            length_m: 0.0,
            miss_m: 0.0,
            miss_yaw_rad: 0.0,
            miss_curvature_1_m: 0.0,
            tilt_rad: 0.0,
            stopped_after_m: 0.0,
            limit: [0; HAIRPIN_NAME],
            excess: 0.0,
            segments: [nothing; HAIRPIN_MOST_SEGMENTS],
        }
    }

    /// With `segments`, found by `method`.
    pub(crate) fn along(mut self, segments: &SegmentList, method: Method) -> Self {
        for (place, segment) in self.segments.iter_mut().zip(segments.iter()) {
            *place = match segment.motion {
                Motion::Arc { length_m, curvature } => {
                    let direction = if segment.gear == Gear::Forward { 1 } else { -1 };
                    DrivenSegment { direction, length_m, angle_rad: 0.0, curvature }
                }
                Motion::Turn { angle_rad } => DrivenSegment { angle_rad, ..*place },
            };
        }
        self.count = segments.len() as u32;
        self.length_m = segments.iter().map(Segment::length_m).sum::<f64>() + 0.0; // the sum of nothing is −0
        self.method = match method {
            Method::SingleArc => HAIRPIN_BY_ARC,
            Method::TurnDriveTurn => HAIRPIN_BY_TURNS,
            Method::Clothoids => HAIRPIN_BY_CLOTHOIDS,
        };
        self
    }

    /// With the limit that is broken.
    pub(crate) fn over(mut self, limit: &str, excess: Option<f64>) -> Self {
        // One place is left for the NUL.
        let letters = self.limit[..HAIRPIN_NAME - 1].iter_mut().zip(limit.bytes());
        letters.for_each(|(place, letter)| *place = letter as c_char);
        self.excess = excess.unwrap_or(f64::NAN);
        self
    }

    /// What a caller brings back.
    pub(crate) fn list(&self) -> Result<SegmentList, Refused> {
        let wrong = |i: usize, what: &str| {
            Refused::new(
                HAIRPIN_INVALID,
                format_args!("`drive.segments[{i}]` {what}: the drive is none of hairpin_steer's"),
            )
        };
        let mut list = SegmentList::EMPTY;
        let count = self.count as usize;
        let segments = self.segments.get(..count).ok_or_else(|| wrong(count, "is one too many"))?;
        for (i, segment) in segments.iter().enumerate() {
            let DrivenSegment { direction, length_m, angle_rad, curvature } = *segment;
            let finite = curvature.iter().chain([&length_m, &angle_rad]).all(|number| number.is_finite());
            if !finite || length_m < 0.0 {
                return Err(wrong(i, "is not finite or negative"));
            }
            let arc = |gear| Segment { motion: Motion::Arc { length_m, curvature }, gear };
            list.add(match direction {
                1 => arc(Gear::Forward),
                -1 => arc(Gear::Reverse),
                0 => Segment { motion: Motion::Turn { angle_rad }, gear: Gear::Forward },
                _ => return Err(wrong(i, "has another direction than 1, -1 and 0")),
            });
        }
        Ok(list)
    }
}
