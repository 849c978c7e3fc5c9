//! Speed along a stretch: constant, a ramp, or a trapezoid, and the time that each makes of the metres.
//!
//! ```text
//! constant    v
//! ramp        v² = v₀² + (v_f² − v₀²) s/L
//! trapezoid   v₀ → cruise → v_f with ±a; top² = a L + (v₀² + v_f²)/2 where the cruise is not reached
//! ```
//!
//! Everything is piecewise of constant acceleration over metres, so that v² is piecewise linear in s, and time and
//! place are each other's closed inverse.

use serde::{Deserialize, Serialize};
use thiserror::Error;

/// How speed depends on time, m/s. Where a drive stops on the way (to change gear or to turn in place) ramps and
/// trapezoids stop there too; a constant speed knows no stops.
///
/// The velocity constraint of a boundary-value drive (v at both ends): the path does not depend on it unless the
/// steering lags, which is why speed is laid over a solved path.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum SpeedProfile {
    /// The same all along.
    Constant {
        /// > 0.
        speed: f64,
    },
    /// Linear in time, and so constant in acceleration: v² = v₀² + (v_f² − v₀²) s/L.
    Ramp {
        /// v₀ ≥ 0.
        start: f64,
        /// v_f ≥ 0; one of both is more than 0.
        end: f64,
    },
    /// From v₀ to the cruising speed, on with it, and from there to v_f; where there is no room for it, with a lower
    /// top.
    Trapezoid {
        /// v₀, from 0 to `cruise`.
        start: f64,
        /// > 0.
        cruise: f64,
        /// v_f, from 0 to `cruise`.
        end: f64,
        /// Of both slopes, m/s², > 0.
        acceleration: f64,
    },
}

/// Why numbers are no profile.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[error("{field} = {value}: must be {bound}")]
pub struct SpeedError {
    /// `v0`, `vf`, `cruise`, `speed` or `acceleration`.
    pub field: &'static str,
    /// The offending value.
    pub value: f64,
    /// What it must be.
    pub bound: &'static str,
}

impl SpeedProfile {
    /// The profile itself, if its numbers make one.
    ///
    /// Nothing that passed is NaN, infinite or stands still from end to end.
    ///
    /// # Errors
    /// The first number that is not finite or out of its bound.
    pub fn checked(self) -> Result<Self, SpeedError> {
        let hold =
            |good: bool, field, value, bound| if good { Ok(()) } else { Err(SpeedError { field, value, bound }) };
        let positive = |field, value: f64| hold(value > 0.0 && value.is_finite(), field, value, "more than 0 m/s");
        let up_to = |field, value: f64, most: f64, bound| hold((0.0..=most).contains(&value), field, value, bound);
        match self {
            Self::Constant { speed } => positive("speed", speed)?,
            Self::Ramp { start, end } => {
                up_to("v0", start, f64::MAX, "a number of 0 m/s or more")?;
                up_to("vf", end, f64::MAX, "a number of 0 m/s or more")?;
                hold(start + end > 0.0, "vf", end, "more than 0 m/s where v0 is 0")?;
            }
            Self::Trapezoid { start, cruise, end, acceleration } => {
                positive("cruise", cruise)?;
                up_to("v0", start, cruise, "a number from 0 m/s to the cruising speed")?;
                up_to("vf", end, cruise, "a number from 0 m/s to the cruising speed")?;
                hold(acceleration > 0.0 && acceleration.is_finite(), "acceleration", acceleration, "more than 0 m/s²")?;
            }
        }
        Ok(self)
    }

    /// v₀, m/s.
    pub fn start(&self) -> f64 {
        match *self {
            Self::Constant { speed } => speed,
            Self::Ramp { start, .. } | Self::Trapezoid { start, .. } => start,
        }
    }

    /// v_f, m/s.
    pub fn end(&self) -> f64 {
        match *self {
            Self::Constant { speed } => speed,
            Self::Ramp { end, .. } | Self::Trapezoid { end, .. } => end,
        }
    }

