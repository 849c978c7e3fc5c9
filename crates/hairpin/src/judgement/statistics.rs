//! Statistics of measured values and of shares of cases.
//!
//! Exact where it can be: intervals of shares by the binomial itself and not by a normal approximation, which is wrong
//! at exactly the small counts that matter here. Special functions are made of `libm`'s, so that a verdict has the same
//! digits on every machine.

use crate::math::power::{power, square};

/// A distribution in evo's names and order.
///
/// n in the denominators, as evo has them: of the values at hand, not estimates for a population.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Statistics {
    /// Largest value.
    pub max: f64,
    /// Mean value.
    pub mean: f64,
    /// Middle value; the mean of the two middle ones of an even number.
    pub median: f64,
    /// Smallest value.
    pub min: f64,
    /// √(Σ x² / n).
    pub rmse: f64,
    /// Σ x².
    pub sse: f64,
    /// √(Σ (x − mean)² / n).
    pub std: f64,
}

impl Statistics {
    /// Of `values`, which must be finite; `None` without values or with one that is not finite.
    ///
    /// O(n log n), for the median's sake; sums over sorted values, so that their order does not change a digit.
    pub fn of(values: &[f64]) -> Option<Self> {
        if values.is_empty() || !values.iter().all(|x| x.is_finite()) {
            return None;
        }
        let mut sorted = values.to_vec();
        sorted.sort_unstable_by(f64::total_cmp);
        let (n, half) = (sorted.len() as f64, sorted.len() / 2);
        let mean = sorted.iter().sum::<f64>() / n;
        let median =
            if sorted.len().is_multiple_of(2) { 0.5 * (sorted[half - 1] + sorted[half]) } else { sorted[half] };
        let sse = sorted.iter().map(|x| x * x).sum::<f64>();
        let variance = sorted.iter().map(|x| square(x - mean)).sum::<f64>() / n;
        Some(Self {
            max: sorted[sorted.len() - 1],
            mean,
            median,
            min: sorted[0],
            rmse: (sse / n).sqrt(),
            sse,
            std: variance.sqrt(),
        })
    }
}

/// Fisher-Pearson skewness g₁ = m₃ / m₂^1.5 with central moments over n; `None` where all values are equal.
///
/// Positive: a long tail of large values.
pub fn skewness(values: &[f64]) -> Option<f64> {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let moment = |order| values.iter().map(|x| power(x - mean, order)).sum::<f64>() / n;
    let variance = moment(2);
    let skewness = moment(3) / (variance * variance.sqrt());
    // A variance that is only rounding has no direction.
    (variance > square(1e-12 * mean) && skewness.is_finite()).then_some(skewness)
}

/// Spearman's rank correlation ρ of paired values, −1 … 1: Pearson's correlation of their ranks, equal values sharing
/// the mean of theirs. `None` for fewer than three pairs, lists of unequal length, or where all values of one list are
/// equal: a constant ranks nothing. Spearman: The proof and measurement of association between two things, 1904.
///
/// What drives a violation is seldom linear: ranks ask only whether more of the one goes with more of the other. O(n
/// log n).
pub fn rank_correlation(x: &[f64], y: &[f64]) -> Option<f64> {
    if x.len() != y.len() || x.len() < 3 || x.iter().chain(y).any(|value| value.is_nan()) {
        return None;
    }
    let (x, y) = (centred_ranks(x), centred_ranks(y));
    let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let spread = product(&x, &x) * product(&y, &y);
    (spread > 0.0).then(|| (product(&x, &y) / spread.sqrt()).clamp(-1.0, 1.0))
}

/// Ranks less their mean, ties averaged.
fn centred_ranks(values: &[f64]) -> Vec<f64> {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|&a, &b| values[a].total_cmp(&values[b]));
    let mean = 0.5 * (values.len() as f64 - 1.0);
    let mut ranks = vec![0.0; values.len()];
    let mut below = 0;
    for equal in order.chunk_by(|&a, &b| values[a] == values[b]) {
        for &index in equal {
            ranks[index] = below as f64 + 0.5 * (equal.len() as f64 - 1.0) - mean;
        }
        below += equal.len();
    }
    ranks
}

/// An observed share with its exact interval, all 0 … 1.
///
/// For random cases only: of cases that were searched for their stress a share says nothing about the population, and
/// the verdict gives none.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Share {
    /// k / n.
    pub value: f64,
    /// Lower end of the interval.
    pub low: f64,
    /// Upper end of the interval.
    pub high: f64,
}

