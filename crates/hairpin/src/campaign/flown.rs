//! A log of the real robot against the waypoints of a case: what its samples break, what may hide between them, and
//! what its own accuracy leaves open.
//!
//! A simulator's samples are dense and exact; a log's are neither. So each limit of distance has three answers:
//! violated for certain, kept for certain, open.

use std::borrow::Cow;

use nalgebra::{Point3, Vector3};
use thiserror::Error;

use super::judge::{reference, settings};
use super::scenario::DeviationFrom;
use super::{Case, Mistake, Setup};
use crate::judgement::{
    self, Clearance, Close, JudgementError, Limits, Measures, Settings, Statistics, Swiftness, Violation, beyond,
    is_seen, longest_mean, look_closely, measure, most_between, where_least,
};
use crate::trajectory::{Flight, Track};

/// What of a log is judged.
///
/// SI units, world frame: the door has turned frames and stamps, and says what it cut out.
#[derive(Debug, Clone)]
pub struct Log {
    /// What was flown, world frame, with the channel `leg`; [`judge_flown`] looks for the moment it left the world.
    pub flight: Flight,
    /// Samples before which something was cut out.
    /// Rising indices of samples; nothing is concluded over a break.
    pub breaks: Vec<usize>,
    /// Horizontal and vertical standard deviation of every sample's position, m; empty where nothing is said of any.
    /// As the estimator claims (`eph`, `epv`); `None` where it claims nothing, which counts as exact.
    pub accuracy: Vec<Option<[f64; 2]>>,
    /// Whether the world is known that it moved in: where it is not, neither obstacles nor bounds are judged.
    pub in_world: bool,
}

/// Why a limit that the samples keep, or break, is open.
///
/// The verdict names it, with what would decide.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Why {
    /// Between two samples it may have been broken.
    Between {
        /// What may have been, in the unit of the limit; infinite where nothing bounds it.
        most: f64,
        /// Samples a second that would decide, 1/s; `None` where none do.
        rate_hz: Option<f64>,
    },
    /// It is a mean over as long a time, s, and what is shorter was not seen.
    Mean(f64),
    /// The log itself does not know its place any better.
    Accuracy {
        /// `eph` or `epv`.
        which: &'static str,
        /// Its standard deviation, m.
        sigma: f64,
    },
    /// When the mission began is not seen: it took longer than the log shows.
    Begin {
        /// What was left out before the judged part, s; `None` where the log itself begins amid the motion.
        before: Option<f64>,
    },
    /// When it ended is not seen: so many seconds of it were left out.
    End(f64),
}

/// A limit that is open; of leaving the world the distance to its edge, `edge`, which must not fall below 0.
#[derive(Debug, Clone, PartialEq)]
pub struct Doubt {
    /// What the samples came to.
    pub value: Violation,
    /// Why that does not decide.
    pub why: Why,
}

/// What a log came to.
///
/// Within spec where both `violations` and `doubts` are empty.
#[derive(Debug, Clone, PartialEq)]
pub struct Flown {
    /// Of its samples.
    pub measures: Measures,
    /// Of the samples' deviations, each counted once.
    pub statistics: Option<Statistics>,
    /// What it is held against.
    pub limits: Limits,
    /// What it violates whatever hides between samples, and however inaccurate they are as they say, gravest first.
    pub violations: Vec<Violation>,
    /// What is open.
    pub doubts: Vec<Doubt>,
    /// The largest deviation that may hide between samples, m; infinite where nothing bounds it.
    /// By speed and acceleration of [`Self::swiftness`], over each interval without a break.
    pub most_between: f64,
    /// What bounds it: without what the log shows to be none.
    pub swiftness: Swiftness,
    /// What of the robot's bounds the log itself exceeds.
    pub exceeded: Option<Exceeded>,
}

/// A bound of the robot's that a log of it exceeds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Exceeded {
    /// `speed` or `acceleration`.
    pub what: &'static str,
    /// The largest that the log has, in `unit`.
    pub seen: f64,
    /// The robot's, in `unit`.
    pub bound: f64,
    /// `m/s` or `m/s²`.
    pub unit: &'static str,
}

