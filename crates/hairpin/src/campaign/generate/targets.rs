//! What the search `worst` is for: one stress, or every limit of a spec.

use crate::campaign::Setup;
use crate::campaign::scenario::SearchMethod;
use crate::campaign::trial::Sought;
use crate::judgement::{Statistics, Stress};

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
    let given = setup.scenario.head().terms.limited().into_iter();
    let given: Vec<Target> =
        given.map(|(stress, limit)| Target { sought: Sought::Measured(stress), limit: Some(limit) }).collect();
    if given.is_empty() { one(Sought::Measured(Stress::default())) } else { given }
}

/// The name of what the largest stress so far of a search is told in: `max_deviation_m`, or `margin_in_spreads` where
/// several limits are searched at once, `target` where the user's own function says it.
///
/// One name for a whole campaign; its values are those of [`Tally::curves`](crate::campaign::tally::Tally).
pub fn column(setup: &Setup) -> String {
    if setup.scenario.search().method != SearchMethod::Worst {
        return setup.scenario.sought().column();
    }
    match *targets(setup) {
        [Target { sought: Sought::Users, .. }] => "target".into(),
        [Target { sought: Sought::Measured(stress), .. }] => stress.column(),
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
            let values = first.iter().flatten().map(|stresses| stresses[target]).filter(|stress| stress.is_finite());
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
        told.filter(|told| told.is_finite()).reduce(f64::max)
    }
}

#[cfg(feature = "unit-tests")]
mod tests {
    use serde_json::{Value, json};

    use super::*;
    use crate::campaign::Scenario;
    use crate::campaign::testing::quadrotor;

    fn told(search: Value, spec: Value) -> (String, Stress) {
        let scenario: Scenario = serde_json::from_value(json!({
            "hairpin": 1, "robot": quadrotor(), "world": { "size_m": [30.0, 30.0, 30.0] }, "spec": spec,
            "task": { "start_m": [3.0, 3.0, 3.0], "end_m": [15.0, 15.0, 15.0], "length": 10 },
            "generate": { "search": search },
        }))
        .unwrap();
        let setup = Setup::new(scenario).unwrap();
        (column(&setup), setup.scenario.sought())
    }

    /// A number has the unit of what was searched for, and what it stands beside is measured alike.
    #[test]
    fn the_only_limit_gives_its_name() {
        let worst = || json!({ "method": "worst" });
        let fast = || json!({ "acceleration": { "max_m_s2": 3.0 } });
        let both = json!({ "acceleration": { "max_m_s2": 3.0 }, "deviation": { "max_m": 0.5 } });
        for (search, spec, name, sought) in [
            (worst(), fast(), "max_acceleration_m_s2", Stress::MaxAcceleration),
            (worst(), json!({ "total_time": { "max_s": 60.0 } }), "time_s", Stress::Time),
            (worst(), json!({ "deviation": { "max_m": 0.5 } }), "max_deviation_m", Stress::MaxDeviation),
            (worst(), both, "margin_in_spreads", Stress::MaxDeviation),
            (json!({ "method": "worst", "target": "time" }), fast(), "time_s", Stress::Time),
            (json!({ "method": "in-loop" }), fast(), "max_deviation_m", Stress::MaxDeviation),
        ] {
            assert_eq!(told(search, spec), (name.to_owned(), sought));
        }
    }
}
