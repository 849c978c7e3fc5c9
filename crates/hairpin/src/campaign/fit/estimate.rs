//! Fits: estimates, intervals, and which numbers cannot be told.
//!
//! ```text
//! descend from given (and from elsewhere)  ─▶ θ₀ ─▶ colour: filters of the residuals at θ₀
//! descend on filtered residuals            ─▶ θ̂;  acting: numbers without effect on Q are left out
//! spread by stretches                      ─▶ covariance;  profile of each number ─▶ 95 % interval ─▶ Reading
//! descend in the numbers that are told     ─▶ what is written, the others as given
//! ```
//!
//! See [`crate::math::output_error`] for Q, its descent and its profiles.

use nalgebra::{DMatrix, SymmetricEigen};

use super::FitError;
use super::answer::{Confounded, Estimate, Fit, Reading};
use super::compare::Flown;
use super::gap::{Gap, deviation};
use super::simulate::Loops;
use super::stretches::{colour, objective, residuals};
use super::whiten::Filter;
use crate::campaign::Setup;
use crate::judgement::{SIGMA_95, student_quantile};
use crate::math::output_error::{Descent, Parameter, Side, Spread, acting, descend, profile, spread};
use crate::math::power::square;

/// What is fitted on.
///
/// One log is always fitted to, whatever number is held out.
#[derive(Debug, Clone, Copy, Default)]
pub struct FitSettings {
    /// So many logs, the last ones, are not fitted to: the fit is tried on them. 0: each is, by a fit to all others.
    pub held_out: usize,
}

/// Stretches that there must be more than numbers.
const LEAST_FREEDOM: usize = 8;
/// Widest interval of a number that is told, as a share of it on either side.
const WIDEST: f64 = 0.25;
/// A number whose value a quarter more or less moves Q by less than this acts on nothing that was flown.
/// Q is a −2 log-likelihood up to a constant.
const NO_EFFECT: f64 = 0.5;

/// Fits the robot and controller of `setup` to logs; `stopped` is asked now and then.
///
/// # Errors
/// See [`FitError`].
///
/// `setup` is that of the robot as given; `flown` are its logs with their missions. With nothing held out each log's
/// `unseen` comes from a fit to all the others, of the told numbers alone: one more descent a log.
pub fn fit(
    setup: &Setup,
    flown: &[Flown],
    settings: &FitSettings,
    stopped: &(dyn Fn() -> bool + Sync),
) -> Result<Fit, FitError> {
    let loops = Loops::new(setup, flown)?;
    let given: Vec<f64> = loops.numbers.iter().map(|number| number.value).collect();
    if let Some(refused) = loops.refused(&given) {
        return Err(refused);
    }
    let held_out = settings.held_out.min(flown.len() - 1);
    let fitted: Vec<usize> = (0..flown.len() - held_out).collect();
    let found = Found::of(&loops, &given, &fitted, stopped)?;
    let written = found.written.clone();
    let mut gaps: Vec<Gap> = (0..flown.len())
        .map(|at| Gap {
            log: flown[at].log.clone(),
            mission: flown[at].mission.clone(),
            before: deviation(&loops, &given, at),
            after: deviation(&loops, &written, at),
            unseen: None,
        })
        .collect();
    if held_out > 0 {
        gaps.iter_mut().skip(fitted.len()).for_each(|gap| gap.unseen = Some(gap.after));
    } else if flown.len() > 1 {
        for (at, gap) in gaps.iter_mut().enumerate() {
            if stopped() {
                return Err(FitError::Stopped);
            }
            let others: Vec<usize> = fitted.iter().copied().filter(|other| *other != at).collect();
            gap.unseen = found.refitted(&loops, &others).map(|theta| deviation(&loops, &theta, at));
        }
    }
    Ok(found.into_fit(&loops, &given, &fitted, gaps))
}

