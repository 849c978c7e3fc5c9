//! What each line of a module means for motion.

/// What a line means for motion, best first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Class {
    /// Never executed here: routines that nothing calls, branches not taken, error handlers.
    Unreached,
    /// Has nothing to do with motion.
    Harmless,
    /// Followed.
    Understood,
    /// Changes motion, and how is not understood.
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
}

impl Line {
    pub(super) fn unreached() -> Self {
        Self { class: Class::Unreached, what: String::new() }
    }
}
