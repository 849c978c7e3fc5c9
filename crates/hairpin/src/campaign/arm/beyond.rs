//! Joints of runs and logs that stand where no joint of the arm can, or turn as none does: another unit, another arm's,
//! a clock that is wrong, or angles that went on turning.

use super::ArmSetup;
use crate::robot::arm::{AXES, JointLimit};
use crate::trajectory::Track;

/// So much beyond its bounds a joint may be told to stand, rad: encoders have noise, gears play, and tables rounded
/// numbers.
const ALLOWED: f64 = 0.5 * std::f64::consts::PI / 180.0;
/// Who stands farther beyond them does not stand there: the unit is another, rad.
const ANOTHER_UNIT: f64 = std::f64::consts::TAU;

/// Mean speeds are looked at over so long (s), and from one sample to the next: noise counts for less over longer.
const LOOK: f64 = 0.1;
/// So much faster than its largest speed a joint may be told to turn, as a share of it: rated speeds are no walls.
const FASTER: f64 = 0.1;

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

/// A joint that turns faster than it can.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TooFast {
    /// From 1.
    pub axis: usize,
    /// Its mean speed, rad/s.
    pub speed: f64,
    /// Its largest, rad/s.
    pub limit: f64,
    /// From when, s.
    pub at: f64,
    /// For how long, s.
    pub over: f64,
}

impl TooFast {
    /// By what share of its largest speed, noise left out; NaN where it stands still in no time.
    fn by(&self) -> f64 {
        (self.speed - ALLOWED / self.over) / self.limit - 1.0
    }

    /// Why such a motion decides nothing: `axis 1 turns by 412.0°/s from t = 3.20 s on for 0.100 s, and its largest
    /// speed is 250.0°/s (10 % and 0.5° more are allowed): no joint of this arm is that fast`.
    pub fn in_words(&self) -> String {
        let [speed, limit, allowed] = [self.speed, self.limit, ALLOWED].map(f64::to_degrees);
        format!(
            "axis {} turns by {speed:.1}°/s from t = {:.2} s on for {:.3} s, and its largest speed is {limit:.1}°/s ({:.0} % and \
             {allowed:.1}° more are allowed): no joint of this arm is that fast",
            self.axis,
            self.at,
            self.over,
            1e2 * FASTER
        )
    }
}

impl ArmSetup {
    /// The joint that is the most too fast, by its share, in a motion with the channels `q1_rad` … `q6_rad`, from one
    /// sample to the next or for a tenth of a second, the first of equals; `None` where none is.
    pub fn too_fast(&self, motion: &Track) -> Option<TooFast> {
        let times = motion.times();
        let all = self.joints(motion).flat_map(|(axis, limit, angles)| {
            let from = move |i: usize, j: usize| {
                let over = times[j] - times[i];
                let speed = (angles[j] - angles[i]).abs() / over;
                TooFast { axis, speed, limit: limit.speed, at: times[i], over }
            };
            let mut far = 0;
            (0..times.len().saturating_sub(1)).flat_map(move |i| {
                while far + 1 < times.len() && times[far] - times[i] < LOOK {
                    far += 1;
                }
                [from(i, i + 1), from(i, far.max(i + 1))]
            })
        });
        let most = all.filter(|one| one.by() > FASTER);
        most.reduce(|most, one| if one.by() > most.by() { one } else { most })
    }

    /// The joint that stands farthest beyond its bounds in a motion with the channels `q1_rad` … `q6_rad`, the first of
    /// equals; `None` where all keep them, but for half a degree.
    pub fn beyond_bounds(&self, motion: &Track) -> Option<Beyond> {
        let all = self.joints(motion).flat_map(|(axis, limit, angles)| {
            let bounds = [limit.lower, limit.upper];
            angles.iter().zip(motion.times()).map(move |(angle, at)| Beyond { axis, angle: *angle, bounds, at: *at })
        });
        let farthest = all.reduce(|most, one| if one.by() > most.by() { one } else { most });
        farthest.filter(|one| one.by() > ALLOWED)
    }

    /// The joints of which `motion` has channels: number from 1, limits, and angle at each sample, rad.
    pub(super) fn joints<'a>(&'a self, motion: &'a Track) -> impl Iterator<Item = (usize, &'a JointLimit, &'a [f64])> {
        let of = move |axis: usize| {
            Some((axis, &self.station.arm.limits[axis - 1], motion.channel(&format!("q{axis}_rad"))?))
        };
        (1..=AXES).filter_map(of)
    }
}
