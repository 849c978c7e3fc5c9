//! The command line of a program of the user's.

use thiserror::Error;

/// A command line, split as a shell splits it; nothing is expanded.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Command {
    pub(super) program: String,
    arguments: Vec<String>,
}

/// Why a text is no command.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum CommandError {
    /// No word in it.
    #[error("is empty")]
    Empty,
    /// A quote that never ends, or a trailing backslash.
    #[error("has a quote that never ends")]
    Quotes,
}

impl Command {
    /// The program and its arguments.
    pub fn words(&self) -> impl Iterator<Item = &str> {
        std::iter::once(&self.program).chain(&self.arguments).map(String::as_str)
    }
}

impl From<&Command> for std::process::Command {
    fn from(command: &Command) -> Self {
        let mut started = Self::new(&command.program);
        started.args(&command.arguments);
        started
    }
}

impl std::str::FromStr for Command {
    type Err = CommandError;

    fn from_str(text: &str) -> Result<Self, CommandError> {
        let mut words = shlex::split(text).ok_or(CommandError::Quotes)?.into_iter();
        let program = words.next().filter(|program| !program.is_empty()).ok_or(CommandError::Empty)?;
        Ok(Self { program, arguments: words.collect() })
    }
}
