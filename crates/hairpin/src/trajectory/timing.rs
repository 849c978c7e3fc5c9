//! Speed and time along a whole drive: stretches between its stops.
//!
//! A stop is where the gear changes or the vehicle turns in place. Stretches between stops are timed apart: rest at
//! every stop, the profile's own speeds at the outer ends only.

use super::drive::{MOST_SEGMENTS, Motion, Segment};
use super::speed::{SpeedProfile, Speeds};

/// Those of [`MOST_SEGMENTS`], and what is driven while the first of them does not act yet.
const MOST_STRETCHES: usize = MOST_SEGMENTS + 1;

/// Speed and time along a whole drive, with its stops.
///
/// On the stack; a query walks the stretches, of which a leg has one or two.
///
/// ```text
/// t(s) = Σ durations of the stretches before + t_stretch(s)          without the time of turns in place
/// ```
///
/// `stretches` are (m, speeds) in driving order; `constant` is set where no stretch has a stop or a slope, and then
/// answers everything.
#[derive(Debug, Clone, Copy)]
pub struct Timing {
    stretches: [(f64, Speeds); MOST_STRETCHES],
    len: usize,
    constant: Option<f64>,
    length: f64,
}

impl Timing {
    /// The timing of `segments` under `profile`.
    ///
    /// # Panics
    /// If there are more stretches than a list of segments, and one that is held before it, can have: a mistake of the
    /// caller's.
    pub fn new(profile: &SpeedProfile, segments: &[Segment]) -> Self {
        let rest = SpeedProfile::from(1.0).over(0.0);
        // The sum of none is −0.
        let length = segments.iter().map(Segment::length_m).sum::<f64>() + 0.0;
        let mut timing = Self { stretches: [(0.0, rest); MOST_STRETCHES], len: 0, constant: None, length };
        if let SpeedProfile::Constant { speed } = *profile {
            timing.constant = Some(speed);
            return timing;
        }
        // Stretches: lengths, each but the first begun after a stop.
        let mut gear = None;
        let mut stopped_first = false;
        let mut stops_last = false;
        for segment in segments {
            match segment.motion {
                Motion::Turn { .. } => {
                    gear = None;
                    stopped_first |= timing.len == 0;
                    stops_last = true;
                }
                Motion::Arc { length_m, .. } => {
                    stops_last = false;
                    if gear != Some(segment.gear) {
                        assert!(timing.len < MOST_STRETCHES, "a drive of more than {MOST_STRETCHES} segments");
                        timing.stretches[timing.len].0 = 0.0;
                        timing.len += 1;
                    }
                    gear = Some(segment.gear);
                    timing.stretches[timing.len - 1].0 += length_m;
                }
            }
        }
        if timing.len <= 1 && !stopped_first && !stops_last && profile.is_constant() {
            timing.constant = Some(profile.start());
            return timing;
        }
        for index in 0..timing.len {
            let length = timing.stretches[index].0;
            let start = if index == 0 && !stopped_first { profile.start() } else { 0.0 };
            let end = if index + 1 == timing.len && !stops_last { profile.end() } else { 0.0 };
            timing.stretches[index].1 = profile.between(start, end, length);
        }
        timing
    }

    /// The stretch that holds `s`, where in it that is, and the seconds before it.
    ///
    /// `s` beyond the end is the end of the last stretch; a stop belongs to the stretch after it. `None` of a drive
    /// that only turns.
    fn stretch_at(&self, s: f64) -> Option<(&Speeds, f64, f64)> {
        let (mut s, mut time) = (s, 0.0);
        for (index, (length, speeds)) in self.stretches[..self.len].iter().enumerate() {
            if s < *length || index + 1 == self.len {
                return Some((speeds, s.min(*length), time));
            }
            s -= length;
            time += speeds.duration();
        }
        None
    }

    /// Metres of the drive.
    pub fn length(&self) -> f64 {
        self.length
    }

    /// Whether the speed is the same all along.
    pub fn is_constant(&self) -> bool {
        self.constant.is_some()
    }

    /// Speed after `s` metres, m/s.
    pub fn speed_at(&self, s: f64) -> f64 {
        self.constant.unwrap_or_else(|| self.stretch_at(s).map_or(0.0, |(speeds, s, _)| speeds.speed_at(s)))
    }

    /// dv/dt after `s` metres, m/s².
    pub fn acceleration_at(&self, s: f64) -> f64 {
        self.constant
            .map_or_else(|| self.stretch_at(s).map_or(0.0, |(speeds, s, _)| speeds.acceleration_at(s)), |_| 0.0)
    }

    /// Seconds of driving after `s` metres; turns in place take more.
    pub fn time_at(&self, s: f64) -> f64 {
        match self.constant {
            Some(speed) => s / speed,
            None => self.stretch_at(s).map_or(0.0, |(speeds, s, before)| before + speeds.time_at(s)),
        }
    }

