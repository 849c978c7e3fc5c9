//! An elevation map: heights at cell centres, Catmull-Rom between them, so that slopes are continuous.
//!
//! Along one axis, with t in [0, 1] between the samples h₀ and h₁,
//! h(t) = ½ [2h₀ + (h₁ − h₋₁) t + (2h₋₁ − 5h₀ + 4h₁ − h₂) t² + (3h₀ − 3h₁ + h₂ − h₋₁) t³];
//! both axes in turn. Source: Catmull & Rom 1974, the cubic convolution of Keys 1981 with a = −½.
//!
//! The surface passes through every cell's height, is C¹, and depends on 4 × 4 cells. Heights are kept as f32, one in
//! four bytes, and computed with as f64. The ring around the map continues the outermost slope, so that all of the
//! extent between outermost cell *centres* is ground; the half cell outside them is not.

use thiserror::Error;

use super::{NoGround, Patch, Terrain, smooth};

/// Where the cells of a map lie.
///
/// x east, y north. Cells need not be square. GeoTIFF's corner of a cell is half a cell off [`Grid::first_center`]; the
/// doors convert.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Grid {
    /// Cells along x.
    pub columns: usize,
    /// Cells along y.
    pub rows: usize,
    /// Centre of the cell with least x and y, m.
    pub first_center: [f64; 2],
    /// Edge lengths of a cell along x and y, m.
    pub cell: [f64; 2],
}

/// What to do with cells without data.
///
/// `Fill` by the membrane over the hole's rim; `KeepOut` leaves NaN, which a look whose 4 × 4 cells touch it answers
/// with [`NoGround::Hole`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum HoleRule {
    /// A map with holes is refused.
    #[default]
    Error,
    /// Nothing may touch them.
    KeepOut,
    /// Heights are interpolated over them, and counted.
    Fill,
}

/// Why cells make no map.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum MapError {
    /// A number of the grid is out of bounds.
    #[error("{field} = {value}: must be {bound}")]
    Grid {
        /// The number's name.
        field: &'static str,
        /// Its value.
        value: String,
        /// What it must be.
        bound: &'static str,
    },
    /// Another number of heights than cells.
    #[error("{heights} heights for {rows} rows of {columns} cells")]
    Count {
        /// Heights given.
        heights: usize,
        /// Rows of the grid.
        rows: usize,
        /// Columns of the grid.
        columns: usize,
    },
    /// Cells without data where none may be.
    #[error(
        "{count} cells without data, the first in row {row}, column {column} (rows from the north, both from 0): no_data = \"keep-out\" or \"fill\" accepts them (`steer`: --no-data)"
    )]
    Holes {
        /// How many.
        count: usize,
        /// Row of the first, from the north.
        row: usize,
        /// Its column.
        column: usize,
    },
    /// No cell has data.
    #[error("no cell of the map has data")]
    Empty,
}

/// Heights on a grid; immutable once built.
///
/// ```
/// use hairpin::world::terrain::{ElevationMap, Grid, HoleRule, Terrain};
///
/// // 4 × 4 cells of 1 m, rising to the east; rows come from the north, as rasters have them.
/// let grid = Grid { columns: 4, rows: 4, first_center: [0.5, 0.5], cell: [1.0, 1.0] };
/// let heights: Vec<f32> = (0..16).map(|cell| (cell % 4) as f32).collect();
/// let map = ElevationMap::new(grid, &heights, HoleRule::Error)?;
/// let patch = map.patch(2.0, 2.0)?;
/// assert!((patch.height - 1.5).abs() < 1e-12 && (patch.slope[0] - 1.0).abs() < 1e-12);
/// assert!(map.patch(0.2, 2.0).is_err()); // outside the outermost cell centres
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct ElevationMap {
    grid: Grid,
    /// 1/m.
    per_cell: [f64; 2],
    /// Rows from the south, with one ring of extrapolated cells around them; holes are NaN.
    heights: Vec<f32>,
    /// Columns with the ring.
    stride: usize,
    /// Cells whose height was filled in, rows from the south, without the ring; empty if there are none.
    filled: Vec<bool>,
    holes: usize,
}

