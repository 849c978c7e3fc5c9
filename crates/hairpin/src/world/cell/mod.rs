//! What stands around an arm: named regions to keep out of, a reach sphere to stay in, and inequations in the user's
//! own words.
//!
//! A region is asked three things: how near a segment comes ([`Region::segment_distance`], floating point), whether a
//! formula over intervals decides ([`Region::formula`], for proofs), and what plane separates it ([`Region::nearest`],
//! [`Region::support`]). Numbers here; the proof that a tool's segment is clear is put together from them on floor 5.
//!
//! Signs throughout: a distance or a formula is ≤ 0 inside and on the border, > 0 outside. Frames: the arm's base; a
//! region that moves is no part of a cell.

mod hulls;
mod near;
mod region;
mod words;

#[cfg(feature = "unit-tests")]
mod tests;

pub use hulls::hulls_gap;
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
///
/// Order is meaning: findings name a part by its index. What the arm stands on belongs in it like everything else;
/// nothing is implied.
#[derive(Debug, Clone, Default)]
pub struct Cell {
    /// The regions, told by their index.
    pub parts: Vec<Part>,
}
