//! What an earlier generation left.

use crate::campaign::{Case, Tally};

/// What an earlier, interrupted generation left.
///
/// Both are read from the folder; [`counted`](super::counted) leaves out what a kill between two writes may have
/// left.
#[derive(Debug, Clone, Default)]
pub struct Known {
    /// Its cases.
    pub cases: Vec<Case>,
    /// Its tally, as of the last unit whose cases are known.
    pub tally: Tally,
}
