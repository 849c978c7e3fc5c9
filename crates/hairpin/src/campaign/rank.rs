//! Where a stress lies among those of other cases.

use super::case::CaseResult;
use super::case_number::CaseNumber;
use super::chance::Baseline;
use crate::judgement::{Measures, Stress};

/// A stress among others.
///
/// Turned where less is worse, so that `below` are always the less stressful ones.
#[derive(Debug, Clone, PartialEq)]
pub struct Rank {
    /// The others.
    pub of: Baseline,
    /// How many of them are less stressful.
    pub below: usize,
    /// By their worst, where both are above 0 and more is worse.
    pub to_worst: Option<f64>,
    /// By their mean, likewise.
    pub to_mean: Option<f64>,
}

impl Rank {
    /// `value`, measured as `stress`, among `others`, of which each had `repeat` runs; `None` where none was measured.
    pub fn of(stress: Stress, repeat: u64, value: f64, others: &[CaseResult]) -> Option<Self> {
        let of = Baseline::of(stress, repeat, others)?;
        let sign = if of.less_is_worse { -1.0 } else { 1.0 };
        let below = stresses(stress, others).filter(|(_, other)| sign * other < sign * value).count();
        let by = |other: f64| (!of.less_is_worse && value >= 0.0 && other > 0.0).then(|| value / other);
        Some(Self { below, to_worst: by(of.worst), to_mean: by(of.mean), of })
    }

    /// The share of the others that are less stressful, %.
    ///
    /// 100 below / cases; 0 … 100.
    pub fn percentile(&self) -> f64 {
        100.0 * self.below as f64 / self.of.cases as f64
    }
}

/// The stress of each case that was measured, the worst over its runs, as it is measured.
pub fn stresses(stress: Stress, results: &[CaseResult]) -> impl Iterator<Item = (CaseNumber, f64)> {
    let value = move |measures: &Measures| {
        let sign = if stress.is_turned(measures) { -1.0 } else { 1.0 };
        Some(sign * stress.of(measures).filter(|value| value.is_finite())?)
    };
    results.iter().filter_map(move |result| Some((result.case, value(result.measured()?)?)))
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;
    use crate::campaign::Status;

    fn results(of: &[f64], measure: fn(f64) -> Measures) -> Vec<CaseResult> {
        let one = |(number, value): (usize, &f64)| CaseResult {
            measures: Some(measure(*value)),
            ended: "done".into(),
            ..CaseResult::bare(CaseNumber(number), Status::Unjudged)
        };
        of.iter().enumerate().map(one).collect()
    }

    #[test]
    fn a_rank_counts_what_is_less_stressful() {
        let others = results(&[0.5, 1.0, 2.0, 4.0], |max_deviation| Measures { max_deviation, ..Measures::default() });
        let rank = |value| Rank::of(Stress::MaxDeviation, 2, value, &others).unwrap();
        let found = rank(1.5);
        assert_eq!((found.below, found.percentile(), found.of.executions), (2, 50.0, 8));
        assert_eq!((found.to_worst, found.to_mean), (Some(1.5 / 4.0), Some(1.5 / 1.875)));
        assert_eq!((rank(0.1).below, rank(9.0).below, rank(1.0).below), (0, 4, 1));
        assert!(Rank::of(Stress::MaxDeviation, 2, 1.0, &[]).is_none());
        // Of clearances less is worse, and nobody divides by them.
        let near = results(&[0.2, 0.5, 0.8], |near| Measures { min_clearance: Some(near), ..Measures::default() });
        let found = Rank::of(Stress::Clearance, 1, 0.3, &near).unwrap();
        assert_eq!((found.below, found.to_worst, found.of.worst), (2, None, 0.2));
    }
}
