//! The family of curves that is searched: headings that meet both ends whatever their free parameters are.
//!
//! With t = s/L in [0, 1],
//! ```text
//! θ(t) = Lκ₀ A(t) + ψ B(t) + Lκ_f C(t) + c₀ φ₀(t) + c₁ φ₁(t) + c₂ φ₂(t)
//! A = t(1 − t)²    B = t²(3 − 2t)    C = −t²(1 − t)        φ_j″ = P_{j+2}(2t − 1)
//! ```
//! has θ(0) = 0, θ(1) = ψ, κ(0) = κ₀, κ(1) = κ_f. The φ_j and their first derivatives vanish at both ends, and their
//! second derivatives, Legendre polynomials, are orthogonal to each other and to those of A, B and C. Of the end
//! constraints only the position remains: two equations for (c, L).
//!
//! κ(s) = θ_t/L is a polynomial of order 5 with c₁ and c₂, of order 3 without them. ∫ φ_j″² dt = 1/(2(j + 2) + 1), so
//! that the weights of the smoothness are those of its integral.

use super::super::dubins::Word;
use super::super::ends::Ends;
use crate::feasibility::steering::shooting::query::Curvatures;
use crate::math::circular::sin_cos;
use crate::math::quadrature::Gauss;
use crate::math::simd::{Simd, kernel};

/// Free shape parameters.
pub(super) const SHAPES: usize = 3;
/// Functions that the heading is made of: A, B, C, φ₀, φ₁, φ₂.
pub(super) const BASIS: usize = 6;

/// The free parameters.
#[derive(Debug, Clone, Copy)]
pub(in super::super) struct Free {
    /// c₀, c₁, c₂, rad.
    pub(in super::super) shape: [f64; SHAPES],
    /// L, m.
    pub(in super::super) length: f64,
}

impl Free {
    /// A start value with the length of `word` and, as far as c₀ can, its mean heading: of the functions of the basis,
    /// ∫A = 1/12, ∫B = 1/2, ∫C = −1/12, ∫φ₀ = 1/60.
    pub(in super::super) fn along(ends: &Ends, word: &Word, bounds: &Curvatures) -> Self {
        // Steering takes some way: a third of that from straight to the tightest bend is about right.
        let length = word.length() / bounds.most + 0.3 * bounds.most / bounds.most_rate;
        let mean = 0.5 * ends.turn + length * (ends.start - ends.end) / 12.0;
        Self { shape: [(60.0 * (word.mean_heading() - mean)).clamp(-80.0, 80.0), 0.0, 0.0], length }
    }
}

/// The basis as polynomials of t, rising powers.
const POLYNOMIALS: [[f64; 7]; BASIS] = [
    [0.0, 1.0, -2.0, 1.0, 0.0, 0.0, 0.0],
    [0.0, 0.0, 3.0, -2.0, 0.0, 0.0, 0.0],
    [0.0, 0.0, -1.0, 1.0, 0.0, 0.0, 0.0],
    [0.0, 0.0, 0.5, -1.0, 0.5, 0.0, 0.0],
    [0.0, 0.0, -0.5, 2.0, -2.5, 1.0, 0.0],
    [0.0, 0.0, 0.5, -10.0 / 3.0, 7.5, -7.0, 7.0 / 3.0],
];

/// Quadrature points, in lanes.
const NODES: usize = 32;
const LANES: usize = 8;
const GROUPS: usize = NODES / LANES;
type Table = [[f64; LANES]; GROUPS];

/// The basis at the nodes, and the weights.
const AT_NODES: [Table; BASIS] = at_nodes();
const WEIGHTS: Table = weights();

const fn weights() -> Table {
    let rule = Gauss::<NODES>::RULE;
    let mut out = [[0.0; LANES]; GROUPS];
    let mut i = 0;
    while i < NODES {
        out[i / LANES][i % LANES] = rule.weights[i];
        i += 1;
    }
    out
}

