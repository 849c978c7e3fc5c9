//! What of a map has no ground, as places to keep out of: boxes that cover a hole closely.
//!
//! Between four cells the height takes 4 × 4 of them: one that is missing leaves the sixteen squares around it without
//! ground. What is covered are those squares, so that a place outside of all boxes has ground as far as its hole goes.

use std::collections::{BTreeSet, VecDeque};

use super::{ElevationMap, KeepOutShape};

/// Squares of a hole that are covered at most: what is farther from the place that was met is met anew.
const SQUARES: usize = 10_000;
/// Boxes of one hole at most …
const BOXES: usize = 12;
/// … and as few as leave no more than this share of what they cover to ground.
const WASTE: f64 = 0.25;

/// Column and row of the square between four cells, from the south-west.
type Square = [usize; 2];

impl ElevationMap {
    /// Boxes over the connected squares without ground around `place` (m), for places to keep out of; none where there
    /// is ground.
    ///
    /// Connected over edges and corners; of those the 10⁴ that are fewest squares away. At most 12 boxes, one split at
    /// a time where that leaves least ground below them, until three quarters of them are without ground.
    pub fn hole(&self, place: [f64; 2]) -> Vec<KeepOutShape> {
        let grid = self.grid();
        let last = [grid.columns - 2, grid.rows - 2];
        let at = [0, 1].map(|axis| {
            let cells = (place[axis] - grid.first_center[axis]) / grid.cell[axis];
            (cells.max(0.0) as usize).min(last[axis])
        });
        // By its rounding a place between two squares may be taken for either's.
        let seeds = around(at, last).filter(|square| self.is_missing(*square));
        let squares = self.connected(seeds.collect(), last);
        let corner = |axis: usize, index: usize| grid.first_center[axis] + index as f64 * grid.cell[axis];
        let boxed = |part: &Part| {
            let [west, south] = [0, 1].map(|axis| corner(axis, part.low[axis]));
            let [east, north] = [0, 1].map(|axis| corner(axis, part.high[axis] + 1));
            KeepOutShape::Polygon { points_m: vec![[west, south], [east, south], [east, north], [west, north]] }
        };
        covered(squares).iter().map(boxed).collect()
    }

    /// Whether the height in a square takes a cell that is missing.
    fn is_missing(&self, [column, row]: Square) -> bool {
        let near = |i: usize, cells: usize| i.saturating_sub(1)..=(i + 2).min(cells - 1);
        let (columns, rows) = (self.grid().columns, self.grid().rows);
        near(row, rows).any(|row| near(column, columns).any(|column| self.cell_height(row, column).is_nan()))
    }

    /// What is connected to `seeds`, those first that are the fewest squares away.
    fn connected(&self, seeds: Vec<Square>, last: Square) -> Vec<Square> {
        let mut seen: BTreeSet<Square> = seeds.iter().copied().collect();
        let mut open = VecDeque::from(seeds);
        let mut squares = Vec::new();
        while let Some(square) = open.pop_front().filter(|_| squares.len() < SQUARES) {
            squares.push(square);
            for next in around(square, last) {
                if !seen.contains(&next) && self.is_missing(next) {
                    seen.insert(next);
                    open.push_back(next);
                }
            }
        }
        squares
    }
}

/// A square and those that it touches, up to `last`.
fn around([column, row]: Square, last: Square) -> impl Iterator<Item = Square> {
    let near = move |i: usize, axis: usize| i.saturating_sub(1)..=(i + 1).min(last[axis]);
    near(row, 1).flat_map(move |row| near(column, 0).map(move |column| [column, row]))
}

/// Squares and the box around them, both ends included.
struct Part {
    squares: Vec<Square>,
    low: Square,
    high: Square,
}

impl Part {
    /// `None` of no squares.
    fn new(squares: Vec<Square>) -> Option<Self> {
        let first = *squares.first()?;
        let (mut low, mut high) = (first, first);
        for square in &squares {
            for axis in 0..2 {
                (low[axis], high[axis]) = (low[axis].min(square[axis]), high[axis].max(square[axis]));
            }
        }
        Some(Self { squares, low, high })
    }

    fn area(&self) -> usize {
        (self.high[0] - self.low[0] + 1) * (self.high[1] - self.low[1] + 1)
    }

    /// Squares of the box that have ground.
    fn waste(&self) -> usize {
        self.area() - self.squares.len()
    }

    /// The axis and the last index before the cut after which the boxes of both sides are smallest.
    fn cut(&self) -> Option<(usize, usize)> {
        let mut best: Option<(usize, (usize, usize))> = None;
        for axis in 0..2 {
            // Across the axis each line reaches from … to.
            let across = 1 - axis;
            let mut lines = vec![None; self.high[axis] - self.low[axis] + 1];
            for square in &self.squares {
                let line: &mut Option<[usize; 2]> = &mut lines[square[axis] - self.low[axis]];
                *line = joined(*line, Some([square[across]; 2]));
            }
            let mut behind = Vec::with_capacity(lines.len());
            for line in lines.iter().rev() {
                behind.push(joined(behind.last().copied().flatten(), *line));
            }
            let mut before = None;
            for (i, line) in lines.iter().enumerate().take(lines.len() - 1) {
                before = joined(before, *line);
                let wide = |reach: Option<[usize; 2]>| reach.map_or(0, |[from, to]| to - from + 1);
                let rest = lines.len() - 1 - i;
                let area = wide(before) * (i + 1) + wide(behind[rest - 1]) * rest;
                if best.is_none_or(|(least, _)| area < least) {
                    best = Some((area, (axis, self.low[axis] + i)));
                }
            }
        }
        best.map(|(_, cut)| cut)
    }
}

