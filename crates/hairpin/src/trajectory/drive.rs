//! The path of a ground vehicle as it is commanded: arcs whose curvature is a polynomial of arc length, and turns in
//! place.
//!
//! ```text
//! ψ̇ = ± v κ(s)     κ(s) = a₀ + a₁ s + … + a₅ s⁵     ẋ = ± v cos(ψ + δ)     ẏ = ± v sin(ψ + δ)
//! ```
//!
//! in the plane; on the ground the same commands and what lean and slip make of them. + is forward, − in reverse; s
//! counts metres from the segment's start, always upwards. Lines, arcs and clothoids are polynomials of degree 0 and 1,
//! so that one form holds all that solvers find.

use serde::{Deserialize, Serialize};
use thiserror::Error;

/// What one [`Segment`] of a drive does.
///
/// κ > 0 has the turning centre on the left in both gears: in reverse the body then turns right, since ψ̇ has the
/// gear's sign.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Motion {
    /// Drives `length_m` metres; ψ̇ = direction · v · κ(s), κ(s) = Σ aᵢ sⁱ, s from 0 in each segment.
    Arc {
        /// Arc length, m, ≥ 0.
        length_m: f64,
        /// a₀ … a₅ of the curvature, 1/m^(i+1).
        curvature: [f64; 6],
    },
    /// Turns in place.
    Turn {
        /// Change of yaw, rad, left positive.
        angle_rad: f64,
    },
}

/// One piece of a drive without a change of gear.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Segment {
    /// What it does.
    pub motion: Motion,
    /// Forward or reverse; forward for turns in place.
    pub gear: Gear,
}

/// Which way the vehicle moves along its path.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Gear {
    /// Along the body's x axis.
    Forward,
    /// Against it.
    Reverse,
}

impl Gear {
    /// +1 forward, −1 in reverse.
    pub fn sign(self) -> f64 {
        match self {
            Self::Forward => 1.0,
            Self::Reverse => -1.0,
        }
    }

    /// The other one.
    pub fn opposite(self) -> Self {
        match self {
            Self::Forward => Self::Reverse,
            Self::Reverse => Self::Forward,
        }
    }
}

impl Segment {
    /// A straight line of `length_m`.
    pub fn straight(length_m: f64, gear: Gear) -> Self {
        Self { motion: Motion::Arc { length_m, curvature: [0.0; 6] }, gear }
    }

    /// A clothoid: curvature from `start` to `end` (1/m), linear over `length_m`.
    ///
    /// dκ/ds = (end − start)/length, 1/m²; of no length the curvature is `start` and `end` is not met.
    pub fn clothoid(length_m: f64, start: f64, end: f64, gear: Gear) -> Self {
        let rate = if length_m > 0.0 { (end - start) / length_m } else { 0.0 };
        Self { motion: Motion::Arc { length_m, curvature: [start, rate, 0.0, 0.0, 0.0, 0.0] }, gear }
    }

    /// Metres driven; 0 for a turn in place.
    pub fn length_m(&self) -> f64 {
        match self.motion {
            Motion::Arc { length_m, .. } => length_m,
            Motion::Turn { .. } => 0.0,
        }
    }

    /// Radians turned in place, left positive; 0 for an arc.
    pub fn turn_rad(&self) -> f64 {
        match self.motion {
            Motion::Arc { .. } => 0.0,
            Motion::Turn { angle_rad } => angle_rad,
        }
    }

    /// Time it takes at `speed` (m/s) and `turn_rate` (rad/s), s.
    pub fn duration(&self, speed: f64, turn_rate: f64) -> f64 {
        match self.motion {
            Motion::Arc { length_m, .. } => length_m / speed,
            Motion::Turn { angle_rad } => angle_rad.abs() / turn_rate,
        }
    }

    /// κ(s), 1/m; 0 for a turn in place.
    pub fn curvature_at(&self, s: f64) -> f64 {
        match self.motion {
            Motion::Arc { curvature, .. } => curvature.iter().rev().fold(0.0, |sum, a| sum * s + a),
            Motion::Turn { .. } => 0.0,
        }
    }
}

/// A pose over the ground with its curvature.
///
/// Flat ground, or the place (x, y, ψ) at which a suspension settles. The world's x is east, its y north.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Planar {
    /// East, m.
    pub x: f64,
    /// North, m.
    pub y: f64,
    /// ψ, rad, counter-clockwise from east.
    pub yaw: f64,
    /// κ, 1/m.
    pub curvature: f64,
}

/// `segments` without their last `metres`; turns in place stay.
///
/// Cut from the end of the drive, across segments: polynomials keep their coefficients and are only followed less far.
/// What is cut may leave segments of no length; metres beyond the drive's own cut all of it.
pub fn shortened(segments: &[Segment], mut metres: f64) -> Vec<Segment> {
    let mut all = segments.to_vec();
    for segment in all.iter_mut().rev() {
        if let Motion::Arc { length_m, .. } = &mut segment.motion {
            let cut = metres.min(*length_m);
            *length_m -= cut;
            metres -= cut;
        }
    }
    all
}

/// Segments of a [`SegmentList`] at most.
pub const MOST_SEGMENTS: usize = 40;

