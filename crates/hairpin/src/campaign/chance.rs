//! What a campaign's stress stands beside: as many numbers from cases that nobody chose, flown alike.
//!
//! A stress of 2.1 m says little; beside 1.2 m of random feasible missions, flown by the same controller under the
//! same draws, it says something. Numbers are the worst of a case over its runs.

use std::collections::BTreeMap;

use super::case::{CaseResult, Status};
use super::digits::number;
use super::setup::Setup;
use crate::judgement::{Measures, Statistics, Stress, Violation, mean_interval, told};
use crate::trajectory::Ended;

/// Random feasible cases, measured by what the campaign searches for.
///
/// Random cases are independent draws, so that mean and interval are estimates of the population that the search
/// chose from.
#[derive(Debug, Clone, PartialEq)]
pub struct Baseline {
    /// Cases that were measured.
    pub cases: usize,
    /// Cases beside these that were not, because an execution failed.
    pub failed: usize,
    /// Cases beside these that were left out, because a program told a motion of one of their runs that no robot of its
    /// kind makes.
    pub implausible: usize,
    /// Runs of all cases.
    pub executions: usize,
    /// What is measured, of each case the worst over its runs, whatever else its spec limits.
    pub stress: Stress,
    /// Whether less is worse: [`Stress::is_turned`]. Numbers here are as they were measured.
    pub less_is_worse: bool,
    /// In the unit of the stress.
    pub mean: f64,
    /// 95 % interval of the mean by Student's t, at 0 at least where nothing can be below; `None` for a single case.
    /// x̄ ± t₀.₉₇₅(n − 1) s/√n.
    pub interval: Option<[f64; 2]>,
    /// In the unit of the stress.
    pub median: f64,
    /// The largest.
    pub max: f64,
    /// The worst: the largest, or the least where less is worse.
    pub worst: f64,
    /// How runs ended that did not come to their goal, and how many cases' worst runs did so: they are measured as far
    /// as they came.
    pub cut_short: BTreeMap<String, usize>,
}

impl Baseline {
    /// Of cases whose `results` were `repeat` runs each; `None` where none was measured.
    pub fn of(stress: Stress, repeat: u64, results: &[CaseResult]) -> Option<Self> {
        let measured: Vec<(f64, bool)> = values(stress, results).collect();
        let less_is_worse = measured.iter().any(|(_, turned)| *turned);
        let values: Vec<f64> = measured.into_iter().map(|(value, _)| value).collect();
        let Statistics { mean, median, min, max, .. } = Statistics::of(&values)?;
        let bound = |end: f64| if min >= 0.0 { end.max(0.0) } else { end };
        Some(Self {
            cases: values.len(),
            failed: results.iter().filter(|result| result.status == Status::ExecutorFailed).count(),
            implausible: results.iter().filter(|result| result.status == Status::Inconclusive).count(),
            executions: results.len() * repeat as usize,
            stress,
            less_is_worse,
            mean,
            interval: mean_interval(&values).map(|ends| ends.map(bound)),
            median,
            max,
            worst: if less_is_worse { min } else { max },
            cut_short: cut_short(results),
        })
    }

    /// By how many percent the mean of `results` lies above its own; `None` where less is worse, or one of them is not
    /// above 0.
    ///
    /// 100 (x̄ of `results` − mean) / mean.
    pub fn stress_percent(&self, results: &[CaseResult]) -> Option<f64> {
        let values: Vec<f64> = values(self.stress, results).map(|(value, _)| value).collect();
        let Statistics { mean, .. } = Statistics::of(&values)?;
        let told = !self.less_is_worse && mean > 0.0 && self.mean > 0.0;
        told.then(|| 100.0 * (mean / self.mean - 1.0))
    }

    /// `random feasible ones 1.22 m in the mean (1.05 to 1.40), 1.90 m at worst of 20`.
    ///
    /// Deviations go without their name where they stand `alone`, beside nothing but another deviation.
    pub fn in_words(&self, setup: &Setup, alone: bool) -> String {
        let name = match self.stress {
            Stress::MaxDeviation if alone => String::new(),
            // Of what has one the margin is measured, of which less is worse.
            Stress::Tilt if self.less_is_worse => ": tip-over margin".into(),
            other => format!(": {}", other.word().replace('-', " ")),
        };
        let [mean, worst] = [self.mean, self.worst].map(|value| self.told(setup, value));
        let interval = self.interval_in_words(setup).map_or(String::new(), |interval| format!(" ({interval})"));
        let cut = match self.cut_short.values().sum::<usize>() {
            0 => String::new(),
            count => {
                let ways: Vec<String> =
                    self.cut_short.iter().map(|(ended, count)| format!("{count} {ended}")).collect();
                format!(", {count} of them cut short ({})", ways.join(", "))
            }
        };
        let of = format!("{}{cut}{}", self.cases, self.others_in_words());
        format!("random feasible ones{name} {mean} in the mean{interval}, {worst} at worst of {of}")
    }

