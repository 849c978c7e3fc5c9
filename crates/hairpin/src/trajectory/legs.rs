//! A drive over several waypoints: the commands of each leg, and the speeds at which they are driven.

use serde::{Deserialize, Serialize};

use super::drive::{Motion, Planar, Segment};
use super::speed::{SpeedProfile, Timing};

/// One leg of a [`Drive`]: what is commanded from one waypoint to the next.
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
}

impl DriveLeg {
    /// Speed and time along the leg.
    pub fn timing(&self) -> Timing {
        Timing::new(&self.speed, &self.segments)
    }

    /// Whether the vehicle stands at the leg's beginning and at its end, as far as the leg knows: before and after turns in place.
    pub fn turns_at_ends(&self) -> [bool; 2] {
        let turns = |segment: Option<&Segment>| segment.is_some_and(|s| matches!(s.motion, Motion::Turn { .. }));
        [turns(self.segments.first()), turns(self.segments.last())]
    }
}

/// The path of a whole mission, leg after leg: the witness of a ground vehicle's trajectory.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Drive {
    /// The legs in the order they are driven; each begins where the one before ends, and as fast.
    pub legs: Vec<DriveLeg>,
    /// The highest speed along the path, m/s, > 0.
    pub speed: f64,
    /// Commanded rate of turns in place, rad/s, > 0.
    pub turn_rate: f64,
    /// Direction of travel in the body, rad: 0 along x, left positive.
    pub direction: f64,
}

impl Drive {
    /// Duration of leg `index` as it is commanded, s: that of its speeds, and radians over turn rate.
    pub fn leg_time(&self, index: usize) -> f64 {
        let leg = &self.legs[index];
        let timing = leg.timing();
        let turned: f64 = leg.segments.iter().map(|segment| segment.turn_rad().abs()).sum();
        timing.time_at(timing.length()) + turned / self.turn_rate
    }
}

#[cfg(test)]
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
        };
        assert_eq!(leg.turns_at_ends(), [false, true]);
        let stopping = SpeedProfile::Trapezoid { start: 2.0, cruise: 2.0, end: 2.0, acceleration: 1.0 };
        let legs = vec![leg.clone(), DriveLeg { speed: stopping, ..leg }];
        let drive = Drive { legs, speed: 2.0, turn_rate: 0.5, direction: 0.0 };
        assert_eq!(drive.leg_time(0), 4.0 + 3.0);
        // 2 m at 2 m/s and 2 m to rest in 2 s; then, from rest to rest over 4 m, 2 s up and 2 s down.
        assert!((drive.leg_time(1) - (1.0 + 2.0 + 4.0 + 3.0)).abs() < 1e-12, "{}", drive.leg_time(1));
    }
}
