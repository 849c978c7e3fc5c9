//! What a vehicle does until the first command acts.
//!
//! With a latency of t seconds commands act t later than they are given. A vehicle under way drives v t metres
//! meanwhile, by the wheels it had; so the problem begins there, and what is commanded at last is held for as long.

use super::course::Course;
use super::outcome::Blocked;
use super::predict::predict;
use crate::trajectory::drive::{Gear, Motion, Planar, Segment, SegmentList};
use crate::world::terrain::Terrain;

/// How a vehicle whose commands act late waits for the first.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Waiting {
    /// It is under way: it goes on forward as it was.
    GoesOn,
    /// It stands before a drive that begins in reverse or with a turn in place, as it does at every change between
    /// them.
    Stands,
}

impl Waiting {
    /// How it waits for the first of `segments`.
    pub fn before(segments: &[Segment]) -> Self {
        let goes_on = segments
            .first()
            .is_none_or(|first| first.gear == Gear::Forward && matches!(first.motion, Motion::Arc { .. }));
        if goes_on { Self::GoesOn } else { Self::Stands }
    }

    /// Where the first command finds the vehicle that is at `start` when it is given.
    ///
    /// At the speed with which the profile begins, the steering and the direction of travel held as they are at the
    /// start. Without latency or from rest, `start` itself.
    ///
    /// # Errors
    /// [`Blocked`] on the way there.
    pub fn over<T: Terrain>(self, course: &Course<'_, T>, start: &Planar) -> Result<Planar, Blocked> {
        let metres = self.metres(course, course.speed.start());
        if metres == 0.0 {
            return Ok(*start);
        }
        let waiting =
            Course { speed: course.speed.start().into(), direction: course.direction.start.into(), ..*course };
        let hold = Segment::clothoid(metres, start.curvature, start.curvature, Gear::Forward);
        let waited = predict(&waiting, start, &[hold], |_| {})?;
        // Held as long, the steering stands where it stood.
        Ok(Planar { curvature: start.curvature, ..waited.end })
    }

    /// Metres driven meanwhile at `speed`.
    ///
    /// latency · speed; 0 for a vehicle that stands.
    fn metres<T>(self, course: &Course<'_, T>, speed: f64) -> f64 {
        match self {
            Self::GoesOn => course.rover.response.latency * speed,
            Self::Stands => 0.0,
        }
    }

    /// What of `segments`, a solver's own, acts before their time is over.
    ///
    /// Cut at the end by the metres that the latency takes at the final speed; turns in place before that are kept.
    pub fn acting<T>(self, course: &Course<'_, T>, segments: &SegmentList) -> SegmentList {
        let total: f64 = segments.iter().map(Segment::length_m).sum();
        let mut left = total - self.metres(course, course.speed.end());
        let mut acting = SegmentList::EMPTY;
        for segment in segments.iter() {
            let mut segment = *segment;
            if let Motion::Arc { length_m, .. } = &mut segment.motion {
                if left <= 0.0 {
                    break;
                }
                *length_m = length_m.min(left);
                left -= *length_m;
            }
            acting.add(segment);
        }
        acting
    }

    /// Adds what is commanded while the last of `segments` still acts. Whether there was room for it.
    ///
    /// The last curvature is held, in the last gear. `false` where the list is full.
    pub(super) fn outlast<T>(self, course: &Course<'_, T>, segments: &mut SegmentList) -> bool {
        let metres = self.metres(course, course.speed.end());
        let Some(last) = segments.last().copied().filter(|_| metres > 0.0) else { return true };
        let curvature = last.curvature_at(last.length_m());
        segments.push(Segment::clothoid(metres, curvature, curvature, last.gear)).is_ok()
    }
}
