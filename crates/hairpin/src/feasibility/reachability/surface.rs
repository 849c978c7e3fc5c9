//! Segments against closed surfaces, proven: a separating direction for every triangle, then on which side of the
//! surface.
//!
//! A segment is farther than r from a triangle if for some direction n every end p and every corner v have n·(p − v) >
//! r|n|: any n will do, so it is found in floating point and only the inequality is proven. A segment that is clear of
//! all triangles lies wholly inside or wholly outside; the winding number of one of its points, Σ 2 atan2(…)/4π over
//! the triangles' solid angles (van Oosterom, Strackee 1983), is an integer that floating point cannot miss away from
//! the surface.
//!
//! Cost: a box test for every triangle, the inequality for those near. The winding number asks all triangles and is
//! needed where no triangle is near, so that a segment wholly inside is not taken for clear; at most five of its points
//! are asked.

use nalgebra::{Point3, Vector3};

use super::verdict::{Verdict, point};
use crate::math::outward::Interval;
use crate::math::segment::{nearest_parameter, nearest_point};
use crate::world::Bounds;
use crate::world::cell::Surface;

/// Points nearer to the surface than this share of its size are not asked on which side they are.
const TOO_NEAR: f64 = 1e-6;

/// See [`super::Obstacle::certify`].
///
/// A segment that is clear of all triangles is clear if one of its points is outside, and a hit if inside.
///
/// Undecided in one word: `at` ½ and `width` 1, for it is not known where.
pub(super) fn certify(surface: &Surface, a: &Point3<f64>, b: &Point3<f64>, radius: f64) -> Verdict {
    let undecided = Verdict::Undecided { at: 0.5, width: 1.0 };
    let Some(all) = Bounds::around(&surface.vertices) else { return undecided };
    let size = (all.max - all.min).norm();
    let own = Bounds { min: a.inf(b), max: a.sup(b) };
    // Boxes are compared with room for the rounding of the comparison itself.
    let room = radius * (1.0 + 1e-9) + 1e-9 * (size + (b - a).norm());
    if own.distance_to(&all) > room {
        return Verdict::Clear;
    }
    let mut unsure = None;
    for corners in surface.corners() {
        if Bounds::around(&corners).is_some_and(|bounds| own.distance_to(&bounds) > room)
            || separated(a, b, &corners, radius)
        {
            continue;
        }
        match touched(a, b, &corners, radius) {
            Some(at) => return Verdict::Hit { at },
            None => unsure = Some(undecided),
        }
    }
    if unsure.is_none() || radius == 0.0 {
        // Where nothing is grown, a surface is crossed from outside to inside: one proven point inside is a hit.
        let inside =
            [0.0, 1.0, 0.5, 0.25, 0.75].into_iter().find_map(|t| winding(surface, a, b, t, size).map(|w| (t, w)));
        match inside {
            Some((at, true)) => return Verdict::Hit { at },
            Some((_, false)) => {}
            None => unsure = Some(undecided),
        }
    }
    unsure.unwrap_or(Verdict::Clear)
}

/// Whether a direction proves that the segment is farther than `radius` from the triangle.
///
/// Directions tried: the triangle's normal both ways, from each edge to the segment, and across both, both ways.
fn separated(a: &Point3<f64>, b: &Point3<f64>, corners: &[Point3<f64>; 3], radius: f64) -> bool {
    let gap = |n: &Vector3<f64>| {
        let ends = n.dot(&a.coords).min(n.dot(&b.coords));
        ends - corners.iter().map(|v| n.dot(&v.coords)).fold(f64::NEG_INFINITY, f64::max) - radius * n.norm()
    };
    let proven = |n: &Vector3<f64>| {
        let dot = |p: &Point3<f64>, v: &Point3<f64>| {
            (0..3).fold(Interval::point(0.0), |sum, k| {
                sum + Interval::point(n[k]) * (Interval::point(p[k]) - Interval::point(v[k]))
            })
        };
        let length = (0..3).fold(Interval::point(0.0), |sum, k| sum + Interval::point(n[k]).square()).sqrt();
        let room = Interval::point(radius) * length;
        [a, b].into_iter().all(|p| corners.iter().all(|v| dot(p, v).low > room.high))
    };
    let normal = (corners[1] - corners[0]).cross(&(corners[2] - corners[0]));
    let along = b - a;
    let edges = (0..3).flat_map(|i| {
        let (from, to) = (corners[i], corners[(i + 1) % 3]);
        let crossed = along.cross(&(to - from));
        let (s, t) = nearest(a, b, &from, &to);
        [s - t, crossed, -crossed]
    });
    [normal, -normal].into_iter().chain(edges).any(|n| gap(&n) > 0.0 && proven(&n))
}

