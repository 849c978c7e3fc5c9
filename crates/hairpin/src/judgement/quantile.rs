//! Quantiles of a sample with intervals that assume no distribution: both are values of the sample, by their ranks.

use super::statistics::beta_share;

/// The value that a share of cases lies beyond, and between which values of the sample it lies.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Quantile {
    /// So many of the sample are larger as the share is of it, at most.
    pub value: f64,
    /// Lower end of the interval.
    pub low: f64,
    /// Upper end of the interval.
    pub high: f64,
}

/// The limit that the share `above` (0 < p < 1) of what `values` are a sample of exceeds, with its interval at
/// `confidence`; `None` where the sample is too small for one, or one of the values is NaN. Infinite ones have their
/// rank.
///
/// Of n values in order it is number ⌈(1 − p) n⌉. The interval is from number l to number u with P(B < l) ≤ α/2 and
/// P(B ≥ u) ≤ α/2 of a binomial B(n, 1 − p): so many of n values lie below the true quantile, whatever their
/// distribution. David and Nagaraja: Order Statistics, 3rd ed. 2003, 7.1.
///
/// ```
/// use hairpin::judgement::exceeded_by;
///
/// let values: Vec<f64> = (1..=200).map(f64::from).collect();
/// let limit = exceeded_by(&values, 0.05, 0.95).expect("200 are enough");
/// assert_eq!((limit.value, limit.low, limit.high), (190.0, 184.0, 197.0));
/// assert!(exceeded_by(&values[..71], 0.05, 0.95).is_none());
/// ```
pub fn exceeded_by(values: &[f64], above: f64, confidence: f64) -> Option<Quantile> {
    let n = values.len();
    if n == 0 || !(above > 0.0 && above < 1.0 && confidence > 0.0 && confidence < 1.0) {
        return None;
    }
    if values.iter().any(|value| value.is_nan()) {
        return None;
    }
    let mut sorted = values.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    // P(B ≤ k), the number of values below the quantile being binomial: I_p(n − k, k + 1).
    let at_most = |k: usize| if k >= n { 1.0 } else { beta_share((n - k) as f64, (k + 1) as f64, above) };
    let tail = 0.5 * (1.0 - confidence);
    let low = (1..=n).take_while(|rank| at_most(rank - 1) <= tail).last()?;
    let high = (low..=n).find(|rank| 1.0 - at_most(rank - 1) <= tail)?;
    // A share of n that is whole but for rounding is whole.
    let beyond = (above * n as f64 + 1e-9) as usize;
    let rank = (n - beyond).clamp(1, n);
    Some(Quantile { value: sorted[rank - 1], low: sorted[low - 1], high: sorted[high - 1] })
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;
    use crate::math::random::{stream, unit};

    /// The ranks, as values of 1 … n.
    fn ranks(n: u32, above: f64) -> Option<[f64; 3]> {
        let values: Vec<f64> = (1..=n).rev().map(f64::from).collect();
        exceeded_by(&values, above, 0.95).map(|found| [found.low, found.value, found.high])
    }

    #[test]
    fn ranks_are_those_of_tables() {
        // The median's: Conover, Practical Nonparametric Statistics, table A3 for n = 10, 20: ranks 2 and 9, 6 and 15.
        assert_eq!(ranks(10, 0.5), Some([2.0, 5.0, 9.0]));
        assert_eq!(ranks(20, 0.5), Some([6.0, 10.0, 15.0]));
        // 1 − 0.95ⁿ ≥ 0.975 first holds of n = 72: below the largest of so many lies the quantile nearly always.
        assert_eq!((ranks(71, 0.05), ranks(72, 0.05).map(|found| found[2])), (None, Some(72.0)));
        assert_eq!((ranks(0, 0.5), ranks(200, 1.0), exceeded_by(&[f64::NAN; 99], 0.5, 0.95)), (None, None, None));
    }

    #[test]
    fn ends_keep_their_tails() {
        // Summed term by term.
        let (n, q) = (200_u32, 0.95_f64);
        let [low, _, high] = ranks(n, 0.05).unwrap();
        let (mut term, mut sum, mut below) = ((1.0 - q).powi(n as i32), 0.0, Vec::new());
        for k in 0..=n {
            sum += term;
            below.push(sum);
            term *= f64::from(n - k) / f64::from(k + 1) * q / (1.0 - q);
        }
        let at_most = |rank: f64| below[rank as usize - 1];
        assert!(at_most(low) <= 0.025 && at_most(low + 1.0) > 0.025, "{low}");
        assert!(1.0 - at_most(high) <= 0.025 && 1.0 - at_most(high - 1.0) > 0.025, "{high}");
    }

    #[test]
    fn intervals_hold_the_quantile_as_often_as_they_say() {
        let mut random = stream(5);
        let (mut held, mut above) = (0, 0.0);
        for _ in 0..2000 {
            let values: Vec<f64> = (0..200).map(|_| -unit(&mut random).max(1e-300).ln()).collect();
            let found = exceeded_by(&values, 0.05, 0.95).unwrap();
            let truth = -(0.05_f64).ln();
            held += usize::from((found.low..=found.high).contains(&truth));
            above += values.iter().filter(|value| **value > found.value).count() as f64 / 200.0;
        }
        assert!((1900..=1980).contains(&held), "{held}");
        assert!((above / 2000.0 - 0.05).abs() < 1e-12, "{above}");
    }

    #[test]
    fn what_never_ends_well_is_beyond_any_limit() {
        let mut values = vec![1.0; 195];
        values.extend([f64::INFINITY; 5]);
        let found = exceeded_by(&values, 0.05, 0.95).unwrap();
        assert_eq!((found.value, found.low, found.high), (1.0, 1.0, f64::INFINITY));
    }
}
