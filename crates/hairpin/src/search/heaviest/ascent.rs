//! Multipliers by subgradients: small bounds soon.
//!
//! λ ← λ + t·(d + momentum), d = arcs too many; t = α (L − target) / |d|² (Polyak 1969), α halved where nothing
//! improves.
//!
//! L(λ) is convex and piecewise linear; d is a subgradient. The target is the best known cost, or a little less while
//! branching. Multipliers are clipped so that sums stay in 64 bits.

use super::choices::{Choices, Made};
use super::relaxation::Relaxation;

/// Share of the last step that the next keeps.
const MOMENTUM: f64 = 0.3;

/// Choices looked at between two questions whether to stop.
const LOOKED_AT: usize = 1 << 17;

/// Limits below leave room for the sums of all prices, whose number `cuts` bounds.
///
/// With a limit per multiplier below 2³⁵ every sum of prices fits; above it cuts share the room among themselves.
const SMALL: i64 = 1 << 35;

/// Multipliers, the best so far, and what relaxed solutions had in common.
///
/// One λ a point and one for the start, then a price for each cut, all in units of the scaled costs.
pub(super) struct Ascent {
    /// The best multipliers, and their bound.
    pub(super) best: Vec<i64>,
    /// L(`best`), scaled; `i64::MAX` before the first look.
    pub(super) bound: i64,
    /// How often each choice was in the late relaxed solutions.
    pub(super) often: Vec<f64>,
    weight: f64,
    /// Share of each choice in a mean of relaxed solutions, where one is formed ([`Ascent::mean`]).
    pub(super) shares: Vec<f64>,
    /// Where the multipliers are now: points, then the start.
    pub(super) at: Vec<i64>,
    /// Arcs too many at `at`, of each point and the start: a subgradient of L.
    pub(super) excess: Vec<i32>,
    /// The direction of the last step: momentum · the one before + (1 − momentum) · excess.
    pub(super) step: Vec<f64>,
    /// No multiplier is farther from 0, so that sums stay in their numbers.
    pub(super) limit: i64,
}

/// How an ascent came to its end.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Ended {
    /// The bound is below the threshold, or nothing keeps the choices.
    Closed,
    /// The relaxed solution keeps all rules: it is a path, and the best of this problem.
    Path,
    /// Neither.
    Open,
}

/// What an ascent may do.
#[derive(Debug, Clone, Copy)]
pub(super) struct Pace {
    /// Looks at the relaxation at most; at least one is made.
    pub(super) iterations: usize,
    /// First α.
    pub(super) alpha: f64,
    /// α is halved after so many iterations without a better bound.
    pub(super) patience: usize,
}

/// Looks after which it is asked whether to stop: so many as take some milliseconds.
///
/// ⌊2¹⁷/choices⌋ looks, 1 to 32.
pub(super) fn asked_every(choices: &Choices) -> usize {
    (LOOKED_AT / choices.len()).clamp(1, 32)
}

impl Ascent {
    /// All multipliers 0; buffers that every later run uses again.
    pub(super) fn new(choices: &Choices, limit: i64) -> Self {
        Self {
            best: vec![0; choices.points + 1],
            bound: i64::MAX,
            often: vec![0.0; choices.len()],
            weight: 1.0,
            shares: Vec::new(),
            at: vec![0; choices.points + 1],
            excess: vec![0; choices.points + 1],
            step: vec![0.0; choices.points + 1],
            limit,
        }
    }