/// The share k / n with its two-sided Clopper-Pearson interval at `confidence` (0 < c < 1, such as 0.95).
///
/// With α = 1 − c: low is the α/2 quantile of Beta(k, n − k + 1) and 0 for k = 0; high is the 1 − α/2 quantile of
/// Beta(k + 1, n − k) and 1 for k = n. `None` for n = 0, k > n or a confidence outside (0, 1).
/// Clopper, Pearson: The use of confidence or fiducial limits illustrated in the case of the binomial, 1934.
///
/// Coverage is at least the confidence for every true share.
///
/// ```
/// use hairpin::judgement::{rule_of_three, share};
///
/// let found = share(3, 200, 0.95).expect("some cases");
/// assert!((found.low - 0.0031).abs() < 1e-4 && (found.high - 0.0432).abs() < 1e-4);
/// assert_eq!(rule_of_three(200), 0.015);
/// ```
pub fn share(k: usize, n: usize, confidence: f64) -> Option<Share> {
    if n == 0 || k > n || !(confidence > 0.0 && confidence < 1.0) {
        return None;
    }
    let tail = 0.5 * (1.0 - confidence);
    let (successes, failures) = (k as f64, (n - k) as f64);
    let low = if k == 0 { 0.0 } else { beta_quantile(successes, failures + 1.0, tail) };
    let high = if k == n { 1.0 } else { beta_quantile(successes + 1.0, failures, 1.0 - tail) };
    Some(Share { value: successes / n as f64, low, high })
}

/// The fewest cases of which, where none violates, the interval of the share lies below `limit`: what a spec that
/// allows so large a share needs at least. `None` for a limit outside (0, 1), or where it takes more than 10⁹.
///
/// With no violation in n cases the interval ends at 1 − (α/2)^(1/n), α = 1 − c: n ≥ ln(α/2)/ln(1 − p).
///
/// ```
/// use hairpin::judgement::{cases_needed, share};
///
/// let needed = cases_needed(0.01, 0.95).expect("a share");
/// assert_eq!(needed, 368);
/// assert!(share(0, needed, 0.95).is_some_and(|share| share.high <= 0.01));
/// assert!(share(0, needed - 1, 0.95).is_some_and(|share| share.high > 0.01));
/// ```
pub fn cases_needed(limit: f64, confidence: f64) -> Option<usize> {
    if !(limit > 0.0 && limit < 1.0 && confidence > 0.0 && confidence < 1.0) {
        return None;
    }
    let estimate = libm::log(0.5 * (1.0 - confidence)) / libm::log1p(-limit);
    if estimate > MOST_CASES {
        return None;
    }
    // The quotient is rounded, the interval decides.
    let decides = |n: usize| share(0, n, confidence).is_some_and(|share| share.high <= limit);
    let near = (estimate as usize).saturating_sub(1).max(1);
    (near..near + 4).find(|&n| decides(n))
}

/// P(B ≤ `k`) of a binomial B(`n`, ½), k < n: I_½(n − k, k + 1).
pub(super) fn binomial_share_half(n: usize, k: usize) -> f64 {
    beta_share((n - k) as f64, (k + 1) as f64, 0.5)
}

/// Upper bound of a share at 95 % when none of `n` violated: the rule of three, 3/n, at most 1.
///
/// (1 − p)ⁿ = 0.05 gives p ≈ 3/n: −ln 0.05 = 2.996. Hanley and Lippman-Hand, JAMA 249(13), 1983.
pub fn rule_of_three(n: usize) -> f64 {
    if n == 0 { 1.0 } else { (3.0 / n as f64).min(1.0) }
}

/// The t beyond which Student's distribution with `freedom` > 0 degrees lies, on both sides together, as often as a
/// normal one lies beyond `sigma` standard deviations: P(|T| > t) = erfc(σ/√2), and P(|T| > t) = I_x(ν/2, ½) with x =
/// ν/(ν + t²).
///
/// With 4 degrees of freedom 3 σ is t = 6.6: few runs know their own spread badly. Infinite where the tail is below
/// what doubles hold.
pub fn student_quantile(freedom: f64, sigma: f64) -> f64 {
    let x = beta_quantile(0.5 * freedom, 0.5, libm::erfc(sigma * std::f64::consts::FRAC_1_SQRT_2));
    if x > 0.0 { (freedom * (1.0 / x - 1.0)).max(0.0).sqrt() } else { f64::INFINITY }
}

