//! Executions of a search that came to no flight. Whatever it keeps is a trajectory on which its executor or controller
//! did not give up; that it did on others is told beside it.
//!
//! Counted where a search asks for executions, so that programs of the user's and controllers in our simulator are
//! counted alike, and by units of work, so that an interrupted search counts none twice.

use serde::{Deserialize, Serialize};

/// Executions that came to no flight.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct Failures {
    /// How many.
    pub failed: u64,
    /// Why one of them did, in a sentence: the first of all in the order of letters, whichever came first.
    /// `None` where others executed, who tell that they failed and not why.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub why: Option<String>,
    /// A fingerprint of who executed, by which another is told from it; `None` where nothing failed, and of folders of
    /// earlier versions.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub by: Option<String>,
    /// Of how many executions they are, where nothing else tells it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub of: Option<u64>,
    /// Whether another executed all of the cases since: what failed is no failure of that one, and what it was of was
    /// never executed.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub is_past: bool,
}

impl Failures {
    /// Whether nothing failed.
    pub fn is_none(&self) -> bool {
        self.failed == 0
    }

    /// Takes in others.
    pub(super) fn add(&mut self, other: Self) {
        self.is_past &= other.is_none();
        self.failed += other.failed;
        self.why = self.why.take().into_iter().chain(other.why).min();
        self.by = self.by.take().or(other.by);
    }

    /// ` (why)`, or nothing.
    pub(super) fn why_in_words(&self) -> String {
        self.why.as_ref().map_or(String::new(), |why| format!(" ({why})"))
    }
}
