//! What a proof asks for and what it found.

use std::fmt::Display;

/// What a proof may leave open.
///
/// What a proof was held to belongs to it: reports state these beside the findings.
///
/// Absolute, not relative: a leg of 100 m is held to the same 0.1 mm as one of 1 m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tolerances {
    /// Distance from the next waypoint at the end of a leg, and from the polynomial on the way, m.
    pub position: f64,
    /// Velocity error at the end of a leg, m/s.
    pub velocity: f64,
    /// Attitude error at the end of a leg, rad.
    pub attitude: f64,
    /// Angular velocity left at the end of a leg, rad/s.
    pub rates: f64,
    /// Mismatch of the polynomials at waypoints beyond rounding, m/s^k for the k-th derivative.
    pub knots: f64,
    /// Error of any component of the integrated state, SI, estimated by halving the step.
    pub accuracy: f64,
    /// Spacing of the grid on which rotor speeds are held to their limits, s; near a limit it is refined.
    pub grid: f64,
}

impl Default for Tolerances {
    /// 0.1 mm, 0.1 mm/s, 0.001°, 0.001°/s; 1e-9 at waypoints; 1e-10; 10 ms.
    fn default() -> Self {
        let thousandth_degree = 1e-3f64.to_radians();
        Self {
            position: 1e-4,
            velocity: 1e-4,
            attitude: thousandth_degree,
            rates: thousandth_degree,
            knots: 1e-9,
            accuracy: 1e-10,
            grid: 0.01,
        }
    }
}

/// The largest (or smallest) of something, and where.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Worst {
    /// The value, SI.
    pub value: f64,
    /// The leg, numbered by its first waypoint.
    pub leg: usize,
    /// Time since the start of the flight, s.
    pub at: f64,
}

/// State at the end of the whole flight against what was claimed.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct EndError {
    /// Distance from the last waypoint, m.
    pub position: f64,
    /// Speed left, m/s.
    pub velocity: f64,
    /// Angle from level with yaw 0, rad.
    pub attitude: f64,
}

/// Something that does not hold.
///
/// `value` and `bound` in `unit`, with `value` > `bound` (of a minimum `value` < `bound`), or not a number.
#[derive(Debug, Clone, PartialEq)]
pub struct Finding {
    /// What: `legs[2].end.velocity`, `legs[0].rotor3.max`, `legs`, ….
    pub field: String,
    /// What was found, in `unit`.
    pub value: f64,
    /// What it must not exceed (or, of a minimum, fall below), in `unit`.
    pub bound: f64,
    /// SI unit; empty for pure numbers.
    pub unit: &'static str,
    /// The leg.
    pub leg: usize,
    /// Time since the start of the flight, s.
    pub at: f64,
}

/// What verification found, condition by condition.
///
/// Worst values are told whether or not they violate anything.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Proof {
    /// Leg by leg, from each leg's own start: distance from the next waypoint, m.
    pub position: Worst,
    /// Velocity error there, m/s.
    pub velocity: Worst,
    /// Angle from level there, rad.
    pub attitude: Worst,
    /// Angular velocity left there, rad/s.
    pub rates: Worst,
    /// Distance of the integrated path from the polynomial, m.
    pub path: Worst,
    /// Mismatch at waypoints: position, velocity, acceleration, jerk, m/s^k.
    pub knots: [Worst; 4],
    /// Smallest rotor speed, rad/s; negative: a rotor would have to pull.
    pub slowest_rotor: Worst,
    /// Largest rotor speed, rad/s.
    pub fastest_rotor: Worst,
    /// The whole flight in one go, without correction at waypoints; `None` if it could not be flown.
    pub open_loop: Option<EndError>,
    /// Steps of the integrator in all.
    pub steps: usize,
    /// All that does not hold; empty: the claim is proven.
    pub findings: Vec<Finding>,
}

impl Proof {
    /// Whether everything holds.
    pub fn ok(&self) -> bool {
        self.findings.is_empty()
    }
}

/// Keeps the larger.
///
/// NaN is never larger, and has to be told by a finding.
pub(super) fn note(worst: &mut Worst, value: f64, leg: usize, at: f64) {
    if value > worst.value {
        *worst = Worst { value, leg, at };
    }
}

/// Collects what does not hold of one thing at one place.
#[derive(Debug)]
pub struct Collector<'a> {
    into: &'a mut Vec<Finding>,
    about: String,
    leg: usize,
    at: f64,
}

impl<'a> Collector<'a> {
    /// Of `about`, which every field is a part of, at the start.
    pub fn about(into: &'a mut Vec<Finding>, about: &str) -> Self {
        Self { into, about: format!("{about}."), leg: 0, at: 0.0 }
    }

    /// Of a leg, at a time since the start (s).
    pub fn on_leg(into: &'a mut Vec<Finding>, leg: usize, at: f64) -> Self {
        Self { into, about: format!("legs[{leg}]."), leg, at }
    }

    /// The same on a leg, at a time since the start (s).
    pub fn at(self, leg: usize, at: f64) -> Self {
        Self { leg, at, ..self }
    }

    /// A finding unless it `holds`.
    ///
    /// `field` is appended to what the collector is about: `legs[2].` + `end.velocity`.
    pub fn unless(&mut self, holds: bool, field: impl Display, value: f64, bound: f64, unit: &'static str) {
        if !holds {
            let Self { into, about, leg, at } = self;
            into.push(Finding { field: format!("{about}{field}"), value, bound, unit, leg: *leg, at: *at });
        }
    }

    /// What does not hold, in words alone.
    ///
    /// The words are the whole field; value and bound NaN, no unit.
    pub fn refuse(&mut self, what: String) {
        let Self { into, leg, at, .. } = self;
        into.push(Finding { field: what, value: f64::NAN, bound: f64::NAN, unit: "", leg: *leg, at: *at });
    }

    /// A finding if `value` is above `bound`, or no number.
    pub fn above(&mut self, field: impl Display, value: f64, bound: f64, unit: &'static str) {
        self.unless(value <= bound, field, value, bound, unit);
    }
}
