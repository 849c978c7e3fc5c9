//! Limits, and which of them a run violates.
//!
//! A limit is a number and a sense (at most, or at least); an event is a violation without one. Their order is the
//! order in which a reader wants to know.

use super::apart::{apart, decimals_of, least};
use super::{LegMeasures, Measures};
use crate::trajectory::{Ended, Flight, Track};

/// What is within spec. A limit that is `None` is not judged; a crash and leaving the world always are.
///
/// A value equal to its limit is within spec.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limits {
    /// Largest deviation, m.
    pub deviation: Option<f64>,
    /// Largest overshoot at a waypoint, m.
    pub overshoot: Option<f64>,
    /// Smallest clearance, m.
    pub clearance: Option<f64>,
    /// Smallest angle by which the body must still lean to tip over, degrees.
    pub tip_over_margin: Option<f64>,
    /// Largest acceleration, m/s².
    pub acceleration: Option<f64>,
    /// Longest duration of a run, s.
    pub total_time: Option<f64>,
    /// Latest arrival at a waypoint after its planned time, s.
    pub late: Option<f64>,
    /// Whether a run violates that is stopped by its time limit before the last waypoint, or that claims to be done
    /// without having been there: it has not flown the mission, and what it did not fly cannot be judged.
    pub unfinished: bool,
    /// Whether a run violates that goes on after its clearance was below 0. Our own simulators end it there, as a
    /// crash; a program may not know of the obstacle.
    pub contact: bool,
}

impl Default for Limits {
    fn default() -> Self {
        Self {
            deviation: None,
            overshoot: None,
            clearance: None,
            tip_over_margin: None,
            acceleration: None,
            total_time: None,
            late: None,
            unfinished: true,
            contact: false,
        }
    }
}

/// What stands still moves less than this, m, for as long, s: what hovers keeps so still by far, and what still creeps
/// to a waypoint of the usual radius does not.
const STILL_M: f64 = 0.1;
const STILL_S: f64 = 5.0;

impl Limits {
    /// Whether there is any limit.
    pub fn are_given(&self) -> bool {
        self.given() > 0
    }

    pub(super) fn given(&self) -> usize {
        let Self { deviation, overshoot, clearance, tip_over_margin, acceleration, total_time, late, .. } = self;
        let all = [deviation, overshoot, clearance, tip_over_margin, acceleration, total_time, late];
        all.into_iter().flatten().count()
    }
}

/// One violated limit of a run, in numbers.
///
/// `what`, `unit` and the numbers are what JSON, JUnit and the sentence are made of: one form for all.
#[derive(Debug, Clone, PartialEq)]
pub struct Violation {
    /// What was measured: `deviation`, `overshoot`, `clearance`, `tip-over-margin`, `acceleration`, `total-time`,
    /// `late`; or an event: `crash`, of a ground vehicle `tip-over`, `belly-contact`, `stuck` or `off-map`, of an arm
    /// `halted`, of what flew on `contact`, `left-world`, `stalled`, `unfinished`.
    pub what: String,
    /// The measured value in `unit`; of a contact the clearance, m; of a crash of any other kind and of leaving the
    /// world the time, s; of an unfinished or stalled run the number of waypoints reached.
    pub value: f64,
    /// The limit in `unit`; of a crash of any kind and of leaving the world 0; of an unfinished or stalled run the
    /// number of waypoints.
    pub limit: f64,
    /// Unit, as printed: `m`, `m/s²`, `s`, `°`, empty.
    pub unit: String,
    /// When, s.
    pub at: f64,
    /// The leg, numbered by its first waypoint.
    pub leg: usize,
}

impl Violation {
    /// Whether the limit is a lower one.
    pub fn is_lower_limit(&self) -> bool {
        self.is_unfinished() || matches!(self.what.as_str(), "clearance" | "contact" | "tip-over-margin" | "edge")
    }

    /// Whether the run came to a bad end, of whatever kind.
    pub fn is_crash(&self) -> bool {
        let all = ["crash", "contact", "tip-over", "belly-contact", "stuck", "halted", "off-map"];
        all.contains(&self.what.as_str())
    }