impl ElevationMap {
    /// A map of `heights` (m, rows from the north as rasters have them; NaN where there is no data).
    ///
    /// Memory is 4 bytes for each cell, and one for each where holes are filled. Linear in the cells.
    ///
    /// # Errors
    /// Grids of fewer than two cells a side, cells that are not positive, another number of heights, infinite
    /// heights, holes where `rule` refuses them.
    pub fn new(grid: Grid, heights: &[f32], rule: HoleRule) -> Result<Self, MapError> {
        check(&grid, heights.len())?;
        let (columns, rows) = (grid.columns, grid.rows);
        let holes = heights.iter().filter(|h| !h.is_finite()).count();
        if holes == heights.len() {
            return Err(MapError::Empty);
        }
        let from_south = heights.chunks_exact(columns).rev();
        let (mut filled, mut padded) = (Vec::new(), None);
        if holes > 0 {
            match rule {
                HoleRule::Error => {
                    let first = heights.iter().position(|h| !h.is_finite()).unwrap_or(0);
                    return Err(MapError::Holes { count: holes, row: first / columns, column: first % columns });
                }
                HoleRule::KeepOut => {}
                HoleRule::Fill => {
                    let mut cells: Vec<f32> = from_south.clone().flatten().map(|h| or_none(*h)).collect();
                    filled = cells.iter().map(|h| h.is_nan()).collect();
                    smooth::fill(&mut cells, columns, rows);
                    padded = Some(pad(cells.chunks_exact(columns), columns, rows));
                }
            }
        }
        // Maps may be large: what needs no room of its own is read where it is.
        let (padded, stride) = padded.unwrap_or_else(|| pad(from_south, columns, rows));
        let per_cell = [1.0 / grid.cell[0], 1.0 / grid.cell[1]];
        Ok(Self { grid, per_cell, heights: padded, stride, filled, holes })
    }

    /// Where the cells lie.
    pub fn grid(&self) -> &Grid {
        &self.grid
    }

    /// Cells that came without data.
    pub fn holes(&self) -> usize {
        self.holes
    }

    /// Least and largest x and y at which the ground is known, m: the outermost cell centres.
    pub fn extent(&self) -> ([f64; 2], [f64; 2]) {
        let Grid { columns, rows, first_center: low, cell } = self.grid;
        (low, [low[0] + (columns - 1) as f64 * cell[0], low[1] + (rows - 1) as f64 * cell[1]])
    }

    /// Distance (m) of a place from the nearest one at which the ground is not known, below 0 there: beyond the extent
    /// or around a hole. Exact up to `within` m, and never less than that beyond.
    ///
    /// A missing cell takes the height from all within two cells of it, in each axis: that box counts.
    pub fn edge_distance(&self, place: [f64; 2], within: f64) -> f64 {
        let (low, high) = self.extent();
        let edge = |axis: usize| (place[axis] - low[axis]).min(high[axis] - place[axis]);
        let least = edge(0).min(edge(1));
        if self.holes == 0 || !self.filled.is_empty() {
            return least;
        }
        let Grid { columns, rows, first_center, cell } = self.grid;
        let near = |axis: usize, cells: usize| {
            let (at, reach) = ((place[axis] - first_center[axis]) / cell[axis], within / cell[axis] + 2.0);
            ((at - reach).floor().max(0.0) as usize)..=((at + reach).ceil().max(0.0) as usize).min(cells - 1)
        };
        let away = |axis: usize, index: usize| {
            (place[axis] - first_center[axis] - index as f64 * cell[axis]).abs() - 2.0 * cell[axis]
        };
        // Holes farther than that are not looked for: what is told of them must not jump where they come near.
        let mut least = least.min(within);
        for row in near(1, rows) {
            for column in near(0, columns).filter(|column| self.cell_height(row, *column).is_nan()) {
                let (x, y) = (away(0, column), away(1, row));
                least = least.min(libm::hypot(x.max(0.0), y.max(0.0)) + x.max(y).min(0.0));
            }
        }
        least
    }

    /// Whether the ground rises or falls by more than `slope` (m per m, along x or y) between two neighbouring cells.
    ///
    /// Cells without data have no neighbours. Linear in the cells.
    pub fn is_steeper_than(&self, slope: f64) -> bool {
        let Grid { columns, rows, cell: [east, north], .. } = self.grid;
        let height = |row: usize, column: usize| f64::from(self.heights[(row + 1) * self.stride + column + 1]);
        (0..rows).any(|row| {
            (0..columns).any(|column| {
                let here = height(row, column);
                let rises = |there: f64, over: f64| (there - here).abs() > slope * over;
                (column + 1 < columns && rises(height(row, column + 1), east))
                    || (row + 1 < rows && rises(height(row + 1, column), north))
            })
        })
    }

    /// Height of the cell in `row` from the south and `column`, m; NaN in a hole.
    ///
    /// # Panics
    /// If there is no such cell.
    pub fn cell_height(&self, row: usize, column: usize) -> f32 {
        assert!(row < self.grid.rows && column < self.grid.columns, "cell ({row}, {column}) is not on the map");
        self.heights[(row + 1) * self.stride + column + 1]
    }

