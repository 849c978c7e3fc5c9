//! A log of the real robot against the waypoints of a case: what its samples break, what may hide between them, and
//! what its own accuracy leaves open.
//!
//! A simulator's samples are dense and exact; a log's are neither. So each limit of distance has three answers:
//! violated for certain, kept for certain, open.

mod doubts;
mod edge;
mod log;
mod refuted;

use std::borrow::Cow;

use thiserror::Error;

use self::doubts::{Looked, mean, overturned, rounded, too_fast};
use self::edge::left_world;
use self::refuted::refuted;
use super::attitude::{self, fallen, tipped_over};
use super::judge::{reference, settings};
use super::scenario::DeviationFrom;
use super::{Case, Mistake, Setup};
use crate::judgement::{
    self, JudgementError, Limits, Measures, Settings, Statistics, Swiftness, Violation, longest_mean, look_closely,
    measure,
};
use crate::trajectory::Track;

pub use self::doubts::{Doubt, Why};
pub use self::log::Log;
pub use self::refuted::Exceeded;

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
/// An acceleration is violated, or kept, for certain by more than the log resolves
/// ([`Resolution`](judgement::Resolution)).
///
/// Bounds that the log itself exceeds bound nothing. Accelerations are means over two intervals: one that is kept in
/// means that are too long ([`is_seen`](judgement::is_seen)) is a doubt. Durations and attitudes are judged by the
/// samples alone.
///
/// What is faster than any robot of the scenario's file ([`Setup::ceiling`]) is a doubt about all of it.
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
    let (breaks, resolution) = (&log.breaks[..], log.resolution);
    let settings = Settings { breaks, resolution, ..settings(&terms, path.as_ref(), clearance.as_deref()) };
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
    let mut doubts: Vec<Doubt> = too_fast(setup, log, &terms.limits, &measures).into_iter().collect();
    let found = attitude::overturned(setup, &log.flight.track);
    doubts.extend(overturned(setup, found, &terms.limits));
    // All the way it is another convention of quaternions rather than a vehicle that fell.
    let fell = fallen(setup, found).filter(|fell| !fell.throughout);
    broken.splice(..0, fell.map(|fell| tipped_over(&fell, &log.flight.track, &measures)));
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
    doubts.extend(rounded(&measures, terms.limits.acceleration));
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
