//! Statistics of measured values and of shares of cases.

use statrs::function::beta::beta_reg;

/// A distribution in evo's names and order.
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
        let variance = sorted.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / n;
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
pub fn skewness(values: &[f64]) -> Option<f64> {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let moment = |power| values.iter().map(|x| (x - mean).powi(power)).sum::<f64>() / n;
    let variance = moment(2);
    let skewness = moment(3) / variance.powf(1.5);
    // A variance that is only rounding has no direction.
    (variance > (1e-12 * mean).powi(2) && skewness.is_finite()).then_some(skewness)
}

/// An observed share with its exact interval, all 0 … 1.
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

/// Upper bound of a share at 95 % when none of `n` violated: the rule of three, 3/n, at most 1.
pub fn rule_of_three(n: usize) -> f64 {
    if n == 0 { 1.0 } else { (3.0 / n as f64).min(1.0) }
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
        if beta_reg(a, b, middle) < probability { low = middle } else { high = middle }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
    fn three_over_n() {
        assert_eq!(rule_of_three(200), 0.015);
        assert_eq!(rule_of_three(2), 1.0);
        assert_eq!(rule_of_three(0), 1.0);
    }
}
