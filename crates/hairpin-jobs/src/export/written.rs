//! What came of an export.

use std::path::PathBuf;

use crate::Problem;

/// What came of one format.
#[derive(Debug, Default)]
pub struct Written {
    /// The files.
    pub files: Vec<PathBuf>,
    /// Of these, files of a format that asks for attitudes, where nobody knows them: they say level.
    pub level: Vec<PathBuf>,
    /// Cases that have no such file, with the reason.
    pub missing: Vec<String>,
    /// What their user has to know of them, a sentence each.
    pub told: Vec<String>,
}

impl Written {
    pub(super) fn all(files: Vec<PathBuf>) -> Self {
        Self { files, ..Self::default() }
    }

    /// Itself, unless nothing was written: then why.
    pub(super) fn or_refused(self) -> Result<Self, Problem> {
        match self.missing.first() {
            Some(why) if self.files.is_empty() => Err(Problem::input(why)),
            _ => Ok(self),
        }
    }
}
