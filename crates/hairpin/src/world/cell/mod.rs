//! What stands around an arm: named regions to keep out of, a reach sphere to stay in, and inequations in the user's own words.

mod near;
mod region;
mod words;

#[cfg(test)]
mod tests;

pub use near::directions;
pub use region::{Region, Surface};
pub use words::{Words, WordsError};

/// A named region that must not be entered.
#[derive(Debug, Clone)]
pub struct Part {
    /// Name for reports.
    pub name: String,
    /// Where it is forbidden to be.
    pub region: Region,
}

/// Everything around an arm, in the frame of its base, m.
#[derive(Debug, Clone, Default)]
pub struct Cell {
    /// The regions, told by their index.
    pub parts: Vec<Part>,
}