    /// The highest speed it may come to, m/s.
    pub fn top(&self) -> f64 {
        match *self {
            Self::Constant { speed } => speed,
            Self::Ramp { start, end } => start.max(end),
            Self::Trapezoid { cruise, .. } => cruise,
        }
    }

    /// Whether the speed is the same all along.
    pub fn is_constant(&self) -> bool {
        match *self {
            Self::Constant { .. } => true,
            Self::Ramp { start, end } => start == end,
            Self::Trapezoid { start, cruise, end, .. } => start == cruise && end == cruise,
        }
    }

    /// The speeds of a stretch of `length` metres, ≥ 0, that is driven from `start` to `end`, which are the profile's
    /// own or 0.
    ///
    /// ```text
    /// a = given (trapezoid), or top²/length for a ramp between two stops, up over one half, down over the other
    /// top² = min(cruise², a L + (v₀² + v_f²)/2)
    /// up = |top² − v₀²|/2a,   down = |top² − v_f²|/2a,   level = L − up − down
    /// ```
    ///
    /// Where top would be below the faster end, a single phase from `start` to `end` replaces all three, at |v_f² −
    /// v₀²|/2L, which is harder than a. Stretches of no length keep both speeds, which [`Speeds::hardest`] tells as
    /// infinite where they differ.
    pub(super) fn between(&self, start: f64, end: f64, length: f64) -> Speeds {
        let (cruise, acceleration) = match *self {
            Self::Constant { speed } => {
                return Speeds::of([(length, speed, speed), (0.0, speed, speed), (0.0, speed, speed)]);
            }
            Self::Ramp { .. } if start + end > 0.0 => {
                return Speeds::of([(length, start, end), (0.0, end, end), (0.0, end, end)]);
            }
            // From rest to rest there is no ramp: up to the higher of its speeds, and down again.
            Self::Ramp { .. } => (self.top(), self.top() * self.top() / length),
            Self::Trapezoid { cruise, acceleration, .. } => (cruise, acceleration),
        };
        let metres = |from: f64, to: f64| (to * to - from * from).abs() / (2.0 * acceleration);
        let top_squared = acceleration * length + 0.5 * (start * start + end * end);
        let top = cruise.min(top_squared.sqrt());
        if length <= 0.0 || top < start.max(end) {
            // No room even for the one slope: it is steeper than was asked for, and says so.
            return Speeds::of([(length, start, end), (0.0, end, end), (0.0, end, end)]);
        }
        let (up, down) = (metres(start, top), metres(top, end));
        Speeds::of([(up, start, top), ((length - up - down).max(0.0), top, top), (down, top, end)])
    }

    /// The speeds of a drive of `length` metres without stops.
    ///
    /// `length` in m, ≥ 0. Where there is no room for both slopes the one that is needed is steeper than asked;
    /// [`Speeds::hardest`] tells.
    pub fn over(&self, length: f64) -> Speeds {
        self.between(self.start(), self.end(), length)
    }
}

impl From<f64> for SpeedProfile {
    /// A constant speed, m/s.
    fn from(speed: f64) -> Self {
        Self::Constant { speed }
    }
}

/// Constant acceleration over some metres.
///
/// `length` m, `from` and `to` m/s: v² is linear in the metres.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Phase {
    length: f64,
    from: f64,
    to: f64,
}

impl Phase {
    /// v, m/s, after `s` metres: v² = from² + (to² − from²) s/length.
    fn speed(&self, s: f64) -> f64 {
        if self.from == self.to || self.length <= 0.0 {
            return self.from;
        }
        if s >= self.length {
            return self.to;
        }
        let share = (s / self.length).max(0.0);
        (self.from * self.from + (self.to * self.to - self.from * self.from) * share).sqrt()
    }

