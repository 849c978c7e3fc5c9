//! A random walk to a length, by steps that are dear to ask for: one trajectory where nobody builds the graph.
//!
//! Every step is drawn evenly from what may follow where the walk stands, as far as that leads on: dead ends are walked
//! back out of. This is not even over all walks, as [`super::uniform()`] is, which has to know every leg: walks through
//! nodes that few steps lead on from come more often than others. Where every step is possible it is even.

use crate::math::random::{Stream, unit};

/// Why there is no walk.
///
/// The first is a proof, the second a budget.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NoWalk {
    /// There is none at all of this length.
    None,
    /// So many steps were asked for, and none of this length was found.
    Asked(u64),
}

/// A walk of `length` nodes from `start`. `next(walk)` are the nodes that may follow the last one of a walk, each once;
/// `step(from, to)` says whether one does, and is asked `most` times at most.
///
/// Depth first: what may follow is tried in a random order, and the first that leads to a walk of the length is taken.
///
/// # Errors
/// [`NoWalk`].
///
/// ```
/// use hairpin::math::random::stream;
/// use hairpin::search::{NoWalk, stroll};
///
/// // Four numbers without 3 after 2, each once.
/// let next = |walk: &[u32]| (0..4).filter(|n| !walk.contains(n)).collect();
/// let walk = stroll(0, 4, next, |from, to| (*from, *to) != (2, 3), 100, &mut stream(1))?;
/// assert!(walk.len() == 4 && walk[0] == 0 && !walk.windows(2).any(|pair| pair == [2, 3]));
/// # Ok::<(), NoWalk>(())
/// ```
///
/// `length` of 0 or 1 gives the start alone. Of `random` one number is taken for each question. Nodes that `next`
/// does not give are not asked; `step` may be asked about the same pair again, after different beginnings.
pub fn stroll<N>(
    start: N,
    length: usize,
    mut next: impl FnMut(&[N]) -> Vec<N>,
    mut step: impl FnMut(&N, &N) -> bool,
    most: u64,
    random: &mut Stream,
) -> Result<Vec<N>, NoWalk> {
    let mut walk = vec![start];
    // Of every node of the walk but the last what may follow it and was not tried.
    let mut open: Vec<Vec<N>> = Vec::with_capacity(length);
    let mut asked = 0;
    while walk.len() < length {
        if open.len() < walk.len() {
            open.push(next(&walk));
        }
        let (Some(here), Some(untried)) = (walk.last(), open.last_mut()) else { return Err(NoWalk::None) };
        if untried.is_empty() {
            open.pop();
            walk.pop();
            if walk.is_empty() {
                return Err(NoWalk::None);
            }
            continue;
        }
        if asked == most {
            return Err(NoWalk::Asked(most));
        }
        asked += 1;
        let drawn = ((unit(random) * untried.len() as f64) as usize).min(untried.len() - 1);
        let to = untried.swap_remove(drawn);
        if step(here, &to) {
            walk.push(to);
        }
    }
    Ok(walk)
}

#[cfg(feature = "unit-tests")]
mod tests {
    use std::collections::BTreeMap;

    use super::*;
    use crate::math::random::stream;

    /// Numbers below `n` that the walk has not.
    fn others(n: u32) -> impl Fn(&[u32]) -> Vec<u32> {
        move |walk| (0..n).filter(|to| !walk.contains(to)).collect()
    }

    #[test]
    fn where_every_step_is_possible_all_walks_come_alike() {
        let mut random = stream(3);
        let mut counts: BTreeMap<Vec<u32>, u32> = BTreeMap::new();
        let draws = 24_000;
        for _ in 0..draws {
            let walk = stroll(0, 4, others(5), |_, _| true, 10, &mut random).unwrap();
            *counts.entry(walk).or_default() += 1;
        }
        // 4 · 3 · 2 walks from node 0: χ² of 23 degrees of freedom is below 49.7 in 999 of 1000 cases.
        assert_eq!(counts.len(), 24);
        let expected = f64::from(draws) / 24.0;
        let chi: f64 = counts.values().map(|count| (f64::from(*count) - expected).powi(2) / expected).sum();
        assert!(chi < 49.7, "{chi}");
    }

    #[test]
    fn dead_ends_are_left_and_what_has_no_walk_says_so() {
        // 0 → 1 → 2 → 3 is the only walk of four; 4 and 5 lead nowhere.
        let step = |from: &u32, to: &u32| matches!((from, to), (0, 1 | 4 | 5) | (1, 2 | 5) | (2, 3));
        let mut random = stream(5);
        for _ in 0..50 {
            assert_eq!(stroll(0, 4, others(6), step, 1000, &mut random), Ok(vec![0, 1, 2, 3]));
        }
        assert_eq!(stroll(0, 5, others(6), step, 1000, &mut random), Err(NoWalk::None));
        assert_eq!(stroll(0, 5, others(6), step, 3, &mut random), Err(NoWalk::Asked(3)));
        assert_eq!(stroll(7, 1, others(6), step, 0, &mut random), Ok(vec![7]));
    }

    #[test]
    fn a_branching_walk_is_drawn_step_by_step() {
        // From 0 to 1, of which one walk goes on, or to 2, of which four do: half of the draws go through 1.
        let next = |walk: &[u32]| match walk.last() {
            Some(0) => vec![1, 2],
            Some(1) => vec![3],
            _ => vec![4, 5, 6, 7],
        };
        let mut random = stream(7);
        let through = (0..4000).filter(|_| stroll(0, 3, next, |_, _| true, 10, &mut random).unwrap()[1] == 1).count();
        // Four standard errors of a half: 126.
        assert!(through.abs_diff(2000) < 126, "{through}");
    }
}
