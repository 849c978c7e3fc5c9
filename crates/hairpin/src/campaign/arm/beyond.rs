//! Joints of runs and logs that stand where no joint of the arm can: another unit, another arm's, or angles that went
//! on turning.

use super::ArmSetup;
use crate::robot::arm::AXES;
use crate::trajectory::Track;

/// So much beyond its bounds a joint may be told to stand, rad: encoders have noise, gears play, and tables rounded
/// numbers.
const ALLOWED: f64 = 0.5 * std::f64::consts::PI / 180.0;
/// Who stands farther beyond them does not stand there: the unit is another, rad.
const ANOTHER_UNIT: f64 = std::f64::consts::TAU;

/// A joint beyond its bounds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Beyond {
    /// From 1.
    pub axis: usize,
    /// Where it stands, rad.
    pub angle: f64,
    /// Its bounds, rad.
    pub bounds: [f64; 2],
    /// When, s.
    pub at: f64,
}

impl Beyond {
    fn by(&self) -> f64 {
        (self.bounds[0] - self.angle).max(self.angle - self.bounds[1])
    }

    /// Why such a motion decides nothing: `axis 1 stands at 519.8° at t = 3.20 s, and its range is -165.0° to 165.0°
    /// (0.5° beyond are allowed for noise and play): no joint of this arm stands there`.
    pub fn in_words(&self) -> String {
        let [angle, lower, upper] = [self.angle, self.bounds[0], self.bounds[1]].map(f64::to_degrees);
        format!(
            "axis {} stands at {angle:.1}° at t = {:.2} s, and its range is {lower:.1}° to {upper:.1}° ({:.1}° beyond are \
             allowed for noise and play): no joint of this arm stands there",
            self.axis,
            self.at,
            ALLOWED.to_degrees()
        )
    }

    /// Why a log with it is refused, the joint called `name`: more than a turn beyond its bounds it is in another unit.
    pub fn refused(&self, name: &str) -> Option<String> {
        let [angle, lower, upper] = [self.angle, self.bounds[0], self.bounds[1]].map(f64::to_degrees);
        (self.by() > ANOTHER_UNIT).then(|| {
            format!(
                "{name} is at {:.2} rad, {angle:.0}°, and its range is {lower:.0}° to {upper:.0}°: another unit, or another \
                 arm's (JointState is in rad, columns say theirs)",
                self.angle
            )
        })
    }
}

impl ArmSetup {
    /// The joint that stands farthest beyond its bounds in a motion with the channels `q1_rad` … `q6_rad`, the first of
    /// equals; `None` where all keep them, but for half a degree.
    pub fn beyond_bounds(&self, motion: &Track) -> Option<Beyond> {
        let axes = (0..AXES).filter_map(|axis| Some((axis, motion.channel(&format!("q{}_rad", axis + 1))?)));
        let all = axes.flat_map(|(axis, angles)| {
            let limit = &self.station.arm.limits[axis];
            let bounds = [limit.lower, limit.upper];
            angles.iter().zip(motion.times()).map(move |(angle, at)| Beyond {
                axis: axis + 1,
                angle: *angle,
                bounds,
                at: *at,
            })
        });
        let farthest = all.reduce(|most, one| if one.by() > most.by() { one } else { most });
        farthest.filter(|one| one.by() > ALLOWED)
    }
}