    /// `, 2 more failed, 1 more left out (no motion of its robot)`, or nothing.
    pub(super) fn others_in_words(&self) -> String {
        let of = |count: usize, what: &str| match count {
            0 => String::new(),
            count => format!(", {count} more {what}"),
        };
        of(self.failed, "failed") + &of(self.implausible, "left out (no motion of its robot)")
    }

    /// What they are, for whoever reads what a campaign rests on.
    pub fn said(&self, setup: &Setup) -> String {
        let sampler = setup.kind().solver().map_or("not drawn", |solver| solver.drawn_how());
        format!(
            "Random feasible cases: {} of the same feasible set, drawn from a graph of their own each, {sampler}, with as many runs each and draws of their own (baseline.parquet); \
             measured, not judged, and counted nowhere. The interval of their mean is Student's, 95 %.{}",
            self.cases,
            self.others_in_full()
        )
    }

    /// That some were not measured, in a sentence of its own, or nothing.
    fn others_in_full(&self) -> String {
        let failed = match self.failed {
            0 => String::new(),
            failed => {
                format!(" Executions of {failed} more failed: their stress is not known, and no part of the mean.")
            }
        };
        match self.implausible {
            0 => failed,
            count => {
                format!(
                    "{failed} {count} more are left out: their program told a motion that no robot of its kind makes."
                )
            }
        }
    }

    /// `1.05 to 1.40`, in the unit that [`Self::told`] has.
    pub fn interval_in_words(&self, setup: &Setup) -> Option<String> {
        let [low, high] = self.interval?.map(|end| digits(&self.in_unit(setup, end)));
        Some(format!("{low} to {high}"))
    }

    /// `value` with the unit that it is told in.
    pub fn told(&self, setup: &Setup, value: f64) -> String {
        let found = self.in_unit(setup, value);
        match found.unit.as_str() {
            "°" => format!("{:.1}°", found.value),
            "" => digits(&found),
            unit => format!("{} {unit}", digits(&found)),
        }
    }

    /// Beside the limit of the deviation where that is what is sought; the limit is no number where there is none.
    fn in_unit(&self, setup: &Setup, value: f64) -> Violation {
        let (what, limit) = match self.stress {
            Stress::MaxDeviation => ("deviation", setup.scenario.deviation_limit()),
            other => (other.word(), None),
        };
        let (unit, limit) = (self.stress.unit().to_owned(), limit.unwrap_or(f64::NAN));
        let measured = Violation { what: what.into(), value, limit, unit, at: 0.0, leg: 0 };
        match setup.kind().programs() {
            Some(programs) => programs.in_their_units(measured),
            None => measured,
        }
    }
}

/// With the digits of the limit, as the verdict has them.
fn digits(found: &Violation) -> String {
    if found.limit.is_nan() { number(Some(found.value)) } else { told(found.value, Some(found.limit), &found.unit) }
}

/// As [`Baseline::cut_short`] has it.
fn cut_short(results: &[CaseResult]) -> BTreeMap<String, usize> {
    let mut ways = BTreeMap::new();
    for result in results.iter().filter(|result| result.measures.is_some() && result.ended != Ended::Done.word()) {
        *ways.entry(result.ended.clone()).or_default() += 1;
    }
    ways
}

/// The worst that was measured of each case, and whether less of it is worse.
fn values(stress: Stress, results: &[CaseResult]) -> impl Iterator<Item = (f64, bool)> {
    let value = move |measures: &Measures| {
        let turned = stress.is_turned(measures);
        Some((stress.of(measures).filter(|value| value.is_finite())? * if turned { -1.0 } else { 1.0 }, turned))
    };
    results.iter().filter_map(move |result| value(result.measured()?))
}

#[cfg(feature = "unit-tests")]
mod tests {
    use serde_json::json;

    use super::*;
    use crate::campaign::testing::quadrotor;
    use crate::campaign::{CaseNumber, Scenario, Status};

    fn results(of: &[Option<f64>], measure: fn(f64) -> Measures) -> Vec<CaseResult> {
        let one = |(number, value): (usize, &Option<f64>)| CaseResult {
            measures: value.map(measure),
            ended: "done".into(),
            ..CaseResult::bare(CaseNumber(number), Status::Unjudged)
        };
        of.iter().enumerate().map(one).collect()
    }

    fn deviating(by: &[Option<f64>]) -> Vec<CaseResult> {
        results(by, |max_deviation| Measures { max_deviation, ..Measures::default() })
    }

