//! The composite likelihood of residuals, and its derivatives by differences.

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

/// What may be adjusted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Parameter {
    /// Least value.
    pub low: f64,
    /// Largest value.
    pub high: f64,
    /// Half of the difference that derivatives are taken over, > 0: far above the grain of the simulation.
    pub step: f64,
}

/// Residuals of all outputs as a function of the parameters; `None` where there is no simulation.
///
/// Always of one length, in one order.
pub type Residuals<'a> = dyn Fn(&[f64]) -> Option<Vec<f64>> + Sync + 'a;

/// Residuals, and how they belong together.
pub struct Objective<'a> {
    /// See [`Residuals`].
    pub residuals: &'a Residuals<'a>,
    /// What each residual is of: outputs of one number have one standard deviation.
    pub output: Vec<usize>,
    /// Which block each residual is in: rising.
    pub block: Vec<usize>,
    /// Blocks that do not follow the one before them: the first of each log.
    pub begins: Vec<bool>,
    /// The parameters.
    pub parameters: Vec<Parameter>,
}

/// Q at a point, and how much a square of each residual weighs there.
#[derive(Debug, Clone)]
pub(super) struct Value {
    pub(super) q: f64,
    pub(super) residuals: Vec<f64>,
    /// n_g/RSS_g by output.
    pub(super) weights: Vec<f64>,
}

/// A standard deviation below this, of whatever unit, counts as this: outputs that are met exactly weigh no more.
const LEAST_DEVIATION: f64 = 1e-6;

impl Objective<'_> {
    /// Q(θ) = Σ_g n_g ln(RSS_g/n_g); `None` where there is no simulation.
    ///
    /// By output g: n_g its residuals, RSS_g the sum of their squares. RSS_g/n_g is 1e-12 at least. The scale of each
    /// output is profiled out, so that outputs of different units add up. O(residuals).
    pub(super) fn at(&self, theta: &[f64]) -> Option<Value> {
        let residuals = (self.residuals)(theta)?;
        if residuals.iter().any(|r| !r.is_finite()) {
            return None;
        }
        let outputs = self.output.iter().max().map_or(0, |most| most + 1);
        let (mut sums, mut counts) = (vec![0.0; outputs], vec![0.0; outputs]);
        for (r, &output) in residuals.iter().zip(&self.output) {
            sums[output] += r * r;
            counts[output] += 1.0;
        }
        let mut q = 0.0;
        let weights = sums.iter().zip(&counts).map(|(sum, &count)| {
            let variance = (sum / f64::max(count, 1.0)).max(LEAST_DEVIATION * LEAST_DEVIATION);
            q += count * libm::log(variance);
            1.0 / variance
        });
        let weights = weights.collect();
        Some(Value { q, residuals, weights })
    }

    /// Columns ∂f/∂θ_k = −∂r/∂θ_k for the parameters `free`, by central differences, one-sided at bounds.
    ///
    /// rows: residuals, columns: `free`. 2 simulations a column, in parallel. `None` where one fails or a number is
    /// none.
    pub(super) fn jacobian(&self, theta: &[f64], free: &[usize]) -> Option<DMatrix<f64>> {
        let columns: Option<Vec<Vec<f64>>> = free
            .par_iter()
            .map(|&k| {
                let Parameter { low, high, step } = self.parameters[k];
                let moved = |to: f64| {
                    let mut there = theta.to_vec();
                    there[k] = to.clamp(low, high);
                    (self.residuals)(&there).map(|residuals| (there[k], residuals))
                };
                let (ahead, behind) = rayon::join(|| moved(theta[k] + step), || moved(theta[k] - step));
                let ((x1, r1), (x0, r0)) = (ahead?, behind?);
                Some(r1.iter().zip(&r0).map(|(a, b)| (b - a) / (x1 - x0)).collect())
            })
            .collect();
        let columns = columns?;
        let jacobian = DMatrix::from_fn(self.output.len(), free.len(), |i, k| columns[k][i]);
        jacobian.iter().all(|j| j.is_finite()).then_some(jacobian)
    }

    /// H = Σ w J Jᵀ and g = Σ w J r over the residuals of `blocks`.
    ///
    /// The Hessian of Gauss and Newton of Q/2 with weights as they are at the point. O(residuals · free²).
    pub(super) fn normal_equations(
        &self,
        value: &Value,
        jacobian: &DMatrix<f64>,
        blocks: std::ops::Range<usize>,
    ) -> (DMatrix<f64>, DVector<f64>) {
        let n = jacobian.ncols();
        let (mut h, mut g) = (DMatrix::zeros(n, n), DVector::zeros(n));
        let from = self.block.partition_point(|block| *block < blocks.start);
        let to = self.block.partition_point(|block| *block < blocks.end);
        for i in from..to {
            let (row, weight) = (jacobian.row(i), value.weights[self.output[i]]);
            for a in 0..n {
                g[a] += weight * row[a] * value.residuals[i];
                for b in 0..n {
                    h[(a, b)] += weight * row[a] * row[b];
                }
            }
        }
        (h, g)
    }

    /// Number of blocks.
    pub fn blocks(&self) -> usize {
        self.block.last().map_or(0, |last| last + 1)
    }
}
