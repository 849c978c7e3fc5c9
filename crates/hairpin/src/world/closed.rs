//! Distances with a closed form: points and segments to points, segments and axis-aligned boxes.

use nalgebra::{Point3, Vector3};

/// Parameter in [0, 1] of the point of the segment a–b nearest to `p`; 0 for a segment without length.
pub(super) fn nearest_parameter(p: &Point3<f64>, a: &Point3<f64>, b: &Point3<f64>) -> f64 {
    let d = b - a;
    let square = d.norm_squared();
    if square > 0.0 { ((p - a).dot(&d) / square).clamp(0.0, 1.0) } else { 0.0 }
}

/// Distance of `p` to the segment a–b, m.
pub(super) fn point_to_segment(p: &Point3<f64>, a: &Point3<f64>, b: &Point3<f64>) -> f64 {
    (p - (a + (b - a) * nearest_parameter(p, a, b))).norm()
}

/// Smallest distance between the segments a–b and c–d, m.
///
/// Minimises ‖a + s u − c − t v‖² over the unit square. The minimum lies either inside (where both partial
/// derivatives vanish) or on an edge of the square, that is at an end of one of the segments.
pub(super) fn segment_to_segment(a: &Point3<f64>, b: &Point3<f64>, c: &Point3<f64>, d: &Point3<f64>) -> f64 {
    let (u, v, r) = (b - a, d - c, a - c);
    let (uu, uv, vv) = (u.norm_squared(), u.dot(&v), v.norm_squared());
    let determinant = uu * vv - uv * uv;
    let ends = point_to_segment(a, c, d)
        .min(point_to_segment(b, c, d))
        .min(point_to_segment(c, a, b))
        .min(point_to_segment(d, a, b));
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

/// Signed distance of `q`, relative to the box's centre, to the box ±`half`, m; negative inside.
pub(super) fn point_to_box(q: &Vector3<f64>, half: &Vector3<f64>) -> f64 {
    let outside = q.abs() - half;
    outside.sup(&Vector3::zeros()).norm() + outside.max().min(0.0)
}

/// Smallest signed distance of the segment from `q` to `q + d`, relative to the box's centre, to the box ±`half`, m.
///
/// Outside, the squared distance Σ max(0, |q_i + t d_i| − h_i)² is convex and piecewise quadratic in t: its minimum
/// lies in the one piece between break points where its derivative changes sign.
pub(super) fn segment_to_box(q: &Vector3<f64>, d: &Vector3<f64>, half: &Vector3<f64>) -> f64 {
    let mut breaks = [0.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0];
    for axis in 0..3 {
        for (k, side) in [-half[axis], half[axis]].into_iter().enumerate() {
            let t = (side - q[axis]) / d[axis];
            if t > 0.0 && t < 1.0 {
                breaks[1 + 2 * axis + k] = t;
            }
        }
    }
    breaks.sort_unstable_by(f64::total_cmp);
    let excess = |t: f64| {
        Vector3::from_fn(|i, _| {
            let c = q[i] + t * d[i];
            c.signum() * (c.abs() - half[i]).max(0.0)
        })
    };
    let slope = |t: f64| excess(t).dot(d);
    // The slope is continuous, piecewise linear and rising.
    let best = if slope(0.0) >= 0.0 {
        0.0
    } else if slope(1.0) <= 0.0 {
        1.0
    } else {
        let piece = breaks.windows(2).find(|piece| slope(piece[1]) >= 0.0);
        let [lo, hi] = piece.map_or([0.0, 1.0], |piece| [piece[0], piece[1]]);
        let (below, above) = (slope(lo), slope(hi));
        if above > below { lo - below * (hi - lo) / (above - below) } else { lo }
    };
    let distance = excess(best).norm();
    if distance > 0.0 { distance } else { deepest_in_box(q, d, half) }
}

/// min over t ∈ [0, 1] of max_i(|q_i + t d_i| − h_i): convex and piecewise linear, so that the minimum lies at an end
/// or where two of the six linear functions ±(q_i + t d_i) − h_i cross.
fn deepest_in_box(q: &Vector3<f64>, d: &Vector3<f64>, half: &Vector3<f64>) -> f64 {
    let line = |k: usize| {
        let (axis, sign) = (k / 2, if k.is_multiple_of(2) { 1.0 } else { -1.0 });
        (sign * q[axis] - half[axis], sign * d[axis])
    };
    let depth = |t: f64| (0..6).map(|k| line(k).0 + t * line(k).1).fold(f64::NEG_INFINITY, f64::max);
    let mut least = depth(0.0).min(depth(1.0));
    for j in 0..6 {
        for k in 0..j {
            let t = (line(k).0 - line(j).0) / (line(j).1 - line(k).1);
            if t > 0.0 && t < 1.0 {
                least = least.min(depth(t));
            }
        }
    }
    least
}
