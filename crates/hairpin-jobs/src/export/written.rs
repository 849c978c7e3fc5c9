//! What came of an export.

use std::path::PathBuf;

/// What came of one format.
#[derive(Debug, Default)]
pub struct Written {
    /// The files.
    pub files: Vec<PathBuf>,
    /// Of these, files of a format that asks for attitudes, where nobody knows them: they say level.
    pub level: Vec<PathBuf>,
    /// Cases that have no such file, with the reason.
    pub missing: Vec<String>,
}

impl Written {
    pub(super) fn all(files: Vec<PathBuf>) -> Self {
        Self { files, ..Self::default() }
    }
}
