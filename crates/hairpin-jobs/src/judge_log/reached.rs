//! Whether what moved was at every waypoint, one after the other: a log that ends where its mission does may have left
//! out all that lies between.

pub use hairpin::campaign::missed::Missed;
use hairpin::math::segment::point_distance;
use hairpin_formats::logs::Sample;
use nalgebra::Point3;

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
