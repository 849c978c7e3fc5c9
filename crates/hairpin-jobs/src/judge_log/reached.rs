//! Whether what moved was at every waypoint, one after the other: a log that ends where its mission does may have left
//! out all that lies between, and what an autopilot says of itself is held against its positions.

use std::ops::RangeInclusive;

use hairpin::campaign::missed::Missed;
use hairpin::math::segment::point_distance;
use hairpin_formats::logs::Sample;
use nalgebra::Point3;

use super::legs::Course;

/// The first of `waypoints` that `samples` do not come to within `accept_m` m, in order; straight from each sample to
/// the next, and by the earliest moment at which each is reached.
pub(super) fn missed(samples: &[Sample], waypoints: &[Point3<f64>], accept_m: f64) -> Option<Missed> {
    let (mut reached, mut nearest_m) = (0, f64::INFINITY);
    let mut from = samples.first()?.p_m;
    for to in samples.iter().map(|sample| sample.p_m) {
        while let Some(waypoint) = waypoints.get(reached) {
            let Some(at) = first_within(&from, &to, waypoint, accept_m) else {
                nearest_m = nearest_m.min(point_distance(waypoint, &from, &to));
                break;
            };
            (from, reached, nearest_m) = (at, reached + 1, f64::INFINITY);
        }
        from = to;
    }
    (reached < waypoints.len()).then_some(Missed { waypoint: reached, of: waypoints.len(), nearest_m, accept_m })
}

/// The first of the waypoints `which` that an autopilot says it was at, and that `samples` are not within `accept_m` m
/// of, straight from each to the next, on either leg beside it.
pub(super) fn untrue(
    samples: &[Sample],
    (course, which): (&Course, RangeInclusive<usize>),
    waypoints: &[Point3<f64>],
    accept_m: f64,
) -> Option<Missed> {
    let mut nearest = vec![f64::INFINITY; waypoints.len()];
    for pair in samples.windows(2) {
        let [Some(first), Some(last)] = [&pair[0], &pair[1]].map(|sample| course.leg_at(sample.t_s)) else { continue };
        // Between two samples it may have been on several legs.
        for (nearest, waypoint) in nearest.iter_mut().zip(waypoints).take(last + 2).skip(first) {
            *nearest = nearest.min(point_distance(waypoint, &pair[0].p_m, &pair[1].p_m));
        }
    }
    let far = nearest.iter().enumerate().find(|(waypoint, far)| which.contains(waypoint) && **far > accept_m);
    far.map(|(waypoint, far)| Missed { waypoint, of: waypoints.len(), nearest_m: *far, accept_m })
}

/// Where the segment first is within `radius` of `centre`.
///
/// ‖f + s w‖² = r², f from the centre to the segment's begin and w along it: the lesser root, where 0 ≤ s ≤ 1.
fn first_within(from: &Point3<f64>, to: &Point3<f64>, centre: &Point3<f64>, radius: f64) -> Option<Point3<f64>> {
    let (f, w) = (from - centre, to - from);
    let (a, b, c) = (w.norm_squared(), f.dot(&w), f.norm_squared() - radius * radius);
    if c <= 0.0 {
        return Some(*from);
    }
    let share = (-b - (b * b - a * c).sqrt()) / a;
    (0.0..=1.0).contains(&share).then(|| *from + w * share)
}
