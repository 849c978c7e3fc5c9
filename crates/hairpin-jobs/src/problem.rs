//! Why a job gave no result.

use std::fmt::Display;
use std::path::Path;

use hairpin::campaign::Mistake;
use hairpin_formats::atomic::WriteError;
use hairpin_formats::folder::FolderError;
use hairpin_formats::scenario::Report;
use thiserror::Error;

/// A job that could not do what was asked.
#[derive(Debug, Error)]
pub enum Problem {
    /// A scenario with mistakes, each with its line and caret.
    #[error("{}", .0.render(false).trim_end())]
    Scenario(Report),
    /// Anything else that the user gave, or the machine refused.
    #[error("{0}")]
    Input(String),
    /// A number of a table that the user gave.
    #[error("{sentence}")]
    Entry {
        /// All that is wrong, with the table's name, line and column.
        sentence: String,
        /// Line and column, both from 1.
        at: [usize; 2],
        /// What it must be.
        bound: String,
    },
    /// A result could not be written: no space is left, or the device failed.
    #[error("{0}")]
    Lost(String),
    /// A program of the user's that was to execute something failed.
    #[error("{0}")]
    Executor(String),
    /// It was asked to stop: what is done is kept.
    #[error("{0}")]
    Interrupted(String),
}

impl Problem {
    /// A problem in words.
    pub fn input(sentence: impl Display) -> Self {
        Self::Input(sentence.to_string())
    }

    /// What is wrong with a file.
    pub fn of_file(file: &Path, why: impl Display) -> Self {
        Self::Input(format!("{}: {why}", file.display()))
    }
}

impl From<Report> for Problem {
    fn from(report: Report) -> Self {
        Self::Scenario(report)
    }
}

impl From<Mistake> for Problem {
    fn from(mistake: Mistake) -> Self {
        Self::input(mistake)
    }
}

impl From<FolderError> for Problem {
    fn from(error: FolderError) -> Self {
        if error.is_lost() { Self::Lost(error.to_string()) } else { Self::input(error) }
    }
}

impl From<WriteError> for Problem {
    fn from(error: WriteError) -> Self {
        if error.is_lost() { Self::Lost(error.to_string()) } else { Self::input(error) }
    }
}
