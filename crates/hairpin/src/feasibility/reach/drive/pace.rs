//! How fast legs are driven: alone, and one after the other, with stops where the vehicle must stand and no harder than
//! it may.

use crate::math::power::square;
use crate::math::random::hashed_unit;
use crate::robot::rover::Response;
use crate::trajectory::SpeedProfile;
use crate::trajectory::drive::{Gear, Motion, Segment};

/// How speeds follow each other along a drive.
///
/// Speeds are of whole drives: they follow once the legs are known, by one pass forward and one back.
///
/// | pace | v along a leg |
/// | --- | --- |
/// | `Constant` | the commanded speed |
/// | `Ramp` | v² linear in the metres from one joint to the next |
/// | `Trapezoid` | up at a, the commanded speed, down at a |
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Pace {
    /// The commanded speed all along: changes of gear and turns in place take no time to stop for.
    Constant,
    /// From each waypoint's speed to the next one's, evenly in time; between two stops as a trapezoid.
    Ramp(Slopes),
    /// Up to the commanded speed between the waypoints.
    Trapezoid(Slopes),
}

/// Speeds at waypoints, and how hard speed changes.
///
/// Both bounds of `waypoints` are cut to the commanded speed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Slopes {
    /// Least and greatest speed at which waypoints are passed, m/s: each has one of its own, drawn evenly.
    pub waypoints: [f64; 2],
    /// Acceleration and deceleration, m/s², > 0 and finite.
    pub acceleration: f64,
}

/// Places of a segment at which its curvature is looked at.
const SAMPLES: u32 = 64;
/// Stream of the waypoints' speeds beside that of pairs of waypoints.
const STREAM: u64 = u64::MAX;

impl Pace {
    /// The speed at which waypoint `index` is passed unless something slows the vehicle there, m/s.
    ///
    /// A pure function of its arguments: every leg to and from a waypoint knows the same.
    pub(super) fn wish(&self, speed: f64, seed: u64, index: usize) -> f64 {
        match self {
            Self::Constant => speed,
            Self::Ramp(_) | Self::Trapezoid(_) => {
                let [low, high] = self.wishes(speed);
                low + (high - low) * hashed_unit(seed, &[STREAM, index as u64])
            }
        }
    }

    /// Least and greatest speed that waypoints wish for where `speed` is commanded, m/s.
    pub fn wishes(&self, speed: f64) -> [f64; 2] {
        match self {
            Self::Constant => [speed; 2],
            Self::Ramp(slopes) | Self::Trapezoid(slopes) => slopes.waypoints.map(|bound| bound.min(speed)),
        }
    }

    /// Hardest change of speed, m/s².
    pub(super) fn acceleration(&self) -> f64 {
        match self {
            Self::Constant => 0.0,
            Self::Ramp(slopes) | Self::Trapezoid(slopes) => slopes.acceleration,
        }
    }

