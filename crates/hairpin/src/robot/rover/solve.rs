//! A small dense linear solve with several right-hand sides, on the stack.
//!
//! Gauss-Jordan with partial pivoting. Sizes are constants (3 × 7, 4 × 8), and nothing is allocated: it runs for every
//! look of every step of every drive.

/// Solves A X = B in place for the augmented rows [A | B], `N` rows of `W` = N + number of right-hand sides; X is in
/// the last columns afterwards. False if A is singular to working precision.
pub(super) fn eliminate<const N: usize, const W: usize>(rows: &mut [[f64; W]; N]) -> bool {
    for pivot in 0..N {
        let mut best = pivot;
        for row in pivot + 1..N {
            if rows[row][pivot].abs() > rows[best][pivot].abs() {
                best = row;
            }
        }
        rows.swap(pivot, best);
        let lead = rows[pivot];
        if lead[pivot].is_nan() || lead[pivot].abs() <= 1e-12 {
            return false;
        }
        let inverse = 1.0 / lead[pivot];
        for (row, line) in rows.iter_mut().enumerate() {
            if row == pivot {
                continue;
            }
            let factor = line[pivot] * inverse;
            // Whole rows: what lies before the pivot is not looked at again, and equal lengths fill the lanes.
            for (value, from) in line.iter_mut().zip(&lead) {
                *value -= factor * from;
            }
        }
        for value in &mut rows[pivot] {
            *value *= inverse;
        }
    }
    true
}
