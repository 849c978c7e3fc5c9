//! The executions of a round in pieces: the same for any number of machines.

use std::ops::Range;

/// Pieces of a round whose executions are cheap, at most: some milliseconds of executing for each file.
pub(super) const OF_CHEAP: usize = 16;

/// The pieces of a round.
pub(super) struct Pieces {
    round: usize,
    /// Executions.
    total: usize,
    count: usize,
}

impl Pieces {
    /// Of round number `round` with `total` executions: one each, but no more than `most`.
    pub(super) fn of(round: usize, total: usize, most: usize) -> Self {
        Self { round, total, count: total.min(most) }
    }

    pub(super) fn count(&self) -> usize {
        self.count
    }

    /// Which executions a piece has.
    pub(super) fn places(&self, piece: usize) -> Range<usize> {
        let until = |piece: usize| self.total * piece / self.count;
        until(piece)..until(piece + 1)
    }

    /// What its files are called.
    pub(super) fn name(&self, piece: usize) -> String {
        format!("{:05}-{piece}", self.round)
    }

    /// All of them, from one at that share of them on: whoever begins elsewhere meets others late.
    pub(super) fn from(&self, share: f64) -> impl Iterator<Item = usize> {
        let (count, first) = (self.count, (share * self.count as f64) as usize);
        (0..count).map(move |k| (first + k) % count)
    }
}