    #[test]
    fn what_could_be_measured_counts() {
        let of = |values: &[Option<f64>]| Baseline::of(Stress::MaxDeviation, 3, &deviating(values));
        let found = of(&[Some(1.0), None, Some(3.0), Some(8.0)]).unwrap();
        assert_eq!((found.cases, found.executions, found.less_is_worse), (3, 12, false));
        assert_eq!((found.mean, found.median, found.max, found.worst), (4.0, 3.0, 8.0, 8.0));
        // s² = 13: 4 ± 4.3027 √(13/3), and no distance is below 0.
        let [low, high] = found.interval.unwrap();
        assert!(low == 0.0 && (high - 12.9566).abs() < 1e-3, "{low} {high}");
        assert_eq!((of(&[None]), of(&[Some(f64::NAN)])), (None, None));
        let unlike = CaseResult::bare(CaseNumber(2), Status::Inconclusive);
        let beside = [deviating(&[Some(1.0), Some(3.0)]), vec![unlike]].concat();
        let found = Baseline::of(Stress::MaxDeviation, 1, &beside).unwrap();
        assert_eq!((found.cases, found.implausible, found.mean), (2, 1, 2.0));
        assert_eq!(found.others_in_words(), ", 1 more left out (no motion of its robot)");
        assert_eq!(of(&[Some(2.0)]).unwrap().interval, None);
    }

    /// A number without a name beside a clearance reads as one.
    #[test]
    fn a_deviation_is_named_beside_something_else() {
        let scenario = json!({
            "hairpin": 1, "robot": quadrotor(), "world": { "size_m": [30.0, 30.0, 30.0] },
            "task": { "start_m": [3.0, 3.0, 3.0], "end_m": [23.0, 3.0, 3.0], "length": 2 },
        });
        let setup = Setup::new(serde_json::from_value::<Scenario>(scenario).unwrap()).unwrap();
        let random = Baseline::of(Stress::MaxDeviation, 1, &deviating(&[Some(1.0), Some(3.0)])).unwrap();
        let crashed = |ended: &str, result| CaseResult { ended: ended.into(), ..result };
        let ways = deviating(&[Some(1.0), Some(3.0), None, Some(2.0)]).into_iter();
        let ways: Vec<_> = ways.zip(["obstacle", "done", "", "time"]).map(|(one, ended)| crashed(ended, one)).collect();
        let cut = Baseline::of(Stress::MaxDeviation, 1, &ways).unwrap().in_words(&setup, true);
        assert!(cut.ends_with(" at worst of 3, 2 of them cut short (1 obstacle, 1 time)"), "{cut}");
        let told = [true, false].map(|alone| random.in_words(&setup, alone));
        assert!(told[0].starts_with("random feasible ones 2"), "{}", told[0]);
        assert!(told[1].starts_with("random feasible ones: max deviation 2"), "{}", told[1]);
    }

    /// A margin that is called a tilt reads as if the vehicle leaned so far.
    #[test]
    fn margins_are_told_as_margins() {
        let margins = results(&[Some(40.0), Some(30.0)], |margin| Measures {
            min_tip_over_margin: Some(margin),
            ..Measures::default()
        });
        let random = Baseline::of(Stress::Tilt, 1, &margins).unwrap();
        let scenario = json!({
            "hairpin": 1, "robot": quadrotor(), "world": { "size_m": [30.0, 30.0, 30.0] },
            "task": { "start_m": [3.0, 3.0, 3.0], "end_m": [23.0, 3.0, 3.0], "length": 2 },
        });
        let setup = Setup::new(serde_json::from_value::<Scenario>(scenario).unwrap()).unwrap();
        let told = random.in_words(&setup, false);
        assert!(
            told.starts_with("random feasible ones: tip-over margin 35.0°") && told.contains("30.0° at worst"),
            "{told}"
        );
    }

    #[test]
    fn stress_is_told_by_the_mean() {
        let random = Baseline::of(Stress::MaxDeviation, 1, &deviating(&[Some(1.0), Some(3.0)])).unwrap();
        let percent = |values: &[Option<f64>]| random.stress_percent(&deviating(values));
        assert_eq!((percent(&[Some(3.0), Some(5.0)]), percent(&[Some(1.0)])), (Some(100.0), Some(-50.0)));
        assert_eq!((percent(&[None]), percent(&[Some(0.0)])), (None, None));
        let near = |values: &[Option<f64>]| {
            results(values, |clearance| Measures { min_clearance: Some(clearance), ..Measures::default() })
        };
        let clear = Baseline::of(Stress::Clearance, 1, &near(&[Some(0.5), Some(0.2), Some(0.8)])).unwrap();
        assert_eq!((clear.mean, clear.max, clear.worst, clear.less_is_worse), (0.5, 0.8, 0.2, true));
        assert_eq!(clear.stress_percent(&near(&[Some(0.1)])), None);
    }
}