/// Filled at compile time.
const fn at_nodes() -> [Table; BASIS] {
    let rule = Gauss::<NODES>::RULE;
    let mut out = [[[0.0; LANES]; GROUPS]; BASIS];
    let mut i = 0;
    while i < NODES {
        let values = basis(rule.nodes[i], 0);
        let mut b = 0;
        while b < BASIS {
            out[b][i / LANES][i % LANES] = values[b];
            b += 1;
        }
        i += 1;
    }
    out
}

/// The basis' derivative of some order at t.
///
/// Orders 0, 1 and 2 only; derivatives by t, not by s.
pub(super) const fn basis(t: f64, order: usize) -> [f64; BASIS] {
    let mut out = [0.0; BASIS];
    let mut b = 0;
    while b < BASIS {
        let mut power = 7;
        while power > order {
            power -= 1;
            let factor = match order {
                0 => 1.0,
                1 => power as f64,
                _ => (power * (power - 1)) as f64,
            };
            out[b] = out[b] * t + factor * POLYNOMIALS[b][power];
        }
        b += 1;
    }
    out
}

/// ∫cos θ, ∫sin θ over t, and the same weighted with each function of the basis.
#[derive(Debug, Clone, Copy, Default)]
struct Moments {
    /// Position over L.
    cos: f64,
    sin: f64,
    /// ∫ cos θ B_b dt for each function of the basis, and the same with sin.
    cos_basis: [f64; BASIS],
    sin_basis: [f64; BASIS],
}

impl Ends {
    /// Factors of the basis.
    ///
    /// Units: rad each, so that θ is their sum over the basis. ∂/∂L is (κ₀, 0, κ_f, 0, 0, 0).
    pub(super) fn factors(&self, free: &Free) -> [f64; BASIS] {
        let [c0, c1, c2] = free.shape;
        [free.length * self.start, self.turn, free.length * self.end, c0, c1, c2]
    }

    /// Position error (m) at the end of the curve, and its derivative by c₀, c₁, c₂, L.
    ///
    /// 32 Gauss points over the whole curve, the same bits at every level of SIMD.
    ///
    /// ∂x/∂c_j = −L ∫ sin θ φ_j dt, ∂y/∂c_j = L ∫ cos θ φ_j dt, ∂x/∂L = ∫ cos θ − L ∫ sin θ (κ₀ A + κ_f C) dt. Columns:
    /// c₀, c₁, c₂, L. Accurate for curves that turn by some radians, not for those that wind up dozens of times.
    pub(super) fn miss(&self, simd: Simd, free: &Free) -> ([f64; 2], [[f64; SHAPES + 1]; 2]) {
        let mut m = Moments::default();
        moments(simd, &self.factors(free), &mut m);
        let l = free.length;
        let (c, s) = (&m.cos_basis, &m.sin_basis);
        let by_length =
            [m.cos - l * (self.start * s[0] + self.end * s[2]), m.sin + l * (self.start * c[0] + self.end * c[2])];
        (
            [l * m.cos - self.x, l * m.sin - self.y],
            [[-l * s[3], -l * s[4], -l * s[5], by_length[0]], [l * c[3], l * c[4], l * c[5], by_length[1]]],
        )
    }

    /// θ_t = Lκ as a polynomial of t, rising powers.
    pub(super) fn turning(&self, free: &Free) -> [f64; 6] {
        let factors = self.factors(free);
        let mut out = [0.0; 6];
        for (factor, polynomial) in factors.iter().zip(&POLYNOMIALS) {
            for (power, slot) in out.iter_mut().enumerate() {
                *slot += factor * (power + 1) as f64 * polynomial[power + 1];
            }
        }
        out
    }

    /// a₀ … a₅ of κ(s) = Σ aᵢ sⁱ.
    pub(in super::super) fn curvature(&self, free: &Free) -> [f64; 6] {
        let mut scale = 1.0;
        self.turning(free).map(|k| {
            scale /= free.length;
            k * scale
        })
    }
}