/// Why a log cannot be judged.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum FlownError {
    /// A case of a folder that was edited.
    #[error(transparent)]
    Mistake(#[from] Mistake),
    /// It has nothing to measure.
    #[error(transparent)]
    Judgement(#[from] JudgementError),
}

/// Judges `log` as a run of `case`.
///
/// A limit of distance is violated for certain where a sample exceeds it by more than the standard deviation that the
/// log claims there, in the direction in which it is off: σ² = (e_h σ_h)² + (e_v σ_v)², e the unit vector from the
/// reference. It is kept for certain where no sample comes as near to it as that, and nothing that may hide between
/// samples does ([`look_closely`]). Everything else is a doubt. So is leaving the world, which has no limit.
///
/// Bounds that the log itself exceeds bound nothing. Accelerations are means over two intervals: one that is kept in
/// means that are too long ([`is_seen`]) is a doubt. Durations and attitudes are judged by the samples alone.
///
/// An obstacle that it was in by more than that standard deviation it met, whatever is limited; one that it may have
/// been in is a doubt about a clearance of 0 m, where nobody limits that.
///
/// # Errors
/// [`FlownError`].
pub fn judge_flown(setup: &Setup, case: &Case, log: &Log) -> Result<Flown, FlownError> {
    let around = setup.around(case)?;
    let setup: &Setup = &around;
    let mut terms = setup.scenario.head().terms;
    // Why a log ends its reader says.
    terms.limits.unfinished = false;
    let path = (terms.from == DeviationFrom::Path).then(|| reference(setup, case, None)).flatten();
    let clearance = if log.in_world { setup.kind().clearance() } else { None };
    let settings = Settings { breaks: &log.breaks, ..settings(&terms, path.as_ref(), clearance.as_deref()) };
    let measures = measure(&log.flight.track, &case.waypoints, &settings)?;
    let enough = terms.limits.deviation.unwrap_or(f64::INFINITY);
    let (swiftness, exceeded) = refuted(setup.swiftness(), log);
    let close = look_closely(&log.flight.track, &case.waypoints, &settings, &swiftness, enough)?;
    let mut flight = Cow::Borrowed(&log.flight);
    if let Some(left) = log.in_world.then(|| left_world(setup, log)).flatten() {
        flight.to_mut().left_world = Some(left);
    }
    let left = flight.left_world.is_some();
    let looked = Looked { log, close: &close, waypoints: &case.waypoints, swiftness: &swiftness };
    terms.limits.contact = settings.clearance.is_some_and(|clearance| looked.touches(clearance));
    // Whoever limits anything limits what stands in the way to not being met; met for certain is a violation already.
    let no_contact = Some(0.0).filter(|_| terms.limits.are_given() && !terms.limits.contact);
    let clear_by = terms.limits.clearance.or(no_contact);
    let mut broken = judgement::violations(&measures, &flight, &terms.limits);
    let mut doubts = Vec::new();
    for (what, doubt) in [
        ("deviation", looked.deviation(&measures, terms.limits.deviation)),
        ("overshoot", looked.overshoot(&measures, terms.limits.overshoot, &settings)),
        ("clearance", looked.clearance(&measures, clear_by, settings.clearance)),
    ] {
        if let Some(doubt) = doubt {
            broken.retain(|violation| violation.what != what);
            doubts.push(doubt);
        }
    }
    if log.in_world && !left {
        doubts.extend(looked.edge(setup));
    }
    doubts.extend(mean(&measures, terms.limits.acceleration, longest_mean(&log.flight.track, &settings)));
    let deviations: Vec<f64> = close.iter().filter_map(|close| Some(close.off?.norm())).collect();
    let most_between = close.iter().filter_map(|close| close.until_next).fold(measures.max_deviation, f64::max);
    let statistics = Statistics::of(&deviations);
    let limits = terms.limits;
    Ok(Flown { measures, statistics, limits, violations: broken, doubts, most_between, swiftness, exceeded })
}

/// The plan of `case`, where deviations are measured from that: of a log that tells no legs they are the plan's.
pub fn plan_followed(setup: &Setup, case: &Case) -> Option<Track> {
    let around = setup.around(case).ok()?;
    let from = around.scenario.head().terms.from;
    (from == DeviationFrom::Path).then(|| reference(&around, case, None)).flatten()
}

/// So many times its largest speed is what noise and wind explain.
const FASTER: f64 = 1.1;
/// What positions come to over so long (s) is a speed.
const LONG_S: f64 = 1.0;
/// So much (m/s) of a change of velocity is what the noise of an estimate explains.
const ROOM_M_S: f64 = 0.5;

/// What bounds the robot, without what the log itself shows not to, and what that is.
///
/// A larger speed than the model has says that its speed bounds nothing: of logged velocities, or what positions come
/// to over a second ([`over_seconds`]). The bound of accelerations counts drag at that speed, at most the square of it:
/// as far as [`FASTER`] it grows so; beyond, and where velocities change faster than by a h + [`ROOM_M_S`], the model
/// does not bound this robot at all. Of a log without velocities steps are told that are longer than the speed allows;
/// each is without its bound already ([`Swiftness::bulge`]).
fn refuted(swiftness: Swiftness, log: &Log) -> (Swiftness, Option<Exceeded>) {
    let track = &log.flight.track;
    let span = |i: usize| track.times()[i + 1] - track.times()[i];
    let whole = || (0..track.len().saturating_sub(1)).filter(|i| log.breaks.binary_search(&(i + 1)).is_err());
    let too_fast = |seen: f64| {
        let bound = swiftness.speed.filter(|speed| *speed < seen)?;
        Some(Exceeded { what: "speed", seen, bound, unit: "m/s" })
    };
    let velocities = match ["vx_m_s", "vy_m_s", "vz_m_s"].map(|name| track.channel(name)) {
        [Some(x), Some(y), Some(z)] => Some([x, y, z]),
        _ => None,
    };
    let velocity = |i: usize| velocities.map(|axes| Vector3::from(axes.map(|axis| axis[i])));
    let told = (0..track.len()).filter_map(velocity).map(|v| v.norm()).fold(0.0, f64::max);
    let faster = too_fast(told.max(over_seconds(log)));
    let mut left = swiftness;
    if let Some(Exceeded { seen, bound, .. }) = faster {
        let ratio = seen / bound;
        left = Swiftness { speed: None, acceleration: left.acceleration.map(|a| a * ratio * ratio) };
        if ratio > FASTER {
            return (Swiftness::default(), faster);
        }
    }
    if velocities.is_none() {
        let steps = whole().map(|i| (track.position(i + 1) - track.position(i)).norm() / span(i));
        return (left, faster.or_else(|| too_fast(steps.fold(0.0, f64::max))));
    }
    let change = |i: usize| Some((velocity(i + 1)? - velocity(i)?).norm());
    let changes = whole().filter_map(|i| Some((change(i)?, span(i))));
    let sudden = left.acceleration.and_then(|bound| {
        let beyond = changes.filter(|(change, span)| *change > bound * span + ROOM_M_S);
        let seen = beyond.map(|(change, span)| change / span).max_by(f64::total_cmp)?;
        Some(Exceeded { what: "acceleration", seen, bound, unit: "m/s²" })
    });
    if sudden.is_some() {
        left.acceleration = None;
    }
    (left, sudden.or(faster))
}

/// The largest speed (m/s) that the positions come to in the mean over the least time from [`LONG_S`] on, without what
/// their accuracy explains; 0 where nothing is as long. Over less it may be the noise of an estimate.
fn over_seconds(log: &Log) -> f64 {
    let track = &log.flight.track;
    let sigma = |i: usize| log.accuracy.get(i).copied().flatten().map_or(0.0, |[across, up]| libm::hypot(across, up));
    let (mut from, mut most) = (0, 0.0_f64);
    for to in 0..track.len() {
        if log.breaks.binary_search(&to).is_ok() {
            from = to;
        }
        let since = |i: usize| track.times()[to] - track.times()[i];
        while from < to && since(from + 1) >= LONG_S {
            from += 1;
        }
        if since(from) >= LONG_S {
            let way = (track.position(to) - track.position(from)).norm() - sigma(from) - sigma(to);
            most = most.max(way / since(from));
        }
    }
    most
}

/// When it was first outside its world for certain: with all that lies within its accuracy, s.
///
/// Nearly: the place itself and its six neighbours at one standard deviation along the axes lie outside.
fn left_world(setup: &Setup, log: &Log) -> Option<f64> {
    let track = &log.flight.track;
    let outside = |i: usize| {
        let (p, [across, up]) = (track.position(i), log.accuracy.get(i).copied().flatten().unwrap_or([0.0; 2]));
        let ways = [Vector3::x() * across, Vector3::y() * across, Vector3::z() * up];
        setup.is_outside(&p) && ways.iter().all(|way| setup.is_outside(&(p + way)) && setup.is_outside(&(p - way)))
    };
    (0..track.len()).find(|i| outside(*i)).map(|i| track.times()[i])
}

struct Looked<'a> {
    log: &'a Log,
    close: &'a [Close],
    waypoints: &'a [Point3<f64>],
    swiftness: &'a Swiftness,
}

