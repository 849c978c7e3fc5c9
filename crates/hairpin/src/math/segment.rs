//! Nearest points of straight segments: what the world's solids and the judge's legs have in common.
//!
//! Points and distances share one unit, m above this room. A segment a–b is {a + t (b − a), 0 ≤ t ≤ 1}; its line goes
//! on, the segment does not, and a segment may be a point.

use nalgebra::Point3;

/// Parameter in [0, 1] of the point of the segment a–b nearest to `p`; 0 for a segment without length.
///
/// t = clamp((p − a)·(b − a)/‖b − a‖², 0, 1), the foot of the perpendicular moved to the nearer end where it falls
/// outside.
pub fn nearest_parameter(p: &Point3<f64>, a: &Point3<f64>, b: &Point3<f64>) -> f64 {
    let d = b - a;
    let square = d.norm_squared();
    if square > 0.0 { ((p - a).dot(&d) / square).clamp(0.0, 1.0) } else { 0.0 }
}

/// The point of the segment a–b nearest to `p`.
pub fn nearest_point(p: &Point3<f64>, a: &Point3<f64>, b: &Point3<f64>) -> Point3<f64> {
    a + (b - a) * nearest_parameter(p, a, b)
}

/// Distance of `p` to the segment a–b.
///
/// 1-Lipschitz in `p`.
pub fn point_distance(p: &Point3<f64>, a: &Point3<f64>, b: &Point3<f64>) -> f64 {
    (p - nearest_point(p, a, b)).norm()
}

/// Smallest distance between the segments a–b and c–d.
///
/// Minimises ‖a + s u − c − t v‖² over the unit square. The minimum lies either inside (where both partial
/// derivatives vanish) or on an edge of the square, that is at an end of one of the segments.
///
/// With r = a − c the stationary point solves, in closed form,
///
/// ```text
/// (u·u) s − (u·v) t = −u·r
/// (u·v) s − (v·v) t = −v·r        determinant (u·u)(v·v) − (u·v)² = ‖u × v‖²
/// ```
///
/// Symmetric in the two segments and in each one's ends, up to rounding. After Ericson, "Real-Time Collision Detection"
/// (2005), §5.1.9.
///
/// ```
/// use hairpin::math::segment::segment_distance;
/// use nalgebra::Point3;
///
/// // Two skew segments that pass each other at (0, 0), 0.5 apart.
/// let (a, b) = (Point3::new(-1.0, 0.0, 0.0), Point3::new(1.0, 0.0, 0.0));
/// let (c, d) = (Point3::new(0.0, -1.0, 0.5), Point3::new(0.0, 1.0, 0.5));
/// assert_eq!(segment_distance(&a, &b, &c, &d), 0.5);
/// ```
pub fn segment_distance(a: &Point3<f64>, b: &Point3<f64>, c: &Point3<f64>, d: &Point3<f64>) -> f64 {
    let (u, v, r) = (b - a, d - c, a - c);
    let (uu, uv, vv) = (u.norm_squared(), u.dot(&v), v.norm_squared());
    let determinant = uu * vv - uv * uv;
    let ends =
        point_distance(a, c, d).min(point_distance(b, c, d)).min(point_distance(c, a, b)).min(point_distance(d, a, b));
    // Nearly parallel segments have their minimum at an end as well, to rounding.
    if determinant > 1e-14 * uu * vv {
        let s = (uv * v.dot(&r) - vv * u.dot(&r)) / determinant;
        let t = (uu * v.dot(&r) - uv * u.dot(&r)) / determinant;
        if (0.0..=1.0).contains(&s) && (0.0..=1.0).contains(&t) {
            return ends.min((r + u * s - v * t).norm());
        }
    }
    ends
}