    /// The speeds of `legs`, driven one after the other at `speed` (m/s) at most, which wish for `wishes` (m/s) at
    /// their ends: one more than there are legs.
    ///
    /// A wish gives way to stops before and after turns in place and where the gear changes, to the steering's rate
    /// within both legs, and to what the acceleration makes of their metres: v² ≤ w² + 2 a L, w the speed at the other
    /// end.
    ///
    /// One profile a leg. Two passes, O(segments); with [`Pace::Constant`] wishes count for nothing.
    pub fn over(&self, speed: f64, wishes: &[f64], legs: &[&[Segment]], response: &Response) -> Vec<SpeedProfile> {
        let (slopes, even) = match self {
            Self::Constant => return vec![speed.into(); legs.len()],
            Self::Ramp(slopes) => (slopes, true),
            Self::Trapezoid(slopes) => (slopes, false),
        };
        let shapes: Vec<Shape> = legs.iter().map(|segments| Shape::of(segments, speed, response)).collect();
        let mut joints = wishes.to_vec();
        for (leg, shape) in shapes.iter().enumerate() {
            for joint in &mut joints[leg..leg + 2] {
                *joint = joint.min(shape.top);
            }
            if shape.ends[0].is_none() || (leg > 0 && shapes[leg - 1].ends[1] != shape.ends[0]) {
                joints[leg] = 0.0;
            }
            if shape.ends[1].is_none() {
                joints[leg + 1] = 0.0;
            }
        }
        let within =
            |wish: f64, other: f64, metres: f64| wish.min((square(other) + 2.0 * slopes.acceleration * metres).sqrt());
        for (leg, shape) in shapes.iter().enumerate() {
            let other = if shape.stretches > 1 { 0.0 } else { joints[leg] };
            joints[leg + 1] = within(joints[leg + 1], other, shape.lengths[1]);
        }
        for (leg, shape) in shapes.iter().enumerate().rev() {
            let other = if shape.stretches > 1 { 0.0 } else { joints[leg + 1] };
            joints[leg] = within(joints[leg], other, shape.lengths[0]);
        }
        let profile = |(leg, shape): (usize, &Shape)| {
            let (start, end) = (joints[leg], joints[leg + 1]);
            if even && shape.stretches == 1 && start + end > 0.0 {
                SpeedProfile::Ramp { start, end }
            } else {
                SpeedProfile::Trapezoid { start, cruise: shape.top, end, acceleration: slopes.acceleration }
            }
        };
        shapes.iter().enumerate().map(profile).collect()
    }
}

/// What the speeds of a leg depend on.
struct Shape {
    /// Parts between stops.
    stretches: usize,
    /// Metres of the first and of the last of them.
    lengths: [f64; 2],
    /// Gears at both ends; `None`: a turn in place.
    ends: [Option<Gear>; 2],
    /// The highest speed, m/s: the given one, or what the steering follows.
    top: f64,
}

impl Shape {
    /// Reads off segments what a profile over them needs: how many stretches of one gear there are, how long the first
    /// and the last one are, the gears at both ends, and the top speed at which the steering still follows every
    /// clothoid.
    fn of(segments: &[Segment], speed: f64, response: &Response) -> Self {
        let gear = |segment: &Segment| matches!(segment.motion, Motion::Arc { .. }).then_some(segment.gear);
        let mut shape = Self { stretches: 0, lengths: [0.0; 2], ends: [None; 2], top: speed };
        let mut before = None;
        for (index, segment) in segments.iter().enumerate() {
            let own = gear(segment);
            if index == 0 {
                shape.ends[0] = own;
            }
            if own.is_some() && own != before {
                shape.stretches += 1;
                shape.lengths[1] = 0.0;
            }
            if shape.stretches == 1 {
                shape.lengths[0] += segment.length_m();
            }
            shape.lengths[1] += segment.length_m();
            shape.top = shape.top.min(fastest(segment, response));
            before = own;
        }
        shape.ends[1] = before;
        shape
    }
}

