//! A planned motion for the judge: poses in planned time, and where along them each move passes its target.
//!
//! For the judge of arms, whose moves are curves with rounded corners: deviation is measured from what was programmed,
//! not from straight legs between targets.

use super::Track;

/// One move of a planned path.
#[derive(Debug, Clone, PartialEq)]
pub struct PlannedMove {
    /// What reports call it, such as `p17→p09`.
    pub name: String,
    /// Index of the pose at which its target is passed: of a blended one the middle of the blend.
    pub end: usize,
    /// Whether the arm stops there.
    pub stops: bool,
}

/// Poses on planned stamps, joined by straight lines or by the cubics that its track has between them; moves end at
/// poses in order.
#[derive(Debug, Clone, PartialEq)]
pub struct PlannedPath {
    track: Track,
    moves: Vec<PlannedMove>,
}

impl PlannedPath {
    /// # Panics
    /// If there is no pose, or a move ends before the one before it or beyond the last pose: a mistake of the caller's.
    pub fn new(track: Track, moves: Vec<PlannedMove>) -> Self {
        assert!(!track.is_empty(), "a planned path has a pose");
        assert!(moves.windows(2).all(|pair| pair[0].end <= pair[1].end), "moves end one after the other");
        assert!(moves.last().is_none_or(|last| last.end < track.len()), "every move ends at a pose");
        Self { track, moves }
    }

    /// Poses in planned time.
    pub fn track(&self) -> &Track {
        &self.track
    }

    /// The moves, in order.
    pub fn moves(&self) -> &[PlannedMove] {
        &self.moves
    }

    /// When move `index` passes its target, s.
    pub fn passes(&self, index: usize) -> f64 {
        self.track.times()[self.moves[index].end]
    }
}
