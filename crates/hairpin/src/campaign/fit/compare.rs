//! What of a log is compared, and what a simulation says in its place.

use nalgebra::Point3;

use super::FitError;
use super::outputs::{has, outputs_at};
use super::passages::{Missed, passages};
use crate::campaign::Case;
use crate::campaign::kind::{Output, Sampling};
use crate::simulation::Acceptance;
use crate::trajectory::Track;

/// A log of a flight, and the mission that was flown.
#[derive(Debug, Clone, PartialEq)]
pub struct Flown {
    /// The log's name.
    pub log: String,
    /// The mission's name.
    pub mission: String,
    /// The mission.
    pub case: Case,
    /// The motion from the moment that the mission began, world frame. Velocities are in channels, if it has them;
    /// attitudes are known, if no channel says that they are not; `rotor1_rad_s`… are the rotors' speeds.
    pub track: Track,
}

/// How motions are compared.
///
/// Of a kind of robots: `Fittable` says it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Rule {
    /// What of them.
    pub(super) outputs: &'static [(Output, usize)],
    /// How long and how often.
    pub(super) sampling: Sampling,
    /// World axes in which distances are.
    /// 3 of what flies, 2 in the plane.
    pub(super) axes: usize,
    /// Where a waypoint counts as reached.
    pub(super) acceptance: Acceptance,
    /// Within so many m.
    pub(super) radius: f64,
    /// Whether all is counted from the start, not from each waypoint.
    pub(super) timed: bool,
}

impl Rule {
    /// How many standard deviations its outputs have.
    pub(super) fn deviations(&self) -> usize {
        self.outputs.iter().map(|(_, number)| number + 1).max().unwrap_or(0)
    }
}

/// After the last waypoint so much is compared, s: what a simulation lingers.
const AFTER: f64 = 2.0;

/// The log's side of a comparison.
#[derive(Debug, Clone)]
pub(super) struct Compared {
    /// Of each sample: leg, and time after it began, s.
    pub(super) samples: Vec<(usize, f64)>,
    /// Of each sample all outputs that the log has.
    pub(super) logged: Vec<Vec<f64>>,
    /// Of each output: which standard deviation it has.
    pub(super) outputs: Vec<usize>,
    /// How long it is, s.
    pub(super) end: f64,
    /// When each leg of the log begins, s.
    begun: Vec<f64>,
    which: Vec<Output>,
}

impl Compared {
    /// The legs of a log that are compared.
    ///
    /// From waypoint to waypoint the first leg is left out: from poses nobody knows when it was ordered.
    ///
    /// Samples lie in the middles of periods, from each leg's begin to the next one's; the last leg has [`AFTER`] s
    /// after the last waypoint, or by the clock all that is left.
    ///
    /// # Errors
    /// `Short` and `Sparse` of what the sampling needs at least, `Outputs` where the log has none, `Start` where it
    /// begins farther from waypoint 0 than is understood, `Missed` for a waypoint that it does not pass.
    pub(super) fn of(flown: &Flown, rule: &Rule) -> Result<Self, FitError> {
        let Flown { log, mission, case, track } = flown;
        let times = track.times();
        let (start, end) = (times.first().copied().unwrap_or(0.0), times.last().copied().unwrap_or(0.0));
        let found = end - start;
        let Sampling { least_s, least_hz, period, .. } = rule.sampling;
        if found < least_s {
            return Err(FitError::Short { log: log.clone(), found, least: least_s });
        }
        let rate = (track.len() - 1) as f64 / found;
        if rate < least_hz {
            return Err(FitError::Sparse { log: log.clone(), found: rate, least: least_hz });
        }
        let (which, outputs): (Vec<Output>, Vec<usize>) =
            rule.outputs.iter().copied().filter(|(output, _)| has(track, *output)).unzip();
        if which.is_empty() {
            return Err(FitError::Outputs { log: log.clone(), what: "joint angles, which an arm" });
        }
        let begins = track.position(0);
        let away = distance(&begins, &case.waypoints[0], rule.axes);
        let within = rule.sampling.start_m.unwrap_or(rule.radius);
        if away > within {
            let told = |p: &Point3<f64>| format!("({:.2}, {:.2}, {:.2}) m", p.x, p.y, p.z);
            let (begins, start) = (told(&begins), told(&case.waypoints[0]));
            return Err(FitError::Start { log: log.clone(), mission: mission.clone(), begins, away, start, within });
        }
        let begun = begins_of_legs(track, &case.waypoints, rule).map_err(|Missed { waypoint, nearest }| {
            let nearest = nearest * rule.radius;
            let within = rule.radius;
            FitError::Missed { log: log.clone(), mission: mission.clone(), waypoint, nearest, within }
        })?;
        let last = begun.len() - 1;
        let first = usize::from(!rule.timed && begun.len() > 1);
        let mut samples = Vec::new();
        for (leg, &from) in begun.iter().enumerate().skip(first) {
            let to = if leg < last {
                begun[leg + 1]
            } else if rule.timed {
                end
            } else {
                (from + AFTER).min(end)
            };
            let count = ((to - from) / period).floor() as usize;
            samples.extend((0..count).map(|i| (leg, (i as f64 + 0.5) * period)));
        }
        let mut compared = Self { samples, logged: Vec::new(), outputs, end: found, begun, which };
        compared.logged = compared.outputs_of(track, &compared.begun, &compared.which, rule);
        Ok(compared)
    }

