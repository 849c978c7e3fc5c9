//! Which change is tried next: shares by success, none without any.
//!
//! Probability matching: a change that gives what is kept more often is tried more often, and what it gave long ago
//! counts less. Source: Goldberg, Probability matching, the magnitude of reinforcement, and classifier system bidding,
//! 1990; with the least share of Thierens, An adaptive pursuit strategy for allocating operator probabilities, 2005.

use crate::math::random::{Stream, unit};

/// Share that every change has, as a part of an even share.
const LEAST: f64 = 0.25;
/// Weight of what a change has come to after one more trial of it.
const MEMORY: f64 = 0.97;

/// Shares of changes.
///
/// Rewards are 0 … 1 and not stationary: what pays early (draws, crossings) does not pay late (steps). Shares
/// therefore follow an exponential mean of the last thirty or so trials, and none falls below a quarter of an even
/// one, so that what begins to pay is noticed.
#[derive(Debug, Clone)]
pub(super) struct Portfolio {
    /// Mean reward of each, the last ones weighing most.
    success: Vec<f64>,
}

impl Portfolio {
    /// Of `count` changes, all of them promising.
    ///
    /// All begin at 0.3: about what a child is worth that becomes a parent.
    pub(super) fn new(count: usize) -> Self {
        Self { success: vec![0.3; count] }
    }

    /// One of the changes that are `open`; `None` where none is.
    ///
    /// P = least / n + (1 − least) s / Σ s, over those that are open.
    ///
    /// An index into `open`; one uniform number is taken from `random`. With all successes at 0 shares are even.
    pub(super) fn draw(&self, open: &[bool], random: &mut Stream) -> Option<usize> {
        let open = || self.success.iter().zip(open).enumerate().filter(|(_, (_, open))| **open);
        let count = open().count() as f64;
        let all: f64 = open().map(|(_, (success, _))| success).sum();
        let mut left = unit(random);
        let mut last = None;
        for (number, (success, _)) in open() {
            let matched = if all > 0.0 { success / all } else { 1.0 / count };
            left -= LEAST / count + (1.0 - LEAST) * matched;
            last = Some(number);
            if left < 0.0 {
                break;
            }
        }
        last
    }

    /// Change `number` came to `reward`, 0 … 1.
    ///
    /// s ← 0.97 s + 0.03 · reward.
    pub(super) fn reward(&mut self, number: usize, reward: f64) {
        let success = &mut self.success[number];
        *success = MEMORY * *success + (1.0 - MEMORY) * reward;
    }
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;
    use crate::math::random::stream;

    #[test]
    fn what_pays_gets_more_and_nothing_gets_none() {
        let mut portfolio = Portfolio::new(4);
        for _ in 0..200 {
            (0..4).for_each(|number| portfolio.reward(number, f64::from(u8::from(number == 2))));
        }
        let mut drawn = [0; 4];
        let mut random = stream(1);
        (0..4000).for_each(|_| drawn[portfolio.draw(&[true; 4], &mut random).unwrap()] += 1);
        assert!(drawn[2] > 3000 && drawn.iter().all(|count| *count > 150), "{drawn:?}");
        assert_eq!(portfolio.draw(&[false, true, false, false], &mut random), Some(1));
        assert_eq!(portfolio.draw(&[false; 4], &mut random), None);
    }
}
