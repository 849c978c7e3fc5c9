//! How near a recording came to each target: who runs along the path at whatever distance arrives on time, and was
//! nowhere.

use std::ops::Range;

use nalgebra::{Isometry3, Point3, Vector4};

use super::align::Way;
use crate::math::segment::point_distance;
use crate::trajectory::Track;

/// A target is come to within this share of the longer move beside it: servos that lag cut corners.
const SHARE: f64 = 0.1;
/// Or within this turn, rad, where moves turn less.
const LEAST_TURN: f64 = 0.02;
/// Who moves less between two samples stands, m.
const STANDS: f64 = 1e-12;

/// How near a recording came to a target while it was on the move to it or the one behind, straight between samples.
///
/// Orientations are those that it had where it was there: on the way past a target a tool may turn through the target's
/// orientation at any time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Approach {
    /// Least distance of positions, m.
    pub distance: f64,
    /// Within so much it was there, m: a tenth of the longer move beside the target, or what an arrival is told by.
    pub distance_within: f64,
    /// Least angle between orientations while the position was within `distance_within`, or nearest where it never was,
    /// rad; 0 where the recording has none.
    pub turn: f64,
    /// Within so much it was turned so, rad: a tenth of the larger turn beside the target, or 0.02.
    pub turn_within: f64,
}

/// Of every target the nearest approach; `None` of those that no sample is about.
///
/// `progress` of the samples, rising; `arrival` in m.
pub(super) fn approaches(
    way: &Way,
    recording: &Track,
    progress: &[f64],
    arrival: f64,
    turns: bool,
) -> Vec<Option<Approach>> {
    let targets = way.ends.len();
    let pose = |target: Option<usize>| way.pose(target.map_or(0, |target| way.end_poses[target]));
    let beside = |of: &dyn Fn(&Isometry3<f64>, &Isometry3<f64>) -> f64, target: usize| {
        let moves = target..(target + 2).min(targets);
        moves.map(|index| of(pose(index.checked_sub(1)), pose(Some(index)))).fold(0.0, f64::max)
    };
    let length = |a: &Isometry3<f64>, b: &Isometry3<f64>| (a.translation.vector - b.translation.vector).norm();
    let one = |target: usize| {
        let about = about(way, progress, target)?;
        let to = pose(Some(target));
        let at = |i: usize| &recording.poses()[i];
        let pairs = || about.clone().map(|i| (at(i.saturating_sub(1)), at(i)));
        let distance = pairs().map(|(a, b)| point_distance(&place(to), &place(a), &place(b))).fold(f64::MAX, f64::min);
        let distance_within = (SHARE * beside(&length, target)).max(arrival);
        let there = distance.max(distance_within);
        let turn_within = (SHARE * beside(&turned, target)).max(LEAST_TURN);
        let turn = || pairs().filter_map(|(a, b)| turn_there(there, to, [a, b], turn_within)).fold(f64::MAX, f64::min);
        Some(Approach { distance, distance_within, turn: if turns { turn() } else { 0.0 }, turn_within })
    };
    (0..targets).map(one).collect()
}

/// The samples on the move to `target` and the one behind it.
fn about(way: &Way, progress: &[f64], target: usize) -> Option<Range<usize>> {
    let first = target.checked_sub(1).map_or(0, |before| progress.partition_point(|along| *along <= way.ends[before]));
    let behind = (target + 1).min(way.ends.len() - 1);
    let last =
        if behind == target { progress.len() } else { progress.partition_point(|along| *along <= way.ends[behind]) };
    // The line that leads there is looked at as well.
    let last = last.max(first + 1).min(progress.len());
    (first < last).then_some(first..last)
}

fn place(of: &Isometry3<f64>) -> Point3<f64> {
    of.translation.vector.into()
}

/// Angle between two orientations, rad: 2 acos |q · r|, by the chord where it is small.
fn turned(a: &Isometry3<f64>, b: &Isometry3<f64>) -> f64 {
    least_turn(a, [b, b], [0.0, 1.0])
}

/// Least angle (rad) of `to` from the orientations between two samples while their position is within `radius` m of
/// its; `None` where it never is. Of samples that are more than `even` rad apart nobody knows how it turned between
/// them: then it may be any of the orientations in between.
fn turn_there(radius: f64, to: &Isometry3<f64>, pair: [&Isometry3<f64>; 2], even: f64) -> Option<f64> {
    let shares = shares_within(radius, &place(to), pair.map(place))?;
    Some(least_turn(to, pair, if turned(pair[0], pair[1]) > even { [0.0, 1.0] } else { shares }))
}

