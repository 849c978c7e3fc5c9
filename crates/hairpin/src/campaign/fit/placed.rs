//! What a wrong place at the begin of a stretch explains of its residuals, taken out of them.
//!
//! ```text
//! r = y − f(θ, x₀)      S = ∂f/∂x₀      r' = r − S δ,   δ = argmin Σ w (r − S δ)²       x₀ = (x, y, ψ) of the stretch
//! ```
//!
//! A place that comes from a log is off by the log's noise, and who steers answers to that as no vehicle did: latency
//! and lags would be read from answers to noise, which are as large as the noise that they are read from (errors in
//! variables). With δ out of the residuals that is of second order (variable projection: Golub and Pereyra 1973).

use nalgebra::{DMatrix, DVector};

/// Residuals `r` of one stretch less what of them the columns `by` explain, each of them as `r` is: rows of samples,
/// an entry for each output; outputs weigh as `weights` says. As they are where there are no more of them than columns.
pub(super) fn without(r: &[Vec<f64>], by: &[&[Vec<f64>]], weights: &[f64]) -> Vec<Vec<f64>> {
    let entries = r.len() * weights.len();
    if entries <= by.len() {
        return r.to_vec();
    }
    let weighed = |rows: &[Vec<f64>]| -> Vec<f64> {
        rows.iter().flat_map(|row| row.iter().zip(weights).map(|(value, weight)| value * weight)).collect()
    };
    let columns: Vec<f64> = by.iter().flat_map(|rows| weighed(rows)).collect();
    let slopes = DMatrix::from_vec(entries, by.len(), columns);
    let normal = slopes.tr_mul(&slopes).cholesky();
    let Some(delta) = normal.map(|normal| normal.solve(&slopes.tr_mul(&DVector::from_vec(weighed(r))))) else {
        return r.to_vec();
    };
    let explained = |sample: usize, output: usize| -> f64 {
        by.iter().zip(&delta).map(|(rows, delta)| rows[sample][output] * delta).sum()
    };
    let left = |(sample, row): (usize, &Vec<f64>)| {
        row.iter().enumerate().map(|(output, value)| value - explained(sample, output)).collect()
    };
    r.iter().enumerate().map(left).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Six samples of two outputs, in the second of which errors are ten times as large.
    fn rows(of: impl Fn(f64) -> [f64; 2]) -> Vec<Vec<f64>> {
        (0..6).map(|i| of(f64::from(i)).to_vec()).collect()
    }

    const WEIGHTS: [f64; 2] = [1.0, 0.1];

    #[test]
    fn what_a_place_explains_is_taken_out_and_nothing_else() {
        let (shift, turn) = (rows(|_| [1.0, 0.0]), rows(|t| [0.3 * t, 1.0]));
        let by = [&shift[..], &turn];
        let wrong = rows(|t| [0.02 + 0.3 * t * -0.04, -0.04]);
        assert!(without(&wrong, &by, &WEIGHTS).iter().flatten().all(|left| left.abs() < 1e-15));
        // What is left of anything has no more of either, weighed; and is left as it is.
        let left = without(&rows(|t| [(3.0 * t).sin(), t * t]), &by, &WEIGHTS);
        for slopes in by {
            let products = left.iter().zip(slopes).flat_map(|(r, s)| (0..2).map(|o| r[o] * s[o] * WEIGHTS[o].powi(2)));
            assert!(products.sum::<f64>().abs() < 1e-13);
        }
        let again = without(&left, &by, &WEIGHTS);
        assert!(left.iter().flatten().zip(again.iter().flatten()).all(|(a, b)| (a - b).abs() < 1e-13));
        assert!(left.iter().flatten().map(|left| left * left).sum::<f64>() > 1.0);
    }

    #[test]
    fn what_nothing_can_be_told_of_stays() {
        let r = rows(|t| [t, 1.0]);
        let (one, none) = (rows(|_| [1.0, 0.0]), rows(|_| [0.0, 0.0]));
        assert_eq!(without(&r, &[&one, &none], &WEIGHTS), r, "a place without effect");
        assert_eq!(without(&r[..1], &[&one[..1], &none[..1]], &WEIGHTS), r[..1], "as many unknowns as numbers");
    }
}