kernel! {
    /// ∫₀¹ cos θ, ∫₀¹ sin θ and each weighted with every function of the basis: end position over L and its derivatives
    /// by the free factors, in one pass over the nodes.
    fn moments(factors: &[f64; BASIS], out: &mut Moments) {
        let mut plain = [[0.0; LANES]; 2];
        let mut weighted = [[[0.0; LANES]; BASIS]; 2];
        for group in 0..GROUPS {
            for lane in 0..LANES {
                let mut heading = 0.0;
                for (factor, table) in factors.iter().zip(&AT_NODES) {
                    heading += factor * table[group][lane];
                }
                let (sin, cos) = sin_cos(heading);
                let weight = WEIGHTS[group][lane];
                let (cos, sin) = (weight * cos, weight * sin);
                plain[0][lane] += cos;
                plain[1][lane] += sin;
                for b in 0..BASIS {
                    weighted[0][b][lane] += cos * AT_NODES[b][group][lane];
                    weighted[1][b][lane] += sin * AT_NODES[b][group][lane];
                }
            }
        }
        let [cos, sin] = plain.map(|lanes| total(&lanes));
        let [cos_basis, sin_basis] = weighted.map(|rows| rows.map(|lanes| total(&lanes)));
        *out = Moments { cos, sin, cos_basis, sin_basis };
    }
}

/// Sum of the lanes in a fixed order.
#[inline(always)]
fn total(lanes: &[f64; LANES]) -> f64 {
    ((lanes[0] + lanes[4]) + (lanes[2] + lanes[6])) + ((lanes[1] + lanes[5]) + (lanes[3] + lanes[7]))
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;
    use crate::math::random::hashed_unit;

    #[test]
    fn jacobian_agrees_with_central_differences() {
        for seed in 0..100 {
            let draw = |k: u64, scale: f64| scale * (2.0 * hashed_unit(seed, &[k]) - 1.0);
            let ends =
                Ends { x: draw(0, 5.0), y: draw(1, 5.0), turn: draw(2, 5.0), start: draw(3, 1.0), end: draw(4, 1.0) };
            let free = Free { shape: [draw(5, 40.0), draw(6, 60.0), draw(7, 60.0)], length: 5.0 + draw(8, 4.0) };
            let (_, jacobian) = ends.miss(Simd::Widest, &free);
            for unknown in 0..=SHAPES {
                let moved = |by: f64| {
                    let mut free = free;
                    match free.shape.get_mut(unknown) {
                        Some(c) => *c += by,
                        None => free.length += by,
                    }
                    ends.miss(Simd::Widest, &free).0
                };
                let (up, down) = (moved(1e-5), moved(-1e-5));
                for (axis, row) in jacobian.iter().enumerate() {
                    let difference = (up[axis] - down[axis]) / 2e-5;
                    assert!((difference - row[unknown]).abs() < 1e-7, "seed {seed}: {axis} by {unknown}");
                }
            }
        }
    }

    #[test]
    fn the_ends_are_as_prescribed_whatever_is_free() {
        let ends = Ends { x: 1.0, y: 2.0, turn: 2.5, start: 0.3, end: -0.7 };
        let free = Free { shape: [10.0, -20.0, 30.0], length: 4.0 };
        let a = ends.curvature(&free);
        let at = |s: f64| a.iter().rev().fold(0.0, |sum, a| sum * s + a);
        let turn: f64 = a.iter().enumerate().map(|(k, a)| a * 4.0_f64.powi(k as i32 + 1) / (k + 1) as f64).sum();
        assert!((at(0.0) - 0.3).abs() < 1e-12 && (at(4.0) + 0.7).abs() < 1e-12 && (turn - 2.5).abs() < 1e-12);
    }

    #[test]
    fn second_derivatives_are_orthogonal_to_lower_order() {
        // φ_j″ is a Legendre polynomial: ∫φ_j″² = 1/(2j + 5), and nothing else of the basis overlaps with it.
        let rule = Gauss::<12>::RULE;
        for j in 3..BASIS {
            for b in 0..BASIS {
                let overlap: f64 =
                    (0..12).map(|i| rule.weights[i] * basis(rule.nodes[i], 2)[j] * basis(rule.nodes[i], 2)[b]).sum();
                let expected = if b == j { 1.0 / (2 * j - 1) as f64 } else { 0.0 };
                assert!((overlap - expected).abs() < 1e-12, "{j} {b}: {overlap}");
            }
        }
    }
}
