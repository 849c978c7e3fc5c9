//! The closed loop with other numbers, undisturbed, over the missions of logs.

use rayon::prelude::*;
use serde_json::{Value, json};

use super::FitError;
use super::compare::{Compared, Flown, Rule};
use super::passages::nearest;
use crate::campaign::kind::{Adjustable, Fittable, Imitator, Order};
use crate::campaign::{Case, Mistake, Setup};
use crate::math::output_error::Parameter;
use crate::trajectory::Track;

/// Who waits for a robot that is slower than the log's, s beyond the log's end.
const PATIENCE: f64 = 5.0;
/// What ends so much before that time, s, ended by it: recordings have their last sample before.
const LATE: f64 = 0.1;

/// A setup without chance, logs, and the rule that they are compared by.
pub(super) struct Loops<'a> {
    setup: Setup,
    pub(super) numbers: Vec<Adjustable>,
    pub(super) flown: Vec<&'a Flown>,
    /// Leg by leg.
    pub(super) compared: Vec<Compared>,
    pub(super) rule: Rule,
    /// Keys of the robot that were written out for it.
    pub(super) spelt: Vec<(String, Value)>,
    /// Whether what the robot leaves out is derived from its other numbers.
    pub(super) derives: bool,
    /// What may be between the logs' scatter and what a fit leaves.
    pub(super) undescribed: &'static str,
    /// Of gaps, and so many of it in a metre.
    pub(super) unit: (&'static str, f64),
    /// On whom intervals were found to hold.
    pub(super) tried: &'static str,
    /// Who steers, of whom it was never tried whether they hold.
    pub(super) untried: Option<&'static str>,
}

impl<'a> Loops<'a> {
    pub(super) fn new(setup: &Setup, flown: &'a [Flown]) -> Result<Self, FitError> {
        let fittable = setup.kind().fittable().map_err(FitError::NotFittable)?;
        let Fittable { calm, spelt, derives, numbers, outputs, axes, unit, sampling, acceptance, .. } = fittable;
        let Fittable { tried, untried, timed, undescribed, .. } = fittable;
        if flown.is_empty() {
            return Err(FitError::NoLogs);
        }
        let keys = [&calm[..], &spelt[..]].concat();
        let setup = setup.drawn(&keys).map_err(|mistake| FitError::NotFittable(mistake.to_string()))?;
        let radius = setup.scenario.executor().accept;
        let rule = Rule { outputs, sampling, axes, acceptance, radius, timed };
        let compared = flown.iter().map(|one| Compared::of(one, &rule)).collect::<Result<_, _>>()?;
        let flown = flown.iter().collect();
        Ok(Self { setup, numbers, flown, compared, rule, spelt, derives, undescribed, unit, tried, untried })
    }

    /// Bounds and steps of the numbers.
    pub(super) fn parameters(&self) -> impl Iterator<Item = Parameter> {
        self.numbers.iter().map(|number| {
            let [low, high] = number.bounds;
            Parameter { low, high, step: number.step }
        })
    }

    /// The keys of the scenario with `theta` in them.
    ///
    /// A number may stand in several keys, each times a factor of its own.
    pub(super) fn draws(&self, theta: &[f64]) -> Vec<(String, Value)> {
        let keys = self.numbers.iter().zip(theta);
        keys.flat_map(|(number, value)| number.keys.iter().map(move |(key, of)| (key.clone(), json!(value * of))))
            .collect()
    }

    pub(super) fn with(&self, theta: &[f64]) -> Result<Setup, Mistake> {
        self.setup.drawn(&self.draws(theta))
    }

    /// The motion of mission number `at` with these numbers.
    ///
    /// With the case's own seed, which a setup without chance does not use; the plan and the controller's knowledge
    /// of the robot stay those of the robot as given.
    fn fly(&self, setup: &Setup, at: usize) -> Result<Track, String> {
        let case = &self.flown[at].case;
        let around = setup.around(case).map_err(|mistake| mistake.to_string())?;
        let order = self.order(at);
        // Who made the plan, and who steers, know the robot as it was given.
        let flight = around.kind().run(self.setup.kind().same(), case, &order).map_err(|error| error.to_string())?;
        match flight.ended.is_crash() {
            true => Err(format!("it ends in `{}`", flight.ended.word())),
            false => Ok(flight.track),
        }
    }

    /// Logged less simulated, of the logs `which`, sample by sample, all outputs of each; `None` where one is not
    /// simulated.
    pub(super) fn residuals(&self, theta: &[f64], which: &[usize]) -> Option<Vec<Vec<Vec<f64>>>> {
        let setup = self.with(theta).ok()?;
        let of = |&at: &usize| Some(self.compared[at].less(&self.freely(&setup, at)?));
        which.par_iter().map(of).collect()
    }