    /// t = 2 s/(v₀ + v(s)): the mean speed of constant acceleration is the mean of both speeds. Needs no division by
    /// the acceleration, so that constant speeds are no special case.
    fn time(&self, s: f64) -> f64 {
        if s <= 0.0 { 0.0 } else { 2.0 * s / (self.from + self.speed(s)) }
    }

    /// (v_to² − v_from²)/2 length, m/s²; infinite where the speed changes in no metres.
    fn acceleration(&self) -> f64 {
        if self.from == self.to { 0.0 } else { (self.to * self.to - self.from * self.from) / (2.0 * self.length) }
    }
}

/// Speed and time along one stretch: up to three phases of constant acceleration.
///
/// ```
/// use hairpin::trajectory::SpeedProfile;
///
/// let profile = SpeedProfile::Trapezoid { start: 0.0, cruise: 2.0, end: 0.0, acceleration: 1.0 }.checked()?;
/// let speeds = profile.over(10.0); // 2 m up, 6 m at 2 m/s, 2 m down
/// assert!((speeds.duration() - 7.0).abs() < 1e-12 && speeds.speed_at(1.0) == f64::sqrt(2.0));
/// assert!((speeds.place_at(speeds.time_at(3.7)) - 3.7).abs() < 1e-12);
/// # Ok::<(), hairpin::trajectory::SpeedError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Speeds {
    phases: [Phase; 3],
}

impl Speeds {
    fn of(phases: [(f64, f64, f64); 3]) -> Self {
        Self { phases: phases.map(|(length, from, to)| Phase { length, from, to }) }
    }

    /// Metres.
    pub fn length(&self) -> f64 {
        self.phases.iter().map(|phase| phase.length).sum()
    }

    /// Seconds; infinite for a stretch that ends at rest from rest without a way between.
    pub fn duration(&self) -> f64 {
        self.phases.iter().map(|phase| phase.time(phase.length)).sum()
    }

    /// The phase that is under way at `s`, and how far into it and how late that is.
    fn phase_at(&self, s: f64) -> (&Phase, f64, f64) {
        let (mut s, mut time) = (s, 0.0);
        for phase in &self.phases[..2] {
            if s < phase.length {
                return (phase, s, time);
            }
            s -= phase.length;
            time += phase.time(phase.length);
        }
        (&self.phases[2], s, time)
    }

    /// Speed after `s` metres, m/s.
    pub fn speed_at(&self, s: f64) -> f64 {
        let (phase, s, _) = self.phase_at(s);
        phase.speed(s)
    }

    /// dv/dt after `s` metres, m/s².
    ///
    /// At a joint of two phases that of the later one.
    pub fn acceleration_at(&self, s: f64) -> f64 {
        self.phase_at(s).0.acceleration()
    }

    /// Seconds after `s` metres.
    pub fn time_at(&self, s: f64) -> f64 {
        let (phase, s, before) = self.phase_at(s);
        before + phase.time(s.min(phase.length))
    }

    /// Metres after `time` seconds: the inverse of [`Speeds::time_at`].
    ///
    /// s = Σ lengths before + v₀ t + ½ a t² in the phase under way. Times below 0 count as 0, times beyond the end
    /// give the stretch's length.
    pub fn place_at(&self, time: f64) -> f64 {
        let (mut time, mut s) = (time.max(0.0), 0.0);
        for phase in &self.phases {
            let duration = phase.time(phase.length);
            if time < duration {
                return s + time * (phase.from + 0.5 * phase.acceleration() * time);
            }
            time -= duration;
            s += phase.length;
        }
        s
    }

    /// Largest |dv/dt|, m/s².
    pub fn hardest(&self) -> f64 {
        self.phases.iter().map(|phase| phase.acceleration().abs()).fold(0.0, f64::max)
    }

    /// The moments, s, at which the acceleration changes.
    pub fn changes(&self) -> [f64; 2] {
        let first = self.phases[0].time(self.phases[0].length);
        [first, first + self.phases[1].time(self.phases[1].length)]
    }

