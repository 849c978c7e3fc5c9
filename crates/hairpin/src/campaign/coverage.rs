//! What a test set exercised: cells of a grid over how the robot moved, and which of them were met.
//!
//! Flights: speed × turn × climb of every leg flown. Drives: slope × curvature × slip of every sample. Arms: joint ×
//! place in its range × speed × direction of every sample, reversals with the speed that they came from.

use std::collections::{BTreeMap, BTreeSet};

use nalgebra::Point3;
use serde::{Deserialize, Serialize};

use super::case::Run;
use super::kind::Axis;
use super::setup::Setup;

/// The grid of a robot's motion.
///
/// Cells are numbered in the order of the axes, the last one fastest.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Grid {
    /// Its axes.
    pub axes: Vec<Axis>,
}

/// What all cases of a campaign met.
///
/// hit / cells is what the report tells; cells that the robot cannot come to count as well, so that 100 % is not the
/// aim.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Coverage {
    /// The grid.
    pub grid: Grid,
    /// Cells of the grid.
    pub cells: usize,
    /// Cells that were met.
    pub hit: usize,
    /// How many cases met each of these, by number.
    pub cases: BTreeMap<usize, usize>,
}

impl Coverage {
    /// Whether its parts fit together, as those of a file that was edited may not.
    ///
    /// Counts agree, and no cell is beyond the grid.
    pub fn fits(&self) -> bool {
        let sound = |axis: &Axis| {
            let rising = axis.edges.windows(2).all(|pair| pair[0] < pair[1]);
            axis.edges.len() >= 2 && rising && (axis.words.is_empty() || axis.words.len() == axis.cells())
        };
        let axes = &self.grid.axes;
        let cells = axes.iter().try_fold(1_usize, |cells, axis| cells.checked_mul(axis.edges.len().saturating_sub(1)));
        axes.iter().all(sound)
            && cells == Some(self.cells)
            && self.hit == self.cases.len()
            && self.cases.keys().all(|cell| *cell < self.cells)
    }
}

impl Grid {
    /// The grid for the robot of `setup`, over what it can do.
    pub fn of(setup: &Setup) -> Self {
        Self { axes: setup.kind().motion().axes }
    }

    /// Cells in all.
    pub fn cells(&self) -> usize {
        self.axes.iter().map(Axis::cells).product()
    }

    fn cell(&self, values: &[f64]) -> usize {
        self.axes.iter().zip(values).fold(0, |cell, (axis, value)| cell * axis.cells() + axis.cell(*value))
    }

    /// The cell number of each axis.
    ///
    /// The inverse of the numbering: one index an axis.
    pub fn places(&self, cell: usize) -> Vec<usize> {
        let mut rest = cell;
        let mut places: Vec<usize> = (self.axes.iter().rev())
            .map(|axis| {
                let place = rest % axis.cells();
                rest /= axis.cells();
                place
            })
            .collect();
        places.reverse();
        places
    }

    /// The cells that a run of a case over `waypoints` met; none where the executor failed.
    ///
    /// Where rows of the run were left out, what was noted at its full rate.
    pub fn met(&self, setup: &Setup, waypoints: &[Point3<f64>], run: &Run) -> BTreeSet<usize> {
        let Ok(flight) = &run.outcome else { return BTreeSet::new() };
        if let Some(known) = &run.full_rate {
            return known.met.clone();
        }
        let mut met = BTreeSet::new();
        (setup.kind().motion().meet)(waypoints, flight, &mut |values| {
            met.insert(self.cell(values));
        });
        met
    }

    /// What all cases met, each case once a cell.
    pub fn coverage<'a>(self, cases: impl IntoIterator<Item = &'a BTreeSet<usize>>) -> Coverage {
        let mut by_cell = BTreeMap::new();
        for cell in cases.into_iter().flatten() {
            *by_cell.entry(*cell).or_insert(0) += 1;
        }
        Coverage { cells: self.cells(), hit: by_cell.len(), cases: by_cell, grid: self }
    }
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;

    #[test]
    fn cells_are_numbered_as_their_places_are() {
        let grid = Grid {
            axes: vec![
                Axis::even("speed", "m/s", 0.0, 10.0, 5),
                Axis::of("climb", "°", &[-90.0, 0.0, 90.0]),
                Axis::worded("direction", &["rising", "falling", "reversing"]),
            ],
        };
        assert_eq!(grid.cells(), 30);
        let all: BTreeSet<Vec<usize>> = (0..30).map(|cell| grid.places(cell)).collect();
        assert_eq!(all.len(), 30);
        let cell = grid.cell(&[3.9, 12.0, 2.5]);
        assert_eq!(grid.places(cell), [1, 1, 2]);
        // What lies on an edge belongs to the cell above, what lies beyond to the outermost.
        assert_eq!(grid.places(grid.cell(&[2.0, -90.0, 0.0])), [1, 0, 0]);
        assert_eq!(grid.places(grid.cell(&[99.0, 99.0, -3.0])), [4, 1, 0]);
        let sets = [BTreeSet::from([1, 2]), BTreeSet::from([2])];
        let coverage = grid.coverage(&sets);
        assert_eq!((coverage.hit, coverage.cells, coverage.cases[&2], coverage.cases[&1]), (2, 30, 2, 1));
    }
}