    /// Whether the run ended short of its last waypoint without a crash.
    pub fn is_unfinished(&self) -> bool {
        matches!(self.what.as_str(), "stalled" | "unfinished")
    }

    /// What happened, in words, where no measured limit is violated.
    pub fn event(&self) -> Option<String> {
        Some(match self.what.as_str() {
            "crash" => "crash".into(),
            "contact" => format!("met an obstacle: clearance {}", self.printed().0),
            "tip-over" => "tipped over".into(),
            "belly-contact" => "set its underside on the ground".into(),
            "stuck" => "got stuck".into(),
            "halted" => "halted".into(),
            "off-map" => "left the map".into(),
            "left-world" => "left the world".into(),
            "stalled" => format!("stood still after {} of {} waypoints", self.value, self.limit),
            "unfinished" => format!("stopped at {} of {} waypoints", self.value, self.limit),
            _ => return None,
        })
    }

    /// Value and limit as they are printed, with their unit, and as many decimals as the limit was given with or as it
    /// takes to tell them apart.
    pub fn printed(&self) -> (String, String) {
        let (value, limit) = apart(self.value, self.limit, decimals_of(self.limit, least(&self.unit)));
        let with_unit = |number: String| match self.unit.as_str() {
            "°" => number + "°",
            unit => format!("{number} {unit}"),
        };
        (with_unit(value), with_unit(limit))
    }

    /// `deviation 0.65 m > 0.50 m at t=12.34 s`, or of an event what happened and when.
    pub fn in_words(&self) -> String {
        let finding = self.event().unwrap_or_else(|| {
            let sign = if self.is_lower_limit() { '<' } else { '>' };
            let (what, (value, limit)) = (self.what.replace('-', " "), self.printed());
            format!("{what} {value} {sign} {limit}")
        });
        format!("{finding} at t={:.2} s", self.at)
    }

    /// Rank (events before measured limits) and excess over the limit relative to it.
    fn gravity(&self) -> (u8, f64) {
        let rank = match self.what.as_str() {
            _ if self.is_crash() => 3,
            "left-world" => 2,
            _ if self.is_unfinished() => 1,
            _ => 0,
        };
        (rank, self.relative_excess())
    }

    /// How far the limit is broken, as a share of it: |value − limit|/|limit|; of a limit of 0 |value|.
    pub fn relative_excess(&self) -> f64 {
        let excess = if self.is_lower_limit() { self.limit - self.value } else { self.value - self.limit };
        if self.limit.abs() > 0.0 { excess / self.limit.abs() } else { excess }
    }
}

/// The limits that a run violates, the gravest first: a crash, leaving the world, an unfinished mission, then by
/// excess over the limit relative to the limit; equals in the order of [`Limits`].
///
/// Relative excess is (value − limit)/|limit|, of a limit of 0 the excess itself. An acceleration or a
/// distance that is beyond its limit by no more than the recording resolves violates nothing.
///
/// ```
/// use hairpin::judgement::{LegMeasures, Limits, Measures, violations};
/// use hairpin::trajectory::{Ended, Flight, Track};
/// use nalgebra::Isometry3;
///
/// let track = Track::new(vec![0.0, 1.0], vec![Isometry3::identity(); 2], vec![])?;
/// let flight = Flight { track, ended: Ended::Done, left_world: None, reached: vec![Some(0.0), Some(1.0)] };
/// let measures = Measures { max_deviation: 0.65, legs: vec![LegMeasures::default()], ..Measures::default() };
/// let found = violations(&measures, &flight, &Limits { deviation: Some(0.5), ..Limits::default() });
/// assert_eq!(found.len(), 1);
/// assert_eq!(found[0].printed(), ("0.65 m".into(), "0.50 m".into()));
/// # Ok::<(), hairpin::trajectory::TrackError>(())
/// ```
pub fn violations(measures: &Measures, flight: &Flight, limits: &Limits) -> Vec<Violation> {
    let mut found = events(measures, flight, limits);
    let end = (flight.track.times().last().copied().unwrap_or(0.0), last_leg(measures, flight));
    found.extend(broken(measures, limits, end));
    // Stable, so that equals keep their order.
    found.sort_by(|a, b| {
        let (a, b) = (a.gravity(), b.gravity());
        b.0.cmp(&a.0).then(b.1.total_cmp(&a.1))
    });
    found
}

