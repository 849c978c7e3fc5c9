//! The Cholesky factor of a large matrix: what a fit waits for.
//!
//! ```text
//! L_ij = (A_ij − Σ_{k<j} L_ik L_jk)/L_jj,   L_jj = √(A_jj − Σ_{k<j} L_jk²)        column by column, k in order
//! ```
//!
//! The products are taken off [`BLOCK`] columns at a time, as many of them together: a number of an earlier column is
//! read once for all that it is taken off. Sums keep their order, so that the factor is the textbook's to the bit, at
//! every level of SIMD.

use nalgebra::{Cholesky, DMatrix, Dyn};

use crate::math::simd::{Simd, kernel};

/// Columns that are taken off others at a time, and how many others at once.
const BLOCK: usize = 4;

kernel! {
    /// Adds each of `sources`, times its number in `by`, to each of `targets`, one source after the other.
    ///
    /// `by[target][source]`; all columns have as many rows as the first target.
    fn add_columns(targets: [&mut [f64]; BLOCK], sources: [&[f64]; BLOCK], by: &[[f64; BLOCK]; BLOCK]) {
        let [a, b, c, d] = targets;
        let rows = a.len();
        let (b, c, d) = (&mut b[..rows], &mut c[..rows], &mut d[..rows]);
        let sources = sources.map(|source| &source[..rows]);
        for i in 0..rows {
            let mut sums = [a[i], b[i], c[i], d[i]];
            // By index: an iterator's own functions are calls in here where the build is for tests.
            for target in 0..BLOCK {
                for source in 0..BLOCK {
                    sums[target] += sources[source][i] * by[target][source];
                }
            }
            [a[i], b[i], c[i], d[i]] = sums;
        }
    }
}

/// `L` of `A = L Lᵀ`, O(rows³/3); `None` where `A` is not positive definite.
///
/// Of `matrix` the lower triangle is read.
pub(super) fn factor(simd: Simd, matrix: DMatrix<f64>) -> Option<Cholesky<f64, Dyn>> {
    let size = matrix.nrows();
    let padded = size.next_multiple_of(BLOCK);
    // Rows that are none are the identity's, and change nothing.
    let mut matrix = matrix.resize(padded, padded, 0.0);
    (size..padded).for_each(|j| matrix[(j, j)] = 1.0);
    for first in (0..padded).step_by(BLOCK) {
        let (known, block) = matrix.as_mut_slice().split_at_mut(first * padded);
        take_off(simd, known, &mut block[..BLOCK * padded], first);
        for j in first..first + BLOCK {
            finish(&mut matrix, j, first)?;
        }
    }
    Some(Cholesky::pack_dirty(matrix.resize(size, size, 0.0)))
}

/// Takes the columns of `known` off those of `block`, which begin at row and column `first`.
fn take_off(simd: Simd, known: &[f64], block: &mut [f64], first: usize) {
    let rows = block.len() / BLOCK;
    for sources in known.chunks_exact(BLOCK * rows) {
        let sources: [&[f64]; BLOCK] = std::array::from_fn(|k| &sources[k * rows + first..(k + 1) * rows]);
        let by = std::array::from_fn(|target| sources.map(|source| -source[target]));
        let (ab, cd) = block.split_at_mut(2 * rows);
        let ((a, b), (c, d)) = (ab.split_at_mut(rows), cd.split_at_mut(rows));
        add_columns(simd, [a, b, c, d].map(|column| &mut column[first..]), sources, &by);
    }
}

/// Takes the columns from `first` on off the column `j`, and divides it by its pivot, which has to be positive.
fn finish(matrix: &mut DMatrix<f64>, j: usize, first: usize) -> Option<()> {
    for k in first..j {
        let by = -matrix[(j, k)];
        let (mut column, known) = matrix.columns_range_pair_mut(j, k);
        column.rows_range_mut(j..).axpy(by, &known.rows_range(j..), 1.0);
    }
    let pivot = Some(matrix[(j, j)]).filter(|square| *square > 0.0).map(libm::sqrt)?;
    matrix[(j, j)] = pivot;
    matrix.view_range_mut(j + 1.., j).apply(|below| *below /= pivot);
    Some(())
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;
    use crate::math::random::{stream, unit};

    /// `Mᵀ M + I/100` of a random `M`.
    fn positive(size: usize, seed: u64) -> DMatrix<f64> {
        let mut random = stream(seed);
        let any = DMatrix::from_fn(size, size, |_, _| 2.0 * unit(&mut random) - 1.0);
        any.transpose() * &any + DMatrix::identity(size, size) * 0.01
    }

    /// Nalgebra's takes one column off at a time.
    #[test]
    fn the_factor_is_that_of_the_textbook_to_the_bit_at_every_level_of_simd() {
        for size in [0, 1, 2, 3, 4, 5, 7, 8, 31, 64, 101] {
            let matrix = positive(size, size as u64);
            let expected = matrix.clone().cholesky().unwrap().unpack();
            for simd in [Simd::Widest, Simd::Portable] {
                assert_eq!(factor(simd, matrix.clone()).unwrap().unpack(), expected, "{size} {simd:?}");
            }
            // What is above the diagonal is not read.
            let lower = factor(Simd::Widest, matrix.lower_triangle()).unwrap();
            assert_eq!(lower.unpack(), expected);
            assert!((&expected * expected.transpose() - matrix).amax() <= 1e-12 * size as f64);
        }
    }

    #[test]
    fn what_is_not_positive_definite_has_none() {
        for (place, value) in [(0, 0.0), (3, -1.0), (6, f64::NAN)] {
            let mut matrix = positive(7, 1);
            matrix[(place, place)] = value;
            assert!(factor(Simd::Widest, matrix.clone()).is_none() && matrix.cholesky().is_none(), "{place}");
        }
    }
}
