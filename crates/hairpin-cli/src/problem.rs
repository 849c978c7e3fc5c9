//! Why a command gave no verdict, as a sentence for people, an object for machines, and an exit code.

use std::fmt::Display;

use hairpin::campaign::Mistake;
use hairpin_formats::scenario::Report;
use serde_json::{Value, json};

use crate::console;
use crate::interrupt::INTERRUPTED;

/// Exit code of wrong input.
pub(crate) const WRONG_INPUT: u8 = 2;
/// Exit code where the user's program failed.
const EXECUTOR_FAILED: u8 = 4;

/// A command that could not do what was asked.
#[derive(Debug)]
pub(crate) enum Problem {
    /// A scenario with mistakes, each with its line and caret.
    Scenario(Report),
    /// Anything else that the user gave, or the machine refused.
    Input(String),
    /// A program of the user's that was to execute something failed.
    Executor(String),
    /// Ctrl-C: what is done is kept.
    Interrupted(String),
}

impl Problem {
    /// A problem in words.
    pub(crate) fn input(sentence: impl Display) -> Self {
        Self::Input(sentence.to_string())
    }

    /// Tells it, and gives the exit code.
    pub(crate) fn tell(&self, json: bool) -> u8 {
        match self {
            Self::Scenario(report) => console::warn(report.render(console::colour_on_stderr()).trim_end()),
            Self::Input(sentence) => console::warn(&format!("Error: {sentence}")),
            Self::Executor(sentence) => console::warn(&format!("EXECUTOR FAILED: {sentence}")),
            Self::Interrupted(sentence) => console::warn(sentence),
        }
        if json {
            console::say(&self.object().to_string());
        }
        self.code()
    }

    fn code(&self) -> u8 {
        match self {
            Self::Scenario(_) | Self::Input(_) => WRONG_INPUT,
            Self::Executor(_) => EXECUTOR_FAILED,
            Self::Interrupted(_) => INTERRUPTED,
        }
    }

    /// What machines get on stdout.
    pub(crate) fn object(&self) -> Value {
        let code = self.code();
        match self {
            Self::Scenario(report) => json!({ "exit_code": code, "mistakes": report.to_json() }),
            Self::Input(sentence) | Self::Executor(sentence) | Self::Interrupted(sentence) => {
                json!({ "exit_code": code, "error": sentence })
            }
        }
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

impl From<hairpin_formats::folder::FolderError> for Problem {
    fn from(error: hairpin_formats::folder::FolderError) -> Self {
        Self::input(error)
    }
}

impl From<hairpin_formats::atomic::WriteError> for Problem {
    fn from(error: hairpin_formats::atomic::WriteError) -> Self {
        Self::input(error)
    }
}