/// The measured limits that `measures` are beyond, and by more than the recording resolves, in the order of [`Limits`]:
/// what [`violations`] has beside what happened to the run.
pub fn exceeded(measures: &Measures, limits: &Limits) -> Vec<Violation> {
    broken(measures, limits, (measures.total_time, measures.legs.len().saturating_sub(1)))
}

fn broken(measures: &Measures, limits: &Limits, end: (f64, usize)) -> Vec<Violation> {
    let open = |one: &Violation| match one.what.as_str() {
        "acceleration" => {
            measures.acceleration_unresolved.is_some_and(|unresolved| unresolved.decides(one.value, one.limit))
        }
        "deviation" | "overshoot" | "clearance" => {
            measures.place_unresolved.is_some_and(|moved| (one.value - one.limit).abs() <= moved)
        }
        _ => false,
    };
    let beyond = |one: &Violation| if one.is_lower_limit() { one.value < one.limit } else { one.value > one.limit };
    held(measures, limits, end).into_iter().filter(|one| beyond(one) && !open(one)).collect()
}

/// Of what `measures` have a limit for, that which comes nearest to it, broken or not, as a share of the limit; the
/// first of equals in the order of [`Limits`]. `None` where nothing that was measured is limited.
///
/// In the form of a violation; what takes long is told as at its end, on the last leg.
pub fn nearest(measures: &Measures, limits: &Limits) -> Option<Violation> {
    let end = (measures.total_time, measures.legs.len().saturating_sub(1));
    let nearer = |a: Violation, b: Violation| if b.relative_excess() > a.relative_excess() { b } else { a };
    held(measures, limits, end).into_iter().filter(|one| !one.value.is_nan()).reduce(nearer)
}

/// What is measured beside each limit that there is, in the order of [`Limits`]; what takes long ends at `end`, s, on
/// leg `last`.
fn held(measures: &Measures, limits: &Limits, (end, last): (f64, usize)) -> Vec<Violation> {
    let mut found = Vec::new();
    let largest = |value: fn(&LegMeasures) -> f64| {
        let mut best = 0;
        for (leg, measure) in measures.legs.iter().enumerate() {
            if value(measure) > value(&measures.legs[best]) {
                best = leg;
            }
        }
        best
    };
    let mut hold = |what: &str, value: Option<f64>, limit: Option<f64>, unit: &str, at: f64, leg: usize| {
        if let (Some(value), Some(limit)) = (value, limit) {
            found.push(Violation { what: what.into(), value, limit, unit: unit.into(), at, leg });
        }
    };
    hold("deviation", measures.deviation(), limits.deviation, "m", measures.t_worst, measures.leg_worst);
    let leg = largest(|leg| leg.overshoot);
    hold("overshoot", Some(measures.max_overshoot()), limits.overshoot, "m", measures.t_overshoot, leg);
    let leg = largest(|leg| leg.max_acceleration);
    hold("acceleration", measures.acceleration(), limits.acceleration, "m/s²", measures.t_acceleration, leg);
    hold("total-time", Some(measures.total_time), limits.total_time, "s", end, last);
    if let Some(late) = &measures.latest {
        hold("late", Some(late.by), limits.late, "s", late.at, late.leg);
    }
    let leg = nearest_leg(measures);
    hold("clearance", measures.min_clearance, limits.clearance, "m", measures.t_clearance, leg);
    let leg = largest(|leg| leg.min_tip_over_margin.map_or(f64::NEG_INFINITY, |margin| -margin));
    let (least, at) = (measures.min_tip_over_margin, measures.t_tip_over_margin);
    hold("tip-over-margin", least, limits.tip_over_margin, "°", at, leg);
    found
}

