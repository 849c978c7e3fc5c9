//! Why a file is no log that can be read, and where.

use std::fmt;
use std::io;
use std::path::{Path, PathBuf};

use thiserror::Error;

use super::samples::MOST_SAMPLES;

/// Why a file is no log that can be read.
#[derive(Debug, Error)]
pub enum LogError {
    /// The file cannot be read.
    #[error("cannot read {}: {cause}", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// The system's answer.
        cause: io::Error,
    },
    /// It is none that is known.
    #[error("{}: {what}", path.display())]
    Unknown {
        /// The file.
        path: PathBuf,
        /// What it looks like, and what would be read.
        what: String,
    },
    /// It breaks its format.
    #[error("{}, {place}: {what}", path.display())]
    Broken {
        /// The file.
        path: PathBuf,
        /// Where.
        place: Place,
        /// What is found there and what must be.
        what: String,
    },
    /// More than is worth judging at once.
    #[error("{}: more than {MOST_SAMPLES} samples; cut the log first", path.display())]
    TooLong {
        /// The file.
        path: PathBuf,
    },
    /// Nothing moves in it.
    #[error("{}: {what}", path.display())]
    Nothing {
        /// The file.
        path: PathBuf,
        /// What it is and what it lacks.
        what: String,
    },
}

/// A place in a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Place {
    /// Bytes before it.
    Byte(u64),
    /// Line, from 1.
    Line(usize),
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Byte(offset) => write!(f, "byte {offset}"),
            Self::Line(line) => write!(f, "line {line}"),
        }
    }
}

/// A [`LogError`] of a reader that does not know the file's name.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Fault {
    Unknown(String),
    Broken(Place, String),
    TooLong,
    Nothing(String),
}

impl Fault {
    pub(super) fn line(line: usize, what: impl Into<String>) -> Self {
        Self::Broken(Place::Line(line), what.into())
    }

    pub(super) fn of(self, path: &Path) -> LogError {
        let path = path.into();
        match self {
            Self::Unknown(what) => LogError::Unknown { path, what },
            Self::Broken(place, what) => LogError::Broken { path, place, what },
            Self::TooLong => LogError::TooLong { path },
            Self::Nothing(what) => LogError::Nothing { path, what },
        }
    }
}
