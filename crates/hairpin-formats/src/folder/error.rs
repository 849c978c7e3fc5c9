//! Why a campaign folder cannot be used.

use std::io;
use std::path::PathBuf;

use hairpin::campaign::CaseNumber;
use thiserror::Error;

use super::names::{LIST, SCENARIO};
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
    /// It has a scenario, and nothing says that hairpin made the folder.
    #[error(
        "{} has a {SCENARIO} and no {LIST}, hairpin's list of what is its own there: it is somebody else's folder, and nothing \
         in it is replaced; choose another --out", path.display()
    )]
    Unlisted {
        /// The folder.
        path: PathBuf,
    },
    /// Something stands where a file of hairpin's would.
    #[error("{} is not hairpin's (no such name in {LIST}) and would be replaced: move it, or choose another --out", path.display())]
    NotOurs {
        /// The file.
        path: PathBuf,
    },
    /// A file whose place the user chose is one that a campaign is read from.
    #[error("{} is a campaign's own, which it is read from: name another file", path.display())]
    Own {
        /// The file.
        path: PathBuf,
    },
    /// A list of names that leads out of its folder.
    #[error("{}, line {line}: `{}` is no name below the folder: no absolute name, no `..`", path.display(), name.escape_default())]
    Listed {
        /// The list.
        path: PathBuf,
        /// Counted from 1.
        line: usize,
        /// What it says.
        name: String,
    },
    /// A link, which could lead anywhere.
    #[error("{} is a link: links in a campaign folder are not followed; put the file itself there", path.display())]
    Link {
        /// The link.
        path: PathBuf,
    },
    /// A pipe, a device.
    #[error("{} is neither a file nor a folder", path.display())]
    Special {
        /// What is there.
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
