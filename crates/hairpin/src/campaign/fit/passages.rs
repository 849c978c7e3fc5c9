//! When a motion passed its waypoints: from poses alone, by one rule for logs and simulations.

use nalgebra::{Point3, Vector3};

use crate::simulation::Acceptance;
use crate::trajectory::Track;

/// Time around a passage in which the way to the waypoint is taken for straight, s: an estimate's noise moves a
/// crossing by itself over the speed, and that of a line through a few samples by less.
const AROUND: f64 = 0.2;

/// A waypoint that was not passed, and how near it was come to, in radii.
///
/// The waypoint's number counts from 0; a radius is the acceptance's, in m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Missed {
    pub(super) waypoint: usize,
    pub(super) nearest: f64,
}

/// Time of the passage of each waypoint, in order, the first at the track's begin: where the distance in radii, linear
/// in time through the samples around, falls to one.
///
/// The distance is ‖p − w‖/r in a sphere, max(‖(p − w)ₓᵧ‖/r, |(p − w)_z|/h) in a cylinder. Times do not fall: a
/// waypoint inside the last one's ball is passed at once. O(samples + waypoints · a few).
///
/// # Errors
/// The first waypoint whose distance never falls to one after the waypoint before it.
pub(super) fn passages(
    track: &Track,
    waypoints: &[Point3<f64>],
    (acceptance, radius): (Acceptance, f64),
) -> Result<Vec<f64>, Missed> {
    let times = track.times();
    let away = |i: usize, waypoint: usize| {
        let way: Vector3<f64> = waypoints[waypoint] - track.position(i);
        match acceptance {
            Acceptance::Sphere => way.norm() / radius,
            Acceptance::Cylinder { height } => (way.xy().norm() / radius).max(way.z.abs() / height),
        }
    };
    let mut passed = vec![times.first().copied().unwrap_or_default()];
    let mut from = 0;
    for waypoint in 1..waypoints.len() {
        let first = (from..track.len()).find(|&i| away(i, waypoint) <= 1.0);
        let Some(first) = first else {
            let nearest = (from..track.len()).map(|i| away(i, waypoint)).fold(f64::INFINITY, f64::min);
            return Err(Missed { waypoint, nearest });
        };
        let (low, high) = (times[first] - AROUND, times[first] + AROUND);
        let around = times.partition_point(|t| *t < low)..times.partition_point(|t| *t <= high);
        let crossing = crossing(around.map(|i| (times[i] - times[first], away(i, waypoint) - 1.0)));
        let before = passed.last().copied().unwrap_or_default();
        passed.push((times[first] + crossing).max(before));
        from = first;
    }
    Ok(passed)
}

/// The least distance of a motion from a waypoint in the first `axes` of the world, m: of the lines between samples.
pub(super) fn nearest(track: &Track, to: &Point3<f64>, axes: usize) -> f64 {
    let plane = |way: Vector3<f64>| Vector3::from_fn(|k, _| if k < axes { way[k] } else { 0.0 });
    let off = |i: usize| {
        let (from, along) = (track.position(i), plane(track.position(i + 1) - track.position(i)));
        let way = plane(to - from);
        let share = if along.norm_squared() > 0.0 { along.dot(&way) / along.norm_squared() } else { 0.0 };
        (way - along * share.clamp(0.0, 1.0)).norm()
    };
    (0..track.len().saturating_sub(1)).map(off).fold(f64::INFINITY, f64::min)
}

/// The zero of a line through points by least squares, within the time around; 0 where they do not fall.
///
/// Seconds from the first sample within the radius.
fn crossing(points: impl Iterator<Item = (f64, f64)> + Clone) -> f64 {
    let (mut n, mut sum) = (0.0, [0.0; 4]);
    for (t, d) in points {
        n += 1.0;
        sum = [sum[0] + t, sum[1] + d, sum[2] + t * t, sum[3] + t * d];
    }
    let [t, d, tt, td] = sum;
    let slope = (n * td - t * d) / (n * tt - t * t);
    if slope.is_finite() && slope < 0.0 {
        let level = (d - slope * t) / n;
        return (-level / slope).clamp(-AROUND, AROUND);
    }
    0.0
}

#[cfg(feature = "unit-tests")]
mod tests {
    use nalgebra::Isometry3;

    use super::*;

    /// At 3 m/s along x past a waypoint at 10 m, off to the side by 0.6 m: the ball of 1 m begins 0.8 m before it.
    #[test]
    fn a_passage_is_where_the_ball_begins() {
        for hz in [10.0, 100.0] {
            let times: Vec<f64> = (0..(6.0 * hz) as usize).map(|i| i as f64 / hz).collect();
            let poses = times.iter().map(|t| Isometry3::translation(3.0 * t, 0.6, 2.0)).collect();
            let track = Track::new(times, poses, vec![]).unwrap();
            let waypoints = [[0.0, 0.0, 2.0], [10.0, 0.0, 2.0], [50.0, 0.0, 2.0]].map(Point3::from);
            let passed = passages(&track, &waypoints[..2], (Acceptance::Sphere, 1.0)).unwrap();
            assert_eq!(passed[0], 0.0);
            // The distance bends on the way in: by a line it is 9.2 m within a few centimetres.
            assert!((3.0 * passed[1] - 9.2).abs() < 0.1, "{hz}: {passed:?}");
            let missed = passages(&track, &waypoints, (Acceptance::Sphere, 1.0)).unwrap_err();
            let nearest = (50.0f64 - 3.0 * track.times()[track.len() - 1]).hypot(0.6);
            assert!(missed.waypoint == 2 && (missed.nearest - nearest).abs() < 1e-9, "{missed:?}");
        }
    }
}