/// A standard deviation (m) and which of the log's two it is mostly.
#[derive(Clone, Copy)]
struct Sigma {
    along: f64,
    which: &'static str,
    claimed: f64,
}

impl Looked<'_> {
    /// Of sample `i` in the direction `off`, or in whichever is worse.
    fn sigma(&self, i: usize, off: Option<Vector3<f64>>) -> Sigma {
        let [across, up] = self.log.accuracy.get(i).copied().flatten().unwrap_or([0.0; 2]);
        let [own_across, own_up] = match off.and_then(|off| off.try_normalize(0.0)) {
            Some(way) => [across * libm::hypot(way.x, way.y), up * way.z.abs()],
            None => [across, up],
        };
        let along = if off.is_some() { libm::hypot(own_across, own_up) } else { across.max(up) };
        let (which, claimed) = if own_up > own_across { ("epv", up) } else { ("eph", across) };
        Sigma { along, which, claimed }
    }

    /// The interval after sample `i`, s, and how far (m) the motion may bulge out of it; `None` before a break.
    fn after(&self, i: usize) -> Option<(f64, f64)> {
        let track = &self.log.flight.track;
        let next = (i + 1 < track.len() && self.log.breaks.binary_search(&(i + 1)).is_err()).then_some(i + 1)?;
        let span = track.times()[next] - track.times()[i];
        Some((span, self.swiftness.bulge(span, (track.position(next) - track.position(i)).norm())))
    }

    /// Samples a second with which `margin` m are not exceeded between them.
    ///
    /// f = min(√(a / 8m), v / 2m): between samples a motion bulges by a Δt²/8 under acceleration a, and by v Δt/2 at
    /// speed v.
    fn rate(&self, margin: f64) -> Option<f64> {
        let by_acceleration = self.swiftness.acceleration.map(|a| (a / (8.0 * margin)).sqrt());
        let by_speed = self.swiftness.speed.map(|v| v / (2.0 * margin));
        let least = by_acceleration.into_iter().chain(by_speed).fold(f64::INFINITY, f64::min);
        (margin > 0.0 && least.is_finite()).then_some(least)
    }

    fn deviation(&self, measures: &Measures, limit: Option<f64>) -> Option<Doubt> {
        let limit = limit?;
        let samples = || {
            let all = self.close.iter().enumerate();
            all.filter_map(|(i, close)| Some((i, close.off?.norm(), self.sigma(i, close.off))))
        };
        let value = |at: f64, value: f64, leg: usize| violation("deviation", value, limit, at, leg);
        let worst = value(measures.t_worst, measures.max_deviation, measures.leg_worst);
        let times = self.log.flight.track.times();
        if measures.max_deviation > limit {
            let certain = samples().any(|(_, off, sigma)| off - sigma.along > limit);
            let (_, _, sigma) = samples().find(|(i, ..)| times[*i] == measures.t_worst)?;
            return (!certain).then_some(Doubt { value: worst, why: sigma.doubt() });
        }
        let unsure = samples().filter(|(_, off, sigma)| off + sigma.along > limit);
        if let Some((i, off, sigma)) = unsure.max_by(|a, b| (a.1 + a.2.along).total_cmp(&(b.1 + b.2.along))) {
            return Some(Doubt { value: value(times[i], off, self.close[i].leg), why: sigma.doubt() });
        }
        let (mut most, mut rate, mut at) = (0.0, Some(0.0_f64), 0);
        for (i, close) in self.close.iter().enumerate() {
            let Some(bound) = close.until_next.map(|bound| bound + self.sigma(i, close.off).along) else { continue };
            if bound > limit {
                let ends =
                    [i, i + 1].map(|k| self.close[k].off.map_or(0.0, |off| off.norm()) + self.sigma(k, None).along);
                let own = self.rate(limit - ends[0].max(ends[1]));
                rate = rate.and_then(|rate| Some(rate.max(own?)));
                if bound > most {
                    (most, at) = (bound, i);
                }
            }
        }
        let off = self.close[at].off.map_or(0.0, |off| off.norm());
        let value = value(times[at], off, self.close[at].leg);
        (most > limit).then_some(Doubt { value, why: Why::Between { most, rate_hz: rate } })
    }

    fn overshoot(&self, measures: &Measures, limit: Option<f64>, settings: &Settings) -> Option<Doubt> {
        let limit = limit?;
        let legs = measures.legs.iter().enumerate();
        let leg = legs.max_by(|a, b| a.1.overshoot.total_cmp(&b.1.overshoot)).map_or(0, |(leg, _)| leg);
        let value = violation("overshoot", measures.max_overshoot(), limit, measures.t_overshoot, leg);
        // Against a path overshoot is measured from the samples' places on it, which between samples nobody knows.
        let by_leg = !matches!(settings.reference, judgement::Reference::Path(_));
        let beyond = |p: &Point3<f64>, leg: usize| if by_leg { beyond(self.waypoints, p, leg) } else { 0.0 };
        self.of_distance(value, false, &beyond)
    }

    fn clearance(&self, measures: &Measures, limit: Option<f64>, clearance: Option<&Clearance<'_>>) -> Option<Doubt> {
        let (limit, clearance, least) = (limit?, clearance?, measures.min_clearance?);
        let legs = measures.legs.iter().enumerate();
        let of = |leg: &judgement::LegMeasures| leg.min_clearance.unwrap_or(f64::INFINITY);
        let leg = legs.min_by(|a, b| of(a.1).total_cmp(&of(b.1))).map_or(0, |(leg, _)| leg);
        let value = violation("clearance", least, limit, measures.t_clearance, leg);
        self.of_distance(value, true, &|p, _| clearance(p))
    }

    /// Whether it may have left its world, which no sample shows for certain: within what the log knows of its place,
    /// or between two samples. Places are off by one standard deviation along each axis, as [`left_world`] has them.
    fn edge(&self, setup: &Setup) -> Option<Doubt> {
        let track = &self.log.flight.track;
        let know = |i: usize| self.log.accuracy.get(i).copied().flatten().unwrap_or([0.0; 2]);
        let ways = |[across, up]: [f64; 2]| {
            let along = [Vector3::x() * across, Vector3::y() * across, Vector3::z() * up];
            let off = along.into_iter().filter(|way| way.norm() > 0.0).flat_map(|way| [way, -way]);
            std::iter::once(Vector3::zeros()).chain(off)
        };
        let value = |i: usize, edge: f64| violation("edge", edge, 0.0, track.times()[i], self.close[i].leg);
        let near = |i: usize| {
            let [across, up] = know(i);
            let edge = setup.edge_distance(&track.position(i), across.max(up));
            ways(know(i)).any(|way| setup.is_outside(&(track.position(i) + way))).then_some((i, edge))
        };
        if let Some((i, edge)) = (0..track.len()).filter_map(near).min_by(|a, b| a.1.total_cmp(&b.1)) {
            // Which of the two it is: up and down alone keep it inside, or do not.
            let [across, up] = know(i);
            let by_across = ways([across, 0.0]).any(|way| setup.is_outside(&(track.position(i) + way)));
            let (which, sigma) = if by_across { ("eph", across) } else { ("epv", up) };
            return Some(Doubt { value: value(i, edge), why: Why::Accuracy { which, sigma } });
        }
        let (mut worst, mut rate) = (None::<(usize, f64, f64)>, Some(0.0_f64));
        for i in 0..track.len() {
            let Some((_, bulge)) = self.after(i) else { continue };
            let ends = [track.position(i), track.position(i + 1)];
            if bulge.is_infinite() {
                let near = setup.edge_distance(&ends[0], 0.0);
                if near.is_finite() {
                    (worst, rate) = (Some((i, f64::INFINITY, near)), None);
                    break;
                }
                continue;
            }
            let accuracy = [0, 1].map(|axis| know(i)[axis].max(know(i + 1)[axis]));
            let reach = (ends[1] - ends[0]).norm() + bulge + accuracy[0].max(accuracy[1]);
            let near = setup.edge_distance(&ends[0], reach);
            if near >= reach {
                continue;
            }
            let (mut most, mut at_ends) = (f64::NEG_INFINITY, -near);
            for way in ways(accuracy) {
                let beyond = |p: &Point3<f64>| -setup.edge_distance(&(p + way), reach);
                let own = ends.map(|p| (p, beyond(&p)));
                at_ends = at_ends.max(own[0].1).max(own[1].1);
                most = most.max(most_between(&beyond, own, bulge, 0.0));
            }
            if most > 0.0 {
                rate = rate.and_then(|rate| Some(rate.max(self.rate(-at_ends)?)));
                if worst.is_none_or(|(_, before, _)| most > before) {
                    worst = Some((i, most, near));
                }
            }
        }
        let (i, most, near) = worst?;
        Some(Doubt { value: value(i, near), why: Why::Between { most: -most, rate_hz: rate } })
    }

    /// Whether a sample is in an obstacle with all that lies within its accuracy.
    fn touches(&self, clearance: &Clearance<'_>) -> bool {
        let track = &self.log.flight.track;
        (0..track.len()).any(|i| clearance(&track.position(i)) + self.sigma(i, None).along < 0.0)
    }

    /// Whether a limit on a function of places and legs that changes by no more than the way is open; `lower` of one
    /// that must not fall short. Where the leg changes between two samples it changes where that is least.
    fn of_distance(&self, value: Violation, lower: bool, of: &dyn Fn(&Point3<f64>, usize) -> f64) -> Option<Doubt> {
        // Falling short is exceeding, the other way round.
        let turn = |x: f64| if lower { -x } else { x };
        let (track, limit) = (&self.log.flight.track, turn(value.limit));
        let at = |i: usize, leg: usize| turn(of(&track.position(i), leg));
        let values: Vec<f64> = (0..track.len()).map(|i| at(i, self.close[i].leg)).collect();
        let sigma = |i: usize| self.sigma(i, None);
        let worst = (0..values.len()).max_by(|a, b| values[*a].total_cmp(&values[*b]))?;
        if turn(value.value) > limit {
            let certain = (0..values.len()).any(|i| values[i] - sigma(i).along > limit);
            return (!certain && sigma(worst).along > 0.0).then(|| Doubt { value, why: sigma(worst).doubt() });
        }
        if let Some(i) = (0..values.len()).find(|i| values[*i] + sigma(*i).along > limit) {
            return Some(Doubt { value, why: sigma(i).doubt() });
        }
        let (mut most, mut rate) = (f64::NEG_INFINITY, Some(0.0_f64));
        for i in 0..values.len() {
            let Some((_, bulge)) = self.after(i) else { continue };
            let enough = limit - sigma(i).along;
            let on = |leg: usize| {
                let ends = [i, i + 1].map(|k| (track.position(k), at(k, leg)));
                most_between(&|p| turn(of(p, leg)), ends, bulge, enough)
            };
            let bound = where_least([self.close[i].leg, self.close[i + 1].leg], on);
            if bound > enough {
                most = most.max(bound);
                let own = self.rate(enough - values[i].max(values[i + 1]));
                rate = rate.and_then(|rate| Some(rate.max(own?)));
            }
        }
        (most > f64::NEG_INFINITY).then(|| Doubt { value, why: Why::Between { most: turn(most), rate_hz: rate } })
    }
}

impl Sigma {
    fn doubt(self) -> Why {
        Why::Accuracy { which: self.which, sigma: self.claimed }
    }
}

/// Why an acceleration within its `limit` is open: it is a mean over `span` s.
fn mean(measures: &Measures, limit: Option<f64>, span: f64) -> Option<Doubt> {
    let (limit, value) = (limit?, measures.acceleration()?);
    let legs = measures.legs.iter().enumerate();
    let leg = legs.max_by(|a, b| a.1.max_acceleration.total_cmp(&b.1.max_acceleration)).map_or(0, |(leg, _)| leg);
    let value =
        Violation { unit: "m/s²".into(), ..violation("acceleration", value, limit, measures.t_acceleration, leg) };
    (value.value <= limit && !is_seen(span)).then_some(Doubt { value, why: Why::Mean(span) })
}

fn violation(what: &str, value: f64, limit: f64, at: f64, leg: usize) -> Violation {
    Violation { what: what.into(), value, limit, unit: "m".into(), at, leg }
}
