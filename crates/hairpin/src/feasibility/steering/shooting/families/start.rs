//! Start values: curvatures of drives that are known to be near, brought into a family by least squares.

use super::basis::{MOST, Row};
use super::grid::Grid;
use crate::math::linear::solve;

/// The parameters whose curvature is nearest to that of the curve: min ∫(Σ pᵢBᵢ − κ)² dσ, κ at the ends counting twice
/// as much.
///
/// Normal equations with a ridge of 10⁻⁹; parameters beyond the family's count are 0.
///
/// `ends` are κ at the start and at the end, `None` where it is free. All 0 where the system cannot be solved. O(nodes
/// · parameters²).
pub(super) fn nearest(grid: &Grid, curvature: &dyn Fn(f64) -> f64, ends: [Option<f64>; 2]) -> Row {
    // The equations, their right-hand sides in the last column.
    let mut rows = [[0.0; MOST + 1]; MOST];
    let mut add = |row: &Row, weight: f64, wanted: f64| {
        for i in 0..MOST {
            rows[i][MOST] += weight * row[i] * wanted;
            for j in 0..MOST {
                rows[i][j] += weight * row[i] * row[j];
            }
        }
    };
    for node in grid.nodes() {
        add(&node.value, node.weight, curvature(node.share));
    }
    for (end, wanted) in grid.ends.iter().zip(ends) {
        if let Some(wanted) = wanted {
            add(&end.value, 2.0, wanted);
        }
    }
    for (i, row) in rows.iter_mut().enumerate() {
        row[i] += if i < grid.count { 1e-9 } else { 1.0 };
    }
    solve(&mut rows).unwrap_or([0.0; MOST])
}

/// Curvature that is constant on three pieces, `signs` over `pieces` metres, 1/m, and bends at most by `most`.
///
/// `share` in 0 … 1 of the whole length; 1/m.
///
/// `signs` are +1, 0, −1; a share beyond 1 stays on the last piece.
pub(super) fn word(signs: [f64; 3], pieces: [f64; 3], most: f64, share: f64) -> f64 {
    let mut left = share * pieces.iter().sum::<f64>();
    for (sign, piece) in signs.iter().zip(pieces) {
        if left <= piece {
            return sign * most;
        }
        left -= piece;
    }
    signs[2] * most
}