/// A parameter at which the segment is proven to be within `radius` of the triangle, or to pass through it.
///
/// `None` is no proof of the contrary. Edges, then ends over the face: together these hold the nearest points of a
/// segment that does not pass through.
fn touched(a: &Point3<f64>, b: &Point3<f64>, corners: &[Point3<f64>; 3], radius: f64) -> Option<f64> {
    if crossed(a, b, corners) {
        let normal = (corners[1] - corners[0]).cross(&(corners[2] - corners[0]));
        let (above, below) = (normal.dot(&(a - corners[0])), normal.dot(&(b - corners[0])));
        return Some((above / (above - below)).clamp(0.0, 1.0));
    }
    let near = |x: &Point3<f64>, y: &Point3<f64>, from: &Point3<f64>, to: &Point3<f64>| {
        let (t, s) = (nearest_parameter(x, a, b), nearest_parameter(y, from, to));
        let (p, q) = (point(a, b, Interval::point(t)), point(from, to, Interval::point(s)));
        let square = (0..3).fold(Interval::point(0.0), |sum, k| sum + (p[k] - q[k]).square());
        (square.high <= Interval::point(radius).square().low).then_some(t)
    };
    let edges = (0..3).find_map(|i| {
        let (from, to) = (corners[i], corners[(i + 1) % 3]);
        let (x, y) = nearest(a, b, &from, &to);
        near(&x, &y, &from, &to)
    });
    edges.or_else(|| [(a, 0.0), (b, 1.0)].into_iter().find_map(|(p, t)| over_face(p, corners, radius).then_some(t)))
}

/// Whether a point is proven to be within `radius` of the triangle's inside: v₀ + s e₁ + t e₂ with s, t ≥ 0, s + t ≤ 1
/// is a point of it, whatever s and t are.
fn over_face(p: &Point3<f64>, corners: &[Point3<f64>; 3], radius: f64) -> bool {
    let (e1, e2, w) = (corners[1] - corners[0], corners[2] - corners[0], p - corners[0]);
    let (aa, ab, bb) = (e1.norm_squared(), e1.dot(&e2), e2.norm_squared());
    let determinant = aa * bb - ab * ab;
    let s = (bb * w.dot(&e1) - ab * w.dot(&e2)) / determinant;
    let t = (aa * w.dot(&e2) - ab * w.dot(&e1)) / determinant;
    if !(s >= 0.0 && t >= 0.0 && (Interval::point(s) + Interval::point(t)).high <= 1.0) {
        return false;
    }
    let square = (0..3).fold(Interval::point(0.0), |sum, k| {
        let [v0, v1, v2] = corners.map(|v| Interval::point(v[k]));
        let at = v0 + Interval::point(s) * (v1 - v0) + Interval::point(t) * (v2 - v0);
        sum + (Interval::point(p[k]) - at).square()
    });
    square.high <= Interval::point(radius).square().low
}

/// Whether the segment is proven to pass through the triangle: its ends on both sides, and the line on one side of all
/// three edges.
fn crossed(a: &Point3<f64>, b: &Point3<f64>, corners: &[Point3<f64>; 3]) -> bool {
    let volume = |p: &Point3<f64>, q: &Point3<f64>, r: &Point3<f64>, s: &Point3<f64>| {
        let minus = |x: &Point3<f64>| -> [Interval; 3] {
            std::array::from_fn(|k| Interval::point(x[k]) - Interval::point(s[k]))
        };
        let (u, v, w) = (minus(p), minus(q), minus(r));
        u[0] * (v[1] * w[2] - v[2] * w[1]) + u[1] * (v[2] * w[0] - v[0] * w[2]) + u[2] * (v[0] * w[1] - v[1] * w[0])
    };
    let [u, v, w] = corners;
    let same = |signs: &[Interval]| signs.iter().all(|s| s.low > 0.0) || signs.iter().all(|s| s.high < 0.0);
    same(&[volume(u, v, w, a), -volume(u, v, w, b)])
        && same(&[volume(a, b, u, v), volume(a, b, v, w), volume(a, b, w, u)])
}

/// Nearest points of two segments, by turns: each turn takes the point nearest to the other's.
///
/// Exact where both nearest points lie inside of their segments, else to one turn from three beginnings; m. A guess
/// that others prove from.
fn nearest(a: &Point3<f64>, b: &Point3<f64>, c: &Point3<f64>, d: &Point3<f64>) -> (Point3<f64>, Point3<f64>) {
    let (u, v, r) = (b - a, d - c, a - c);
    let (uu, uv, vv) = (u.norm_squared(), u.dot(&v), v.norm_squared());
    let determinant = uu * vv - uv * uv;
    let inner = (uv * v.dot(&r) - vv * u.dot(&r)) / determinant;
    let start = if inner.is_finite() { a + u * inner.clamp(0.0, 1.0) } else { *a };
    let mut best: Option<(f64, Point3<f64>, Point3<f64>)> = None;
    for begun in [start, *a, *b] {
        let other = nearest_point(&begun, c, d);
        let own = nearest_point(&other, a, b);
        let distance = (own - other).norm();
        if best.is_none_or(|(least, ..)| distance < least) {
            best = Some((distance, own, other));
        }
    }
    best.map_or((*a, *c), |(_, own, other)| (own, other))
}

/// Whether the point at `t` is inside; `None` where it is too near to the surface to tell.
///
/// Inside where the nearest whole number is not 0; `None` as well where none is within 0.1.
fn winding(surface: &Surface, a: &Point3<f64>, b: &Point3<f64>, t: f64, size: f64) -> Option<bool> {
    let p = a + (b - a) * t;
    let mut sum = 0.0;
    for corners in surface.corners() {
        if !separated(&p, &p, &corners, TOO_NEAR * size) {
            return None;
        }
        let [u, v, w] = corners.map(|c| c - p);
        let (lu, lv, lw) = (u.norm(), v.norm(), w.norm());
        let height = u.dot(&v.cross(&w));
        sum += libm::atan2(height, lu * lv * lw + u.dot(&v) * lw + v.dot(&w) * lu + w.dot(&u) * lv);
    }
    let turns = sum / std::f64::consts::TAU;
    ((turns - turns.round()).abs() < 0.1).then_some(turns.round() != 0.0)
}
