//! Choices that are made one by one, and how near to the best they are known to be.

use std::cmp::Ordering;
use std::collections::{BTreeSet, BinaryHeap};

/// `count` items for Σ weight · (count − 1)/2 + Σ distance over pairs, so that both sums have as many terms: each time
/// the item that adds most to half of the weights and the whole of the distances, which is at least half of the best
/// for distances that are a metric (Borodin, Lee, Ye: Max-sum diversification, monotone submodular functions and
/// dynamic updates, 2012).
///
/// `distances` of an item to each are asked for once for every item that is chosen; of equal gains the first item.
pub(super) fn dispersed(weights: &[f64], distances: impl Fn(usize) -> Vec<f64>, count: usize) -> Vec<usize> {
    // One item has no pairs: its weight alone decides.
    let per_weight = 0.5 * (count.saturating_sub(1)).max(1) as f64;
    let mut gains: Vec<f64> = weights.iter().map(|weight| 0.5 * per_weight * weight).collect();
    let mut left: Vec<usize> = (0..weights.len()).collect();
    let mut chosen = Vec::with_capacity(count);
    while chosen.len() < count {
        let best = left.iter().copied().reduce(|best, item| if gains[item] > gains[best] { item } else { best });
        let Some(best) = best else { break };
        left.retain(|item| *item != best);
        chosen.push(best);
        let distances = distances(best);
        for item in &left {
            gains[*item] += distances[*item];
        }
    }
    chosen
}

/// `count` sets that cover most: each time the one that covers most that is new, of equals the heaviest; at least 1 −
/// 1/e of what the best choice covers (Nemhauser, Wolsey, Fisher: An analysis of approximations for maximizing
/// submodular set functions, 1978).
///
/// Weights 0 … 1. What a set covers that is new only falls: sets wait with what they last had, and only those that
/// could be the best are looked at again (Minoux: Accelerated greedy algorithms for maximizing submodular set
/// functions, 1978).
pub(super) fn covering(sets: &[&BTreeSet<usize>], weights: &[f64], count: usize) -> Vec<usize> {
    let mut covered: BTreeSet<usize> = BTreeSet::new();
    // Weights are 0 … 1: they decide between equals alone. Of equals the first is the greatest here.
    let worth = |item: usize, covered: &BTreeSet<usize>| Waiting {
        gain: sets[item].difference(covered).count() as f64 + 0.5 * weights[item],
        item,
    };
    let mut waiting: BinaryHeap<Waiting> = (0..sets.len()).map(|item| worth(item, &covered)).collect();
    let mut chosen = Vec::with_capacity(count);
    while chosen.len() < count {
        let Some(first) = waiting.pop() else { break };
        let now = worth(first.item, &covered);
        if waiting.peek().is_some_and(|next| *next > now) {
            waiting.push(now);
            continue;
        }
        chosen.push(now.item);
        covered.extend(sets[now.item].iter().copied());
    }
    chosen
}

/// A set that waits to be chosen.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Waiting {
    gain: f64,
    item: usize,
}

impl Eq for Waiting {}

impl Ord for Waiting {
    fn cmp(&self, other: &Self) -> Ordering {
        self.gain.total_cmp(&other.gain).then(other.item.cmp(&self.item))
    }
}

impl PartialOrd for Waiting {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;
    use crate::math::random::{stream, unit};

    /// Every choice of `count` of `n`.
    fn all(n: usize, count: usize) -> Vec<Vec<usize>> {
        (0_u32..1 << n)
            .filter(|bits| bits.count_ones() as usize == count)
            .map(|bits| (0..n).filter(|i| bits >> i & 1 == 1).collect())
            .collect()
    }

    /// Each time the first of those that gain most, all of them asked again.
    fn plainly(n: usize, count: usize, gain: impl Fn(usize, &[usize]) -> f64) -> Vec<usize> {
        let mut chosen = Vec::new();
        for _ in 0..count {
            let left = (0..n).filter(|item| !chosen.contains(item));
            let best = left.reduce(|best, item| if gain(item, &chosen) > gain(best, &chosen) { item } else { best });
            chosen.extend(best);
        }
        chosen
    }

    #[test]
    fn one_item_is_the_heaviest() {
        assert_eq!(dispersed(&[0.2, 0.1, 0.9, 0.9], |_| vec![1.0; 4], 1), [2]);
    }

    #[test]
    fn greedy_keeps_what_it_promises_against_every_choice() {
        let (n, count) = (11, 4);
        for seed in 0..40 {
            let mut random = stream(seed);
            let places: Vec<[f64; 2]> = (0..n).map(|_| [unit(&mut random), unit(&mut random)]).collect();
            let weights: Vec<f64> = (0..n).map(|_| unit(&mut random)).collect();
            let apart = |a: usize, b: usize| {
                ((places[a][0] - places[b][0]).powi(2) + (places[a][1] - places[b][1]).powi(2)).sqrt()
            };
            let value = |items: &[usize]| {
                let pairs = items.iter().enumerate().flat_map(|(i, a)| items[..i].iter().map(move |b| (*a, *b)));
                let weight: f64 = items.iter().map(|item| weights[*item]).sum();
                1.5 * weight + pairs.map(|(a, b)| apart(a, b)).sum::<f64>()
            };
            let best = all(n, count).iter().map(|items| value(items)).fold(0.0, f64::max);
            let row = |one: usize| (0..n).map(|other| apart(one, other)).collect();
            let chosen = dispersed(&weights, row, count);
            assert_eq!(
                chosen,
                plainly(n, count, |item, chosen| 0.75 * weights[item]
                    + chosen.iter().fold(0.0, |sum, other| sum + apart(item, *other))),
                "seed {seed}"
            );
            let found = value(&chosen);
            assert!(found >= 0.5 * best && found <= best + 1e-12, "seed {seed}: {found} of {best}");

            let sets: Vec<BTreeSet<usize>> =
                (0..n).map(|_| (0..6).map(|_| (20.0 * unit(&mut random)) as usize).collect()).collect();
            let sets: Vec<&BTreeSet<usize>> = sets.iter().collect();
            let covers = |items: &[usize]| items.iter().flat_map(|item| sets[*item]).collect::<BTreeSet<_>>().len();
            let best = all(n, count).iter().map(|items| covers(items)).max().unwrap();
            let chosen = covering(&sets, &weights, count);
            let new = |item: usize, chosen: &[usize]| {
                let known: BTreeSet<usize> = chosen.iter().flat_map(|other| sets[*other].clone()).collect();
                sets[item].difference(&known).count() as f64 + 0.5 * weights[item]
            };
            assert_eq!(chosen, plainly(n, count, new), "seed {seed}");
            let found = covers(&chosen);
            assert!(found as f64 >= (1.0 - (-1.0_f64).exp()) * best as f64 && found <= best, "seed {seed}");
        }
    }
}
