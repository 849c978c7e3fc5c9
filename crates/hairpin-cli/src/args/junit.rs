//! Where a build server finds its JUnit file.

use std::path::{Path, PathBuf};

use clap::Args;

/// A second place for `junit.xml`.
#[derive(Debug, Clone, Args)]
pub(crate) struct Junit {
    /// Write the JUnit file there as well, beside OUT/junit.xml
    #[arg(long, value_name = "PATH")]
    pub(crate) junit: Option<PathBuf>,
}

impl Junit {
    /// The place, if there is one.
    pub(crate) fn path(&self) -> Option<&Path> {
        self.junit.as_deref()
    }
}
