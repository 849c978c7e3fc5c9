//! How much more a way of generating stresses a robot than another: the paper's measure of scores.

use hairpin::campaign::judge::measures_of;
use hairpin::campaign::{Case, Run, Setup, Stop, execute_run};
use hairpin::judgement::{Measures, Statistics, Stress};
use hairpin::math::random::stream;
use hairpin::trajectory::Ended;
use rand::RngExt;
use rayon::prelude::*;

/// Resamples of a bootstrap interval.
const RESAMPLES: usize = 2_000;

/// Measures and end of every run of a case.
type Runs = Vec<(Measures, Option<Ended>)>;

/// Trajectories executed, and what they came to.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Flown {
    /// Stress of every case that could be measured, the mean over its runs.
    pub(super) stresses: Vec<f64>,
    /// Place of each of those among the cases given.
    pub(super) places: Vec<usize>,
    /// Share of runs that ended in a crash.
    pub(super) crashed: f64,
    /// Share of runs that ended by their time limit.
    pub(super) timed_out: f64,
}

impl Flown {
    /// Executes `cases` as `setup` says, each as often as its `execute.repeat`, and tells what they came to by each of
    /// `stresses`. `None` where `stop` asked to.
    pub(super) fn of<const N: usize>(
        setup: &Setup,
        cases: &[Case],
        stresses: [Stress; N],
        stop: &Stop,
    ) -> Option<[Self; N]> {
        let repeat = setup.scenario.executor().repeat as usize;
        let flown: Option<Vec<Runs>> = cases
            .par_iter()
            .map(|case| {
                let run = |run| measured(setup, case, execute_run(setup, case, run));
                (!(stop.cancelled)()).then(|| (0..repeat).filter_map(run).collect())
            })
            .collect();
        let flown = flown?;
        Some(stresses.map(|stress| Self::by(stress, &flown)))
    }

    /// What `runs` of `cases`, whoever flew them, came to by each of `stresses`.
    pub(super) fn by_runs<const N: usize>(
        setup: &Setup,
        cases: &[Case],
        runs: Vec<Vec<Run>>,
        stresses: [Stress; N],
    ) -> [Self; N] {
        let of_case = |(case, runs): (&Case, Vec<Run>)| -> Runs {
            runs.into_iter().filter_map(|run| measured(setup, case, run)).collect()
        };
        let flown: Vec<Runs> = cases.iter().zip(runs).map(of_case).collect();
        stresses.map(|stress| Self::by(stress, &flown))
    }

    fn by(stress: Stress, flown: &[Runs]) -> Self {
        let measured = |runs: &Runs| -> Vec<_> {
            runs.iter().filter_map(|(measures, ended)| Some((stress.of(measures)?, *ended))).collect()
        };
        let flown: Vec<Vec<(f64, Option<Ended>)>> = flown.iter().map(measured).collect();
        let runs = || flown.iter().flatten();
        let share = |of: fn(&Ended) -> bool| {
            runs().filter(|(_, ended)| ended.as_ref().is_some_and(of)).count() as f64 / runs().count().max(1) as f64
        };
        let mean = |runs: &[(f64, Option<Ended>)]| runs.iter().map(|(value, _)| value).sum::<f64>() / runs.len() as f64;
        let measured = || flown.iter().enumerate().filter(|(_, runs)| !runs.is_empty());
        Self {
            stresses: measured().map(|(_, runs)| mean(runs)).collect(),
            places: measured().map(|(place, _)| place).collect(),
            crashed: share(|ended| ended.is_crash()),
            timed_out: share(|ended| *ended == Ended::Time),
        }
    }

    /// Mean stress; NaN of none.
    pub(super) fn mean(&self) -> f64 {
        mean(&self.stresses)
    }

    /// Median stress; NaN of none.
    pub(super) fn median(&self) -> f64 {
        Statistics::of(&self.stresses).map_or(f64::NAN, |told| told.median)
    }
}

fn measured(setup: &Setup, case: &Case, run: Run) -> Option<(Measures, Option<Ended>)> {
    let measures = measures_of(setup, case, &run)?;
    Some((measures, run.outcome.ok().map(|flight| flight.ended)))
}

/// Mean over mean − 1, with its interval.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Lift {
    /// The lift, a share: 0.5 is half as much again.
    pub(super) value: f64,
    /// The 95 % percentile bootstrap interval; both samples are drawn again.
    pub(super) interval: [f64; 2],
}

impl Lift {
    /// Lift and both ends of its interval, %.
    pub(super) fn percent(&self) -> [f64; 3] {
        [self.value, self.interval[0], self.interval[1]].map(|share| 100.0 * share)
    }
}

/// How much larger the mean of `sample` is than that of `baseline`; a pure function of its arguments.
pub(super) fn lift(sample: &[f64], baseline: &[f64], seed: u64) -> Lift {
    let value = mean(sample) / mean(baseline) - 1.0;
    let mut rng = stream(seed);
    let mut again = |values: &[f64]| {
        let draw = |_| values[rng.random_range(0..values.len())];
        (0..values.len()).map(draw).sum::<f64>() / values.len() as f64
    };
    if sample.is_empty() || baseline.is_empty() {
        return Lift { value, interval: [f64::NAN; 2] };
    }
    let mut lifts: Vec<f64> = (0..RESAMPLES).map(|_| again(sample) / again(baseline) - 1.0).collect();
    lifts.sort_by(f64::total_cmp);
    let at = |share: f64| lifts[(share * (RESAMPLES - 1) as f64) as usize];
    Lift { value, interval: [at(0.025), at(0.975)] }
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_lift_is_a_ratio_of_means_and_its_interval_covers_it() {
        let baseline: Vec<f64> = (0..400).map(|i| 1.0 + f64::from(i % 10) / 10.0).collect();
        let sample: Vec<f64> = baseline.iter().map(|value| 1.5 * value).collect();
        let told = lift(&sample, &baseline, 1);
        assert!((told.value - 0.5).abs() < 1e-12);
        // Standard error of each mean 0.29/20 of 1.45: 1 %, of the ratio 1.4 %.
        let [low, high] = told.interval;
        assert!(low < 0.5 && high > 0.5 && (0.06..0.12).contains(&(high - low)), "{low} … {high}");
        assert_eq!(lift(&sample, &baseline, 1), told);
        assert!(lift(&[], &baseline, 1).interval[0].is_nan());
        let flown = Flown { stresses: vec![3.0, 1.0, 2.0, 10.0], ..Flown::default() };
        assert_eq!((flown.mean(), flown.median()), (4.0, 2.5));
    }
}