/// The 95 % interval of the mean of what `values` are a sample of, by Student's t: x̄ ± t s/√n with
/// s² = Σ (x − x̄)²/(n − 1).
///
/// Exact for normal values; of a few dozen with a long tail to one side it covers a little less. `None` for fewer than
/// two values, or one that is not finite.
///
/// ```
/// use hairpin::judgement::mean_interval;
///
/// let [low, high] = mean_interval(&[4.0, 6.0]).expect("two values");
/// assert!((low - (5.0 - 12.7062)).abs() < 1e-3 && (high - (5.0 + 12.7062)).abs() < 1e-3);
/// ```
pub fn mean_interval(values: &[f64]) -> Option<[f64; 2]> {
    let Statistics { mean, std, .. } = Statistics::of(values)?;
    let freedom = values.len().checked_sub(1).filter(|freedom| *freedom > 0)?;
    let half = student_quantile(freedom as f64, SIGMA_95) * std / (freedom as f64).sqrt();
    Some([mean - half, mean + half])
}

/// The x with I_x(a, b) = `probability`, by bisection to the last bit: the library's own quantile (AS 109) starts
/// from a guess clamped to 0.0001, too large for one case in a hundred thousand.
fn beta_quantile(a: f64, b: f64, probability: f64) -> f64 {
    let (mut low, mut high) = (0.0, 1.0);
    loop {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            return middle;
        }
        if beta_share(a, b, middle) < probability { low = middle } else { high = middle }
    }
}

/// The regularised incomplete beta function I_x(a, b), 0 < x < 1, by its continued fraction 8.17.22 of NIST's Digital
/// Library of Mathematical Functions, evaluated from the front (Lentz: Applied Optics 15, 1976).
pub(super) fn beta_share(a: f64, b: f64, x: f64) -> f64 {
    // Beyond the mean the fraction of the complement converges faster.
    if x > (a + 1.0) / (a + b + 2.0) {
        return 1.0 - beta_share(b, a, 1.0 - x);
    }
    let beta = libm::lgamma(a) + libm::lgamma(b) - libm::lgamma(a + b);
    let front = libm::exp(a * libm::log(x) + b * libm::log1p(-x) - beta) / a;
    let (mut fraction, mut above, mut below) = (1.0, 1.0, 0.0);
    for i in 1..MOST_TERMS {
        let m = f64::from(i / 2);
        let term = if i % 2 == 0 {
            m * (b - m) * x / ((a + 2.0 * m - 1.0) * (a + 2.0 * m))
        } else {
            -(a + m) * (a + b + m) * x / ((a + 2.0 * m) * (a + 2.0 * m + 1.0))
        };
        above = 1.0 + term / above;
        below = 1.0 / (1.0 + term * below);
        fraction *= above * below;
        if (above * below - 1.0).abs() < 1e-15 {
            break;
        }
    }
    front / fraction
}

