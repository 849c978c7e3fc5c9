//! How far a segment is from a region, in floating point: closed forms, and for words a search for room.
//!
//! With K the convex core of a region and x(t) = a + t (b − a), t ↦ dist(x(t), K)² is convex with the derivative 2
//! (x(t) − π_K(x(t)))·(b − a), so that its sign brackets the minimum. No bound of rounding is claimed in this file.

use nalgebra::{Point3, Vector3};

use super::region::Region;
use super::words::Words;
use crate::math::outward::Interval;
use crate::math::segment;
use crate::world::Shape;

/// Halvings of a convex function's interval: beyond them t no longer changes.
const HALVINGS: usize = 52;

impl Region {
    /// Smallest signed distance of the segment a–b to the region, m; ≤ 0 where they meet, `None` for words.
    ///
    /// Exact to rounding for all but words; the segment's own points alone, no tool around them.
    ///
    /// Negative values are depths for balls, capsules, half-spaces and reach spheres; cylinders give 0 where they are
    /// met.
    pub fn segment_distance(&self, a: &Point3<f64>, b: &Point3<f64>) -> Option<f64> {
        Some(match self {
            Self::Shape(shape) => shape.segment_distance(a, b),
            Self::Cylinder { .. } => self.nearest(a, b)?.1.norm(),
            Self::HalfSpace { normal, offset } => {
                let height = |p: &Point3<f64>| (normal.dot(&p.coords) - offset) / normal.norm();
                height(a).min(height(b))
            }
            // The farthest point of a segment is an end.
            Self::Beyond { center, radius } => radius - (a - center).norm().max((b - center).norm()),
            Self::Words(_) => return None,
        })
    }

    /// Whether every point within `room` (m, ≥ 0) of the segment a–b is outside the region. Words are asked for whole
    /// boxes, so that `true` is certain and `false` may be cautious.
    ///
    /// Grown by `room`: of words the cube around the ball, halved along the segment at most ten times.
    pub fn is_clear(&self, a: &Point3<f64>, b: &Point3<f64>, room: f64) -> bool {
        match self {
            Self::Words(words) => room_around(words, a, b, room, 0),
            _ => self.segment_distance(a, b).is_some_and(|distance| distance > room),
        }
    }

    /// Whether a point within `radius` (m, ≥ 0) of the segment a–b is in the region; of words, whether one of those
    /// looked at is.
    ///
    /// Of words 33 points of the segment times the 27 of [`directions`]: what is found is in the region, what is not
    /// may be.
    pub fn meets(&self, a: &Point3<f64>, b: &Point3<f64>, radius: f64) -> bool {
        match self {
            Self::Words(words) => (0..=SAMPLES).any(|i| {
                let p = a + (b - a) * (i as f64 / SAMPLES as f64);
                directions(radius).any(|shift| words.holds((p + shift).into()))
            }),
            Self::Cylinder { a: from, b: to, radius: own } => {
                // The capsule around it is cheaper to ask, and most segments pass that by.
                segment::segment_distance(a, b, from, to) <= own + radius
                    && self.nearest(a, b).is_some_and(|(_, excess)| excess.norm() <= radius)
            }
            _ => self.segment_distance(a, b).is_some_and(|distance| distance <= radius),
        }
    }
}

/// Points of a segment that are looked at.
const SAMPLES: usize = 32;

/// The centre and 26 points of a ball, to the corners, edges and faces of a cube in it.
///
/// m; one point, the centre, for a radius of 0. None is outside of the ball by rounding.
pub fn directions(radius: f64) -> impl Iterator<Item = Vector3<f64>> {
    let step = |i: usize| i as f64 - 1.0;
    let all = (0..27).map(move |i| Vector3::new(step(i % 3), step(i / 3 % 3), step(i / 9)));
    // Rounding must not lead outside.
    all.filter(move |v| radius > 0.0 || *v == Vector3::zeros())
        .map(move |v| if v == Vector3::zeros() { v } else { v * (radius * (1.0 - 1e-12) / v.norm()) })
}