/// What reaches over both.
fn joined(a: Option<[usize; 2]>, b: Option<[usize; 2]>) -> Option<[usize; 2]> {
    let (Some(a), Some(b)) = (a, b) else { return a.or(b) };
    Some([a[0].min(b[0]), a[1].max(b[1])])
}

/// `squares` in few boxes; together they hold all of them.
fn covered(squares: Vec<Square>) -> Vec<Part> {
    let total = squares.len() as f64;
    let mut parts: Vec<Part> = Part::new(squares).into_iter().collect();
    while parts.len() < BOXES && parts.iter().map(Part::waste).sum::<usize>() as f64 > WASTE * total {
        let Some(most) = (0..parts.len()).max_by_key(|i| parts[*i].waste()) else { break };
        let Some((axis, last)) = parts[most].cut() else { break };
        let part = parts.swap_remove(most);
        let (before, behind) = part.squares.into_iter().partition(|square| square[axis] <= last);
        parts.extend([before, behind].into_iter().filter_map(Part::new));
    }
    parts
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;
    use crate::world::terrain::{Grid, HoleRule, KeepOut, KeepOuts, Terrain};

    /// 60 × 50 cells of 0.2 m × 0.1 m without data where `missing` says so of a cell's column and row from the south.
    fn map(missing: impl Fn(usize, usize) -> bool) -> ElevationMap {
        let grid = Grid { columns: 60, rows: 50, first_center: [-3.0, 2.0], cell: [0.2, 0.1] };
        let height = |i: usize| if missing(i % 60, 49 - i / 60) { f32::NAN } else { 0.5 };
        let heights: Vec<f32> = (0..3000).map(height).collect();
        ElevationMap::new(grid, &heights, HoleRule::KeepOut).expect("a map")
    }

    fn places(shapes: Vec<KeepOutShape>) -> KeepOuts {
        let place = |shape| KeepOut { name: "hole".into(), shape };
        KeepOuts::new(shapes.into_iter().map(place).collect()).expect("places")
    }

    /// Places without ground outside of `boxes`, and with ground inside, of many over the map.
    fn beside(map: &ElevationMap, boxes: &KeepOuts) -> (usize, usize) {
        let (mut missed, mut wasted) = (0, 0);
        for i in 0..590_u32 {
            for k in 0..490_u32 {
                let (x, y) = (-2.99 + 0.02 * f64::from(i), 2.005 + 0.01 * f64::from(k));
                let (inside, ground) = (boxes.distance(x, y) <= 0.0, map.height(x, y).is_ok());
                missed += usize::from(!inside && !ground);
                wasted += usize::from(inside && ground);
            }
        }
        (missed, wasted)
    }

    #[test]
    fn boxes_cover_a_hole_and_little_else() {
        let square = |column: usize, row: usize| (20..25).contains(&column) && (10..18).contains(&row);
        let l = |column: usize, row: usize| {
            (10..40).contains(&column) && (5..8).contains(&row) || (10..12).contains(&column) && (5..45).contains(&row)
        };
        let round = |column: usize, row: usize| (column as f64 - 30.0).hypot(row as f64 - 25.0) < 15.0;
        let slanted = |column: usize, row: usize| column.abs_diff(row) < 2;
        let border = |column: usize, row: usize| column < 4 && row > 30;
        let all: [&dyn Fn(usize, usize) -> bool; 5] = [&square, &l, &round, &slanted, &border];
        let told = [([1.4, 3.4], 1), ([-0.8, 4.0], 2), ([3.0, 4.5], 1), ([3.0, 5.0], 12), ([-3.0, 6.9], 1)];
        for (i, (missing, (at, count))) in all.into_iter().zip(told).enumerate() {
            let map = map(missing);
            let boxes = map.hole(at);
            assert_eq!(boxes.len(), count, "{i}");
            let (missed, wasted) = beside(&map, &places(boxes));
            assert!(missed == 0 && wasted < 20_000, "{i}: {missed} missed, {wasted} wasted");
        }
        assert!(map(square).hole([0.0, 6.0]).is_empty(), "there is ground");
    }

    #[test]
    fn another_hole_is_another_one() {
        let map = map(|column, row| (column == 10 || column == 40) && row == 25);
        let [west, east] = [[-1.0, 4.5], [5.0, 4.5]].map(|at| places(map.hole(at)));
        assert!(west.distance(-1.0, 4.5) < 0.0 && west.distance(5.0, 4.5) > 4.0);
        assert!(east.distance(5.0, 4.5) < 0.0 && east.distance(-1.0, 4.5) > 4.0);
    }
}