/// What was found on some logs.
struct Found {
    free: Vec<usize>,
    told: Vec<usize>,
    best: Descent,
    spread: Spread,
    readings: Vec<(Reading, Option<[f64; 2]>)>,
    written: Vec<f64>,
    stretches: usize,
    colour: Vec<Filter>,
}

impl Found {
    fn of(
        loops: &Loops,
        given: &[f64],
        which: &[usize],
        stopped: &(dyn Fn() -> bool + Sync),
    ) -> Result<Self, FitError> {
        // Who is stopped simulates no more, so that all searches end at once.
        let none = vec![Filter::NONE; loops.rule.deviations()];
        let raw = |theta: &[f64]| if stopped() { None } else { residuals(loops, theta, which, &none) };
        let coarse = objective(loops, which, &raw);
        let (stretches, numbers) = (coarse.blocks(), given.len());
        if stretches < numbers + LEAST_FREEDOM {
            let least = numbers + LEAST_FREEDOM;
            let stretch_s = loops.rule.sampling.stretch;
            return Err(FitError::Few { stretches, stretch_s, least, numbers });
        }
        let over = |error: FitError| if stopped() { FitError::Stopped } else { error };
        let all: Vec<usize> = (0..numbers).collect();
        let mut start = descend(&coarse, given, &all).ok_or_else(|| over(FitError::NoEffect))?;
        // From elsewhere, where a number that did nothing at first may do something.
        let other: Vec<f64> = loops.numbers.iter().map(|number| number.other).collect();
        if let Some(found) = descend(&coarse, &other, &all)
            && found.q < start.q
        {
            start = found;
        }
        let colour = colour(loops, &start.theta, which).ok_or_else(|| over(FitError::NoEffect))?;
        let white = |theta: &[f64]| if stopped() { None } else { residuals(loops, theta, which, &colour) };
        let mut objective = objective(loops, which, &white);
        let best = descend(&objective, &start.theta, &all).ok_or_else(|| over(FitError::NoEffect))?;
        let free =
            acting(&objective, &best, &all, &|k| 0.25 * best.theta[k].abs().max(loops.numbers[k].step), NO_EFFECT);
        let spread = spread(&objective, &best, &free).ok_or_else(|| over(FitError::NoEffect))?;
        let mut readings = vec![(Reading::NoEffect, None); numbers];
        for (k, &own) in free.iter().enumerate() {
            let t = student_quantile(spread.freedom[k], SIGMA_95);
            let rise = t * t * spread.covariance[(k, k)] / spread.white[(k, k)];
            let ends = profile(&objective, &best, &free, &spread, (k, rise));
            readings[own] = reading(best.theta[own], ends);
            if readings[own].0 == Reading::Told && loops.numbers[own].doubt.is_some() {
                readings[own].0 = Reading::Doubted;
            }
        }
        if stopped() {
            return Err(FitError::Stopped);
        }
        let told: Vec<usize> = free.iter().copied().filter(|own| readings[*own].0 == Reading::Told).collect();
        let mut start = given.to_vec();
        // With the others as they were given, each goes where it fits best within its interval.
        for &own in &told {
            start[own] = best.theta[own];
            if let Some([low, high]) = readings[own].1 {
                objective.parameters[own] = Parameter { low, high, ..objective.parameters[own] };
            }
        }
        let written = match told.is_empty() {
            true => start,
            false => descend(&objective, &start, &told).map_or(start, |found| found.theta),
        };
        Ok(Self { free, told, best, spread, readings, written, stretches, colour })
    }

    /// The numbers that are told, from the logs `which` alone.
    fn refitted(&self, loops: &Loops, which: &[usize]) -> Option<Vec<f64>> {
        if self.told.is_empty() {
            return Some(self.written.clone());
        }
        let residuals = |theta: &[f64]| residuals(loops, theta, which, &self.colour);
        descend(&objective(loops, which, &residuals), &self.written, &self.told).map(|found| found.theta)
    }

