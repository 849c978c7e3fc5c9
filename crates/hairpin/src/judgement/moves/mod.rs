//! The oracle of programs: recordings of an arm against its planned path, move by move, against a spec and against what
//! an earlier release did. It knows poses in time and nothing of arms.
//!
//! | step | file |
//! | --- | --- |
//! | where on the path each sample is | `align`: monotone, in position and orientation |
//! | deviation, arrival and duration of each move | [`measure_moves`] |
//! | gaps, and what they may hide | [`unseen`] |
//! | how near it came to each target, and whether at all | [`Approach`], `come_to` |
//! | against an earlier release's repeats | [`compare`], [`Regression`] |
//! | over all releases | [`trend`] |
//!
//! Clocks are not fitted in silence: the offset of a recording is estimated, told, and taken off only where it was
//! asked for. After Collet, Gotlieb, Lazaar and Mossige, "Stress testing of single-arm robots through constraint-based
//! generation of continuous trajectories" (2019), whose oracle compares positions and times against thresholds and
//! earlier versions.

mod align;
mod approach;
mod come_to;
mod compare;
mod gap;
mod measure;
mod regression;
mod told;
mod trend;
mod unseen;

#[cfg(feature = "unit-tests")]
mod tests;

use thiserror::Error;

pub use approach::Approach;
pub use compare::{Band, Comparison, Metric, MoveComparison, Outcome, Release, compare};
pub use gap::{Gap, Unseen};
pub use measure::{Clock, MeasureSettings, Measured, MoveMeasures, Offset, measure_moves};
pub use regression::{ProgramComparison, Regression};
pub use told::offset_told;
pub use trend::{Trend, trend};
pub use unseen::{Between, Hidden, unseen};

/// Why recordings cannot be judged.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum MovesError {
    /// A plan without a move.
    #[error("the planned path has no move")]
    NoMoves,
    /// Too little to align.
    #[error("the recording has {found} samples: must be at least 2")]
    Samples {
        /// How many there are.
        found: usize,
    },
    /// A setting out of its bounds.
    #[error("{field} = {value}: must be {bound}")]
    Setting {
        /// Which.
        field: &'static str,
        /// As given.
        value: f64,
        /// What it must be.
        bound: &'static str,
    },
    /// Runs of one program differ in their moves.
    #[error("`{release}`, run {run}: move {index} is `{found}`, expected `{expected}`")]
    Moves {
        /// Whose runs.
        release: String,
        /// From 0.
        run: usize,
        /// From 0.
        index: usize,
        /// Its name there; empty if missing.
        found: String,
        /// As in the first run of the baseline; empty if missing.
        expected: String,
    },
    /// A band needs a spread.
    #[error("`{release}` has {found} runs: must be at least {least}")]
    Runs {
        /// Whose runs.
        release: String,
        /// How many there are.
        found: usize,
        /// How many it takes.
        least: usize,
    },
}
