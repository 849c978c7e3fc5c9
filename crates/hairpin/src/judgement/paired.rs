//! Paired comparison: the same tests under two conditions, and whether one of them was worse than chance has it.
//!
//! Two sets of runs of the same cases differ by case far more than by condition; differences of pairs take the cases
//! out.

use super::statistics::binomial_share_half;

/// Up to so many pairs the test's distribution is counted out; the counts, 2^n in all, are exact.
const MOST_COUNTED: usize = 50;

/// Wilcoxon's signed-rank test of paired differences.
///
/// `plus` + `minus` = n(n + 1)/2. Zero differences carry no sign and are left out (Wilcoxon's own rule).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SignedRank {
    /// Differences that are not zero: only these have a rank.
    pub ranked: usize,
    /// Sum of the ranks of positive differences.
    pub plus: f64,
    /// Sum of the ranks of negative differences.
    pub minus: f64,
    /// Matched-pairs rank biserial correlation (W⁺ − W⁻) / (W⁺ + W⁻), −1 … 1; 0 where nothing differs.
    pub rank_biserial: f64,
    /// Two-sided probability of rank sums at least as unequal if both signs were equally likely.
    pub p: f64,
    /// Whether `p` was counted out over all signs, ties included; else it is the normal approximation.
    pub exact: bool,
}

/// Tests `differences`; ranks are of their sizes, ties sharing the mean of theirs. `None` where one is not finite.
///
/// Up to 50 ranked differences every one of the 2^n assignments of signs to the ranks is counted, so that ties change
/// nothing of its exactness. Above, W⁺ is taken as normal with mean n(n+1)/4 and variance n(n+1)(2n+1)/24 − Σ(t³ −
/// t)/48 over groups of t ties, with a continuity correction of ½. Wilcoxon: Individual comparisons by ranking methods,
/// 1945; Kerby: The simple difference formula, 2014.
///
/// Counting takes n · W steps for a rank sum W ≤ n(n + 1): at most a hundred thousand.
///
/// ```
/// use hairpin::judgement::signed_rank;
///
/// let test = signed_rank(&[0.3, 0.1, 0.5, 0.2, 0.4, 0.6]).expect("finite");
/// assert!(test.exact && test.rank_biserial == 1.0);
/// assert_eq!(test.p, 2.0 / 64.0); // all six of one sign: 2 of 2⁶ assignments
/// ```
pub fn signed_rank(differences: &[f64]) -> Option<SignedRank> {
    if !differences.iter().all(|difference| difference.is_finite()) {
        return None;
    }
    let mut ranked: Vec<f64> = differences.iter().copied().filter(|difference| *difference != 0.0).collect();
    ranked.sort_by(|a, b| a.abs().total_cmp(&b.abs()));
    // Twice the ranks, which are whole even where ties share theirs.
    let mut doubled = Vec::with_capacity(ranked.len());
    let mut ties = 0.0;
    for equal in ranked.chunk_by(|a, b| a.abs() == b.abs()) {
        let (below, count) = (doubled.len(), equal.len());
        doubled.extend(std::iter::repeat_n(2 * below + count + 1, count));
        let t = count as f64;
        ties += t * (t * t - 1.0);
    }
    let side = |positive: bool| -> usize {
        let signs = ranked.iter().zip(&doubled).filter(|(difference, _)| (**difference > 0.0) == positive);
        signs.map(|(_, rank)| rank).sum()
    };
    let (plus, minus) = (side(true), side(false));
    let n = ranked.len();
    let exact = n <= MOST_COUNTED;
    let p = if exact { counted(&doubled, plus.min(minus)) } else { approximated(n, 0.5 * plus as f64, ties) };
    let (plus, minus) = (0.5 * plus as f64, 0.5 * minus as f64);
    let rank_biserial = if n == 0 { 0.0 } else { (plus - minus) / (plus + minus) };
    Some(SignedRank { ranked: n, plus, minus, rank_biserial, p, exact })
}

/// Twice the share of all assignments of signs whose positive ranks (doubled) sum to `least` or less; at most 1.
fn counted(doubled: &[usize], least: usize) -> f64 {
    let mut ways = vec![0_u64; least + 1];
    ways[0] = 1;
    for &rank in doubled {
        for sum in (rank..=least).rev() {
            ways[sum] += ways[sum - rank];
        }
    }
    let all = (1_u64 << doubled.len()) as f64;
    (2.0 * ways.iter().sum::<u64>() as f64 / all).min(1.0)
}