    fn into_fit(self, loops: &Loops, given: &[f64], which: &[usize], gaps: Vec<Gap>) -> Fit {
        let estimates: Vec<Estimate> = loops
            .numbers
            .iter()
            .enumerate()
            .map(|(own, number)| {
                let (reading, interval) = self.readings[own];
                let acts = self.free.contains(&own);
                let best = if acts { self.best.theta[own] } else { given[own] };
                Estimate { number: number.clone(), best, value: self.written[own], interval, reading }
            })
            .collect();
        let squares = |of: &dyn Fn(&Gap) -> Option<f64>| {
            let all: Vec<f64> = gaps.iter().filter_map(of).collect();
            (all.iter().map(|rmse| rmse * rmse).sum::<f64>() / all.len() as f64).sqrt()
        };
        let unseen = gaps.iter().any(|gap| gap.unseen.is_some()).then(|| {
            let before = squares(&|gap| gap.unseen.map(|_| gap.before.rmse_m));
            [before, squares(&|gap| Some(gap.unseen?.rmse_m))]
        });
        let seen: Vec<&Gap> = which.iter().map(|at| &gaps[*at]).collect();
        let residual_m = (seen.iter().map(|gap| square(gap.after.rmse_m)).sum::<f64>() / seen.len() as f64).sqrt();
        let n = self.free.len();
        let inflation =
            (0..n).map(|k| self.spread.covariance[(k, k)] / self.spread.white[(k, k)]).sum::<f64>() / n as f64;
        let keys = estimates.iter().filter(|estimate| estimate.is_told());
        let keys =
            keys.flat_map(|estimate| estimate.number.keys.iter().map(|(key, of)| (key.clone(), estimate.value * of)));
        Fit {
            confounded: self.confounded(loops, &estimates),
            keys: keys.collect(),
            spelt: loops.spelt.clone(),
            derives: loops.derives,
            unit: loops.unit,
            residual_m,
            inflation,
            stretches: self.stretches,
            samples: which.iter().map(|at| loops.compared[*at].samples.len()).sum(),
            unseen,
            gaps,
            estimates,
        }
    }

    /// The direction of the largest relative spread, where a number that acts is not told.
    ///
    /// The eigenvector of the largest eigenvalue of the relative covariance C_ab/(s_a s_b), s the larger of a
    /// number's size and its step; parts below 0.2 are left out.
    fn confounded(&self, loops: &Loops, estimates: &[Estimate]) -> Option<Confounded> {
        let vague = self.free.iter().any(|own| !estimates[*own].is_told());
        if !vague || self.free.len() < 2 {
            return None;
        }
        let size = |k: usize| {
            let own = self.free[k];
            self.best.theta[own].abs().max(loops.numbers[own].step)
        };
        let n = self.free.len();
        let relative = DMatrix::from_fn(n, n, |a, b| self.spread.covariance[(a, b)] / (size(a) * size(b)));
        let SymmetricEigen { eigenvectors, eigenvalues } = SymmetricEigen::new(relative);
        let weakest = eigenvalues.imax();
        let loading = |k: usize| (loops.numbers[self.free[k]].field, eigenvectors[(k, weakest)]);
        let direction = (0..n).map(loading).filter(|(_, share)| share.abs() >= 0.2).collect();
        Some(Confounded { direction, deviation: eigenvalues[weakest].max(0.0).sqrt() })
    }
}

/// What an interval says of an estimate.
///
/// Closed on both sides: told if neither end is farther from the best than [`WIDEST`] of it.
fn reading(best: f64, ends: [Side; 2]) -> (Reading, Option<[f64; 2]>) {
    let interval = ends.map(|end| match end {
        Side::Closed(at) | Side::Open(at) => at,
    });
    if ends.iter().any(|end| matches!(end, Side::Open(_))) {
        return (Reading::Open, Some(interval));
    }
    let [low, high] = interval;
    let wide = (best - low).max(high - best) > WIDEST * best.abs();
    (if wide { Reading::Wide } else { Reading::Told }, Some(interval))
}
