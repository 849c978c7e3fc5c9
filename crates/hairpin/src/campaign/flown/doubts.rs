//! Limits that a log leaves open: what may hide between its samples, and what its own accuracy does not tell.

use nalgebra::{Point3, Vector3};

use super::log::Log;
use crate::campaign::Setup;
use crate::campaign::attitude::{fallen, upside_down};
use crate::campaign::implausible::{Impossible, Overturned};
use crate::campaign::impossible::impossible;
use crate::judgement::{
    self, AccelerationSource, Around, Clearance, Close, Limits, Measures, Settings, Swiftness, Unresolved, Violation,
    beyond, is_seen, most_between, where_least,
};

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
    /// The log tells its numbers in steps that may make as much of it.
    Resolution(Unresolved, AccelerationSource),
    /// The log tells its positions in steps that have moved them as far as this, m.
    Digits(f64),
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
    /// Its attitudes are of another convention, or it was carried.
    Overturned(Overturned),
    /// No robot of its file is as fast: neither its times nor its places decide anything.
    Impossible(Impossible),
}

/// A limit that is open; of leaving the world the distance to its edge, `edge`, which must not fall below 0.
#[derive(Debug, Clone, PartialEq)]
pub struct Doubt {
    /// What the samples came to.
    pub value: Violation,
    /// Why that does not decide.
    pub why: Why,
}

/// A log, with each of its samples looked at.
pub(super) struct Looked<'a> {
    pub(super) log: &'a Log,
    pub(super) close: &'a [Close],
    pub(super) waypoints: &'a [Point3<f64>],
    pub(super) swiftness: &'a Swiftness,
}

/// How far off a place may be (m), and what that mostly is.
#[derive(Clone, Copy)]
struct Sigma {
    along: f64,
    why: Why,
}

