//! Polynomials of degree 7 on [0, T]: built from what they do at both ends, and bounded by their Bernstein form.
//!
//! A leg between two states is one such polynomial per axis (m, m/s, m/s², m/s³ at the ends; s): eight conditions,
//! eight coefficients, so that a leg costs no solve. In Bernstein form, B_i(σ) = C(7, i) σⁱ (1 − σ)⁷⁻ⁱ, σ = τ/T, the
//! B_i are ≥ 0 and sum to 1, which makes min b_i ≤ p(τ) ≤ max b_i a bound between samples; each halving takes the gap
//! to a quarter (Farin, "Curves and Surfaces for CAGD", 5th ed. 2002, ch. 4-5).

use wide::f64x4;

use super::interval::unrolled;

/// Coefficients c_i of Σ c_i τ^i.
///
/// On [0, T], τ in s: c_i has the unit of the value over sⁱ.
pub type Septic = [f64; 8];

/// The binomials C(7, i).
const CHOOSE_7: [f64; 8] = [1.0, 7.0, 21.0, 35.0, 35.0, 21.0, 7.0, 1.0];

/// The one polynomial of degree 7 with value, first, second and third derivative `start` at 0 and `end` at `duration`.
///
/// Solved in σ = τ/T, where c₀…c₃ are read off `start` and c₄…c₇ solve a 4 × 4 system whose inverse is constant.
///
/// With r the residues of the cubic c₀ + c₁σ + c₂σ² + c₃σ³ at σ = 1, (c₄ … c₇) = M r for the constant M of the rows
/// below (the same as [`crate::math::minimum_snap::hermite`] takes). Coefficients are returned in powers of τ.
/// `duration` T > 0 is the caller's to see to: T → 0 makes them infinite, never wrong in silence.
///
/// ```
/// use hairpin::math::polynomial::{control_points, septic};
///
/// // From rest to rest over 1 m in 2 s: value, velocity, acceleration, jerk at either end.
/// let leg = septic(&[0.0; 4], &[1.0, 0.0, 0.0, 0.0], 2.0);
/// let middle: f64 = leg.iter().sum(); // at τ = 1 s
/// assert!((middle - 0.5).abs() < 1e-12);
/// // Its control points prove that it never leaves [0, 1].
/// assert!(control_points(&leg, 2.0).iter().all(|b| (-1e-12..1.0 + 1e-12).contains(b)));
/// ```
#[inline]
pub fn septic(start: &[f64; 4], end: &[f64; 4], duration: f64) -> Septic {
    let t = duration;
    let (t2, t3) = (t * t, t * t * t);
    let (c0, c1, c2, c3) = (start[0], start[1] * t, 0.5 * start[2] * t2, start[3] * t3 / 6.0);
    // What the cubic part misses at σ = 1, derivative by derivative.
    let e0 = end[0] - (c0 + c1 + c2 + c3);
    let e1 = end[1] * t - (c1 + 2.0 * c2 + 3.0 * c3);
    let e2 = end[2] * t2 - (2.0 * c2 + 6.0 * c3);
    let e3 = end[3] * t3 - 6.0 * c3;
    let c4 = 35.0 * e0 - 15.0 * e1 + 2.5 * e2 - e3 / 6.0;
    let c5 = -84.0 * e0 + 39.0 * e1 - 7.0 * e2 + 0.5 * e3;
    let c6 = 70.0 * e0 - 34.0 * e1 + 6.5 * e2 - 0.5 * e3;
    let c7 = -20.0 * e0 + 10.0 * e1 - 2.0 * e2 + e3 / 6.0;
    let u = 1.0 / t;
    let (u2, u4) = (u * u, u * u * u * u);
    [c0, start[1], 0.5 * start[2], start[3] / 6.0, c4 * u4, c5 * u4 * u, c6 * u4 * u2, c7 * u4 * u2 * u]
}

