//! What of a log is compared, and what a simulation says in its place.

use nalgebra::{Point3, Vector3};

use super::FitError;
use super::passages::{Missed, passages};
use crate::campaign::Case;
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
#[derive(Debug, Clone, Copy)]
pub(super) struct Rule {
    /// Where a waypoint counts as reached.
    pub(super) acceptance: Acceptance,
    /// Within so many m.
    pub(super) radius: f64,
    /// Whether all is counted from the start, not from each waypoint.
    pub(super) timed: bool,
}

/// Shortest motion of a log that is compared, s, and least samples in a second.
const LEAST_S: f64 = 5.0;
const LEAST_HZ: f64 = 8.0;
/// Samples are compared so often, s.
pub(super) const PERIOD: f64 = 0.1;
/// After the last waypoint so much is compared, s: what a simulation lingers.
const AFTER: f64 = 2.0;
/// A log may begin so far from the first waypoint, in radii.
const START: f64 = 1.0;

/// What a stretch of a track is made of: position, and velocity, thrust axis and the mean of the rotors' squared speeds
/// where there are any.
const OUTPUTS: [usize; 9] = [0, 0, 1, 2, 2, 3, 4, 4, 5];

/// How many numbers outputs have.
pub(super) const OUTPUT_NUMBERS: usize = 6;

/// The log's side of a comparison.
#[derive(Debug, Clone)]
pub(super) struct Compared {
    /// Of each sample: leg, and time after it began, s.
    pub(super) samples: Vec<(usize, f64)>,
    /// Of each sample all outputs that the log has.
    pub(super) logged: Vec<Vec<f64>>,
    /// Of each output: which of [`OUTPUTS`].
    pub(super) outputs: Vec<usize>,
    /// How long it is, s.
    pub(super) end: f64,
    columns: Columns,
}

/// Which outputs a track has.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Columns {
    velocity: bool,
    attitude: bool,
    rotors: bool,
}

impl Columns {
    fn of(track: &Track) -> Self {
        let has = |names: &[&str]| names.iter().all(|name| track.channel(name).is_some());
        Self {
            velocity: has(&VELOCITY),
            attitude: track.channel(crate::trajectory::ATTITUDE_UNKNOWN).is_none(),
            rotors: has(&ROTORS),
        }
    }

    fn outputs(self) -> Vec<usize> {
        let has = |output: usize| match output {
            0 | 1 => true,
            2 | 3 => self.velocity,
            4 => self.attitude,
            _ => self.rotors,
        };
        OUTPUTS.into_iter().filter(|output| has(*output)).collect()
    }
}

const VELOCITY: [&str; 3] = ["vx_m_s", "vy_m_s", "vz_m_s"];
const ROTORS: [&str; 4] = ["rotor1_rad_s", "rotor2_rad_s", "rotor3_rad_s", "rotor4_rad_s"];

impl Compared {
    /// The legs of a log that are compared.
    ///
    /// From waypoint to waypoint the first leg is left out: from poses nobody knows when it was ordered.
    pub(super) fn of(flown: &Flown, rule: &Rule) -> Result<Self, FitError> {
        let Flown { log, mission, case, track } = flown;
        let times = track.times();
        let (start, end) = (times.first().copied().unwrap_or(0.0), times.last().copied().unwrap_or(0.0));
        let found = end - start;
        if found < LEAST_S {
            return Err(FitError::Short { log: log.clone(), found, least: LEAST_S });
        }
        let rate = (track.len() - 1) as f64 / found;
        if rate < LEAST_HZ {
            return Err(FitError::Sparse { log: log.clone(), found: rate, least: LEAST_HZ });
        }
        let begins = track.position(0);
        let away = (begins - case.waypoints[0]).norm();
        let within = START * rule.radius;
        if away > within {
            let told = |p: &Point3<f64>| format!("({:.2}, {:.2}, {:.2}) m", p.x, p.y, p.z);
            let (begins, start) = (told(&begins), told(&case.waypoints[0]));
            return Err(FitError::Start { log: log.clone(), mission: mission.clone(), begins, away, start, within });
        }
        let columns = Columns::of(track);
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
            let count = ((to - from) / PERIOD).floor() as usize;
            samples.extend((0..count).map(|i| (leg, (i as f64 + 0.5) * PERIOD)));
        }
        let logged = samples.iter().map(|(leg, tau)| outputs_at(track, columns, begun[*leg] + tau)).collect();
        Ok(Self { samples, logged, outputs: columns.outputs(), end: found, columns })
    }

    /// What `flown` says in the place of the log, sample by sample; `None` where it passes not all waypoints.
    pub(super) fn simulated(&self, flown: &Track, waypoints: &[Point3<f64>], rule: &Rule) -> Option<Vec<Vec<f64>>> {
        let begun = begins_of_legs(flown, waypoints, rule).ok()?;
        let at = |(leg, tau): &(usize, f64)| outputs_at(flown, self.columns, begun[*leg] + tau);
        Some(self.samples.iter().map(at).collect())
    }
}

/// When each leg begins, and what comes after the last waypoint; the whole motion as one where it goes by the clock.
fn begins_of_legs(track: &Track, waypoints: &[Point3<f64>], rule: &Rule) -> Result<Vec<f64>, Missed> {
    if rule.timed {
        return Ok(vec![track.times().first().copied().unwrap_or_default()]);
    }
    passages(track, waypoints, (rule.acceptance, rule.radius))
}

/// The outputs at `t`, each by a line through the samples within half a period of it, or between the two around it
/// where these are few; as at its end where the track is over.
fn outputs_at(track: &Track, columns: Columns, t: f64) -> Vec<f64> {
    let times = track.times();
    let t = t.clamp(times[0], times[times.len() - 1]);
    let near =
        times.partition_point(|time| *time < t - 0.5 * PERIOD)..times.partition_point(|time| *time <= t + 0.5 * PERIOD);
    let range = if near.len() >= 4 {
        near
    } else {
        let after = times.partition_point(|time| *time < t).clamp(1, times.len() - 1);
        after - 1..after + 1
    };
    let line = Line::through(&times[range.clone()], t);
    let mut found = Vec::with_capacity(OUTPUTS.len());
    let mut push = |value: &dyn Fn(usize) -> f64| found.push(line.at(range.clone().map(value)));
    for axis in 0..3 {
        push(&|i| track.position(i)[axis]);
    }
    if columns.velocity {
        for name in VELOCITY {
            let values = track.channel(name).unwrap_or_default();
            push(&|i| values[i]);
        }
    }
    if columns.attitude {
        for axis in 0..2 {
            push(&|i| (track.poses()[i].rotation * Vector3::z())[axis]);
        }
    }
    if columns.rotors {
        let speeds = ROTORS.map(|name| track.channel(name).unwrap_or_default());
        push(&|i| 0.25 * speeds.iter().map(|speed| speed[i] * speed[i]).sum::<f64>());
    }
    found
}

/// Weights of samples whose least-squares line is asked for at one time.
struct Line(Vec<f64>);

impl Line {
    fn through(times: &[f64], t: f64) -> Self {
        let n = times.len() as f64;
        let mean = times.iter().sum::<f64>() / n;
        let spread: f64 = times.iter().map(|time| (time - mean) * (time - mean)).sum();
        Self(times.iter().map(|time| 1.0 / n + (t - mean) * (time - mean) / spread).collect())
    }

    fn at(&self, values: impl Iterator<Item = f64>) -> f64 {
        self.0.iter().zip(values).map(|(weight, value)| weight * value).sum()
    }
}
