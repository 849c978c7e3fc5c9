//! `results.parquet`: one row per case, its worst run. The first columns and their order are a contract with other
//! programs; what follows them holds the rest of a judgement, so that nothing has to be judged again to report it.

mod read;
mod write;

use hairpin::campaign::{Case, CaseResult};

pub use read::{read, read_counted};
pub use write::{write, write_counted};

/// Confidence of the intervals of shares in the table.
const CONFIDENCE: f64 = 0.95;

/// Column: what other runs than the worst violate, of tables in which some do.
const ELSEWHERE: &str = "violations_elsewhere";

/// The status of a case that has not been judged.
pub const GENERATED: &str = "generated";

/// A row: the case without its waypoints and profile, and its result once judged.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// `waypoints`, `leg_times` and `profile` are empty here: they stand in files of their own.
    pub case: Case,
    /// Waypoints, both ends included.
    pub length: usize,
    /// `None`: generated, not judged.
    pub result: Option<CaseResult>,
}
