//! Distances of points and segments to axis-aligned boxes, in closed form.
//!
//! With q relative to the centre and e = |q| − h: sd(q) = ‖max(e, 0)‖ + min(max_i e_i, 0). Exact to rounding; points
//! need no iteration, segments one sorted list of at most eight break points.

use nalgebra::Vector3;

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
    // A segment that enters the box may be nearest to it, rounded, just outside where it enters.
    if distance > 1e-12 * (half.max() + q.amax()) {
        return distance;
    }
    let deepest = deepest_in_box(q, d, half);
    if deepest <= 0.0 { deepest } else { distance }
}

/// min over t ∈ [0, 1] of max_i(|q_i + t d_i| − h_i): convex and piecewise linear, so that the minimum lies at an end
/// or where two of the six linear functions ±(q_i + t d_i) − h_i cross.
///
/// m; negative where the segment comes inside. Fifteen crossings, in closed form.
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