    /// Whether the height at (`x`, `y`) rests on a cell that was filled in.
    ///
    /// Asks the 4 × 4 cells that the height depends on.
    pub fn is_filled(&self, x: f64, y: f64) -> bool {
        if self.filled.is_empty() {
            return false;
        }
        let Some(at) = self.locate(x, y) else { return false };
        let near = |i: usize, most: usize| i.saturating_sub(1)..=(i + 2).min(most - 1);
        near(at.row, self.grid.rows)
            .any(|row| near(at.column, self.grid.columns).any(|column| self.filled[row * self.grid.columns + column]))
    }

    /// The same map with what `raise` makes of its cells' heights, rows from the south; holes are NaN and stay so.
    pub(super) fn raised(&self, raise: impl FnOnce(&mut [f32])) -> Self {
        let Grid { columns, rows, .. } = self.grid;
        let mut cells = Vec::with_capacity(columns * rows);
        for row in 1..=rows {
            cells.extend_from_slice(&self.heights[row * self.stride + 1..][..columns]);
        }
        raise(&mut cells);
        let (heights, _) = pad(cells.chunks_exact(columns), columns, rows);
        Self { heights, ..self.clone() }
    }

    /// Row `j` of the 4 × 4 heights that those at `at` depend on.
    #[inline(always)]
    fn cells(&self, at: &Located, j: usize) -> [f64; 4] {
        let from = (at.row + j) * self.stride + at.column;
        let cells = &self.heights[from..from + 4];
        [f64::from(cells[0]), f64::from(cells[1]), f64::from(cells[2]), f64::from(cells[3])]
    }

    /// `None` outside the outermost cell centres, and of NaN.
    #[inline]
    fn locate(&self, x: f64, y: f64) -> Option<Located> {
        let u = (x - self.grid.first_center[0]) * self.per_cell[0];
        let v = (y - self.grid.first_center[1]) * self.per_cell[1];
        let (last_u, last_v) = ((self.grid.columns - 1) as f64, (self.grid.rows - 1) as f64);
        // Written so that NaN is outside.
        if !(u >= 0.0 && u <= last_u && v >= 0.0 && v <= last_v) {
            return None;
        }
        let column = (u as usize).min(self.grid.columns - 2);
        let row = (v as usize).min(self.grid.rows - 2);
        Some(Located { row, column, u: u - column as f64, v: v - row as f64 })
    }
}

/// What is no height is none.
fn or_none(height: f32) -> f32 {
    if height.is_finite() { height } else { f32::NAN }
}

struct Located {
    /// South-west cell of the four around the point.
    row: usize,
    column: usize,
    /// How far from its centre towards the next, in cells.
    u: f64,
    v: f64,
}

/// Weights of four neighbouring samples for the value and its first two derivatives at `t` in [0, 1].
///
/// Rows: value, by t, by t twice; each has the sums 1, 0, 0, and lines are met exactly. Derivatives are by cells, not
/// by metres.
#[inline(always)]
fn weights(t: f64) -> [[f64; 4]; 3] {
    let (t2, t3) = (t * t, t * t * t);
    [
        [
            0.5 * (-t + 2.0 * t2 - t3),
            0.5 * (2.0 - 5.0 * t2 + 3.0 * t3),
            0.5 * (t + 4.0 * t2 - 3.0 * t3),
            0.5 * (t3 - t2),
        ],
        [
            0.5 * (-1.0 + 4.0 * t - 3.0 * t2),
            0.5 * (-10.0 * t + 9.0 * t2),
            0.5 * (1.0 + 8.0 * t - 9.0 * t2),
            0.5 * (3.0 * t2 - 2.0 * t),
        ],
        [2.0 - 3.0 * t, -5.0 + 9.0 * t, 4.0 - 9.0 * t, 3.0 * t - 1.0],
    ]
}

#[inline(always)]
fn dot(a: &[f64; 4], b: &[f64; 4]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3]
}

impl Terrain for ElevationMap {
    /// Cubic convolution of the 4 × 4 cells around (Keys 1981), along x, then along y: height (m), slope (1), bend
    /// (1/m) as (∂xx, ∂xy, ∂yy). One missing cell among the sixteen makes a hole.
    #[inline]
    fn patch(&self, x: f64, y: f64) -> Result<Patch, NoGround> {
        let Some(at) = self.locate(x, y) else { return Err(NoGround::OffMap { x, y }) };
        let (along_x, along_y) = (weights(at.u), weights(at.v));
        // Value, slope and bend along x of each of the four rows.
        let mut rows = [[0.0; 4]; 3];
        for j in 0..4 {
            let h = self.cells(&at, j);
            for (row, weight) in rows.iter_mut().zip(&along_x) {
                row[j] = dot(weight, &h);
            }
        }
        let height = dot(&along_y[0], &rows[0]);
        if height.is_nan() {
            return Err(NoGround::Hole { x, y });
        }
        let [px, py] = self.per_cell;
        Ok(Patch {
            height,
            slope: [px * dot(&along_y[0], &rows[1]), py * dot(&along_y[1], &rows[0])],
            bend: [
                px * px * dot(&along_y[0], &rows[2]),
                px * py * dot(&along_y[1], &rows[1]),
                py * py * dot(&along_y[2], &rows[0]),
            ],
        })
    }