fn approximated(n: usize, plus: f64, ties: f64) -> f64 {
    let n = n as f64;
    let mean = n * (n + 1.0) / 4.0;
    let variance = n * (n + 1.0) * (2.0 * n + 1.0) / 24.0 - ties / 48.0;
    let z = ((plus - mean).abs() - 0.5).max(0.0) / variance.sqrt();
    libm::erfc(z * std::f64::consts::FRAC_1_SQRT_2)
}

/// A median and between which values of the sample it lies.
///
/// The interval needs no assumption but independence: with fewer than six values none has 95 %.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Median {
    /// Of the sample; the mean of the two middle values of an even number.
    pub value: f64,
    /// Lower and upper end of the interval, whatever the distribution; `None` where there are too few values for one.
    pub interval: Option<[f64; 2]>,
}

/// The median of `values` with the interval of order statistics that covers it with at least `confidence` (0 < c < 1):
/// from the k-th smallest to the k-th largest value, k the largest with 2 P(B(n, ½) < k) ≤ 1 − c. `None` without
/// values, or with one that is not finite. Thompson: On confidence ranges for the median, 1936.
///
/// ```
/// use hairpin::judgement::median;
///
/// let middle = median(&[3.0, 1.0, 2.0, 6.0, 5.0, 4.0], 0.95).expect("six values");
/// assert_eq!((middle.value, middle.interval), (3.5, Some([1.0, 6.0]))); // six are the fewest that have one
/// ```
pub fn median(values: &[f64], confidence: f64) -> Option<Median> {
    if values.is_empty() || !values.iter().all(|value| value.is_finite()) {
        return None;
    }
    let mut sorted = values.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    let (n, half) = (sorted.len(), sorted.len() / 2);
    let value = if n.is_multiple_of(2) { 0.5 * (sorted[half - 1] + sorted[half]) } else { sorted[half] };
    let covers = |k: usize| 2.0 * binomial_share_half(n, k - 1) <= 1.0 - confidence;
    // The largest k that covers, by bisection: none (0) if not even the extremes do.
    let (mut low, mut high) = (0, half + 1);
    while high - low > 1 {
        let middle = (low + high) / 2;
        if covers(middle) { low = middle } else { high = middle }
    }
    let interval = (low > 0).then(|| [sorted[low - 1], sorted[n - low]]);
    Some(Median { value, interval })
}