/// Standard deviations around the mean of a normal distribution that hold 95 %.
pub const SIGMA_95: f64 = 1.959_963_984_540_054;
/// Terms of the fraction; about the root of the larger argument are needed, 10 000 for a hundred million cases.
const MOST_TERMS: u32 = 100_000;
/// Beyond these nobody counts cases.
const MOST_CASES: f64 = 1e9;

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;

    #[test]
    fn student_is_that_of_tables() {
        // Two-sided 95 %: σ = 1.959964.
        for (freedom, t) in [(1.0, 12.7062), (4.0, 2.776_445), (10.0, 2.228_139), (1000.0, 1.962_339)] {
            let found = student_quantile(freedom, 1.959_963_985);
            assert!((found - t).abs() < 1e-4 * t, "{freedom}: {found}");
        }
        assert!((student_quantile(4.0, 3.0) - 6.6201).abs() < 1e-3);
        assert_eq!(student_quantile(4.0, 0.0), 0.0);
    }

    #[test]
    fn means_have_students_interval() {
        // scipy.stats.t.interval(0.95, 4, loc=3, scale=sqrt(2.5/5)) = (1.036757, 4.963243)
        let [low, high] = mean_interval(&[1.0, 2.0, 3.0, 4.0, 5.0]).unwrap();
        assert!((low - 1.036_757).abs() < 1e-6 && (high - 4.963_243).abs() < 1e-6, "{low} {high}");
        assert_eq!(mean_interval(&[2.0, 2.0, 2.0]), Some([2.0, 2.0]));
        assert!(mean_interval(&[1.0]).is_none() && mean_interval(&[1.0, f64::NAN]).is_none());
    }

    #[test]
    fn known_statistics() {
        let s = Statistics::of(&[3.0, 1.0, 2.0, 6.0]).unwrap();
        let expected = [6.0, 3.0, 2.5, 1.0, 12.5f64.sqrt(), 50.0, 3.5f64.sqrt()];
        let found = [s.max, s.mean, s.median, s.min, s.rmse, s.sse, s.std];
        assert!(found.iter().zip(expected).all(|(f, e)| (f - e).abs() < 1e-12), "{found:?}");
        assert!(Statistics::of(&[]).is_none() && Statistics::of(&[f64::NAN]).is_none());
        // scipy.stats.skew([1, 2, 3, 10]) = 1.0182…: m2 = 12.5, m3 = 45
        assert!((skewness(&[1.0, 2.0, 3.0, 10.0]).unwrap() - 45.0 / 12.5f64.powf(1.5)).abs() < 1e-12);
        assert_eq!(skewness(&[0.1; 7]), None);
        assert_eq!(skewness(&[]), None);
    }

    #[test]
    fn published_intervals() {
        // Newcombe: Two-sided confidence intervals for the single proportion, Statistics in Medicine 17, 1998, table I,
        // method 5 (Clopper-Pearson).
        for (k, n, low, high) in [(81, 263, 0.2527, 0.3676), (15, 148, 0.0578, 0.1617), (1, 29, 0.0009, 0.1776)] {
            let found = share(k, n, 0.95).unwrap();
            assert!((found.low - low).abs() < 6e-5 && (found.high - high).abs() < 6e-5, "{k}/{n}: {found:?}");
        }
        let none = share(0, 200, 0.95).unwrap();
        assert_eq!(none.low, 0.0);
        assert!((none.high - (1.0 - 0.025f64.powf(1.0 / 200.0))).abs() < 1e-12);
        let all = share(20, 20, 0.99).unwrap();
        assert!((all.low - 0.005f64.powf(1.0 / 20.0)).abs() < 1e-12 && all.high == 1.0);
        let rare = share(1, 1_000_000, 0.95).unwrap();
        // Low end: 1 − (1 − low)^n = 0.025.
        assert!((rare.low - 2.531_78e-8).abs() < 1e-12, "{rare:?}");
        assert!(share(1, 0, 0.95).is_none() && share(3, 2, 0.95).is_none() && share(1, 2, 1.0).is_none());
    }

    #[test]
    fn intervals_cover_as_the_binomial_says() {
        // At the upper end, k or fewer have probability α/2, summed term by term.
        for (k, n) in [(3usize, 200usize), (7, 30), (0, 5)] {
            let p = share(k, n, 0.9).unwrap().high;
            let mut term = (1.0 - p).powi(n as i32);
            let mut sum = term;
            for i in 0..k {
                term *= (n - i) as f64 / (i + 1) as f64 * p / (1.0 - p);
                sum += term;
            }
            assert!((sum - 0.05).abs() < 1e-10, "{k}/{n}: {sum}");
        }
    }

    #[test]
    fn the_beta_function_is_that_of_another_library() {
        for (a, b) in [(1.0, 1.0), (1.0, 200.0), (8.0, 14.0), (81.0, 183.0), (3000.0, 2.0), (4000.0, 5000.0)] {
            for i in 1..200 {
                let x = f64::from(i) / 200.0;
                let (found, expected) = (beta_share(a, b, x), statrs::function::beta::beta_reg(a, b, x));
                assert!((found - expected).abs() < 1e-10, "I_{x}({a}, {b}) = {found}, not {expected}");
            }
        }
    }

    #[test]
    fn published_rank_correlations() {
        // Wikipedia, Spearman's rank correlation coefficient: IQ and hours of television of ten people, −29/165.
        let iq = [106.0, 100.0, 86.0, 101.0, 99.0, 103.0, 97.0, 113.0, 112.0, 110.0];
        let hours = [7.0, 27.0, 2.0, 50.0, 28.0, 29.0, 20.0, 12.0, 6.0, 17.0];
        assert!((rank_correlation(&iq, &hours).unwrap() + 29.0 / 165.0).abs() < 1e-15);
        // With ties: scipy's documentation of spearmanr.
        let ties = rank_correlation(&[1.0, 2.0, 3.0, 4.0, 5.0], &[5.0, 6.0, 7.0, 8.0, 7.0]).unwrap();
        assert!((ties - 0.820_782_681_668_123_3).abs() < 1e-15, "{ties}");
        // Only the order counts.
        let cubes = iq.map(|x| -x * x * x);
        assert_eq!(rank_correlation(&iq, &cubes), Some(-1.0));
        assert_eq!(rank_correlation(&iq, &iq), Some(1.0));
        assert_eq!(rank_correlation(&[1.0; 5], &[1.0, 2.0, 3.0, 4.0, 5.0]), None);
        assert_eq!(rank_correlation(&[1.0, 2.0], &[1.0, 2.0]), None);
        assert_eq!(rank_correlation(&[1.0, f64::NAN, 2.0], &[1.0, 2.0, 3.0]), None);
    }

    #[test]
    fn three_over_n() {
        assert_eq!(rule_of_three(200), 0.015);
        assert_eq!(rule_of_three(2), 1.0);
        assert_eq!(rule_of_three(0), 1.0);
    }
}