    /// What is compared of mission number `at`, flown freely.
    fn freely(&self, setup: &Setup, at: usize) -> Option<Vec<Vec<f64>>> {
        let flown = self.flown[at];
        self.compared[at].simulated(&self.fly(setup, at).ok()?, &flown.case.waypoints, &self.rule)
    }

    /// Who imitates the logs `which`, where the kind has its logs imitated.
    ///
    /// # Errors
    /// A mission whose plan nobody can follow.
    pub(super) fn imitator(&self, which: &[usize]) -> Result<Option<Box<dyn Imitator + '_>>, FitError> {
        let cases: Vec<&Case> = which.iter().map(|at| &self.flown[*at].case).collect();
        self.setup.kind().imitator(&cases).map_err(|error| FitError::NotFittable(error.to_string()))
    }

    /// The motion that `imitator`, of logs `which`, makes of number `own` of them with `setup`, drawn by `seed`, with
    /// so much noise; `None` where it does not come to its end.
    pub(super) fn imitate(
        &self,
        setup: &Setup,
        imitator: &dyn Imitator,
        (which, own): (&[usize], usize),
        (seed, noise): (u64, f64),
    ) -> Option<Track> {
        let around = setup.around(&self.flown[which[own]].case).ok()?;
        let order = Order { seed, ..self.order(which[own]) };
        let flight = imitator.run(around.kind().same(), own, &order, noise).ok()?;
        (!flight.ended.is_crash()).then_some(flight.track)
    }

    /// How mission number `at` is flown: somewhat longer than the log, and with nothing in the way. With other numbers
    /// it may come nearer to what the log kept off.
    fn order(&self, at: usize) -> Order<'_> {
        let case = &self.flown[at].case;
        let time_limit = self.compared[at].end + PATIENCE;
        Order { waypoints: &case.waypoints, accept: self.rule.radius, time_limit, seed: case.seed, obstacles: false }
    }

    /// How far the motion with these numbers is from log number `at`, sample by sample, m.
    pub(super) fn distances(&self, theta: &[f64], at: usize) -> Option<Vec<f64>> {
        let (setup, flown) = (self.with(theta).ok()?, self.flown[at]);
        let track = self.fly(&setup, at).ok()?;
        self.compared[at].distances(&flown.track, &track, &flown.case.waypoints, &self.rule)
    }

    /// The first waypoint that log number `at` keeps farther off than `simulated` does, where motions go by the clock
    /// and no passage is asked for: a log of another mission would be compared as a whole, and be late everywhere.
    ///
    /// Twice as far as a log may begin from the first waypoint is allowed beyond what the simulation keeps off: corners
    /// are cut by lags that are to be found.
    fn kept_off(&self, at: usize, simulated: &Track) -> Option<FitError> {
        if !self.rule.timed {
            return None;
        }
        let Flown { log, mission, case, track } = self.flown[at];
        let allowed = 2.0 * self.rule.sampling.start_m.unwrap_or(self.rule.radius);
        let off = |track: &Track, to| nearest(track, to, self.rule.axes);
        case.waypoints.iter().enumerate().skip(1).find_map(|(waypoint, to)| {
            let (nearest, within) = (off(track, to), off(simulated, to) + allowed);
            let kept_off = FitError::Missed { log: log.clone(), mission: mission.clone(), waypoint, nearest, within };
            (nearest > within).then_some(kept_off)
        })
    }

    /// Why the first mission that is not simulated with `theta` is not, or its log is none of it.
    /// `None` where all are.
    pub(super) fn refused(&self, theta: &[f64]) -> Option<FitError> {
        let told = |at: usize, why: String| FitError::Simulated { mission: self.flown[at].mission.clone(), why };
        let setup = match self.with(theta) {
            Ok(setup) => setup,
            Err(mistake) => return Some(told(0, mistake.to_string())),
        };
        (0..self.flown.len()).find_map(|at| match self.fly(&setup, at) {
            Err(why) => Some(told(at, why)),
            Ok(track) => {
                let passed = self.compared[at].simulated(&track, &self.flown[at].case.waypoints, &self.rule);
                match passed {
                    None => Some(told(at, self.late(at, &track).unwrap_or_else(|| "it misses a waypoint".into()))),
                    Some(_) => self.kept_off(at, &track),
                }
            }
        })
    }

    /// That the simulation of mission number `at` ended before it came to its end, as the log's robot is faster.
    fn late(&self, at: usize, simulated: &Track) -> Option<String> {
        let (limit, last) = (self.order(at).time_limit, simulated.times().last()?);
        let (log, end) = (&self.flown[at].log, self.compared[at].end);
        (last + LATE >= limit).then(|| {
            format!("{log} is at its end after {end:.1} s, and it is on its way {PATIENCE} s later: it is slower than what was logged")
        })
    }
}