    /// Seconds from `s` to `s + h` metres.
    ///
    /// One division where the speed is constant; else a difference of two times, which for steps far below the drive's
    /// length loses digits.
    pub fn time_over(&self, s: f64, h: f64) -> f64 {
        match self.constant {
            Some(speed) => h / speed,
            None => self.time_at(s + h) - self.time_at(s),
        }
    }

    /// Speed at the end of the drive, m/s.
    pub fn end_speed(&self) -> f64 {
        self.speed_at(self.length)
    }

    /// Highest speed, m/s; 0 of a drive that only turns, unless its speed is constant.
    ///
    /// max of v over the knots, as v² is linear between them.
    pub fn fastest(&self) -> f64 {
        self.knots().iter().map(|[_, speed]| *speed).fold(0.0, f64::max)
    }

    /// Largest |dv/dt|, m/s².
    pub fn hardest(&self) -> f64 {
        self.stretches[..self.len].iter().map(|(_, speeds)| speeds.hardest()).fold(0.0, f64::max)
    }

    /// Metres with the speed there, v² linear between: what another integration needs to know.
    ///
    /// Pairs (m, m/s): the proof integrates time over them by its own means, ∫ ds/v.
    pub fn knots(&self) -> Vec<[f64; 2]> {
        if let Some(speed) = self.constant {
            return vec![[0.0, speed]];
        }
        let mut knots = Vec::new();
        let mut s = 0.0;
        for (length, speeds) in &self.stretches[..self.len] {
            knots.extend(speeds.knots_from(s));
            s += length;
        }
        knots.dedup();
        knots
    }
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;
    use crate::trajectory::drive::Gear;

    #[test]
    fn drives_stop_where_gears_change_and_vehicles_turn() {
        let turn = Segment { motion: Motion::Turn { angle_rad: 1.0 }, gear: Gear::Forward };
        let drive = [
            Segment::straight(3.0, Gear::Forward),
            Segment::straight(5.0, Gear::Forward),
            Segment::straight(6.0, Gear::Reverse),
            turn,
            Segment::straight(7.0, Gear::Reverse),
        ];
        let timing =
            Timing::new(&SpeedProfile::Trapezoid { start: 1.0, cruise: 1.5, end: 0.5, acceleration: 0.5 }, &drive);
        for (s, expected) in [(0.0, 1.0), (3.0, 1.5), (14.0, 0.0), (17.0, 1.5), (21.0, 0.5)] {
            assert!((timing.speed_at(s) - expected).abs() < 1e-6, "{s}: {}", timing.speed_at(s));
        }
        assert!(timing.speed_at(8.0) < 1e-6 && timing.speed_at(8.0 - 1e-9) < 1e-3);
        let parts: f64 = (0..210).map(|i| timing.time_over(0.1 * f64::from(i), 0.1)).sum();
        assert!((parts - timing.time_at(21.0)).abs() < 1e-9 && (timing.hardest() - 0.5).abs() < 1e-12);
        assert_eq!(timing.fastest(), 1.5);
        let knots = timing.knots();
        assert!(
            knots.windows(2).all(|pair| pair[0][0] <= pair[1][0]) && knots.last() == Some(&[21.0, 0.5]),
            "{knots:?}"
        );
        let none = Timing::new(&SpeedProfile::from(1.0), &[]);
        assert!(none.length().is_sign_positive() && none.time_at(none.length()).is_sign_positive());
        // The same speed all along, but for the stops.
        let stopping = SpeedProfile::Trapezoid { start: 1.5, cruise: 1.5, end: 1.5, acceleration: 0.5 };
        let timing = Timing::new(&stopping, &drive);
        assert!(timing.speed_at(8.0 - 1e-9) < 1e-3 && timing.speed_at(4.0) == 1.5 && !timing.is_constant());
        assert!(Timing::new(&stopping, &drive[..2]).is_constant());
        // 1 m from rest to rest is half a metre up and half a metre down: v² = 2 · 0.5 · 0.5.
        let short = SpeedProfile::Trapezoid { start: 0.0, cruise: 1.5, end: 0.0, acceleration: 0.5 };
        let short = Timing::new(&short, &[Segment::straight(1.0, Gear::Forward)]);
        assert!((short.fastest() - 0.5_f64.sqrt()).abs() < 1e-12, "{}", short.fastest());
        assert_eq!(Timing::new(&stopping, &drive[3..4]).fastest(), 0.0);
        let even = Timing::new(&0.5.into(), &drive);
        assert_eq!((even.time_at(21.0), even.speed_at(8.0), even.hardest()), (42.0, 0.5, 0.0));
    }
}
