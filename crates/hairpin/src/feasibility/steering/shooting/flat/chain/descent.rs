//! Fits a chain of clothoids to both ends under bounds: sequential quadratic programming on its knots and length.
//!
//! The heading is a third equation here, for knots do not meet it by construction. Bounds on κ are asked at knots and
//! those on κ′ on pieces, where both are exact; nothing is sampled.

use super::super::ends::{Bends, Ends};
use super::super::task::Task;
use super::bordered::Bordered;
use super::position::end;
use super::{Chain, PIECES};
use crate::feasibility::steering::shooting::query::Curvatures;

/// What came of it.
#[derive(Debug, Clone, Copy)]
pub(in super::super) struct Fit {
    /// The curve.
    pub(in super::super) chain: Chain,
    /// Distance of its end from the goal, m, or difference of heading, rad, whichever is larger.
    pub(in super::super) miss: f64,
    /// How it keeps the bounds.
    pub(in super::super) bends: Bends,
    /// Steps taken.
    pub(in super::super) iterations: u32,
}

/// Weight of the penalty; that of ½N Σ (κᵢ₊₁ − κᵢ)²; damping of steps of the knots, and of relative steps of L.
const PENALTY: f64 = 100.0;
const SMOOTH: f64 = 1e-4;
const KNOTS: f64 = 1e-3;
const LENGTH: f64 = 1.0;
/// The penalty is soft: it holds the curve to bounds this much narrower.
const MARGIN: f64 = 2e-3;
/// No step turns the curve by more than this anywhere, rad, or changes its length by more than half of it.
const STRIDE: f64 = 1.0;
/// Below this miss only the goal is aimed at, provided that the bounds hold: then convergence is quadratic.
const NEAR: f64 = 0.02;

/// Follows
/// ```text
/// min ½ Σ smoothness + penalty   such that   x, y, heading of the end are as prescribed
/// ```
/// from `start` until the end is met within the tolerance and the bounds hold, or for `iterations` steps.
///
/// Three equations in 16 unknowns; a step is O(pieces). `bends` are exact, as κ is linear between knots.
pub(in super::super) fn descend(task: &Task, ends: &Ends, start: Chain, iterations: u32) -> Fit {
    let Task { bounds, tolerance, step_scale, simd, .. } = *task;
    let narrow = Curvatures { most: bounds.most * (1.0 - MARGIN), most_rate: bounds.most_rate * (1.0 - MARGIN) };
    let unknown = Bends { curvature: f64::INFINITY, rate: f64::INFINITY };
    let mut fit = Fit { chain: start, miss: f64::INFINITY, bends: unknown, iterations: 0 };
    let mut chain = start;
    loop {
        let end = end(simd, &chain);
        let error = [end.values[0] - ends.x, end.values[1] - ends.y, end.values[2] - ends.turn];
        let miss = (error[0] * error[0] + error[1] * error[1]).sqrt().max(error[2].abs());
        if !miss.is_finite() {
            return fit;
        }
        fit.chain = chain;
        fit.miss = miss;
        fit.bends = chain.bends(&bounds);
        if (miss < tolerance && fit.bends.within()) || fit.iterations >= iterations {
            return fit;
        }
        let (matrix, mut gradient) = objective(&chain, &narrow, bounds.most);
        if miss < NEAR && fit.bends.within() {
            gradient = [0.0; PIECES];
        }
        let step = newton(&matrix, &gradient, &error, &end.gradients);
        let scale = step_scale * stride(&chain, &step);
        for (knot, change) in chain.curvatures.iter_mut().skip(1).zip(&step) {
            *knot += scale * change;
        }
        chain.length += scale * step[PIECES - 1];
        fit.iterations += 1;
    }
}

