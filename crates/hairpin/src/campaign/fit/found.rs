//! What a fit finds on some logs, however it is found: estimates, intervals, and what is told of them.

use nalgebra::{DMatrix, SymmetricEigen};

use super::FitError;
use super::answer::{Confounded, Estimate, Fit, Reading};
use super::gap::{Gap, scatter};
use super::simulate::Loops;
use super::whiten::Filter;
use crate::campaign::kind::Adjustable;
use crate::math::output_error::Side;
use crate::math::power::square;

/// Stretches that there must be more than numbers.
const LEAST_FREEDOM: usize = 8;
/// Widest interval of a number that is told, as a share of it on either side.
const WIDEST: f64 = 0.25;
/// A number whose value a quarter more or less moves Q, or D, by less than this acts on nothing that was flown.
/// Q is a −2 log-likelihood up to a constant, and D another.
pub(super) const NO_EFFECT: f64 = 0.5;

/// What was found on some logs.
pub(super) struct Found {
    /// Numbers that act.
    pub(super) free: Vec<usize>,
    pub(super) told: Vec<usize>,
    /// Of all numbers.
    pub(super) best: Vec<f64>,
    /// Of those that act, in their order.
    pub(super) covariance: DMatrix<f64>,
    /// How much larger than with independent residuals, or with simulations that show what the logs do.
    pub(super) inflation: f64,
    pub(super) readings: Vec<(Reading, Option<[f64; 2]>)>,
    pub(super) written: Vec<f64>,
    pub(super) stretches: usize,
    pub(super) disturbance: Disturbance,
}

/// What was found of that which no number explains.
pub(super) enum Disturbance {
    /// The colour of each output's residuals.
    Coloured(Vec<Filter>),
    /// Logarithms of the standard deviations of noise.
    Noisy(Vec<f64>),
}

impl Found {
    pub(super) fn into_fit(self, loops: &Loops, given: &[f64], which: &[usize], gaps: Vec<Gap>) -> Fit {
        let estimates: Vec<Estimate> = loops
            .numbers
            .iter()
            .enumerate()
            .map(|(own, number)| {
                let (reading, interval) = self.readings[own];
                let acts = self.free.contains(&own);
                let best = if acts { self.best[own] } else { given[own] };
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
        let scattered = which.iter().map(|at| square(scatter(&loops.flown[*at].track, loops.rule.axes)));
        let held_to_samples = matches!(self.disturbance, Disturbance::Coloured(_));
        let scatter_m = held_to_samples.then(|| (scattered.sum::<f64>() / which.len() as f64).sqrt());
        let keys = estimates.iter().filter(|estimate| estimate.is_told());
        let keys =
            keys.flat_map(|estimate| estimate.number.keys.iter().map(|(key, of)| (key.clone(), estimate.value * of)));
        Fit {
            confounded: self.confounded(loops, &estimates),
            keys: keys.collect(),
            spelt: loops.spelt.clone(),
            derives: loops.derives,
            unit: loops.unit,
            undescribed: loops.undescribed,
            tried: loops.tried,
            untried: loops.untried,
            residual_m,
            scatter_m,
            inflation: self.inflation,
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
            self.best[own].abs().max(loops.numbers[own].step)
        };
        let n = self.free.len();
        let relative = DMatrix::from_fn(n, n, |a, b| self.covariance[(a, b)] / (size(a) * size(b)));
        let SymmetricEigen { eigenvectors, eigenvalues } = SymmetricEigen::new(relative);
        let weakest = eigenvalues.imax();
        let loading = |k: usize| (loops.numbers[self.free[k]].field, eigenvectors[(k, weakest)]);
        let direction = (0..n).map(loading).filter(|(_, share)| share.abs() >= 0.2).collect();
        Some(Confounded { direction, deviation: eigenvalues[weakest].max(0.0).sqrt() })
    }
}

/// # Errors
/// `Few` where there are not [`LEAST_FREEDOM`] stretches more than numbers.
pub(super) fn enough(loops: &Loops, stretches: usize) -> Result<(), FitError> {
    let (numbers, stretch_s) = (loops.numbers.len(), loops.rule.sampling.stretch);
    let least = numbers + LEAST_FREEDOM;
    if stretches < least { Err(FitError::Few { stretches, stretch_s, least, numbers }) } else { Ok(()) }
}

/// Those of the numbers `free` that are told.
pub(super) fn told(free: &[usize], readings: &[(Reading, Option<[f64; 2]>)]) -> Vec<usize> {
    free.iter().copied().filter(|own| readings[*own].0 == Reading::Told).collect()
}

/// What is written: of the numbers `told` what was found with all that acts free, of the others what was given.
///
/// A number that is known and not told (an open delay, say) is left out of the model, not made up for by the others:
/// they would be drawn to the ends of their intervals, and be measurements of nothing.
pub(super) fn written(given: &[f64], told: &[usize], best: &[f64]) -> Vec<f64> {
    let mut written = given.to_vec();
    told.iter().for_each(|own| written[*own] = best[*own]);
    written
}

/// What an interval says of an estimate.
///
/// Closed on both sides: told if neither end is farther from the best than [`WIDEST`] of it, and if such intervals of
/// the number are believed.
pub(super) fn reading(number: &Adjustable, best: f64, ends: [Side; 2]) -> (Reading, Option<[f64; 2]>) {
    let interval = ends.map(|end| match end {
        Side::Closed(at) | Side::Open(at) => at,
    });
    if ends.iter().any(|end| matches!(end, Side::Open(_))) {
        return (Reading::Open, Some(interval));
    }
    let [low, high] = interval;
    let wide = (best - low).max(high - best) > WIDEST * best.abs();
    let reading = match number.doubt {
        _ if wide => Reading::Wide,
        Some(_) => Reading::Doubted,
        None => Reading::Told,
    };
    (reading, Some(interval))
}
