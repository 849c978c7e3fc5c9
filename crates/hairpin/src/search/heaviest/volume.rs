//! Multipliers along means of relaxed solutions, where single ones are of no help: many points of one price, as in
//! clusters.
//!
//! A single tree hangs a whole cluster on one point, so its excess says little of where the bound falls. The excess of
//! a mean of trees, v̄ ← α d + (1 − α) v̄ with the α that makes |v̄| least, does; steps go from the best multipliers
//! (volume algorithm; Barahona & Anbil 2000).

use super::ascent::{Ascent, Ended, asked_every};
use super::choices::{Choices, Made};
use super::relaxation::Relaxation;

/// First share of a new relaxed solution in the mean, at most; it shrinks where the gap does not.
const SHARE: f64 = 0.2;
/// Steps after which the gap must be smaller by [`SHRINKING`], else the share is halved.
const PERIOD: usize = 50;
const SHRINKING: f64 = 0.98;
/// Steps after which the gap must be smaller by [`STALLING`], else more of them are in vain.
const STALLED: usize = 1000;
const STALLING: f64 = 0.95;
/// First factor of Polyak's step; it grows while the bound falls along the mean, and shrinks after [`PATIENCE`] steps
/// in vain.
const FACTOR: f64 = 0.2;
const PATIENCE: usize = 10;

impl Ascent {
    /// From `begin` downwards until the bound is below `threshold`. The relaxation is left at the last multipliers.
    ///
    /// `step` holds the mean v̄, not a step; multipliers are always set out from the best ones, λ = best + t v̄.
    /// Barahona and Anbil, "The volume algorithm: producing primal solutions with a subgradient method", Mathematical
    /// Programming 87, 2000.
    ///
    /// ```text
    /// v̄ ← α d + (1 − α) v̄,   α = clamp((v̄² − d·v̄)/|d − v̄|², share/10, share)
    /// λ = λ_best + factor (L_best − target)/|v̄|² · v̄
    /// ```
    ///
    /// d is the excess at λ. The factor grows by 1.1 where a better bound lies along the mean (d·v̄ ≥ 0), up to 2,
    /// and shrinks to 0.66 of itself after ten looks in vain. Ends early where 1000 looks bring the gap down by less
    /// than a twentieth.
    pub(super) fn mean<R: Relaxation>(
        &mut self,
        relaxation: &mut R,
        problem: (&Choices, &Made),
        begin: &[i64],
        (threshold, target): (i64, f64),
        iterations: usize,
        stop: &(dyn Fn() -> bool + Sync),
    ) -> Ended {
        self.begin(problem.0, begin);
        self.shares.clear();
        self.shares.resize(problem.0.len(), 0.0);
        let (mut factor, mut share, mut waited, mut gap) = (FACTOR, SHARE, 0, f64::INFINITY);
        let every = asked_every(problem.0);
        let mut stalled = f64::INFINITY;
        for iteration in 0..iterations {
            if iteration % every == every - 1 && stop() {
                return Ended::Open;
            }
            let Some(bound) = self.look(relaxation, problem, iteration == 0) else { return Ended::Closed };
            let (dd, dv, vv) = self.step.iter().zip(&self.excess).fold((0.0, 0.0, 0.0), |(dd, dv, vv), (v, d)| {
                let d = f64::from(*d);
                (dd + d * d, dv + d * v, vv + v * v)
            });
            if dd == 0.0 {
                self.take(bound);
                return Ended::Path;
            }
            if bound < self.bound {
                self.take(bound);
                if bound < threshold {
                    return Ended::Closed;
                }
                if dv >= 0.0 {
                    factor = (factor * 1.1).min(2.0);
                }
                waited = 0;
            } else {
                waited += 1;
                if waited == PATIENCE {
                    (factor, waited) = ((factor * 0.66).max(5e-4), 0);
                }
            }
            if iteration % STALLED == STALLED - 1 {
                let left = self.bound as f64 - target;
                if left > STALLING * stalled {
                    return Ended::Open;
                }
                stalled = left;
            }
            if iteration % PERIOD == PERIOD - 1 {
                let left = self.bound as f64 - target;
                if left > SHRINKING * gap {
                    share = (share * 0.5).max(1e-3);
                }
                gap = left;
            }
            // |α d + (1 − α) v̄|² is least at (v̄² − d·v̄) / |d − v̄|²; the first mean is the first solution.
            let apart = dd - 2.0 * dv + vv;
            let alpha = match iteration {
                0 => 1.0,
                _ if apart > 0.0 => ((vv - dv) / apart).clamp(share / 10.0, share),
                _ => share,
            };
            let mut norm = 0.0;
            for (v, d) in self.step.iter_mut().zip(&self.excess) {
                *v = alpha * f64::from(*d) + (1.0 - alpha) * *v;
                norm += *v * *v;
            }
            self.shares.iter_mut().for_each(|share| *share *= 1.0 - alpha);
            relaxation.used().iter().for_each(|id| self.shares[*id as usize] += alpha);
            let length = factor * (self.bound as f64 - target) / norm.max(1e-9);
            for ((at, best), v) in self.at.iter_mut().zip(&self.best).zip(&self.step) {
                let moved = (*v * length + 0.5).floor() as i64;
                *at = best.saturating_add(moved);
            }
            self.confine(problem.0);
        }
        Ended::Open
    }
}
