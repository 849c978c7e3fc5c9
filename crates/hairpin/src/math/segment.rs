//! Nearest points of straight segments: what the world's solids and the judge's legs have in common.

use nalgebra::Point3;

/// Parameter in [0, 1] of the point of the segment a–b nearest to `p`; 0 for a segment without length.
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
pub fn point_distance(p: &Point3<f64>, a: &Point3<f64>, b: &Point3<f64>) -> f64 {
    (p - nearest_point(p, a, b)).norm()
}

/// Smallest distance between the segments a–b and c–d.
///
/// Minimises ‖a + s u − c − t v‖² over the unit square. The minimum lies either inside (where both partial
/// derivatives vanish) or on an edge of the square, that is at an end of one of the segments.
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
