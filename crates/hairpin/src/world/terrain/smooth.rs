//! Heights over holes: the membrane that spans them from their rims.
//!
//! ∇²h = 0 inside a hole, h as measured on its rim: by the maximum principle no filled height is beyond the rim's, so
//! that a hole never becomes a peak. What is filled is counted and can be asked for, since no wheel was ever there.

/// Sweeps of the relaxation on each level; more change the fill by less than the sensor's noise.
const SWEEPS: usize = 60;

/// Replaces every NaN of `cells` by the solution of Laplace's equation with the known cells as boundary.
///
/// Coarse to fine: holes are averaged into grids of half the size until none is left, and each level starts the
/// Gauss-Seidel relaxation of the next finer one. At least one cell must be known.
///
/// h at a hole's cell is the mean of its four neighbours', of fewer at the map's border, where no flux crosses. Linear
/// in the cells, and in sweeps times holes; in place. Not iterated until nothing changes.
pub(super) fn fill(cells: &mut [f32], columns: usize, rows: usize) {
    let holes: Vec<usize> = (0..cells.len()).filter(|&i| cells[i].is_nan()).collect();
    if holes.is_empty() {
        return;
    }
    let (coarse_columns, coarse_rows) = (columns.div_ceil(2), rows.div_ceil(2));
    let mut coarse = vec![f32::NAN; coarse_columns * coarse_rows];
    for row in 0..coarse_rows {
        for column in 0..coarse_columns {
            let (mut sum, mut count) = (0.0, 0.0);
            for fine_row in (2 * row)..(2 * row + 2).min(rows) {
                for fine_column in (2 * column)..(2 * column + 2).min(columns) {
                    let h = cells[fine_row * columns + fine_column];
                    if !h.is_nan() {
                        sum += h;
                        count += 1.0;
                    }
                }
            }
            if count > 0.0 {
                coarse[row * coarse_columns + column] = sum / count;
            }
        }
    }
    fill(&mut coarse, coarse_columns, coarse_rows);
    for &hole in &holes {
        cells[hole] = coarse[hole / columns / 2 * coarse_columns + hole % columns / 2];
    }
    for _ in 0..SWEEPS {
        for &hole in &holes {
            let (row, column) = (hole / columns, hole % columns);
            let (mut sum, mut count) = (0.0, 0.0);
            let mut take = |i: usize| {
                sum += cells[i];
                count += 1.0;
            };
            if row > 0 {
                take(hole - columns);
            }
            if row + 1 < rows {
                take(hole + columns);
            }
            if column > 0 {
                take(hole - 1);
            }
            if column + 1 < columns {
                take(hole + 1);
            }
            cells[hole] = sum / count;
        }
    }
}
