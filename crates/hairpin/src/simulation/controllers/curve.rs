//! A timed reference and the clock that runs along it.

use nalgebra::{Point3, Vector3};

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::math::minimum_snap::{MinimumSnapError, minimum_snap};
use crate::robot::quadrotor::Quadrotor;
use crate::simulation::controller::Schedule;
use crate::trajectory::{Profile, ProfileLeg};

/// Shortest leg time of a reference, s: waypoints that coincide still take some.
const LEAST_LEG_TIME: f64 = 0.2;

/// What those who follow a curve say without one.
pub(super) const NOT_RESET: &str = "asked for a command before it was reset to a course";

/// Leg times of the minimum-snap reference.
///
/// The sum over legs is the same: what differs is how it is shared out, and so where the curve swings out.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum SegmentTimes {
    /// By the square root of the leg's length.
    #[default]
    SqrtLength,
    /// By the leg's length, for the same total time.
    Length,
}

/// A profile and a clock on it.
///
/// `leg` counts from 0, `tau` is in s since its start.
#[derive(Debug, Clone)]
pub(crate) struct Curve {
    legs: Vec<ProfileLeg>,
    leg: usize,
    tau: f64,
}

/// Position, velocity, acceleration, jerk, snap of a reference.
///
/// m/s^k for the k-th, world frame.
pub(crate) type Sample = [Vector3<f64>; 5];

impl Curve {
    /// A given profile; `None` if it has no legs.
    pub(crate) fn new(profile: &Profile) -> Option<Self> {
        (!profile.legs.is_empty()).then(|| Self { legs: profile.legs.clone(), leg: 0, tau: 0.0 })
    }

    /// The minimum-snap curve through waypoints.
    ///
    /// # Errors
    /// Waypoints that have no such curve.
    pub(crate) fn through(waypoints: &[Point3<f64>], pace: &Pace) -> Result<Self, MinimumSnapError> {
        let times = pace.leg_times(waypoints);
        let segments = minimum_snap(waypoints, &times)?;
        let legs = segments
            .into_iter()
            .zip(times)
            .map(|(coefficients, duration)| ProfileLeg { duration, coefficients })
            .collect();
        Ok(Self { legs, leg: 0, tau: 0.0 })
    }

    /// Without its clock.
    pub(super) fn into_profile(self) -> Profile {
        Profile { legs: self.legs }
    }

    /// Lets `dt` s pass on the reference's clock, which stops at the end.
    pub(crate) fn advance(&mut self, dt: f64) {
        self.tau += dt;
        while self.leg + 1 < self.legs.len() && self.tau >= self.legs[self.leg].duration {
            self.tau -= self.legs[self.leg].duration;
            self.leg += 1;
        }
        self.tau = self.tau.min(self.legs[self.leg].duration);
    }

    /// The reference now. At its end it stands still.
    pub(crate) fn sample(&self) -> Sample {
        let leg = &self.legs[self.leg];
        let mut sample = [0, 1, 2, 3, 4].map(|order| leg.derivative(self.tau, order));
        if self.schedule().over {
            sample[1..].fill(Vector3::zeros());
        }
        sample
    }

    /// Where the clock stands.
    pub(crate) fn schedule(&self) -> Schedule {
        let over = self.leg + 1 == self.legs.len() && self.tau >= self.legs[self.leg].duration;
        Schedule { leg: self.leg, over }
    }
}

/// How fast a robot is to fly along a curve that it makes for itself.
///
/// For robots that make their own curve; a planned profile has times of its own.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Pace {
    /// Half a g, or half of what the thrust leaves, m/s².
    acceleration: f64,
    max_speed: f64,
    rule: SegmentTimes,
}

impl Pace {
    /// That of a robot.
    pub(crate) fn new(robot: &Quadrotor, rule: SegmentTimes) -> Self {
        let spare = robot.max_thrust() / robot.mass - robot.gravity;
        let acceleration = 0.5 * robot.gravity.min(spare.max(0.1 * robot.gravity));
        Self { acceleration, max_speed: robot.max_speed, rule }
    }

    /// T = √(7.51 L/a), the time in which the rest-to-rest polynomial of length L peaks at the acceleration a; longer
    /// where its peak speed 2.19 L/T would pass the robot's top speed. By length: the same total, shared out by L.
    fn leg_times(&self, waypoints: &[Point3<f64>]) -> Vec<f64> {
        let lengths: Vec<f64> = waypoints.windows(2).map(|pair| (pair[1] - pair[0]).norm()).collect();
        let time = |l: &f64| (7.513 * l / self.acceleration).sqrt().max(2.1875 * l / self.max_speed);
        let mut times: Vec<f64> = lengths.iter().map(time).collect();
        if self.rule == SegmentTimes::Length {
            let (total, length): (f64, f64) = (times.iter().sum(), lengths.iter().sum());
            if length > 0.0 {
                times = lengths.iter().map(|l| total * l / length).collect();
            }
        }
        times.iter().map(|t| t.max(LEAST_LEG_TIME)).collect()
    }
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;
    use crate::simulation::tests::flightgoggles;

    /// Legs of 1, 4 and 9 m, all long enough to count and short enough for the top speed.
    #[test]
    fn leg_times_follow_their_rule_and_share_their_total() {
        let x = [0.0, 1.0, 5.0, 14.0].map(|x| Point3::new(x, 2.0, 3.0));
        let pace = |rule| Pace::new(&flightgoggles(), rule);
        let by_root = pace(SegmentTimes::SqrtLength).leg_times(&x);
        let by_length = pace(SegmentTimes::Length).leg_times(&x);
        for (i, (root, length)) in [(1.0, 1.0), (2.0, 4.0), (3.0, 9.0)].into_iter().enumerate() {
            assert!((by_root[i] - root * by_root[0]).abs() < 1e-12, "{by_root:?}");
            assert!((by_length[i] - length * by_length[0]).abs() < 1e-12, "{by_length:?}");
        }
        let total = |times: &[f64]| times.iter().sum::<f64>();
        assert!((total(&by_root) - total(&by_length)).abs() < 1e-12 && by_root[0] > LEAST_LEG_TIME);
        // The middle waypoint's time is where the curve passes it.
        for (rule, times) in [(SegmentTimes::SqrtLength, by_root), (SegmentTimes::Length, by_length)] {
            let mut curve = Curve::through(&x, &pace(rule)).unwrap();
            curve.advance(times[0] + times[1]);
            assert!((curve.sample()[0] - x[2].coords).norm() < 1e-9, "{rule:?}");
        }
    }
}