impl Looked<'_> {
    /// Of sample `i` in the direction `off`, or in whichever is worse: its standard deviation, and what rounding has
    /// moved it at most, whichever way.
    fn sigma(&self, i: usize, off: Option<Vector3<f64>>) -> Sigma {
        let [across, up] = self.log.sigma(i);
        let [own_across, own_up] = match off.and_then(|off| off.try_normalize(0.0)) {
            Some(way) => [across * libm::hypot(way.x, way.y), up * way.z.abs()],
            None => [across, up],
        };
        let along = if off.is_some() { libm::hypot(own_across, own_up) } else { across.max(up) };
        let moved = self.log.resolution.place.moved;
        let why = match own_up > own_across {
            _ if moved > along => Why::Digits(moved),
            true => Why::Accuracy { which: "epv", sigma: up },
            false => Why::Accuracy { which: "eph", sigma: across },
        };
        Sigma { along: along + moved, why }
    }

    /// The interval after sample `i`, s, and how far (m) the motion may bulge out of it; `None` before a break.
    pub(super) fn after(&self, i: usize) -> Option<(f64, f64)> {
        let track = &self.log.flight.track;
        let next = (i + 1 < track.len() && self.log.breaks.binary_search(&(i + 1)).is_err()).then_some(i + 1)?;
        let span = track.times()[next] - track.times()[i];
        Some((span, self.swiftness.bulge(span, (track.position(next) - track.position(i)).norm())))
    }

    /// Whether the limit of deviation is open. What is told is the largest of the samples, wherever it is in doubt.
    pub(super) fn deviation(&self, measures: &Measures, limit: Option<f64>) -> Option<Doubt> {
        let limit = limit?;
        let samples = || {
            let all = self.close.iter().enumerate();
            all.filter_map(|(i, close)| Some((i, close.off?.norm(), self.sigma(i, close.off))))
        };
        let worst = violation("deviation", measures.max_deviation, limit, measures.t_worst, measures.leg_worst);
        if measures.max_deviation > limit {
            let times = self.log.flight.track.times();
            let certain = samples().any(|(_, off, sigma)| off - sigma.along > limit);
            let (_, _, sigma) = samples().find(|(i, ..)| times[*i] == measures.t_worst)?;
            return (!certain).then_some(Doubt { value: worst, why: sigma.why });
        }
        let unsure = samples().filter(|(_, off, sigma)| off + sigma.along > limit);
        if let Some((.., sigma)) = unsure.max_by(|a, b| (a.1 + a.2.along).total_cmp(&(b.1 + b.2.along))) {
            return Some(Doubt { value: worst, why: sigma.why });
        }
        let (mut most, mut rate) = (0.0_f64, Some(0.0_f64));
        for (i, close) in self.close.iter().enumerate() {
            let Some(bound) = close.until_next.map(|bound| bound + self.sigma(i, close.off).along) else { continue };
            if bound > limit {
                let ends =
                    [i, i + 1].map(|k| self.close[k].off.map_or(0.0, |off| off.norm()) + self.sigma(k, None).along);
                let own = self.swiftness.rate(limit - ends[0].max(ends[1]));
                rate = rate.and_then(|rate| Some(rate.max(own?)));
                most = most.max(bound);
            }
        }
        (most > limit).then_some(Doubt { value: worst, why: Why::Between { most, rate_hz: rate } })
    }

    pub(super) fn overshoot(&self, measures: &Measures, limit: Option<f64>, settings: &Settings) -> Option<Doubt> {
        let limit = limit?;
        let legs = measures.legs.iter().enumerate();
        let leg = legs.max_by(|a, b| a.1.overshoot.total_cmp(&b.1.overshoot)).map_or(0, |(leg, _)| leg);
        let value = violation("overshoot", measures.max_overshoot(), limit, measures.t_overshoot, leg);
        // Against a path overshoot is measured from the samples' places on it, which between samples nobody knows.
        let by_leg = !matches!(settings.reference, judgement::Reference::Path(_));
        let beyond = |p: &Point3<f64>, leg: usize, around: Around<'_>| {
            if by_leg { beyond(self.waypoints, p, leg, around) } else { 0.0 }
        };
        self.of_distance(value, false, &beyond)
    }

    pub(super) fn clearance(
        &self,
        measures: &Measures,
        limit: Option<f64>,
        clearance: Option<&Clearance<'_>>,
    ) -> Option<Doubt> {
        let (limit, clearance, least) = (limit?, clearance?, measures.min_clearance?);
        let legs = measures.legs.iter().enumerate();
        let of = |leg: &judgement::LegMeasures| leg.min_clearance.unwrap_or(f64::INFINITY);
        let leg = legs.min_by(|a, b| of(a.1).total_cmp(&of(b.1))).map_or(0, |(leg, _)| leg);
        let value = violation("clearance", least, limit, measures.t_clearance, leg);
        self.of_distance(value, true, &|p, _, _| clearance(p))
    }

    /// Whether a sample is in an obstacle with all that lies within its accuracy.
    pub(super) fn touches(&self, clearance: &Clearance<'_>) -> bool {
        let track = &self.log.flight.track;
        (0..track.len()).any(|i| clearance(&track.position(i)) + self.sigma(i, None).along < 0.0)
    }

    /// Whether a limit on a function of places, legs and what is around a place that changes by no more than the way is
    /// open; `lower` of one that must not fall short. Where the leg changes between two samples it changes where that
    /// is least.
    fn of_distance(
        &self,
        value: Violation,
        lower: bool,
        of: &dyn Fn(&Point3<f64>, usize, Around<'_>) -> f64,
    ) -> Option<Doubt> {
        // Falling short is exceeding, the other way round.
        let turn = |x: f64| if lower { -x } else { x };
        let (track, limit) = (&self.log.flight.track, turn(value.limit));
        let at = |i: usize, leg: usize| {
            let p = track.position(i);
            turn(of(&p, leg, Around { places: &[p], within: 0.0 }))
        };
        let values: Vec<f64> = (0..track.len()).map(|i| at(i, self.close[i].leg)).collect();
        let sigma = |i: usize| self.sigma(i, None);
        let worst = (0..values.len()).max_by(|a, b| values[*a].total_cmp(&values[*b]))?;
        if turn(value.value) > limit {
            let certain = (0..values.len()).any(|i| values[i] - sigma(i).along > limit);
            return (!certain && sigma(worst).along > 0.0).then(|| Doubt { value, why: sigma(worst).why });
        }
        if let Some(i) = (0..values.len()).find(|i| values[*i] + sigma(*i).along > limit) {
            return Some(Doubt { value, why: sigma(i).why });
        }
        let (mut most, mut rate) = (f64::NEG_INFINITY, Some(0.0_f64));
        for i in 0..values.len() {
            let Some((_, bulge)) = self.after(i) else { continue };
            let enough = limit - sigma(i).along;
            let places = [i, i + 1].map(|k| track.position(k));
            let around = Around { places: &places, within: 0.5 * (places[1] - places[0]).norm() + bulge };
            let on = |leg: usize| {
                let ends = places.map(|p| (p, turn(of(&p, leg, around))));
                most_between(&|p| turn(of(p, leg, around)), ends, bulge, enough)
            };
            let bound = where_least([self.close[i].leg, self.close[i + 1].leg], on);
            if bound > enough {
                most = most.max(bound);
                let own = self.swiftness.rate(enough - values[i].max(values[i + 1]));
                rate = rate.and_then(|rate| Some(rate.max(own?)));
            }
        }
        (most > f64::NEG_INFINITY).then(|| Doubt { value, why: Why::Between { most: turn(most), rate_hz: rate } })
    }
}

