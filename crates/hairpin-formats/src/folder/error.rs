//! Why a campaign folder cannot be used.

use std::io;
use std::path::PathBuf;

use hairpin::campaign::CaseNumber;
use thiserror::Error;

use super::names::SCENARIO;
use crate::atomic::{WriteError, is_lost};
use crate::parquet::TableError;
use crate::scenario;

impl FolderError {
    /// Whether results were lost for want of space, or because the device failed.
    pub fn is_lost(&self) -> bool {
        match self {
            Self::Write(error) => error.is_lost(),
            Self::Copy { cause, .. } => is_lost(cause),
            _ => false,
        }
    }
}

/// Why a campaign folder cannot be used.
#[derive(Debug, Error)]
pub enum FolderError {
    /// A file cannot be written.
    #[error(transparent)]
    Write(#[from] WriteError),
    /// A table cannot be read.
    #[error(transparent)]
    Table(#[from] TableError),
    /// Its scenario cannot be written.
    #[error(transparent)]
    Scenario(#[from] scenario::WriteError),
    /// A file cannot be read.
    #[error("cannot read {}: {cause}", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// The system's answer.
        cause: io::Error,
    },
    /// A file cannot be copied.
    #[error("cannot copy {} to {}: {cause}", from.display(), to.display())]
    Copy {
        /// The file.
        from: PathBuf,
        /// Where it was to go.
        to: PathBuf,
        /// The system's answer.
        cause: io::Error,
    },
    /// A program cannot be written, or is none.
    #[error("{}: {what}", path.display())]
    Program {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        what: String,
    },
    /// Not ours: writing into it could destroy something.
    #[error("{} is not empty and not a campaign folder (no {SCENARIO} in it): choose another --out", path.display())]
    Foreign {
        /// The folder.
        path: PathBuf,
    },
    /// No campaign stands here.
    #[error("{} is not a campaign folder: no {SCENARIO} in it", path.display())]
    NoCampaign {
        /// The folder.
        path: PathBuf,
    },
    /// Another process writes here.
    #[error("another hairpin is writing to {}", path.display())]
    Locked {
        /// The folder.
        path: PathBuf,
    },
    /// Files of one folder contradict each other.
    #[error("{}: case {case} {what}", path.display())]
    Contradiction {
        /// The file.
        path: PathBuf,
        /// Number of the case.
        case: CaseNumber,
        /// What is wrong with it.
        what: &'static str,
    },
}
