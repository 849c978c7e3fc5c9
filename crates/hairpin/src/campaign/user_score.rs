//! Scores of the user's own: whatever tells legs apart outside of hairpin.

use std::fmt;
use std::sync::Arc;

use crate::search::LegView;

/// Name of the score's file in a campaign folder.
pub const NAME: &str = "score.py";

/// What a score of the user's begins with in scenarios.
const PREFIX: &str = "python:";

/// Scores legs. The same leg must get the same numbers whenever, and in whatever company, it is asked for.
pub trait LegScorer: Send + Sync {
    /// Of every leg what it scores whatever was flown before it, and what it adds to the score of the leg after it; NaN where
    /// there is [trouble](Self::trouble).
    fn parts(&self, legs: &[LegView<'_>]) -> Vec<[f64; 2]>;

    /// Why legs have no score, if that has happened.
    fn trouble(&self) -> Option<String>;
}

/// A score of the user's and the file that it was read from.
#[derive(Clone)]
pub struct UserScore {
    /// The file's contents.
    pub bytes: Arc<[u8]>,
    /// Scores legs by it.
    pub scorer: Arc<dyn LegScorer>,
}

impl UserScore {
    /// The file that a score of a scenario names: `python:FILE`.
    pub fn file_of(score: &str) -> Option<&str> {
        score.strip_prefix(PREFIX)
    }

    /// The score of a resolved scenario, whose folder holds the file.
    pub fn score() -> String {
        format!("{PREFIX}{NAME}")
    }
}

/// Of the same file.
impl PartialEq for UserScore {
    fn eq(&self, other: &Self) -> bool {
        self.bytes == other.bytes
    }
}

impl fmt::Debug for UserScore {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("UserScore").field("bytes", &self.bytes.len()).finish_non_exhaustive()
    }
}