fn events(measures: &Measures, flight: &Flight, limits: &Limits) -> Vec<Violation> {
    let end = flight.track.times().last().copied().unwrap_or(0.0);
    let event = |what: &str, value: f64, limit: f64, unit: &str, at: f64, leg: usize| Violation {
        what: what.into(),
        value,
        limit,
        unit: unit.into(),
        at,
        leg,
    };
    let last = last_leg(measures, flight);
    let mut found = Vec::new();
    if flight.ended.is_crash() {
        let what = match flight.ended {
            Ended::TipOver | Ended::BellyContact | Ended::Stuck | Ended::Halted | Ended::OffMap => flight.ended.word(),
            _ => "crash",
        };
        found.push(event(what, end, 0.0, "s", end, last));
    } else if let Some(clearance) = met(measures).filter(|_| limits.contact) {
        found.push(event("contact", clearance, 0.0, "m", measures.t_clearance, nearest_leg(measures)));
    }
    if let Some(at) = flight.left_world {
        found.push(event("left-world", at, 0.0, "s", at, leg_at(measures, flight, at)));
    }
    let reached = flight.reached.iter().filter(|time| time.is_some()).count();
    let all = measures.legs.len() + 1;
    let unfinished = match flight.ended {
        Ended::Time => reached < all,
        // An executor's word against what it flew: waypoints on the way it may have passed by a radius of its own.
        Ended::Done => flight.reached.last() == Some(&None),
        _ => false,
    };
    if limits.unfinished && unfinished {
        // One that stands still short of a waypoint would not have come there in any time.
        let (what, at) = stalled(flight).map_or(("unfinished", end), |since| ("stalled", since));
        found.push(event(what, reached as f64, all as f64, "waypoints", at, last));
    }
    found
}

/// The clearance of what met an obstacle, m; what rounding may have moved into one decides nothing.
fn met(measures: &Measures) -> Option<f64> {
    let moved = measures.place_unresolved.unwrap_or(0.0);
    measures.min_clearance.filter(|clearance| *clearance < -moved)
}

/// Since when a run that its time limit ended had stood still, s: for [`STILL_S`] at least.
fn stalled(flight: &Flight) -> Option<f64> {
    let (since, end) = (still_since(&flight.track)?, *flight.track.times().last()?);
    (flight.ended == Ended::Time && end - since >= STILL_S).then_some(since)
}

/// The first stamp (s) from which on `track` lies within 0.1 m of where it ends; `None` where it is empty.
pub fn still_since(track: &Track) -> Option<f64> {
    let end = track.times().len().checked_sub(1)?;
    let moved = |index: &usize| (track.position(*index) - track.position(end)).norm() > STILL_M;
    Some(track.times()[(0..end).rev().find(moved).map_or(0, |moved| moved + 1)])
}

/// The leg being flown at `t`, by the executor's channel or, without one, by the waypoints reached until then.
fn leg_at(measures: &Measures, flight: &Flight, t: f64) -> usize {
    let last = measures.legs.len().saturating_sub(1);
    match flight.track.channel("leg") {
        Some(legs) => {
            let index = flight.track.times().partition_point(|time| *time < t).min(legs.len().saturating_sub(1));
            legs.get(index).map_or(0, |leg| leg.max(0.0) as usize).min(last)
        }
        None => {
            let reached = flight.reached.iter().skip(1).filter(|time| time.is_some_and(|time| time <= t)).count();
            reached.min(last)
        }
    }
}

/// The leg with the least clearance, the first of equals.
fn nearest_leg(measures: &Measures) -> usize {
    let of = |leg: &LegMeasures| leg.min_clearance.unwrap_or(f64::INFINITY);
    let legs = measures.legs.iter().enumerate();
    legs.min_by(|a, b| of(a.1).total_cmp(&of(b.1))).map_or(0, |(leg, _)| leg)
}

fn last_leg(measures: &Measures, flight: &Flight) -> usize {
    leg_at(measures, flight, f64::INFINITY)
}