    #[inline]
    fn tangent(&self, x: f64, y: f64) -> Result<(f64, [f64; 2]), NoGround> {
        let Some(at) = self.locate(x, y) else { return Err(NoGround::OffMap { x, y }) };
        let ([value_x, slope_x, _], [value_y, slope_y, _]) = (weights(at.u), weights(at.v));
        let (mut values, mut slopes) = ([0.0; 4], [0.0; 4]);
        for j in 0..4 {
            let h = self.cells(&at, j);
            (values[j], slopes[j]) = (dot(&value_x, &h), dot(&slope_x, &h));
        }
        let height = dot(&value_y, &values);
        if height.is_nan() {
            return Err(NoGround::Hole { x, y });
        }
        let [px, py] = self.per_cell;
        Ok((height, [px * dot(&value_y, &slopes), py * dot(&slope_y, &values)]))
    }

    #[inline]
    fn height(&self, x: f64, y: f64) -> Result<f64, NoGround> {
        let Some(at) = self.locate(x, y) else { return Err(NoGround::OffMap { x, y }) };
        let ([along_x, ..], [along_y, ..]) = (weights(at.u), weights(at.v));
        let row = |j: usize| dot(&along_x, &self.cells(&at, j));
        let height = dot(&along_y, &[row(0), row(1), row(2), row(3)]);
        if height.is_nan() { Err(NoGround::Hole { x, y }) } else { Ok(height) }
    }
}

fn check(grid: &Grid, heights: usize) -> Result<(), MapError> {
    let wrong = |field, value: String, bound| Err(MapError::Grid { field, value, bound });
    for (field, cells) in [("columns", grid.columns), ("rows", grid.rows)] {
        if cells < 2 {
            return wrong(field, cells.to_string(), "≥ 2");
        }
    }
    for (field, edge) in [("cell width", grid.cell[0]), ("cell height", grid.cell[1])] {
        if !(edge.is_finite() && edge > 0.0) {
            return wrong(field, edge.to_string(), "finite and > 0 m");
        }
    }
    for (field, at) in [("origin x", grid.first_center[0]), ("origin y", grid.first_center[1])] {
        if !at.is_finite() {
            return wrong(field, at.to_string(), "finite");
        }
    }
    if grid.rows.checked_mul(grid.columns) != Some(heights) {
        return Err(MapError::Count { heights, rows: grid.rows, columns: grid.columns });
    }
    Ok(())
}

/// The cells of `lines`, rows from the south, with a ring around them, continued linearly: the slope at the border is
/// that of the outermost cells.
///
/// Corners are continued along both axes in turn.
fn pad<'a>(lines: impl Iterator<Item = &'a [f32]>, columns: usize, rows: usize) -> (Vec<f32>, usize) {
    let stride = columns + 2;
    let mut padded = vec![0.0; stride * (rows + 2)];
    for (padded, line) in padded.chunks_exact_mut(stride).skip(1).zip(lines) {
        padded[1..=columns].iter_mut().zip(line).for_each(|(cell, height)| *cell = or_none(*height));
        padded[0] = 2.0 * padded[1] - padded[2];
        padded[columns + 1] = 2.0 * padded[columns] - padded[columns - 1];
    }
    for column in 0..stride {
        let at = |row: usize| row * stride + column;
        padded[at(0)] = 2.0 * padded[at(1)] - padded[at(2)];
        padded[at(rows + 1)] = 2.0 * padded[at(rows)] - padded[at(rows - 1)];
    }
    // A ring next to a hole has no height of its own to go on; it repeats its neighbour unless that is one too.
    for row in 0..rows + 2 {
        for column in [0, stride - 1] {
            let inner = if column == 0 { 1 } else { stride - 2 };
            if padded[row * stride + column].is_nan() {
                padded[row * stride + column] = padded[row * stride + inner];
            }
        }
    }
    for column in 0..stride {
        for (row, inner) in [(0, 1), (rows + 1, rows)] {
            if padded[row * stride + column].is_nan() {
                padded[row * stride + column] = padded[inner * stride + column];
            }
        }
    }
    (padded, stride)
}