    /// Logged less simulated.
    pub(super) fn less(&self, simulated: &[Vec<f64>]) -> Vec<Vec<f64>> {
        let differences = self.logged.iter().zip(simulated);
        differences.map(|(y, f)| y.iter().zip(f).map(|(y, f)| y - f).collect()).collect()
    }

    /// What `flown` says in the place of the log, sample by sample; `None` where it passes not all waypoints.
    /// As many rows as [`Self::samples`], as many numbers in each as [`Self::outputs`].
    pub(super) fn simulated(&self, flown: &Track, waypoints: &[Point3<f64>], rule: &Rule) -> Option<Vec<Vec<f64>>> {
        let begun = begins_of_legs(flown, waypoints, rule).ok()?;
        Some(self.outputs_of(flown, &begun, &self.which, rule))
    }

    /// How far `flown` is from the log, `track`, sample by sample, m; `None` where it passes not all waypoints.
    pub(super) fn distances(
        &self,
        track: &Track,
        flown: &Track,
        waypoints: &[Point3<f64>],
        rule: &Rule,
    ) -> Option<Vec<f64>> {
        let begun = begins_of_legs(flown, waypoints, rule).ok()?;
        let axes: Vec<Output> = (0..rule.axes).map(Output::Position).collect();
        let logged = self.outputs_of(track, &self.begun, &axes, rule);
        let simulated = self.outputs_of(flown, &begun, &axes, rule);
        let pairs = logged.iter().zip(&simulated);
        Some(pairs.map(|(y, f)| y.iter().zip(f).map(|(y, f)| (y - f) * (y - f)).sum::<f64>().sqrt()).collect())
    }

    fn outputs_of(&self, track: &Track, begun: &[f64], which: &[Output], rule: &Rule) -> Vec<Vec<f64>> {
        let at = |(leg, tau): &(usize, f64)| outputs_at(track, which, begun[*leg] + tau, rule.sampling.period);
        self.samples.iter().map(at).collect()
    }
}

/// In the first `axes` of the world.
fn distance(a: &Point3<f64>, b: &Point3<f64>, axes: usize) -> f64 {
    let way = a - b;
    way.iter().take(axes).map(|part| part * part).sum::<f64>().sqrt()
}

/// When each leg begins, and what comes after the last waypoint; the whole motion as one where it goes by the clock.
fn begins_of_legs(track: &Track, waypoints: &[Point3<f64>], rule: &Rule) -> Result<Vec<f64>, Missed> {
    if rule.timed {
        return Ok(vec![track.times().first().copied().unwrap_or_default()]);
    }
    passages(track, waypoints, (rule.acceptance, rule.radius))
}