/// That a log is faster than any robot of the scenario's file, whatever is limited.
pub(super) fn too_fast(setup: &Setup, log: &Log, limits: &Limits, measures: &Measures) -> Option<Doubt> {
    let track = &log.flight.track;
    let found = impossible(setup, track, &log.breaks, &|i| log.radius(i)).filter(|_| limits.are_given())?;
    let leg = measures.leg_after(found.from_s - track.times()[0]);
    let value = violation("speed", found.speed(), found.bound_m_s, found.from_s, leg.unwrap_or(0));
    Some(Doubt { value: Violation { unit: "m/s".into(), ..value }, why: Why::Impossible(found) })
}

/// That a log's up axis points down, or lies beyond the tilt of its robot's file all the way, as it was `found`,
/// whatever is limited.
pub(super) fn overturned(setup: &Setup, found: Option<Overturned>, limits: &Limits) -> Option<Doubt> {
    let all_the_way = || fallen(setup, found).filter(|found| found.throughout);
    let found = upside_down(setup, found).or_else(all_the_way).filter(|_| limits.are_given())?;
    let most = setup.kind().most_tilt().unwrap_or(std::f64::consts::FRAC_PI_2);
    let value = violation("tilt", found.tilt_rad.to_degrees(), most.to_degrees(), found.at_s, 0);
    Some(Doubt { value: Violation { unit: "°".into(), ..value }, why: Why::Overturned(found) })
}

/// Why an acceleration within its `limit` is open: it is a mean over `span` s.
pub(super) fn mean(measures: &Measures, limit: Option<f64>, span: f64) -> Option<Doubt> {
    let (limit, value) = (limit?, measures.acceleration()?);
    let legs = measures.legs.iter().enumerate();
    let leg = legs.max_by(|a, b| a.1.max_acceleration.total_cmp(&b.1.max_acceleration)).map_or(0, |(leg, _)| leg);
    let value =
        Violation { unit: "m/s²".into(), ..violation("acceleration", value, limit, measures.t_acceleration, leg) };
    (value.value <= limit && !is_seen(span)).then_some(Doubt { value, why: Why::Mean(span) })
}

/// Why an acceleration is open that the step decides in which the log tells its numbers.
pub(super) fn rounded(measures: &Measures, limit: Option<f64>) -> Option<Doubt> {
    let (limit, value) = (limit?, measures.acceleration()?);
    let unresolved = measures.acceleration_unresolved.filter(|unresolved| unresolved.decides(value, limit))?;
    let legs = measures.legs.iter().enumerate();
    let leg = legs.max_by(|a, b| a.1.max_acceleration.total_cmp(&b.1.max_acceleration)).map_or(0, |(leg, _)| leg);
    let value =
        Violation { unit: "m/s²".into(), ..violation("acceleration", value, limit, measures.t_acceleration, leg) };
    Some(Doubt { value, why: Why::Resolution(unresolved, measures.acceleration_source) })
}

pub(super) fn violation(what: &str, value: f64, limit: f64, at: f64, leg: usize) -> Violation {
    Violation { what: what.into(), value, limit, unit: "m".into(), at, leg }
}