/// Gradient and Gauss-Newton matrix of smoothness and penalty, by κ₁ … κ_{N−1} and L.
///
/// `unit` is the largest curvature, 1/m. Terms: ½N·SMOOTH Σ (κᵢ₊₁ − κᵢ)²/κ_max²; half of PENALTY times the squares of
/// what |κᵢ| and |κᵢ₊₁ − κᵢ|/hᵢ exceed their bounds by, relatively; a damping of knots by the squared share of the way
/// that they turn, and one of L.
fn objective(chain: &Chain, narrow: &Curvatures, unit: f64) -> (Bordered, [f64; PIECES]) {
    // Curvatures are weighed in units of the bound, so that the same numbers suit vehicles of any size.
    let per_unit = 1.0 / (unit * unit);
    let mut gradient = [0.0; PIECES];
    let mut matrix = Bordered { diagonal: [0.0; PIECES], beside: [0.0; PIECES], border: [0.0; PIECES] };
    for (pair, slot) in chain.shares.windows(2).zip(&mut matrix.diagonal) {
        // By what a knot turns: those of long pieces are the more powerful.
        let share = 0.5 * PIECES as f64 * (pair[0] + pair[1]);
        *slot = KNOTS * per_unit * share * share;
    }
    let last = PIECES - 1;
    matrix.diagonal[last] = LENGTH / (chain.length * chain.length);
    let scale = 1.0 / narrow.most;
    for i in 1..PIECES {
        let knot = chain.curvatures[i];
        let excess = knot.abs() * scale - 1.0;
        if excess > 0.0 {
            gradient[i - 1] += PENALTY * excess * scale.copysign(knot);
            matrix.diagonal[i - 1] += PENALTY * scale * scale;
        }
    }
    for i in 0..PIECES {
        let rise = chain.knot(i + 1) - chain.knot(i);
        let mut weight = SMOOTH * PIECES as f64 * per_unit;
        let mut slope = weight * rise;
        let mut with_length = 0.0;
        let scale = 1.0 / (narrow.most_rate * chain.piece(i));
        let relative = rise.abs() * scale;
        if relative > 1.0 {
            let row = scale.copysign(rise);
            let by_length = -relative / chain.length;
            weight += PENALTY * row * row;
            slope += PENALTY * (relative - 1.0) * row;
            with_length = PENALTY * row * by_length;
            gradient[last] += PENALTY * (relative - 1.0) * by_length;
            matrix.diagonal[last] += PENALTY * by_length * by_length;
        }
        // The prescribed ends are no unknowns.
        if i > 0 {
            matrix.diagonal[i - 1] += weight;
            gradient[i - 1] -= slope;
            matrix.border[i - 1] -= with_length;
        }
        if i < last {
            matrix.diagonal[i] += weight;
            gradient[i] += slope;
            matrix.border[i] += with_length;
        }
        if i > 0 && i < last {
            matrix.beside[i - 1] -= weight;
        }
    }
    (matrix, gradient)
}

/// d of min gᵀd + ½dᵀHd such that Jd = −e: d = −H⁻¹(g + Jᵀλ), (JH⁻¹Jᵀ)λ = e − JH⁻¹g.
///
/// `jacobian` holds a row for each unknown and a column for x, y (m) and heading (rad): the transpose of J. The 3 × 3
/// system is eliminated without pivoting, being positive definite with a ridge of 10⁻¹⁰ of its trace.
fn newton(
    matrix: &Bordered,
    gradient: &[f64; PIECES],
    error: &[f64; 3],
    jacobian: &[[f64; 3]; PIECES],
) -> [f64; PIECES] {
    let right = std::array::from_fn(|i| [gradient[i], jacobian[i][0], jacobian[i][1], jacobian[i][2]]);
    let pulls = matrix.factor().solve(&right);
    // Columns of J(H⁻¹g, H⁻¹Jᵀ).
    let mut products = [[0.0; 4]; 3];
    for (row, pull) in jacobian.iter().zip(&pulls) {
        for (product, lever) in products.iter_mut().zip(row) {
            for (sum, value) in product.iter_mut().zip(pull) {
                *sum += lever * value;
            }
        }
    }
    // Where the end can move in some directions only, it moves in those.
    let ridge = 1e-10 * (products[0][1] + products[1][2] + products[2][3]);
    let mut force: [f64; 3] = std::array::from_fn(|i| error[i] - products[i][0]);
    let mut schur = products.map(|[_, a, b, c]| [a, b, c]);
    for (i, row) in schur.iter_mut().enumerate() {
        row[i] += ridge;
    }
    for i in 0..3 {
        let (pivot, right) = (schur[i], force[i]);
        for below in i + 1..3 {
            let factor = schur[below][i] / pivot[i];
            for (value, above) in schur[below].iter_mut().zip(&pivot) {
                *value -= factor * above;
            }
            force[below] -= factor * right;
        }
    }
    for i in (0..3).rev() {
        for column in i + 1..3 {
            force[i] -= schur[i][column] * force[column];
        }
        force[i] /= schur[i][i];
    }
    pulls.map(|[downhill, a, b, c]| -downhill - a * force[0] - b * force[1] - c * force[2])
}

/// The share of `step` to take.
///
/// 1 or less: no step turns the curve anywhere by more than 1 rad at the present length, nor changes L by more than
/// half.
fn stride(chain: &Chain, step: &[f64; PIECES]) -> f64 {
    let (mut turn, mut worst, mut before) = (0.0, 0.0_f64, 0.0);
    for (i, change) in step.iter().enumerate() {
        // The last is no knot's but the length's.
        let next = if i + 1 < PIECES { *change } else { 0.0 };
        turn += 0.5 * chain.piece(i) * (before + next);
        worst = worst.max(f64::abs(turn));
        before = next;
    }
    let size = worst.max(2.0 * step[PIECES - 1].abs() / chain.length);
    if size > STRIDE { STRIDE / size } else { 1.0 }
}