/// `p` made larger for as many tests as there are, so that none of them is called significant by their number alone:
/// the k-th smallest times what is left of them, never smaller than the one before, at most 1. Holm: A simple
/// sequentially rejective multiple test procedure, 1979.
///
/// The chance of any false finding among all tests stays below the level that one is held to, whatever their
/// dependence.
///
/// ```
/// use hairpin::judgement::holm;
///
/// assert_eq!(holm(&[1.0 / 64.0, 0.25, 0.125]), [3.0 / 64.0, 0.25, 0.25]);
/// ```
pub fn holm(p: &[f64]) -> Vec<f64> {
    let mut order: Vec<usize> = (0..p.len()).collect();
    order.sort_by(|&a, &b| p[a].total_cmp(&p[b]));
    let mut adjusted = vec![0.0; p.len()];
    let mut least = 0.0_f64;
    for (place, &index) in order.iter().enumerate() {
        least = least.max(((p.len() - place) as f64 * p[index]).min(1.0));
        adjusted[index] = least;
    }
    adjusted
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;
    use statrs::distribution::{Binomial, ContinuousCDF, DiscreteCDF, Normal};

    /// All assignments of signs, one by one.
    fn enumerated(differences: &[f64]) -> f64 {
        let found = signed_rank(differences).unwrap();
        let sizes: Vec<f64> = differences.iter().map(|d| d.abs()).collect();
        let ranks: Vec<f64> = (sizes.iter())
            .map(|size| {
                let below = sizes.iter().filter(|other| *other < size).count() as f64;
                let equal = sizes.iter().filter(|other| *other == size).count() as f64;
                below + 0.5 * (equal + 1.0)
            })
            .collect();
        let least = found.plus.min(found.minus);
        let all = 1_u32 << differences.len();
        let sum = |signs: u32| -> f64 { (0..ranks.len()).filter(|i| signs >> i & 1 == 1).map(|i| ranks[i]).sum() };
        (2.0 * (0..all).filter(|&signs| sum(signs) <= least).count() as f64 / f64::from(all)).min(1.0)
    }

    #[test]
    fn counts_are_those_of_all_signs() {
        for differences in [
            vec![1.0, 2.0, 3.0, 4.0, 5.0, 6.0],
            vec![-1.5, 2.0, 3.25, -0.5, 7.0, 8.0, 9.0, 10.0],
            vec![1.0, 1.0, -1.0, 2.0, -2.0, 2.0, 2.0, 3.0, 3.0, 5.0],
            vec![-4.0],
        ] {
            let found = signed_rank(&differences).unwrap();
            assert!(found.exact && (found.p - enumerated(&differences)).abs() < 1e-15, "{differences:?} {found:?}");
        }
        // All of six have one sign: 2 / 2⁶.
        assert_eq!(signed_rank(&[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]).unwrap().p, 0.03125);
    }

    #[test]
    fn published_example() {
        // Darwin's maize (Fisher: The Design of Experiments, 1935): 15 pairs; R's wilcox.test gives V = 96, p =
        // 0.04126.
        let eighths = [49, -67, 8, 16, 6, 23, 28, 41, 14, 29, 56, 24, 75, 60, -48].map(f64::from);
        let found = signed_rank(&eighths).unwrap();
        assert_eq!((found.plus, found.minus, found.ranked), (96.0, 24.0, 15));
        assert!((found.p - 0.041_26).abs() < 5e-6, "{found:?}");
        assert!((found.rank_biserial - 0.6).abs() < 1e-15);
    }

    #[test]
    fn many_pairs_are_normal() {
        // 60 differences with ties and zeros, and the formula over another library's normal distribution.
        let differences: Vec<f64> = (0..70).map(|i| f64::from((i * 37 % 23) - 9)).collect();
        let found = signed_rank(&differences).unwrap();
        assert!(!found.exact && found.ranked < 70);
        let n = found.ranked as f64;
        let mut ties = 0.0;
        for size in 1..30 {
            let t = differences.iter().filter(|d| d.abs() == f64::from(size)).count() as f64;
            ties += t.powi(3) - t;
        }
        let deviation = (n * (n + 1.0) * (2.0 * n + 1.0) / 24.0 - ties / 48.0).sqrt();
        let z = ((found.plus - n * (n + 1.0) / 4.0).abs() - 0.5) / deviation;
        let expected = 2.0 * (1.0 - Normal::standard().cdf(z));
        assert!((found.p - expected).abs() < 1e-9, "{found:?} {expected}");
        // Where both can be had they agree: the largest that is counted.
        let fifty: Vec<f64> = (1..=50).map(|i| f64::from(i) * if i % 3 == 0 { -1.0 } else { 1.0 }).collect();
        let found = signed_rank(&fifty).unwrap();
        assert!(found.exact && (found.p - approximated(50, found.plus, 0.0)).abs() < 2e-3, "{found:?}");
    }

    #[test]
    fn nothing_that_differs_is_no_difference() {
        let found = signed_rank(&[0.0; 4]).unwrap();
        assert_eq!((found.p, found.rank_biserial, found.ranked), (1.0, 0.0, 0));
        assert!(signed_rank(&[f64::NAN]).is_none());
    }

    #[test]
    fn intervals_of_the_median_cover_as_the_binomial_says() {
        for n in [1_u32, 5, 6, 10, 25, 200] {
            let values: Vec<f64> = (1..=n).map(f64::from).collect();
            let found = median(&values, 0.95).unwrap();
            let binomial = Binomial::new(0.5, n.into()).unwrap();
            match found.interval {
                None => assert!(n < 6, "{n}"),
                Some([low, high]) => {
                    assert_eq!(low + high, f64::from(n) + 1.0);
                    let k = low as u64;
                    assert!(2.0 * binomial.cdf(k - 1) <= 0.05 && 2.0 * binomial.cdf(k) > 0.05, "{n}: {k}");
                }
            }
        }
        assert_eq!(median(&[3.0, 1.0, 2.0, 10.0], 0.95).unwrap().value, 2.5);
        assert!(median(&[], 0.95).is_none());
    }

    #[test]
    fn holm_is_that_of_its_definition() {
        // R: p.adjust(c(0.01, 0.04, 0.03, 0.005), "holm") = 0.03 0.06 0.06 0.02
        let found = holm(&[0.01, 0.04, 0.03, 0.005]);
        assert!(found.iter().zip([0.03, 0.06, 0.06, 0.02]).all(|(a, b)| (a - b).abs() < 1e-15), "{found:?}");
    }
}
