//! Bounds of polynomials on [0, 1], decided exactly by their Bernstein coefficients.
//!
//! A polynomial lies in the hull of its Bernstein coefficients and takes the first and the last of them at the ends;
//! halving the interval narrows the hull quadratically.
//!
//! Sampling would miss a peak between samples, and roots of a derivative of degree 4 need care where they nearly
//! coincide; Bernstein's coefficients bound from both sides and need neither.

/// Halvings after which an interval is as good as a point.
///
/// What would need more is answered by its hull, which errs high.
const DEPTH: usize = 40;
/// Relative width of the enclosure of a maximum.
const WIDTH: f64 = 1e-10;

/// Whether |p(t)| ≤ `bound` for 0 ≤ t ≤ 1, p = Σ aₖ tᵏ; an excess below 10⁻¹⁰ of the bound may pass.
///
/// `bound` ≥ 0. Cheap where the first hull is within it, which most curves' is.
pub(super) fn within(p: &[f64; 6], bound: f64) -> bool {
    let reached = bound * (1.0 - WIDTH);
    let enough = bound * (1.0 + WIDTH);
    look(&bernstein(p), reached, enough) <= enough
}

/// max |p(t)| over 0 ≤ t ≤ 1, p = Σ aₖ tᵏ, or more by 10⁻¹⁰ of it at most; infinite if any aₖ is no number.
pub(in super::super) fn largest(p: &[f64; 6]) -> f64 {
    look(&bernstein(p), 0.0, f64::INFINITY)
}

/// The largest magnitude, from above, if it is more than `reached`; stops at any that is more than `enough`.
///
/// Branch and bound: pieces whose hull is no larger than the largest value seen (with its width) are left out.
fn look(whole: &[f64; 6], reached: f64, enough: f64) -> f64 {
    let mut reached = reached.max(whole[0].abs()).max(whole[5].abs());
    let limit = |reached: f64| reached * (1.0 + WIDTH);
    if !whole.iter().all(|b| b.is_finite()) {
        return f64::INFINITY;
    }
    if hull(whole) <= limit(reached) || reached > enough {
        return limit(reached).min(hull(whole)).max(reached);
    }
    let mut stack = [*whole; DEPTH];
    let mut height = 1;
    while height > 0 {
        height -= 1;
        let piece = stack[height];
        if hull(&piece) <= limit(reached) {
            continue;
        }
        let (left, right) = halves(&piece);
        reached = reached.max(right[0].abs());
        if reached > enough {
            return reached;
        }
        if height + 2 > DEPTH {
            reached = reached.max(hull(&piece));
            continue;
        }
        // The half that promises more is looked at first: the stack grows by one a level.
        let left_first = hull(&left) > hull(&right);
        stack[height] = if left_first { right } else { left };
        stack[height + 1] = if left_first { left } else { right };
        height += 2;
    }
    limit(reached)
}

fn hull(coefficients: &[f64; 6]) -> f64 {
    let [a, b, c, d, e, f] = coefficients.map(f64::abs);
    (a.max(b)).max(c.max(d)).max(e.max(f))
}

/// bᵢ = Σₖ aₖ C(i, k) / C(5, k).
///
/// Rising powers in, coefficients over the fifth-order Bernstein polynomials out; the first and the last are p(0) and
/// p(1).
fn bernstein(a: &[f64; 6]) -> [f64; 6] {
    let [a0, a1, a2, a3, a4, a5] = [a[0], a[1] / 5.0, a[2] / 10.0, a[3] / 10.0, a[4] / 5.0, a[5]];
    [
        a0,
        a0 + a1,
        a0 + 2.0 * a1 + a2,
        a0 + 3.0 * a1 + 3.0 * a2 + a3,
        a0 + 4.0 * a1 + 6.0 * a2 + 4.0 * a3 + a4,
        a0 + 5.0 * a1 + 10.0 * a2 + 10.0 * a3 + 5.0 * a4 + a5,
    ]
}

/// De Casteljau's triangle at ½: the coefficients of both halves.
fn halves(b: &[f64; 6]) -> ([f64; 6], [f64; 6]) {
    let (mut left, mut right) = (*b, *b);
    for (level, slot) in left.iter_mut().enumerate().skip(1) {
        for i in 0..6 - level {
            right[i] = 0.5 * (right[i] + right[i + 1]);
        }
        *slot = right[0];
    }
    (left, right)
}

/// The smallest number that no |p(t)| on [0, 1] exceeds by the hull alone: quick, and up to a few times too large.
pub(super) fn hull_of(p: &[f64; 6]) -> f64 {
    hull(&bernstein(p))
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;
    use crate::math::random::hashed_unit;

    #[test]
    fn encloses_what_dense_samples_reach() {
        for seed in 0..500 {
            let p: [f64; 6] = std::array::from_fn(|k| (hashed_unit(seed, &[k as u64]) - 0.5) * 3.0_f64.powi(k as i32));
            let value = |t: f64| p.iter().rev().fold(0.0, |sum, a| sum * t + a).abs();
            let sampled = (0..=20_000).map(|i| value(f64::from(i) / 20_000.0)).fold(0.0, f64::max);
            let bound = largest(&p);
            assert!(
                sampled <= bound * (1.0 + 1e-14) && bound <= sampled * (1.0 + 1e-5),
                "seed {seed}: {sampled} {bound}"
            );
            assert!(within(&p, bound) && within(&p, 1.001 * bound) && !within(&p, 0.999 * bound), "seed {seed}");
            assert!(hull_of(&p) >= sampled * (1.0 - 1e-14), "seed {seed}");
        }
    }

    #[test]
    fn an_end_that_just_touches_its_bound_keeps_it() {
        assert!(within(&[1.0, -1.0, 0.0, 0.0, 0.0, 0.0], 1.0));
        assert!(within(&[0.0; 6], 0.0));
        assert!(!within(&[f64::NAN; 6], 1.0));
        // 4t(1 − t) touches 1 at ½.
        assert!(within(&[0.0, 4.0, -4.0, 0.0, 0.0, 0.0], 1.0));
        assert!(!within(&[0.0, 4.0, -4.0, 0.0, 0.0, 0.0], 1.0 - 1e-6));
    }
}
