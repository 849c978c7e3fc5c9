//! Where a chain of clothoids ends, and how that depends on its knots.

use super::{Chain, PIECES};
use crate::math::circular::sin_cos;
use crate::math::quadrature::Gauss;
use crate::math::simd::{Simd, kernel};

/// Points a piece: it turns by a radian or less where bounds are kept, and then 4 are right to 10⁻⁷ of its length.
const NODES: usize = 4;

/// Values and derivatives at the end: x, y (m), heading (rad).
#[derive(Debug, Clone, Copy)]
pub(super) struct End {
    /// x, y (m) and θ (rad).
    pub(super) values: [f64; 3],
    /// By κ₁ … κ_{N−1} and, last, by L.
    ///
    /// Row m − 1 by κ_m, m, m and rad by 1/m; the last by L.
    pub(super) gradients: [[f64; 3]; PIECES],
}

/// θ within piece i at share τ: θᵢ + hᵢ (κᵢ τ + (κᵢ₊₁ − κᵢ) τ²/2); positions by Gauss–Legendre quadrature, one lane a
/// piece.
///
/// Not wrapped in θ.
pub(super) fn end(simd: Simd, chain: &Chain) -> End {
    let mut out = End { values: [0.0; 3], gradients: [[0.0; 3]; PIECES] };
    integrate(simd, chain, &mut out);
    out
}

kernel! {
    /// All pieces at once by Gauss-Legendre nodes. In a piece of length h from turn θ₀ and curvatures κ₀ to κ₁: θ(τ) =
    /// θ₀ + hκ₀τ + ½h(κ₁ − κ₀)τ², τ ∈ [0, 1]; x = Σ h∫cos θ dτ, y = Σ h∫sin θ dτ.
    ///
    /// Derivatives come from the same nodes: ∂x/∂p = −Σ h∫ sin θ ∂θ/∂p dτ and ∂y/∂p = Σ h∫ cos θ ∂θ/∂p dτ, with ∂θ/∂κ_m
    /// piecewise quadratic and then constant; and as θ is proportional to L at fixed knots, L ∂x/∂L = x − Σ h∫ θ sin θ
    /// dτ.
    fn integrate(chain: &Chain, out: &mut End) {
        let rule = Gauss::<NODES>::RULE;
        let mut heading = [0.0; PIECES];
        let mut linear = [0.0; PIECES];
        let mut quadratic = [0.0; PIECES];
        let mut length = [0.0; PIECES];
        let mut turn = 0.0;
        for i in 0..PIECES {
            let (from, to) = (chain.knot(i), chain.knot(i + 1));
            length[i] = chain.piece(i);
            heading[i] = turn;
            linear[i] = length[i] * from;
            quadratic[i] = 0.5 * length[i] * (to - from);
            turn += 0.5 * length[i] * (from + to);
        }
        // ∫cos, ∫sin over each piece, weighted with 1, τ, τ² and θ.
        let mut cos = [[0.0; PIECES]; 4];
        let mut sin = [[0.0; PIECES]; 4];
        for (t, w) in rule.nodes.into_iter().zip(rule.weights) {
            for i in 0..PIECES {
                let angle = heading[i] + t * (linear[i] + t * quadratic[i]);
                let (s, c) = sin_cos(angle);
                let (s, c) = (w * length[i] * s, w * length[i] * c);
                cos[0][i] += c;
                cos[1][i] += t * c;
                cos[2][i] += t * t * c;
                cos[3][i] += angle * c;
                sin[0][i] += s;
                sin[1][i] += t * s;
                sin[2][i] += t * t * s;
                sin[3][i] += angle * s;
            }
        }
        let (x, y) = (total(&cos[0]), total(&sin[0]));
        let mut gradients = [[0.0; 3]; PIECES];
        // dθ/dκ_m: hτ²/2 in the piece before the knot, then its ½h + h(τ − τ²/2) in the one after, then ½ of both
        // lengths.
        let (mut later_cos, mut later_sin) = (0.0, 0.0);
        for m in (1..PIECES).rev() {
            let (before, after) = (length[m - 1], length[m]);
            let lever = |rows: &[[f64; PIECES]; 4], later: f64| {
                0.5 * before * (rows[2][m - 1] + rows[0][m])
                    + after * (rows[1][m] - 0.5 * rows[2][m])
                    + 0.5 * (before + after) * later
            };
            gradients[m - 1] = [-lever(&sin, later_sin), lever(&cos, later_cos), 0.5 * (before + after)];
            later_cos += cos[0][m];
            later_sin += sin[0][m];
        }
        // All lengths grow with L, and so do all headings.
        let per_length = 1.0 / chain.length;
        gradients[PIECES - 1] = [(x - total(&sin[3])) * per_length, (y + total(&cos[3])) * per_length, turn * per_length];
        *out = End { values: [x, y, turn], gradients };
    }
}

