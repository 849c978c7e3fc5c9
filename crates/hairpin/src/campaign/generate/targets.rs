//! What the search `worst` is for: one stress, or every limit of a spec.

use crate::campaign::Setup;
use crate::campaign::scenario::SearchMethod;
use crate::campaign::trial::Sought;
use crate::judgement::{Limits, Statistics, Stress};

/// What is measured, and the limit that is asked of it, as it is measured: more is worse.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Target {
    pub(super) sought: Sought,
    pub(super) limit: Option<f64>,
}

/// The target that the scenario names, or its stress where that is not the usual one; else all limits of its spec, and
/// where there are none the deviation.
///
/// Limits that must not be fallen short of (clearance, tip-over margin) are turned, so that more is worse throughout.
/// At least one.
pub(super) fn targets(setup: &Setup) -> Vec<Target> {
    let search = setup.scenario.search();
    let one = |sought| vec![Target { sought, limit: None }];
    if let Some(target) = search.target {
        return one(target.stress().map_or(Sought::Users, Sought::Measured));
    }
    if search.stress != Stress::default() {
        return one(Sought::Measured(search.stress));
    }
    let Limits { deviation, overshoot, clearance, tip_over_margin, acceleration, total_time, late, unfinished: _ } =
        setup.scenario.head().terms.limits;
    let least = |limit: Option<f64>| limit.map(|limit| -limit);
    let limits = [
        (Stress::MaxDeviation, deviation),
        (Stress::Overshoot, overshoot),
        (Stress::Clearance, least(clearance)),
        (Stress::Tilt, least(tip_over_margin)),
        (Stress::MaxAcceleration, acceleration),
        (Stress::Time, total_time),
        (Stress::Lateness, late),
    ];
    let given = limits.into_iter().filter(|(_, limit)| limit.is_some());
    let given: Vec<Target> = given.map(|(stress, limit)| Target { sought: Sought::Measured(stress), limit }).collect();
    if given.is_empty() { one(Sought::Measured(Stress::default())) } else { given }
}

/// The name of what the largest stress so far of a search is told in: `max_deviation_m`, or `margin_in_spreads` where
/// several limits are searched at once, `target` where the user's own function says it.
///
/// One name for a whole campaign; its values are those of [`Tally::curves`](crate::campaign::tally::Tally).
pub fn column(setup: &Setup) -> String {
    let search = setup.scenario.search();
    if search.method != SearchMethod::Worst {
        return search.sought().column();
    }
    match *targets(setup) {
        [Target { sought: Sought::Users, .. }] => "target".into(),
        [_] => search.sought().column(),
        _ => "margin_in_spreads".into(),
    }
}

/// How stresses are told: as they are where there is one, and as what they are beyond their limits, in spreads of what
/// was drawn at random, where there are several.
///
/// (stress − limit) / spread: above 0 is a violation, and limits of different units can stand in one curve.
pub(super) struct Margins<'a> {
    targets: &'a [Target],
    spreads: Vec<f64>,
}

impl<'a> Margins<'a> {
    /// Over the stresses of what was drawn `first`, one for each target.
    ///
    /// The spread is the standard deviation, or 1 in the stress's own unit where that is 0.
    pub(super) fn of(targets: &'a [Target], first: &[Option<Vec<f64>>]) -> Self {
        let spread = |target: usize| {
            let values = first.iter().flatten().map(|stresses| stresses[target]).filter(|stress| !stress.is_nan());
            let spread = Statistics::of(&values.collect::<Vec<_>>()).map(|statistics| statistics.std);
            spread.filter(|spread| *spread > 0.0).unwrap_or(1.0)
        };
        Self { targets, spreads: (0..targets.len()).map(spread).collect() }
    }

    /// What is told of `stress` by target number `target`.
    pub(super) fn told(&self, target: usize, stress: f64) -> f64 {
        match self.targets[target].limit.filter(|_| self.targets.len() > 1) {
            Some(limit) => (stress - limit) / self.spreads[target],
            None => stress,
        }
    }

    /// The largest of what is told of an execution.
    pub(super) fn most(&self, stresses: &[f64]) -> Option<f64> {
        let told = stresses.iter().enumerate().map(|(target, stress)| self.told(target, *stress));
        told.filter(|told| !told.is_nan()).reduce(f64::max)
    }
}