    /// Metres, counted on from `s`, and the speed there, at both ends of every phase; v² is linear between.
    pub(super) fn knots_from(&self, mut s: f64) -> [[f64; 2]; 6] {
        let mut knots = [[0.0; 2]; 6];
        for (ends, phase) in knots.chunks_exact_mut(2).zip(self.phases) {
            ends[0] = [s, phase.from];
            s += phase.length;
            ends[1] = [s, phase.to];
        }
        knots
    }
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;

    const TRAPEZOID: SpeedProfile = SpeedProfile::Trapezoid { start: 0.0, cruise: 2.0, end: 1.0, acceleration: 0.5 };

    #[test]
    fn profiles_are_the_closed_forms_of_constant_acceleration() {
        let ramp = SpeedProfile::Ramp { start: 1.0, end: 3.0 }.over(8.0);
        assert!((ramp.duration() - 4.0).abs() < 1e-12 && (ramp.hardest() - 0.5).abs() < 1e-12);
        assert!((ramp.speed_at(3.0) - 2.0).abs() < 1e-12 && (ramp.time_at(3.0) - 2.0).abs() < 1e-12);
        // Up in 4 s and 4 m, down in 2 s and 3 m, and 3 m at 2 m/s between.
        let all = TRAPEZOID.over(10.0);
        assert!((all.duration() - 7.5).abs() < 1e-12 && all.changes() == [4.0, 5.5]);
        assert!((all.speed_at(5.0) - 2.0).abs() < 1e-12 && (all.speed_at(10.0) - 1.0).abs() < 1e-12);
        // Too short for the cruise: a triangle with the same slopes.
        let short = TRAPEZOID.over(4.0);
        assert!((short.hardest() - 0.5).abs() < 1e-12 && short.speed_at(2.5) < 2.0);
        assert!((short.length() - 4.0).abs() < 1e-12);
        // Too short for the change itself: steeper than it may be.
        assert!(
            SpeedProfile::Trapezoid { start: 2.0, cruise: 2.0, end: 0.0, acceleration: 0.5 }.over(1.0).hardest() > 1.9
        );
    }

    #[test]
    fn places_and_times_are_inverse_and_speed_is_their_derivative() {
        for (profile, length) in
            [(TRAPEZOID, 10.0), (TRAPEZOID, 3.0), (SpeedProfile::Ramp { start: 2.0, end: 0.0 }, 4.0)]
        {
            let speeds = profile.over(length);
            for i in 0..200 {
                let time = speeds.duration() * (f64::from(i) + 0.5) / 200.0;
                let s = speeds.place_at(time);
                assert!((speeds.time_at(s) - time).abs() < 1e-9, "{profile:?} {time}");
                let slope = (speeds.place_at(time + 1e-6) - speeds.place_at(time - 1e-6)) / 2e-6;
                assert!((slope - speeds.speed_at(s)).abs() < 1e-5, "{profile:?} {time}: {slope}");
            }
            assert!((speeds.place_at(1e9) - length).abs() < 1e-12);
        }
    }

    #[test]
    fn numbers_that_make_no_profile_are_refused_by_name() {
        let refused = |profile: SpeedProfile| profile.checked().unwrap_err().field;
        assert_eq!(refused(0.0.into()), "speed");
        assert_eq!(refused(SpeedProfile::Ramp { start: 0.0, end: 0.0 }), "vf");
        assert_eq!(refused(SpeedProfile::Ramp { start: f64::NAN, end: 1.0 }), "v0");
        let with = |start, cruise, acceleration| SpeedProfile::Trapezoid { start, cruise, end: 0.0, acceleration };
        assert_eq!(
            [with(2.0, 1.0, 1.0), with(0.0, 0.0, 1.0), with(0.0, 1.0, 0.0)].map(refused),
            ["v0", "cruise", "acceleration"]
        );
        assert!(TRAPEZOID.checked().is_ok());
    }
}
