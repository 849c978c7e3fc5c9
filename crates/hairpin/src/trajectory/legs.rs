//! A drive over several waypoints: the commands of each leg, and the speeds at which they are driven.
//!
//! A witness of a drive, as files keep it: segments of [`super::drive`] for each leg, the speeds over them, the
//! direction of travel. Poses at both ends are kept beside the commands, so that a replay can start each leg where it
//! says it starts and be held to where it says it ends.

use nalgebra::Point3;
use serde::{Deserialize, Serialize};

use super::direction::Direction;
use super::drive::{Motion, Planar, Segment};
use super::speed::SpeedProfile;
use super::timing::Timing;

/// One leg of a [`Drive`]: what is commanded from one waypoint to the next.
///
/// `from` and `to` are what was solved for; between them the segments, integrated from `from` on the ground the drive
/// is for, end at `to` within the generator's precision.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct DriveLeg {
    /// Pose and curvature at its first waypoint.
    pub from: Planar,
    /// Pose and curvature at its last waypoint.
    pub to: Planar,
    /// The commands.
    pub segments: Vec<Segment>,
    /// The speeds of the commands, from the first waypoint to the last.
    pub speed: SpeedProfile,
    /// The direction of travel in the body, from the first waypoint to the last.
    pub direction: Direction,
}

/// How a waypoint of a [`Drive`] is passed.
///
/// All that two legs must agree on at a waypoint beside their speed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Passing {
    /// Pose and curvature.
    pub at: Planar,
    /// Direction of travel in the body, rad: 0 along x, left positive.
    pub direction: f64,
}

impl Passing {
    /// The same at another place: heading, curvature and direction of travel stay.
    pub fn moved_to(self, place: &Point3<f64>) -> Self {
        Self { at: Planar { x: place.x, y: place.y, ..self.at }, ..self }
    }
}

impl DriveLeg {
    /// Speed and time along the leg.
    pub fn timing(&self) -> Timing {
        Timing::new(&self.speed, &self.segments)
    }

    /// Whether the vehicle stands at the leg's beginning and at its end, as far as the leg knows: before and after
    /// turns in place.
    pub fn turns_at_ends(&self) -> [bool; 2] {
        let turns = |segment: Option<&Segment>| segment.is_some_and(|s| matches!(s.motion, Motion::Turn { .. }));
        [turns(self.segments.first()), turns(self.segments.last())]
    }
}

/// The path of a whole mission, leg after leg: the witness of a ground vehicle's trajectory.
///
/// Time is not stored: it follows from segments and speeds by [`super::Timing`], and turns in place take
/// |angle|/turn_rate.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Drive {
    /// The legs in the order they are driven; each begins where the one before ends, as fast, and in its direction of
    /// travel.
    pub legs: Vec<DriveLeg>,
    /// The highest speed along the path, m/s, > 0.
    pub speed: f64,
    /// Commanded rate of turns in place, rad/s, > 0.
    pub turn_rate: f64,
}

impl Drive {
    /// Duration of leg `index` as it is commanded, s: that of its speeds, and radians over turn rate.
    pub fn leg_time(&self, index: usize) -> f64 {
        let leg = &self.legs[index];
        let timing = leg.timing();
        let turned: f64 = leg.segments.iter().map(|segment| segment.turn_rad().abs()).sum();
        timing.time_at(timing.length()) + turned / self.turn_rate
    }

    /// How waypoint number `index` is passed; `None` beyond the last.
    pub fn passing(&self, index: usize) -> Option<Passing> {
        let leaves = |leg: &DriveLeg| Passing { at: leg.from, direction: leg.direction.start };
        let arrives = |leg: &DriveLeg| Passing { at: leg.to, direction: leg.direction.end };
        let before = || index.checked_sub(1).and_then(|leg| self.legs.get(leg)).map(arrives);
        self.legs.get(index).map(leaves).or_else(before)
    }
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;
    use crate::trajectory::drive::Gear;

    #[test]
    fn a_leg_takes_its_metres_at_their_speeds_and_its_turns() {
        let turn = Segment { motion: Motion::Turn { angle_rad: -1.5 }, gear: Gear::Forward };
        let leg = DriveLeg {
            from: Planar::default(),
            to: Planar::default(),
            segments: vec![Segment::straight(4.0, Gear::Forward), Segment::straight(4.0, Gear::Reverse), turn],
            speed: SpeedProfile::Constant { speed: 2.0 },
            direction: Direction { start: 0.1, end: 0.3 },
        };
        assert_eq!(leg.turns_at_ends(), [false, true]);
        let stopping = SpeedProfile::Trapezoid { start: 2.0, cruise: 2.0, end: 2.0, acceleration: 1.0 };
        let legs = vec![leg.clone(), DriveLeg { speed: stopping, ..leg }];
        let drive = Drive { legs, speed: 2.0, turn_rate: 0.5 };
        assert_eq!(drive.leg_time(0), 4.0 + 3.0);
        let passed: Vec<_> = (0..4).map(|index| drive.passing(index).map(|passing| passing.direction)).collect();
        assert_eq!(passed, [Some(0.1), Some(0.1), Some(0.3), None]);
        // 2 m at 2 m/s and 2 m to rest in 2 s; then, from rest to rest over 4 m, 2 s up and 2 s down.
        assert!((drive.leg_time(1) - (1.0 + 2.0 + 4.0 + 3.0)).abs() < 1e-12, "{}", drive.leg_time(1));
    }
}
