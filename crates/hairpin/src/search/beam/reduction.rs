//! Partial trajectories of equal length at the same node have the same futures: only the best few are worth keeping.
//!
//! The paper names it as future work. With revisits and a score without memory it is exact dominance: a future is a
//! function of (node, length).
//!
//! Without revisits a future depends on the set of waypoints used as well, so that equals in (node, length) are not
//! equals in what may follow; `keep` > 1 leaves room for that, and the outcome then claims no proof.

use std::collections::HashMap;

use rustc_hash::FxBuildHasher;

/// (Node, length) pairs remembered at most; past it all are forgotten, which only keeps more.
const MOST_PAIRS: usize = 1 << 20;

/// The best `keep` scores per (node, length).
///
/// `keep` scores of 8 bytes a pair; a lookup is a hash and a binary search among `keep`.
#[derive(Debug)]
pub(super) struct Reduction {
    keep: usize,
    places: HashMap<(u32, u32), u32, FxBuildHasher>,
    /// `keep` scores a place, best first; NaN where there are fewer.
    scores: Vec<f64>,
}

impl Reduction {
    /// Nothing remembered; `keep` of 0 is taken as 1.
    pub(super) fn new(keep: usize) -> Self {
        Self { keep: keep.max(1), places: HashMap::default(), scores: Vec::new() }
    }

    /// Whether a new partial trajectory is among the best; if so it is remembered.
    ///
    /// Of equal scores the earlier ones stay. Not idempotent: each call takes a seat.
    pub(super) fn admits(&mut self, node: u32, length: u32, score: f64) -> bool {
        if self.places.len() >= MOST_PAIRS / self.keep {
            self.places.clear();
            self.scores.clear();
        }
        let next = (self.scores.len() / self.keep) as u32;
        let place = *self.places.entry((node, length)).or_insert(next);
        if place == next {
            self.scores.resize(self.scores.len() + self.keep, f64::NAN);
        }
        let first = place as usize * self.keep;
        let best = &mut self.scores[first..first + self.keep];
        // NaN marks a free seat: everything is better than that.
        let at = best.partition_point(|&s| !s.is_nan() && s >= score);
        if at == self.keep {
            return false;
        }
        best[at..].rotate_right(1);
        best[at] = score;
        true
    }

    /// Whether a partial trajectory that was admitted has not been overtaken by better ones since.
    ///
    /// True while fewer than `keep` seats are taken, or where the worst that sits is not better.
    pub(super) fn still_admits(&self, node: u32, length: u32, score: f64) -> bool {
        self.places.get(&(node, length)).is_none_or(|&place| {
            let worst = self.scores[(place as usize + 1) * self.keep - 1];
            worst.is_nan() || score >= worst
        })
    }
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;

    #[test]
    fn the_best_two_stay() {
        let mut reduction = Reduction::new(2);
        assert!(reduction.admits(7, 3, 1.0));
        assert!(reduction.admits(7, 3, f64::NEG_INFINITY));
        assert!(reduction.admits(7, 3, 2.0));
        assert!(!reduction.admits(7, 3, 1.0));
        assert!(reduction.admits(7, 4, 0.0));
        assert!(reduction.still_admits(7, 3, 1.0));
        assert!(!reduction.still_admits(7, 3, f64::NEG_INFINITY));
        assert!(reduction.admits(7, 3, 3.0));
        assert!(!reduction.still_admits(7, 3, 1.0));
    }
}
