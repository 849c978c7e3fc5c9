//! Sums over rows, and the normal equations that they make.

use nalgebra::{DMatrix, DVector};

/// Sums over rows that a fit needs.
#[derive(Clone)]
pub(super) struct Sums {
    count: f64,
    products: DMatrix<f64>,
    monomials: DVector<f64>,
    with_value: DVector<f64>,
    value: f64,
}

impl Sums {
    pub(super) fn new(monomials: usize) -> Self {
        Self {
            count: 0.0,
            products: DMatrix::zeros(monomials, monomials),
            monomials: DVector::zeros(monomials),
            with_value: DVector::zeros(monomials),
            value: 0.0,
        }
    }

    pub(super) fn add(&mut self, monomials: &[f64], value: f64) {
        self.count += 1.0;
        self.value += value;
        for (j, &b) in monomials.iter().enumerate() {
            self.monomials[j] += b;
            self.with_value[j] += b * value;
            // One triangle; the other follows when it is solved.
            for (i, &a) in monomials.iter().enumerate().skip(j) {
                self.products[(i, j)] += a * b;
            }
        }
    }

    pub(super) fn include(&mut self, other: &Sums) {
        self.count += other.count;
        self.products += &other.products;
        self.monomials += &other.monomials;
        self.with_value += &other.with_value;
        self.value += other.value;
    }

    pub(super) fn without(&self, other: &Sums) -> Self {
        Self {
            count: self.count - other.count,
            products: &self.products - &other.products,
            monomials: &self.monomials - &other.monomials,
            with_value: &self.with_value - &other.with_value,
            value: self.value - other.value,
        }
    }

    /// Weights of plain monomials, and the intercept. Monomials are standardised on the way, so that one penalty fits all.
    pub(super) fn solve(&self, penalty: f64) -> (Vec<f64>, f64) {
        let n = self.count;
        let mean = &self.monomials / n;
        let value = self.value / n;
        let size = mean.len();
        let variance = |j: usize| self.products[(j, j)] / n - mean[j] * mean[j];
        // A monomial that does not differ gets no weight.
        let inverse: Vec<f64> =
            (0..size).map(|j| if variance(j) > 1e-12 { 1.0 / libm::sqrt(variance(j)) } else { 0.0 }).collect();
        let mut matrix = DMatrix::zeros(size, size);
        let mut right = DVector::zeros(size);
        for j in 0..size {
            right[j] = (self.with_value[j] / n - mean[j] * value) * inverse[j];
            for i in j..size {
                let covariance = (self.products[(i, j)] / n - mean[i] * mean[j]) * inverse[i] * inverse[j];
                matrix[(i, j)] = covariance;
                matrix[(j, i)] = covariance;
            }
            matrix[(j, j)] += penalty;
        }
        // Positive definite but for rounding: the penalty is ten thousand times larger than that.
        let scaled = matrix.cholesky().map_or_else(|| DVector::zeros(size), |factor| factor.solve(&right));
        let weights: Vec<f64> = (0..size).map(|j| scaled[j] * inverse[j]).collect();
        let intercept = value - weights.iter().zip(mean.iter()).map(|(weight, mean)| weight * mean).sum::<f64>();
        (weights, intercept)
    }
}