/// The speed at which the steering's rate is just enough all along `segment`, m/s: δ = atan(κL), dδ/ds = κ′L/(1 +
/// κ²L²).
fn fastest(segment: &Segment, response: &Response) -> f64 {
    let Motion::Arc { length_m, curvature } = segment.motion else { return f64::INFINITY };
    if !response.steering_rate.is_finite() {
        return f64::INFINITY;
    }
    let axle = response.steered_axle;
    let bends = |i: u32| {
        let s = length_m * f64::from(i) / f64::from(SAMPLES);
        let slope = (1..6).rev().fold(0.0, |sum, i| sum * s + i as f64 * curvature[i]);
        slope.abs() * axle / (1.0 + square(segment.curvature_at(s) * axle))
    };
    let most = (0..=SAMPLES).map(bends).fold(0.0, f64::max);
    if most > 0.0 { response.steering_rate / most } else { f64::INFINITY }
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;
    use crate::trajectory::Timing;

    const SLOPES: Slopes = Slopes { waypoints: [1.0, 1.0], acceleration: 0.5 };

    fn straight(metres: f64, gear: Gear) -> Vec<Segment> {
        vec![Segment::straight(metres, gear)]
    }

    fn speeds(pace: Pace, legs: &[Vec<Segment>], wishes: &[f64]) -> Vec<Timing> {
        let segments: Vec<&[Segment]> = legs.iter().map(Vec::as_slice).collect();
        let profiles = pace.over(2.0, wishes, &segments, &Response::default());
        assert!(profiles.iter().all(|profile| profile.checked().is_ok()), "{profiles:?}");
        profiles.iter().zip(legs).map(|(profile, leg)| Timing::new(profile, leg)).collect()
    }

    #[test]
    fn drives_stand_where_gears_change_and_keep_the_acceleration_through_short_legs() {
        use Gear::{Forward, Reverse};
        let turn = Segment { motion: Motion::Turn { angle_rad: 1.0 }, gear: Forward };
        let cusp = [straight(3.0, Forward), straight(2.0, Reverse)].concat();
        let turning = [vec![turn], straight(5.0, Forward)].concat();
        let legs = [straight(6.0, Forward), straight(0.4, Forward), cusp, straight(6.0, Reverse), turning];
        let wishes = [0.0, 1.5, 1.5, 1.5, 1.5, 0.0];
        for pace in [Pace::Ramp(SLOPES), Pace::Trapezoid(SLOPES)] {
            let timings = speeds(pace, &legs, &wishes);
            let ends: Vec<[f64; 2]> = timings.iter().map(|timing| [timing.speed_at(0.0), timing.end_speed()]).collect();
            for (before, after) in ends.iter().zip(&ends[1..]) {
                assert!((before[1] - after[0]).abs() < 1e-6, "{ends:?}");
            }
            // At the end itself rounding of metres is left.
            assert!([ends[0][0], ends[3][1], ends[4][0], ends[4][1]].iter().all(|speed| *speed < 1e-6), "{ends:?}");
            assert!(timings[2].speed_at(3.0 - 1e-12) < 1e-5 && ends[2][1] > 0.9, "{ends:?}");
            assert!(timings.iter().all(|timing| timing.hardest() <= 0.5 + 1e-9));
        }
        // Trapezoids come to the commanded speed where there is room: 0 to 2 m/s takes 4 m.
        assert!((speeds(Pace::Trapezoid(SLOPES), &legs, &wishes)[0].speed_at(4.0) - 2.0).abs() < 1e-12);
        assert!(speeds(Pace::Constant, &legs, &wishes).iter().all(|timing| timing.speed_at(0.0) == 2.0));
    }

    #[test]
    fn the_steering_has_time_for_every_change_of_curvature() {
        let response = Response { steering_rate: 0.2, steered_axle: 0.5, ..Response::default() };
        let bend = [Segment::clothoid(2.0, -1.0, 1.0, Gear::Forward)];
        let profiles = Pace::Trapezoid(SLOPES).over(2.0, &[2.0, 2.0], &[&bend], &response);
        // Hardest where it is straight: dδ/ds = κ′L = 0.5 rad/m.
        let timing = Timing::new(&profiles[0], &bend);
        assert!((timing.speed_at(1.0) - 0.4).abs() < 1e-3 && timing.end_speed() <= 0.4 + 1e-9, "{profiles:?}");
    }

    #[test]
    fn waypoints_have_speeds_of_their_own_within_their_bounds() {
        let pace = Pace::Ramp(Slopes { waypoints: [0.4, 1.6], ..SLOPES });
        let drawn: Vec<f64> = (0..100).map(|index| pace.wish(1.0, 7, index)).collect();
        assert!(drawn.iter().all(|speed| (0.4..=1.0).contains(speed)) && drawn.iter().any(|speed| *speed < 0.6));
        assert_eq!((Pace::Constant.wish(1.0, 7, 3), pace.wish(1.0, 7, 5)), (1.0, drawn[5]));
    }
}
