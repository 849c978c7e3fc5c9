//! Fits by output error: no sample of a simulation is far from the log's.
//!
//! ```text
//! descend from given (and from elsewhere)  ─▶ θ₀ ─▶ colour: filters of the residuals at θ₀
//! descend on filtered residuals            ─▶ θ̂;  acting: numbers without effect on Q are left out
//! spread by stretches                      ─▶ covariance;  profile of each number ─▶ 95 % interval ─▶ Reading
//! ```
//!
//! See [`crate::math::output_error`] for Q, its descent and its profiles.

use super::FitError;
use super::answer::Reading;
use super::found::{Disturbance, Found, NO_EFFECT, enough, reading, told, written};
use super::simulate::Loops;
use super::stretches::{colour, objective, residuals};
use super::whiten::Filter;
use crate::judgement::{SIGMA_95, student_quantile};
use crate::math::output_error::{acting, descend, profile, spread};

/// On the logs `which`.
///
/// Two starts: as given, and each number at its `other`. The rise of Q that ends an interval is t² C_kk/W_kk, C the
/// covariance by stretches and W that of white residuals, so that profiles of a likelihood that counts neighbours twice
/// are as wide as they should be.
///
/// # Errors
/// Too few stretches, numbers without any effect, no simulation at the start, or that it was stopped.
pub(super) fn found(
    loops: &Loops,
    given: &[f64],
    which: &[usize],
    stopped: &(dyn Fn() -> bool + Sync),
) -> Result<Found, FitError> {
    // Who is stopped simulates no more, so that all searches end at once.
    let none = vec![Filter::NONE; loops.rule.deviations()];
    let raw = |theta: &[f64]| if stopped() { None } else { residuals(loops, theta, which, &none) };
    let coarse = objective(loops, which, &raw);
    let (stretches, numbers) = (coarse.blocks(), given.len());
    enough(loops, stretches)?;
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
    let objective = objective(loops, which, &white);
    let best = descend(&objective, &start.theta, &all).ok_or_else(|| over(FitError::NoEffect))?;
    let free = acting(&objective, &best, &all, &|k| 0.25 * best.theta[k].abs().max(loops.numbers[k].step), NO_EFFECT);
    let spread = spread(&objective, &best, &free).ok_or_else(|| over(FitError::NoEffect))?;
    let mut readings = vec![(Reading::NoEffect, None); numbers];
    for (k, &own) in free.iter().enumerate() {
        let t = student_quantile(spread.freedom[k], SIGMA_95);
        let rise = t * t * spread.covariance[(k, k)] / spread.white[(k, k)];
        let ends = profile(&objective, &best, &free, &spread, (k, rise));
        readings[own] = reading(&loops.numbers[own], best.theta[own], ends);
    }
    if stopped() {
        return Err(FitError::Stopped);
    }
    let told = told(&free, &readings);
    let written = written(given, &told, &best.theta);
    let n = free.len() as f64;
    let inflation = spread.covariance.diagonal().component_div(&spread.white.diagonal()).sum() / n;
    let (covariance, disturbance) = (spread.covariance, Disturbance::Coloured(colour));
    Ok(Found { free, told, best: best.theta, covariance, inflation, readings, written, stretches, disturbance })
}

/// All numbers that act, from the logs `which` alone.
///
/// With the filters that were found on all logs.
pub(super) fn refitted(loops: &Loops, found: &Found, colour: &[Filter], which: &[usize]) -> Option<Vec<f64>> {
    let residuals = |theta: &[f64]| residuals(loops, theta, which, colour);
    descend(&objective(loops, which, &residuals), &found.best, &found.free).map(|found| found.theta)
}
