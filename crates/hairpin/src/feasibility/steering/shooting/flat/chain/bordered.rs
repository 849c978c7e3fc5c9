//! Symmetric positive definite systems that are tridiagonal but for a full last row: neighbours meet in knots, and
//! everything depends on the length.
//!
//! ```text
//! H = ⎡ T  b ⎤    T tridiagonal (15 × 15), b the border, d the last diagonal element
//!     ⎣ bᵀ d ⎦
//! ```
//!
//! Solved in O(n) where a dense factorisation takes O(n³).

use super::PIECES;

/// Unknowns but the last.
const INNER: usize = PIECES - 1;

/// The matrix.
#[derive(Debug, Clone, Copy)]
pub(super) struct Bordered {
    /// Diagonal, the last unknown's included.
    pub(super) diagonal: [f64; PIECES],
    /// Elements (i, i + 1) of the inner part.
    pub(super) beside: [f64; PIECES],
    /// Last row but for its diagonal element.
    pub(super) border: [f64; PIECES],
}

/// H = LDLᵀ, with no fill beyond the matrix's own pattern.
#[derive(Debug, Clone, Copy)]
pub(super) struct Factor {
    /// Reciprocals of D.
    inverse: [f64; PIECES],
    /// L's elements beside the diagonal.
    beside: [f64; PIECES],
    /// L's last row.
    border: [f64; PIECES],
}

impl Bordered {
    /// The factorisation; pivots that rounding makes negative are lifted.
    ///
    /// O(pieces), without an allocation.
    ///
    /// The last pivot is kept above 10⁻¹⁴ of its diagonal element: where the length is all but determined by the knots,
    /// steps of it stay finite.
    #[inline(always)]
    pub(super) fn factor(&self) -> Factor {
        let mut factor = Factor { inverse: [0.0; PIECES], beside: [0.0; PIECES], border: [0.0; PIECES] };
        let (mut carried, mut carried_border) = (0.0, 0.0);
        let mut corner = self.diagonal[INNER];
        for i in 0..INNER {
            let inverse = 1.0 / (self.diagonal[i] - carried).max(1e-300);
            let border = self.border[i] - carried_border;
            factor.inverse[i] = inverse;
            factor.border[i] = border * inverse;
            corner -= border * factor.border[i];
            let beside = if i + 1 < INNER { self.beside[i] } else { 0.0 };
            factor.beside[i] = beside * inverse;
            carried = beside * factor.beside[i];
            carried_border = border * factor.beside[i];
        }
        factor.inverse[INNER] = 1.0 / corner.max(1e-14 * self.diagonal[INNER]).max(1e-300);
        factor
    }
}

impl Factor {
    /// x of Hx = `right`, for `M` right sides at once: row i holds all of their components i.
    ///
    /// Forward and backward substitution, right sides side by side so that lanes are used.
    #[inline(always)]
    pub(super) fn solve<const M: usize>(&self, right: &[[f64; M]; PIECES]) -> [[f64; M]; PIECES] {
        let mut x = *right;
        let mut above = [0.0; M];
        let mut last = x[INNER];
        for (i, row) in x.iter_mut().enumerate().take(INNER) {
            let beside = if i > 0 { self.beside[i - 1] } else { 0.0 };
            for m in 0..M {
                above[m] = row[m] - beside * above[m];
                last[m] -= self.border[i] * above[m];
                row[m] = above[m] * self.inverse[i];
            }
        }
        last = last.map(|value| value * self.inverse[INNER]);
        x[INNER] = last;
        let mut below = [0.0; M];
        for (i, row) in x.iter_mut().enumerate().take(INNER).rev() {
            for m in 0..M {
                below[m] = row[m] - self.border[i] * last[m] - self.beside[i] * below[m];
            }
            *row = below;
        }
        x
    }
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;
    use crate::math::random::hashed_unit;
    use nalgebra::{SMatrix, SVector};

    #[test]
    fn agrees_with_a_dense_solver() {
        for seed in 0..50 {
            let random = |k: usize, i: usize| hashed_unit(seed, &[k as u64, i as u64]) - 0.5;
            let matrix = Bordered {
                diagonal: std::array::from_fn(|i| if i == INNER { 8.0 } else { 2.5 + random(0, i) }),
                beside: std::array::from_fn(|i| random(1, i)),
                border: std::array::from_fn(|i| random(2, i)),
            };
            let mut dense = SMatrix::<f64, PIECES, PIECES>::from_diagonal(&SVector::from(matrix.diagonal));
            for i in 0..INNER {
                dense[(i, INNER)] = matrix.border[i];
                dense[(INNER, i)] = matrix.border[i];
                if i + 1 < INNER {
                    dense[(i, i + 1)] = matrix.beside[i];
                    dense[(i + 1, i)] = matrix.beside[i];
                }
            }
            let right: [[f64; 2]; PIECES] = std::array::from_fn(|i| [random(3, i), random(4, i)]);
            let found = matrix.factor().solve(&right);
            for side in 0..2 {
                let expected = dense.lu().solve(&SVector::from(right.map(|row| row[side]))).expect("a regular matrix");
                assert!((SVector::from(found.map(|row| row[side])) - expected).amax() < 1e-12, "seed {seed}");
            }
        }
    }
}