    /// From `begin` downwards until the bound is below `threshold`. The relaxation is left at the last multipliers.
    ///
    /// Each look is one spanning tree or arborescence. `threshold` and `target` are scaled costs: a bound below the
    /// first closes the problem, since nothing in it is wanted, and the second is where Polyak's step aims. `stop` is
    /// asked every 32 looks, of many arcs at each. Rounding to whole multipliers costs nothing but a slightly different
    /// step: L is a bound at any λ.
    pub(super) fn run<R: Relaxation>(
        &mut self,
        relaxation: &mut R,
        problem @ (choices, _): (&Choices, &Made),
        begin: &[i64],
        (threshold, target): (i64, f64),
        pace: Pace,
        stop: &(dyn Fn() -> bool + Sync),
    ) -> Ended {
        self.begin(choices, begin);
        let (mut alpha, mut waited) = (pace.alpha, 0);
        let every = asked_every(choices);
        for iteration in 0..pace.iterations.max(1) {
            if iteration % every == every - 1 && stop() {
                return Ended::Open;
            }
            let Some(bound) = self.look(relaxation, problem, iteration == 0) else { return Ended::Closed };
            if bound < self.bound {
                self.take(bound);
                waited = 0;
                if bound < threshold {
                    return Ended::Closed;
                }
            } else {
                waited += 1;
                if waited >= pace.patience {
                    alpha *= 0.5;
                    waited = 0;
                }
            }
            let norm: i64 = self.excess.iter().map(|e| i64::from(*e) * i64::from(*e)).sum();
            if norm == 0 {
                self.take(bound);
                return Ended::Path;
            }
            let length = alpha * (bound as f64 - target) / norm as f64;
            for ((at, step), excess) in self.at.iter_mut().zip(&mut self.step).zip(&self.excess) {
                *step = MOMENTUM * *step + f64::from(*excess) * (1.0 - MOMENTUM);
                let moved = (*step * length + 0.5).floor() as i64;
                *at = at.saturating_add(moved);
            }
            self.confine(choices);
        }
        Ended::Open
    }

    /// Begins at multipliers of which nothing is known.
    pub(super) fn begin(&mut self, choices: &Choices, begin: &[i64]) {
        self.at.clear();
        self.at.extend_from_slice(begin);
        self.best.clone_from(&self.at);
        self.excess.resize(begin.len(), 0);
        self.step.clear();
        self.step.resize(begin.len(), 0.0);
        self.bound = i64::MAX;
        self.often.resize(choices.len(), 0.0);
        self.often.fill(0.0);
        self.weight = 1.0;
    }

    /// The bound where the multipliers are, with what is in its solution counted and its excess; `None` if nothing
    /// keeps the choices.
    pub(super) fn look<R: Relaxation>(
        &mut self,
        relaxation: &mut R,
        (choices, made): (&Choices, &Made),
        renew: bool,
    ) -> Option<i64> {
        let bound = relaxation.solve(choices, made, &self.at, renew)?;
        for id in relaxation.used() {
            self.often[*id as usize] += self.weight;
        }
        self.weight *= 1.1;
        relaxation.excess(choices, &mut self.excess);
        // A price that is 0 cannot fall.
        let prices = self.at[choices.points + 1..].iter().zip(&mut self.excess[choices.points + 1..]);
        prices.filter(|(price, _)| **price == 0).for_each(|(_, excess)| *excess = (*excess).max(0));
        Some(bound)
    }

    /// Keeps multipliers where sums stay in their numbers, and prices of cuts at least 0.
    pub(super) fn confine(&mut self, choices: &Choices) {
        let (degrees, prices) = self.at.split_at_mut(choices.points + 1);
        degrees.iter_mut().for_each(|at| *at = (*at).clamp(-self.limit, self.limit));
        let most = if self.limit < SMALL { self.limit } else { self.limit / prices.len().max(1) as i64 };
        prices.iter_mut().for_each(|at| *at = (*at).clamp(0, most));
    }

    /// Keeps the multipliers where they are as the best.
    pub(super) fn take(&mut self, bound: i64) {
        self.bound = bound;
        self.best.copy_from_slice(&self.at);
    }

    /// Share of the late relaxed solutions in which a choice was.
    ///
    /// Later ones weigh more, by 1.1 a look: the weights are geometric and their sum is (1.1ⁿ − 1)/0.1.
    pub(super) fn share(&self, id: usize) -> f64 {
        self.often[id] / ((self.weight - 1.0) / 0.1)
    }
}