/// Whether the words are proven false within `room` of a–b: on the box around it, or around both halves.
///
/// Boxes are rounded outwards by one unit in the last place of each bound.
fn room_around(words: &Words, a: &Point3<f64>, b: &Point3<f64>, room: f64, depth: usize) -> bool {
    let side = |k: usize| {
        let between = Interval::between(a[k], b[k]);
        Interval { low: (between.low - room).next_down(), high: (between.high + room).next_up() }
    };
    match words.holds_on([side(0), side(1), side(2)]) {
        Some(holds) => !holds,
        // Boxes much shorter than the room say nothing new.
        None if depth < 10 && (b - a).norm() > 0.2 * room => {
            let middle = nalgebra::center(a, b);
            room_around(words, a, &middle, room, depth + 1) && room_around(words, &middle, b, room, depth + 1)
        }
        None => false,
    }
}

impl Region {
    /// From the nearest point of the region's core to `p`, m: zero inside. The core of a ball is its centre, of a
    /// capsule its axis; of boxes and cylinders they themselves. `None` for everything else.
    ///
    /// Of balls and capsules the radius that grows the core is not taken off.
    fn excess(&self, p: &Point3<f64>) -> Option<Vector3<f64>> {
        Some(match self {
            Self::Shape(Shape::Sphere { center, .. }) => p - center,
            Self::Shape(Shape::Capsule { a, b, .. }) => p - segment::nearest_point(p, a, b),
            Self::Shape(Shape::Box { center, half_extents }) => {
                let q = p - center;
                Vector3::from_fn(|k, _| q[k] - q[k].clamp(-half_extents[k], half_extents[k]))
            }
            Self::Cylinder { a, b, radius } => {
                let (w, axis) = (p - a, b - a);
                let share = w.dot(&axis) / axis.norm_squared();
                let across = w - axis * share;
                let from_axis = across.norm();
                let out = if from_axis > *radius { across * (1.0 - radius / from_axis) } else { Vector3::zeros() };
                out + axis * (share - share.clamp(0.0, 1.0))
            }
            _ => return None,
        })
    }

    /// Where the segment a–b is nearest to the region's core, as its parameter, and the way there from the core, m;
    /// `None` as of regions without a core. The distance is convex along the segment, so that its derivative's sign
    /// leads to the minimum.
    ///
    /// Secant steps with a bisection at every third: at most 52 evaluations of π_K, usually four or five. The vector is
    /// 0 where the segment enters the core.
    pub fn nearest(&self, a: &Point3<f64>, b: &Point3<f64>) -> Option<(f64, Vector3<f64>)> {
        let d = b - a;
        let at = |t: f64| self.excess(&(a + d * t));
        let (first, last) = (at(0.0)?, at(1.0)?);
        // Squared distances have the derivative 2 (excess · d).
        let (mut low, mut high) = ((0.0, first.dot(&d)), (1.0, last.dot(&d)));
        if low.1 >= 0.0 {
            return Some((0.0, first));
        }
        if high.1 <= 0.0 {
            return Some((1.0, last));
        }
        let (mut best, mut turns) = ((0.0, first), 0);
        while turns < HALVINGS && high.0 - low.0 > 1e-12 {
            // The secant of a convex function's derivative, and now and then the middle, so that the interval does
            // shrink.
            let secant = low.0 - low.1 * (high.0 - low.0) / (high.1 - low.1);
            let t = if turns % 3 == 2 { 0.5 * (low.0 + high.0) } else { secant.clamp(low.0, high.0) };
            let excess = at(t)?;
            let slope = excess.dot(&d);
            best = (t, excess);
            if slope.abs() <= 1e-14 * (d.norm() * excess.norm()) {
                break;
            }
            *(if slope > 0.0 { &mut high } else { &mut low }) = (t, slope);
            turns += 1;
        }
        Some(best)
    }
}