/// More segments than a [`SegmentList`] holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[error("{0} segments: must be at most {MOST_SEGMENTS}")]
pub struct TooManySegments(pub usize);

/// A drive of few segments, kept in place: [`MOST_SEGMENTS`] at most, nothing on the heap.
///
/// A solver's answer: on the stack, `Copy`, so that solving needs no heap. 40 segments are more than any family here
/// makes, which [`SegmentList::add`] asserts; where that is not known, [`SegmentList::push`] and
/// [`SegmentList::append`] refuse what does not fit. Nothing is ever left out in silence.
///
/// ```
/// use hairpin::trajectory::drive::{Gear, Segment, SegmentList};
///
/// let mut drive = SegmentList::EMPTY;
/// for segment in [Segment::straight(2.0, Gear::Forward), Segment::clothoid(1.0, 0.0, 0.5, Gear::Forward)] {
///     drive.push(segment).expect("room for forty");
/// }
/// assert_eq!(drive.iter().map(Segment::length_m).sum::<f64>(), 3.0);
/// assert_eq!(drive[1].curvature_at(0.5), 0.25);
/// ```
#[derive(Clone, Copy)]
pub struct SegmentList {
    segments: [Segment; MOST_SEGMENTS],
    len: usize,
}

impl SegmentList {
    /// Without segments.
    pub const EMPTY: Self = Self {
        segments: [Segment { motion: Motion::Turn { angle_rad: 0.0 }, gear: Gear::Forward }; MOST_SEGMENTS],
        len: 0,
    };

    /// Adds a segment at the end.
    ///
    /// # Errors
    /// The segment itself, if the list is full.
    pub fn push(&mut self, segment: Segment) -> Result<(), Segment> {
        let slot = self.segments.get_mut(self.len).ok_or(segment)?;
        *slot = segment;
        self.len += 1;
        Ok(())
    }

    /// Adds a segment of a drive whose number of segments is known to fit.
    ///
    /// # Panics
    /// If the list is full: a mistake of ours.
    pub fn add(&mut self, segment: Segment) {
        assert!(self.push(segment).is_ok(), "a drive of more than {MOST_SEGMENTS} segments");
    }

    /// Adds all of `segments` at the end, or none.
    ///
    /// # Errors
    /// How many there would be, if that is more than [`MOST_SEGMENTS`].
    pub fn append(&mut self, segments: &[Segment]) -> Result<(), TooManySegments> {
        let all = self.len + segments.len();
        self.segments.get_mut(self.len..all).ok_or(TooManySegments(all))?.copy_from_slice(segments);
        self.len = all;
        Ok(())
    }
}

impl Default for SegmentList {
    fn default() -> Self {
        Self::EMPTY
    }
}

impl std::ops::Deref for SegmentList {
    type Target = [Segment];

    fn deref(&self) -> &[Segment] {
        &self.segments[..self.len]
    }
}

impl std::ops::DerefMut for SegmentList {
    fn deref_mut(&mut self) -> &mut [Segment] {
        &mut self.segments[..self.len]
    }
}

impl PartialEq for SegmentList {
    fn eq(&self, other: &Self) -> bool {
        **self == **other
    }
}

impl std::fmt::Debug for SegmentList {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_list().entries(self.iter()).finish()
    }
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;

    #[test]
    fn a_full_list_gives_the_segment_back() {
        let mut list = SegmentList::default();
        let segment = |i: usize| Segment::straight(i as f64, Gear::Forward);
        for i in 0..MOST_SEGMENTS {
            assert_eq!(list.push(segment(i)), Ok(()));
        }
        assert_eq!(list.push(segment(99)), Err(segment(99)));
        assert_eq!((list.len(), list[7]), (MOST_SEGMENTS, segment(7)));
        assert_ne!(list, SegmentList::EMPTY);
    }

    #[test]
    fn segments_are_appended_all_or_none() {
        let many: Vec<Segment> = (0..30).map(|i| Segment::straight(f64::from(i), Gear::Forward)).collect();
        let mut list = SegmentList::EMPTY;
        assert_eq!(list.append(&many), Ok(()));
        assert_eq!(list.append(&many), Err(TooManySegments(60)));
        assert_eq!(&*list, &many[..]);
        assert_eq!(list.append(&many[..10]), Ok(()));
        assert_eq!(list.append(&many[..1]), Err(TooManySegments(41)));
        assert_eq!((list.append(&[]), list.len(), list[39]), (Ok(()), MOST_SEGMENTS, many[9]));
        // What may be longer than a list, such as the legs of a file, is cut whole.
        let long = [&many[..], &many].concat();
        let shorter = shortened(&long, 30.0);
        assert_eq!((shorter.len(), shorter[59].length_m(), shorter[58].length_m()), (60, 0.0, 27.0));
    }

    #[test]
    #[should_panic(expected = "a drive of more than 40 segments")]
    fn one_more_than_fits_is_a_mistake_of_ours() {
        let mut list = SegmentList::EMPTY;
        (0..41).for_each(|_| list.add(Segment::straight(1.0, Gear::Forward)));
    }
}