/// The part of the line between two points that is within `radius` of `centre`, as shares of it.
///
/// About the foot of the centre f = (c − a)·w / |w|², w along the line: f ± √(r² − |c − a − f w|²) / |w|.
fn shares_within(radius: f64, centre: &Point3<f64>, [a, b]: [Point3<f64>; 2]) -> Option<[f64; 2]> {
    if point_distance(centre, &a, &b) > radius {
        return None;
    }
    let (way, from) = (b - a, centre - a);
    let length = way.norm_squared();
    if length < STANDS * STANDS {
        return Some([0.0, 1.0]);
    }
    let foot = from.dot(&way) / length;
    let half = ((radius * radius - (from - way * foot).norm_squared()).max(0.0) / length).sqrt();
    let begin = (foot - half).clamp(0.0, 1.0);
    Some([begin, (foot + half).clamp(begin, 1.0)])
}

/// Least angle (rad) of `to` from the orientations between two samples, from one share of the way between them to
/// another, by the chord of their quaternions: θ = 4 asin(|q − r| / 2).
fn least_turn(to: &Isometry3<f64>, [a, b]: [&Isometry3<f64>; 2], [begin, end]: [f64; 2]) -> f64 {
    let to = to.rotation.coords;
    let near = |q: Vector4<f64>| if q.dot(&to) < 0.0 { -q } else { q };
    let (a, b) = (near(a.rotation.coords), near(b.rotation.coords));
    let chord = b - a;
    let share = ((to - a).dot(&chord) / chord.norm_squared().max(f64::MIN_POSITIVE)).clamp(begin, end);
    4.0 * libm::asin((0.5 * (to - a - chord * share).norm()).min(1.0))
}

#[cfg(feature = "unit-tests")]
mod tests {
    use nalgebra::{Translation3, UnitQuaternion, Vector3};

    use super::*;

    #[test]
    fn turns_are_angles_whichever_sign_a_quaternion_has() {
        let turn = |angle: f64| {
            Isometry3::from_parts(Translation3::identity(), UnitQuaternion::from_axis_angle(&Vector3::x_axis(), angle))
        };
        for angle in [1e-9, 0.1, 1.0, 3.0] {
            assert!((turned(&turn(0.0), &turn(angle)) - angle).abs() < 1e-9, "{angle}");
            assert!((turned(&turn(0.2), &turn(0.2 + angle)) - angle).abs() < 1e-9, "{angle}");
        }
        assert!((turned(&turn(3.0), &turn(-3.0)) - (std::f64::consts::TAU - 6.0)).abs() < 1e-9);
        // Half-way between both, though neither sample is there.
        let least = |to: f64, shares| least_turn(&turn(to), [&turn(0.0), &turn(0.2)], shares);
        assert!(least(0.1, [0.0, 1.0]) < 0.01 && (least(0.5, [0.0, 1.0]) - 0.3).abs() < 1e-9);
        assert!((least(0.1, [0.75, 1.0]) - 0.05).abs() < 1e-3);
    }

    #[test]
    fn what_turns_far_between_two_samples_may_be_turned_either_way_there() {
        let at = |x: f64, angle: f64| {
            let turn = UnitQuaternion::from_axis_angle(&Vector3::x_axis(), angle);
            Isometry3::from_parts(Translation3::new(x, 0.0, 0.0), turn)
        };
        // Turned by 0.2 at x = 1, of which it is within 0.1 only where it is nearly turned by 0.4.
        let there = |even| turn_there(0.1, &at(1.0, 0.2), [&at(0.0, 0.0), &at(1.0, 0.4)], even).unwrap();
        // By the chord of the quaternions, half-way of which is a little off.
        assert!((there(0.5) - 0.16).abs() < 0.01 && there(0.3) < 0.02, "{} {}", there(0.5), there(0.3));
        assert_eq!(turn_there(0.1, &at(2.0, 0.2), [&at(0.0, 0.0), &at(1.0, 0.4)], 0.3), None);
    }

    #[test]
    fn a_line_is_near_a_point_between_two_shares_of_it() {
        let line = |from: f64, to: f64| [Point3::new(from, 0.3, 0.0), Point3::new(to, 0.3, 0.0)];
        let within = |radius, line| shares_within(radius, &Point3::origin(), line);
        let near = |found: Option<[f64; 2]>, [a, b]: [f64; 2]| {
            assert!(found.is_some_and(|[c, d]| (a - c).abs() < 1e-9 && (b - d).abs() < 1e-9), "{found:?} {a} {b}");
        };
        near(within(0.5, line(-1.0, 1.0)), [0.3, 0.7]);
        near(within(0.5, line(0.0, 1.0)), [0.0, 0.4]);
        near(within(0.5, line(0.1, 0.2)), [0.0, 1.0]);
        near(within(0.5, line(0.1, 0.1)), [0.0, 1.0]);
        near(within(0.3, line(-1.0, 3.0)), [0.25, 0.25]);
        assert_eq!((within(0.29, line(-1.0, 1.0)), within(0.5, line(0.41, 1.0))), (None, None));
    }
}
