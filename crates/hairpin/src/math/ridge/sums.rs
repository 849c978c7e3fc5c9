//! Sums over rows, and the normal equations that they make.
//!
//! ```text
//! n,  Σ m,  Σ m mᵀ,  Σ m y,  Σ y                     over rows; sums of parts add up, and are taken off again
//! cov_ij = (Σ m_i m_j/n − m̄_i m̄_j)/(σ_i σ_j),   σ² = Σ m²/n − m̄²
//! (cov + λ I) w̃ = (Σ m_j y/n − m̄_j ȳ)/σ_j,   w_j = w̃_j/σ_j,   b = ȳ − Σ w_j m̄_j
//! ```
//!
//! Means are taken off at the end, not row by row: inputs are standardised and clamped, so that moments are of the
//! order of 1 and little is lost.

use nalgebra::{DMatrix, DVector};

use super::factor::factor;
use crate::math::simd::{Simd, kernel};

/// Rows whose products are added at a time: a column is read and written once for all of them.
const BLOCK: usize = 4;

kernel! {
    /// Adds each of `rows` to `sums`, times its first number, one row after the other.
    fn add_multiples(sums: &mut [f64], rows: [&[f64]; BLOCK]) {
        let first = rows.map(|row| row[0]);
        let rows = rows.map(|row| &row[..sums.len()]);
        for (i, sum) in sums.iter_mut().enumerate() {
            for row in 0..BLOCK {
                *sum += rows[row][i] * first[row];
            }
        }
    }
}

/// Sums over rows that a fit needs.
///
/// Memory: monomials² numbers, of which the lower triangle is kept.
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

    /// Sums over rows; `write` puts the monomials of one into the buffer given and gives its value.
    ///
    /// One pass, O(rows · monomials²/2). Sums are those of the rows one after the other, at every level of SIMD to the
    /// bit.
    pub(super) fn over<R>(
        monomials: usize,
        rows: impl Iterator<Item = R>,
        write: impl Fn(R, &mut [[f64; 1]]) -> f64,
    ) -> Self {
        let mut sums = Self::new(monomials);
        let mut block = vec![vec![0.0; monomials]; BLOCK];
        let mut filled = 0;
        for row in rows {
            let value = write(row, block[filled].as_chunks_mut().0);
            sums.count += 1.0;
            sums.value += value;
            for (j, &monomial) in block[filled].iter().enumerate() {
                sums.monomials[j] += monomial;
                sums.with_value[j] += monomial * value;
            }
            filled += 1;
            if filled == BLOCK {
                sums.add_products(&block);
                filled = 0;
            }
        }
        block[filled..].iter_mut().for_each(|row| row.fill(0.0));
        if filled > 0 {
            sums.add_products(&block);
        }
        sums
    }

    /// The lower triangle.
    fn add_products(&mut self, block: &[Vec<f64>]) {
        let size = self.monomials.len();
        for (j, column) in self.products.as_mut_slice().chunks_exact_mut(size.max(1)).enumerate() {
            add_multiples(Simd::Widest, &mut column[j..], std::array::from_fn(|row| &block[row][j..]));
        }
    }

    /// Both of the same monomials.
    pub(super) fn include(&mut self, other: &Sums) {
        self.count += other.count;
        self.products += &other.products;
        self.monomials += &other.monomials;
        self.with_value += &other.with_value;
        self.value += other.value;
    }

    /// Rounding of the whole sum stays behind, some 1e-16 of it.
    pub(super) fn without(&self, other: &Sums) -> Self {
        Self {
            count: self.count - other.count,
            products: &self.products - &other.products,
            monomials: &self.monomials - &other.monomials,
            with_value: &self.with_value - &other.with_value,
            value: self.value - other.value,
        }
    }

    /// Weights of plain monomials, and the intercept. Monomials are standardised on the way, so that one penalty fits
    /// all.
    ///
    /// O(monomials³/3), Cholesky. A variance of at most 1e-12 counts as none. Where the factorisation fails all weights
    /// are 0 and the answer is the mean. `penalty` > 0.
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
                matrix[(i, j)] = (self.products[(i, j)] / n - mean[i] * mean[j]) * inverse[i] * inverse[j];
            }
            matrix[(j, j)] += penalty;
        }
        // Positive definite but for rounding: the penalty is ten thousand times larger than that.
        let scaled = factor(Simd::Widest, matrix).map_or_else(|| DVector::zeros(size), |factor| factor.solve(&right));
        let weights: Vec<f64> = (0..size).map(|j| scaled[j] * inverse[j]).collect();
        let intercept = value - weights.iter().zip(mean.iter()).map(|(weight, mean)| weight * mean).sum::<f64>();
        (weights, intercept)
    }
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;
    use crate::math::random::{stream, unit};

    #[test]
    fn sums_are_those_of_the_rows_one_after_the_other_at_every_simd_level() {
        let mut random = stream(3);
        for (rows, monomials) in [(1, 1), (4, 7), (30, 13), (43, 1)] {
            let all: Vec<Vec<f64>> =
                (0..rows).map(|_| (0..monomials).map(|_| 2.0 * unit(&mut random) - 1.0).collect()).collect();
            let sums = Sums::over(monomials, all.iter(), |row, out| {
                out.as_flattened_mut().copy_from_slice(row);
                row[0]
            });
            for (i, j) in (0..monomials).flat_map(|j| (j..monomials).map(move |i| (i, j))) {
                let expected = all.iter().fold(0.0, |sum, row| sum + row[i] * row[j]);
                assert_eq!(sums.products[(i, j)].to_bits(), expected.to_bits(), "{rows} rows, {i}, {j}");
            }
            assert_eq!((sums.count, sums.value), (rows as f64, all.iter().map(|row| row[0]).sum()));
        }
        let rows: [Vec<f64>; BLOCK] = std::array::from_fn(|_| (0..29).map(|_| unit(&mut random)).collect());
        let told = [Simd::Widest, Simd::Portable].map(|simd| {
            let mut sums = vec![0.5; 29];
            add_multiples(simd, &mut sums, std::array::from_fn(|row| rows[row].as_slice()));
            sums
        });
        assert_eq!(told[0], told[1]);
    }
}
