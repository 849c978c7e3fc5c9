//! What can be proven of a segment, and its points.

use nalgebra::Point3;

use crate::math::outward::Real;

/// What is proven of a segment a + t(b − a), t in [0, 1], grown by a radius.
///
/// Both answers are of the real numbers: no later computation can contradict them.
///
/// `Undecided` is within rounding of contact, or beyond the effort allowed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Verdict {
    /// It does not meet the region.
    Clear,
    /// The point at this t is within the radius of the region.
    Hit {
        /// Parameter of the point.
        at: f64,
    },
    /// Neither could be proven down to the least width; to be treated as a hit.
    Undecided {
        /// Parameter of the place.
        at: f64,
        /// Width of the parameter's interval there.
        width: f64,
    },
}

/// a + t(b − a).
///
/// t as an interval or a centred form gives an enclosure of that part of the segment.
pub(super) fn point<N: Real>(a: &Point3<f64>, b: &Point3<f64>, t: N) -> [N; 3] {
    std::array::from_fn(|k| N::constant(a[k]) + t * (N::constant(b[k]) - N::constant(a[k])))
}
