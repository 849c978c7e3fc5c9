//! What each line of a program means for motion.

use std::fmt;

use super::unmodelled::Unmodelled;

/// Where in a program, both from 1; columns count characters. Lines of several files are counted through.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default)]
pub struct At {
    /// Line.
    pub line: usize,
    /// Column.
    pub column: usize,
}

impl fmt::Display for At {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "line {}, column {}", self.line, self.column)
    }
}

/// What a line means for motion, best first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Class {
    /// Never executed here: routines that nothing calls, branches not taken, error handlers.
    Unreached,
    /// Has nothing to do with motion.
    Harmless,
    /// Followed.
    Understood,
    /// Changes motion, and how is not understood or not modelled.
    ChangesMotion,
}

impl Class {
    /// In words.
    pub fn words(self) -> &'static str {
        match self {
            Self::Unreached => "not reached",
            Self::Harmless => "harmless to motion",
            Self::Understood => "understood",
            Self::ChangesMotion => "changes motion, not understood",
        }
    }
}

/// A line's class, and why where there is more to say.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Line {
    /// Its class.
    pub class: Class,
    /// Why; empty where the class says all.
    pub what: String,
    /// Of a line that changes motion: what it is, where that is known and not modelled.
    pub unmodelled: Option<Unmodelled>,
}

impl Line {
    pub(crate) fn unreached() -> Self {
        Self { class: Class::Unreached, what: String::new(), unmodelled: None }
    }

    pub(crate) fn harmless(what: String) -> Self {
        Self { class: Class::Harmless, what, unmodelled: None }
    }
}