/// The derivatives of order 0 … 7 of Σ c_i τ^i at four times, by repeated synthetic division.
#[inline(always)]
pub(crate) fn derivatives(c: &Septic, tau: f64x4) -> [f64x4; 8] {
    const FACTORIAL: [f64; 8] = [1.0, 1.0, 2.0, 6.0, 24.0, 120.0, 720.0, 5040.0];
    let mut b = unrolled!([0, 1, 2, 3, 4, 5, 6, 7], |i| f64x4::splat(c[i]));
    for order in 0..7 {
        for i in (order..7).rev() {
            b[i] += b[i + 1] * tau;
        }
    }
    unrolled!([0, 1, 2, 3, 4, 5, 6, 7], |order| b[order] * FACTORIAL[order])
}

/// Control points b_0…b_7 of the same polynomial on [0, `duration`]: p(τ) = Σ b_i B_i(τ/T) lies in their hull, and
/// b_0, b_7 are its values at the ends.
///
/// b_j = Σ_{i ≤ j} C(j, i)/C(7, i) c_i Tⁱ. Derivatives are bounded likewise: those of p have the control points 7
/// (b_{j+1} − b_j)/T.
#[inline]
pub fn control_points(c: &Septic, duration: f64) -> [f64; 8] {
    // b_j = Σ_{i ≤ j} C(j, i)/C(7, i) c_i T^i, summed along Pascal's triangle.
    let mut b = [0.0; 8];
    let mut power = 1.0;
    for i in 0..8 {
        b[i] = c[i] * power / CHOOSE_7[i];
        power *= duration;
    }
    for level in 1..8 {
        for j in (level..8).rev() {
            b[j] += b[j - 1];
        }
    }
    b
}

/// The control points of both halves, by de Casteljau's construction at the middle.
///
/// The union of both hulls lies in the old hull, so bisecting never loosens a bound. 28 averages, no multiplication but
/// by ½: exact but for rounding of sums.
#[inline]
pub fn halve(b: &[f64; 8]) -> ([f64; 8], [f64; 8]) {
    let (mut work, mut left, mut right) = (*b, [0.0; 8], [0.0; 8]);
    for level in 0..8 {
        left[level] = work[0];
        right[7 - level] = work[7 - level];
        for j in 0..7 - level {
            work[j] = 0.5 * (work[j] + work[j + 1]);
        }
    }
    (left, right)
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;
    use crate::math::random::stream;
    use rand::RngExt;

    fn derivative(c: &Septic, tau: f64, order: usize) -> f64 {
        (order..8).rev().fold(0.0, |value, i| value * tau + c[i] * (0..order).map(|k| (i - k) as f64).product::<f64>())
    }

    #[test]
    fn meets_both_ends() {
        for seed in 0..500 {
            let mut random = stream(seed);
            let start: [f64; 4] = std::array::from_fn(|_| random.random_range(-5.0..5.0));
            let end: [f64; 4] = std::array::from_fn(|_| random.random_range(-5.0..5.0));
            let t = random.random_range(0.3..5.0);
            let c = septic(&start, &end, t);
            for order in 0..4 {
                assert!((derivative(&c, 0.0, order) - start[order]).abs() < 1e-12, "seed {seed}, order {order}");
                let miss = derivative(&c, t, order) - end[order];
                assert!(miss.abs() < 1e-9 / t.powi(order as i32).min(1.0), "seed {seed}, order {order}: {miss}");
            }
        }
    }

    #[test]
    fn control_points_and_their_halves_are_the_polynomial() {
        let bernstein = |b: &[f64; 8], s: f64| {
            (0..8).map(|i| b[i] * CHOOSE_7[i] * s.powi(i as i32) * (1.0 - s).powi(7 - i as i32)).sum::<f64>()
        };
        for seed in 0..200 {
            let mut random = stream(seed);
            let c: Septic = std::array::from_fn(|_| random.random_range(-2.0..2.0));
            let t = random.random_range(0.5..2.0);
            let b = control_points(&c, t);
            let (left, right) = halve(&b);
            for k in 0..=10 {
                let s = k as f64 / 10.0;
                let close = |a: f64, b: f64| (a - b).abs() < 1e-9 * (1.0 + b.abs());
                assert!(close(bernstein(&b, s), derivative(&c, s * t, 0)), "seed {seed}");
                assert!(close(bernstein(&left, s), derivative(&c, 0.5 * s * t, 0)), "seed {seed}");
                assert!(close(bernstein(&right, s), derivative(&c, 0.5 * (1.0 + s) * t, 0)), "seed {seed}");
            }
        }
    }
}