/// The sum, as a tree.
#[inline(always)]
fn total(row: &[f64; PIECES]) -> f64 {
    let mut sums = *row;
    let mut half = PIECES / 2;
    while half > 0 {
        for i in 0..half {
            sums[i] += sums[i + half];
        }
        half /= 2;
    }
    sums[0]
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;
    use crate::math::random::hashed_unit;

    fn random(seed: u64) -> Chain {
        let draw = |k: u64| 2.0 * hashed_unit(seed, &[k]) - 1.0;
        let raw: [f64; PIECES] = std::array::from_fn(|i| 1.5 + draw(100 + i as u64));
        let sum: f64 = raw.iter().sum();
        Chain {
            curvatures: std::array::from_fn(|i| draw(i as u64)),
            end: draw(50),
            length: 6.0 + 5.0 * draw(51),
            shares: raw.map(|share| share / sum),
        }
    }

    #[test]
    fn ends_agree_with_a_finer_rule() {
        for seed in 0..50 {
            let chain = random(seed);
            let (mut at, mut heading) = ([0.0, 0.0], 0.0);
            for (length, from, to) in chain.pieces() {
                let n = 200;
                for i in 0..n {
                    // The midpoint rule, its error taken out by a second one with half the points.
                    for (parts, weight) in [(1, -1.0 / 3.0), (2, 4.0 / 3.0)] {
                        for part in 0..parts {
                            let t = (f64::from(i) + (f64::from(part) + 0.5) / f64::from(parts)) / f64::from(n);
                            let angle = heading + length * t * (from + 0.5 * t * (to - from));
                            let h = weight * length / f64::from(n * parts);
                            at = [at[0] + h * angle.cos(), at[1] + h * angle.sin()];
                        }
                    }
                }
                heading += 0.5 * length * (from + to);
            }
            let found = end(Simd::Widest, &chain).values;
            let off = [at[0] - found[0], at[1] - found[1], heading - found[2]];
            assert!(off.iter().all(|off| off.abs() < 1e-6), "seed {seed}: {off:?}");
        }
    }

    #[test]
    fn gradients_agree_with_central_differences() {
        for seed in 0..50 {
            let chain = random(seed);
            let gradients = end(Simd::Widest, &chain).gradients;
            for (unknown, row) in gradients.iter().enumerate() {
                let moved = |by: f64| {
                    let mut chain = chain;
                    match chain.curvatures.get_mut(unknown + 1) {
                        Some(knot) => *knot += by,
                        None => chain.length += by,
                    }
                    end(Simd::Widest, &chain).values
                };
                let (up, down) = (moved(1e-5), moved(-1e-5));
                for (axis, value) in row.iter().enumerate() {
                    let difference = (up[axis] - down[axis]) / 2e-5;
                    assert!((difference - value).abs() < 1e-7, "seed {seed}: {axis} by {unknown}");
                }
            }
        }
    }
}
