//! Small dense systems of equations.

/// Solves `matrix` · x = `right` in place by elimination with partial pivoting; `false` where the matrix is singular to
/// rounding.
pub(super) fn solve<const N: usize>(matrix: &mut [[f64; N]; N], right: &mut [f64; N]) -> bool {
    let largest = matrix.iter().flatten().fold(0.0, |most: f64, value| most.max(value.abs()));
    for column in 0..N {
        let mut pivot = column;
        for row in column + 1..N {
            if matrix[row][column].abs() > matrix[pivot][column].abs() {
                pivot = row;
            }
        }
        matrix.swap(column, pivot);
        right.swap(column, pivot);
        let lead = matrix[column][column];
        if lead.is_nan() || lead.abs() <= 1e-18 * largest {
            return false;
        }
        let (above, below) = matrix.split_at_mut(column + 1);
        let pivot_row = &above[column];
        for (offset, row) in below.iter_mut().enumerate() {
            let factor = row[column] / lead;
            if factor == 0.0 {
                continue;
            }
            for (value, lead) in row[column..].iter_mut().zip(&pivot_row[column..]) {
                *value -= factor * lead;
            }
            right[column + 1 + offset] -= factor * right[column];
        }
    }
    for row in (0..N).rev() {
        let known: f64 = (row + 1..N).map(|k| matrix[row][k] * right[k]).sum();
        right[row] = (right[row] - known) / matrix[row][row];
    }
    right.iter().all(|value| value.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::random::hashed_unit;

    #[test]
    fn solutions_solve_and_singular_systems_are_told() {
        for seed in 0..50 {
            let matrix: [[f64; 6]; 6] =
                std::array::from_fn(|i| std::array::from_fn(|j| hashed_unit(seed, &[i as u64, j as u64]) - 0.5));
            let x: [f64; 6] = std::array::from_fn(|i| hashed_unit(seed, &[9, i as u64]));
            let mut right = matrix.map(|row| row.iter().zip(&x).map(|(a, x)| a * x).sum());
            assert!(solve(&mut matrix.clone(), &mut right), "seed {seed}");
            assert!(right.iter().zip(&x).all(|(found, x)| (found - x).abs() < 1e-9), "seed {seed}");
            let mut twice = matrix;
            twice[4] = twice[2];
            assert!(!solve(&mut twice, &mut [1.0, 0.0, 0.0, 0.0, 2.0, 0.0]), "seed {seed}");
        }
    }
}
