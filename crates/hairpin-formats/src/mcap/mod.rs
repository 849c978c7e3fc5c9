//! Motions as MCAP, by two writers that never meet in one file: one channel that is not CDR stops `ros2 bag play`.

mod cdr;
pub mod foxglove;
mod protobuf;
pub mod ros2;
mod schema;
mod writer;

use std::path::PathBuf;

use hairpin::campaign::kind::Surface;
use hairpin::trajectory::Track;
use thiserror::Error;

use crate::atomic::WriteError;

/// The frame of all positions; robots' frames stand in it.
pub const WORLD: &str = "world";

/// What is written of a case: the planned motion, each run, and what stood around.
#[derive(Debug, Clone, Default)]
pub struct Recording<'a> {
    /// The planned motion, where there is a timed one.
    pub planned: Option<&'a Track>,
    /// Runs with their numbers, which topics and frames have in their names.
    pub runs: Vec<(usize, &'a Track)>,
    /// Motions of an arm's joints; topics have their names.
    pub joints: Vec<JointMotion<'a>>,
    /// Obstacles, world frame.
    pub obstacles: Vec<Surface>,
    /// Key and value of the file's record `hairpin`: the case, its evidence, whether attitudes are known.
    pub facts: Vec<(&'a str, String)>,
}

/// The motion of an arm's joints. `times_s` rise strictly by a nanosecond at least; one row a time, rad, as long as
/// `names`.
#[derive(Debug, Clone, PartialEq)]
pub struct JointMotion<'a> {
    /// In topics: `planned`.
    pub name: &'a str,
    /// Names of the joints.
    pub names: Vec<String>,
    /// s.
    pub times_s: Vec<f64>,
    /// rad.
    pub rows: Vec<Vec<f64>>,
}

/// Why nothing was written.
#[derive(Debug, Error)]
pub enum McapError {
    /// There is no motion.
    #[error("{}: neither a planned motion nor a run", path.display())]
    Empty {
        /// The file.
        path: PathBuf,
    },
    /// A time that the format cannot hold.
    #[error("{}: {topic}: time {value} s: must rise by a nanosecond at least, from 0 to 2147483647 s", path.display())]
    Time {
        /// The file.
        path: PathBuf,
        /// Of which topic.
        topic: String,
        /// The value.
        value: f64,
    },
    /// Rows of joints that have not the length of their names.
    #[error("{}: {topic}: {found} angles in a row, must be {expected}", path.display())]
    Joints {
        /// The file.
        path: PathBuf,
        /// Of which topic.
        topic: String,
        /// How many there are.
        found: usize,
        /// How many names there are.
        expected: usize,
    },
    /// The crate refused.
    #[error("{}: {cause}", path.display())]
    Format {
        /// The file.
        path: PathBuf,
        /// Its reason.
        cause: String,
    },
    /// The file cannot be written.
    #[error(transparent)]
    Write(#[from] WriteError),
}

#[cfg(test)]
mod tests;
