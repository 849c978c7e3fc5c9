//! Small dense systems of equations on the stack: Gauss's elimination with partial pivoting.
//!
//! One choice of pivots, two ends. [`reduce`] clears the rows above as well (Gauss-Jordan): many right-hand sides of
//! three or four unknowns, for every look of every step of every drive. [`solve`] clears below and substitutes back, a
//! third fewer operations for one right-hand side of many unknowns.

/// Solves A X = B in place for the augmented rows [A | B], `N` rows of `W` = N + number of right-hand sides; X is in
/// the last columns afterwards. False if A is singular: a pivot of 1e-12 at most.
///
/// O(N² W) operations. The bound of pivots is absolute: rows must be of the order of 1. Where it is false the rows are
/// left as far as they were reduced.
pub fn reduce<const N: usize, const W: usize>(rows: &mut [[f64; W]; N]) -> bool {
    for pivot in 0..N {
        let lead = *choose(rows, pivot);
        if lead[pivot].is_nan() || lead[pivot].abs() <= 1e-12 {
            return false;
        }
        let inverse = 1.0 / lead[pivot];
        for (row, line) in rows.iter_mut().enumerate() {
            if row != pivot {
                let factor = line[pivot] * inverse;
                subtract(line, factor, &lead);
            }
        }
        for value in &mut rows[pivot] {
            *value *= inverse;
        }
    }
    true
}

/// The solution of A x = b of the augmented rows [A | b], `N` rows of `W` = N + 1; `None` where A is singular to
/// rounding, a pivot being 1e-18 of its largest component at most, or the solution is not finite.
///
/// N³/3 operations for the elimination. The bound is relative to the matrix, so that scaled systems are told alike; NaN
/// in A or b is `None`. The rows are overwritten.
pub fn solve<const N: usize, const W: usize>(rows: &mut [[f64; W]; N]) -> Option<[f64; N]> {
    const { assert!(W == N + 1, "one right-hand side") };
    let largest = rows.iter().flat_map(|row| &row[..N]).fold(0.0, |most: f64, value| most.max(value.abs()));
    for pivot in 0..N {
        let lead = *choose(rows, pivot);
        if lead[pivot].is_nan() || lead[pivot].abs() <= 1e-18 * largest {
            return None;
        }
        for line in &mut rows[pivot + 1..] {
            let factor = line[pivot] / lead[pivot];
            if factor != 0.0 {
                subtract(line, factor, &lead);
            }
        }
    }
    let mut x = [0.0; N];
    for row in (0..N).rev() {
        let known: f64 = (row + 1..N).map(|k| rows[row][k] * x[k]).sum();
        x[row] = (rows[row][N] - known) / rows[row][row];
    }
    x.iter().all(|value| value.is_finite()).then_some(x)
}

/// Puts the row with the largest component in column `pivot`, of those from there on, in its place.
///
/// O(N): one column. Of equals the first; a NaN there is not chosen unless it is at the pivot already.
fn choose<const N: usize, const W: usize>(rows: &mut [[f64; W]; N], pivot: usize) -> &[f64; W] {
    let mut best = pivot;
    for row in pivot + 1..N {
        if rows[row][pivot].abs() > rows[best][pivot].abs() {
            best = row;
        }
    }
    rows.swap(pivot, best);
    &rows[pivot]
}

/// Whole rows: what lies before the pivot is not looked at again, and equal lengths fill the lanes.
fn subtract<const W: usize>(line: &mut [f64; W], factor: f64, lead: &[f64; W]) {
    for (value, from) in line.iter_mut().zip(lead) {
        *value -= factor * from;
    }
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;
    use crate::math::random::hashed_unit;

    #[test]
    fn solutions_solve_and_singular_systems_are_told() {
        for seed in 0..50 {
            let matrix: [[f64; 6]; 6] =
                std::array::from_fn(|i| std::array::from_fn(|j| hashed_unit(seed, &[i as u64, j as u64]) - 0.5));
            let x: [f64; 6] = std::array::from_fn(|i| hashed_unit(seed, &[9, i as u64]));
            let augmented = |matrix: &[[f64; 6]; 6], right: &[f64; 6]| -> [[f64; 7]; 6] {
                std::array::from_fn(|i| std::array::from_fn(|j| if j < 6 { matrix[i][j] } else { right[i] }))
            };
            let right = matrix.map(|row| row.iter().zip(&x).map(|(a, x)| a * x).sum());
            let found = solve(&mut augmented(&matrix, &right)).unwrap_or_else(|| panic!("seed {seed}"));
            assert!(found.iter().zip(&x).all(|(found, x)| (found - x).abs() < 1e-9), "seed {seed}");
            let mut reduced = augmented(&matrix, &right);
            assert!(reduce(&mut reduced), "seed {seed}");
            assert!(reduced.iter().zip(&x).all(|(row, x)| (row[6] - x).abs() < 1e-9), "seed {seed}");
            let mut twice = matrix;
            twice[4] = twice[2];
            let mut singular = augmented(&twice, &[1.0, 0.0, 0.0, 0.0, 2.0, 0.0]);
            assert!(solve(&mut singular.clone()).is_none() && !reduce(&mut singular), "seed {seed}");
        }
    }
}
