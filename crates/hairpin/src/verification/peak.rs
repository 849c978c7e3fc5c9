//! The largest value of a polynomial: at an end, or where its slope changes sign.

/// Coefficients at most.
const MOST: usize = 6;
/// Steps to a root at most; Newton takes five or so, halving takes all of a double's digits.
const STEPS: usize = 60;
/// Share of the interval that a root is known to: values there differ by its square.
const CLOSED: f64 = 1e-10;

/// Largest |p| on [0, length], p(s) = Σ aᵢ sⁱ; no number where one of them is none.
///
/// Between two neighbouring turns of p⁽ᵏ⁺¹⁾'s sign p⁽ᵏ⁾ is monotone and has one root at most: from the highest
/// derivative down, each gives the next one's intervals.
///
/// ```text
/// max |p| = max of |p(s)| over s = 0, s = length and the roots of p′ between
/// ```
///
/// At most 1 + 2 + 3 + 4 roots are looked for. A value beside the true root is off by the square of what the root is
/// off by. Double roots of a slope, where it does not change sign, are no peaks and may be passed by.
pub(super) fn peak(p: &[f64; MOST], length: f64) -> f64 {
    let degree = p.iter().rposition(|a| *a != 0.0).unwrap_or(0);
    let mut derivatives = [[0.0; MOST]; MOST];
    derivatives[0] = *p;
    for order in 1..=degree {
        for i in 0..=degree - order {
            derivatives[order][i] = (i + 1) as f64 * derivatives[order - 1][i + 1];
        }
    }
    let value =
        |order: usize, s: f64| derivatives[order][..=degree - order].iter().rev().fold(0.0, |sum, a| sum * s + a);
    let (mut stops, mut count) = ([0.0; MOST + 1], 2);
    stops[1] = length;
    for order in (1..degree).rev() {
        let (mut next, mut found) = ([0.0; MOST + 1], 1);
        for pair in stops[..count].windows(2) {
            if let Some(root) = root(&|s| [value(order, s), value(order + 1, s)], pair[0], pair[1]) {
                next[found] = root;
                found += 1;
            }
        }
        next[found] = length;
        (stops, count) = (next, found + 1);
    }
    stops[..count].iter().map(|s| value(0, *s).abs()).fold(0.0, largest)
}

/// Where `f`, which gives value and slope, is 0 in (low, high], if it changes its sign there.
///
/// Newton steps kept within the bracket, else its middle; converged where a step is below 10⁻¹⁰ of the first bracket,
/// or after 60. `None` where `f` keeps its sign, or is 0 at `low`: a root there belongs to the interval before.
fn root(f: &impl Fn(f64) -> [f64; 2], mut low: f64, mut high: f64) -> Option<f64> {
    let ([at_low, _], [at_high, _]) = (f(low), f(high));
    if at_high == 0.0 && at_low != 0.0 {
        return Some(high);
    }
    if !(at_low < 0.0 && at_high > 0.0 || at_low > 0.0 && at_high < 0.0) {
        return None;
    }
    let close = CLOSED * (high - low);
    let mut s = 0.5 * (low + high);
    for _ in 0..STEPS {
        let [value, slope] = f(s);
        if (value < 0.0) == (at_low < 0.0) {
            low = s
        } else {
            high = s
        }
        let newton = s - value / slope;
        // Newton where it stays between what is known, else the middle.
        let next = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
        if (next - s).abs() < close {
            return Some(next);
        }
        s = next;
    }
    Some(s)
}

/// The larger, or no number if one is none.
pub(super) fn largest(a: f64, b: f64) -> f64 {
    if a.is_nan() || b.is_nan() { f64::NAN } else { a.max(b) }
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;
    use crate::math::random::hashed_unit;

    #[test]
    fn no_place_of_a_fine_grid_is_higher_and_one_is_as_high() {
        for seed in 0..2000 {
            let length = 0.1 + 5.0 * hashed_unit(seed, &[9]);
            let mut p: [f64; MOST] =
                std::array::from_fn(|i| (2.0 * hashed_unit(seed, &[i as u64]) - 1.0) / length.powi(i as i32));
            // Of every degree, some with roots of their slope that are double or at an end.
            p[1 + (seed % 5) as usize..].iter_mut().skip(1).for_each(|a| *a = 0.0);
            if seed % 7 == 0 {
                p[1] = 0.0;
            }
            let at = |s: f64| p.iter().rev().fold(0.0, |sum, a| sum * s + a);
            let grid = (0..=4000).map(|i| at(length * f64::from(i) / 4000.0).abs()).fold(0.0, f64::max);
            let found = peak(&p, length);
            assert!(
                found >= grid * (1.0 - 1e-12) && found <= grid + 1e-5,
                "seed {seed}: {p:?} {length}: {found} {grid}"
            );
        }
    }

    #[test]
    fn slopes_with_a_root_of_many_at_once_and_numbers_that_are_none() {
        // (s − 1)⁴ − 1 has its least value, −1, at a triple root of its slope.
        assert!((peak(&[0.0, -4.0, 6.0, -4.0, 1.0, 0.0], 1.5) - 1.0).abs() < 1e-9);
        assert_eq!(peak(&[0.0; MOST], 3.0), 0.0);
        assert_eq!(peak(&[-2.0, 0.0, 0.0, 0.0, 0.0, 0.0], 0.0), 2.0);
        assert!(peak(&[0.0, f64::NAN, 0.0, 0.0, 0.0, 0.0], 1.0).is_nan());
        assert!(peak(&[1.0, 1.0, 0.0, 0.0, 0.0, 0.0], f64::NAN).is_nan());
    }
}
