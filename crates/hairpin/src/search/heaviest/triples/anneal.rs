//! Good paths of many points by simulated annealing over orders: what is turned, moved, exchanged, put in and left out
//! is drawn.
//!
//! S. Kirkpatrick, C. D. Gelatt, M. P. Vecchi, *Optimization by simulated annealing*, Science 220 (1983).
//!
//! Each change is judged by the best cut of the whole order, O(length); four chains beside each other, from named
//! seeds, so that threads change nothing.

use std::collections::BTreeSet;

use rand::Rng;
use rayon::prelude::*;

use super::problem::Question;
use crate::math::random::{Stream, named_seed, stream, unit};

/// Chains that are annealed beside each other, by the temperatures that they begin at, as shares of the largest cost:
/// the hot ones forget where they began, the others mend it.
///
/// T(done) = largest cost · hot · (COLD/hot)^done, done from 0 to 1: the chains end alike, whatever they begin at.
const CHAINS: [f64; 4] = [0.3, 0.1, 0.05, 0.05];
/// The temperature at the end.
const COLD: f64 = 2e-3;
/// Steps of a chain per point, in its longest round.
const STEPS: f64 = 20_000.0;
/// Steps between two looks at the clock.
const STEPS_A_LOOK: u64 = 256;
/// The heaviest orders that are met when chains are annealed from `first`, the heaviest first, at most `count`: `first`
/// is among them or worse than they are. `share` of the full number of steps is taken; `seed` is the round's own.
///
/// Four chains of `share` · 20 000 steps a point; a step costs O(n). Which chain met an order does not matter: they are
/// put together in the order of cost, then of points.
pub(super) fn annealed(
    question: &Question,
    first: &[usize],
    count: usize,
    (share, seed): (f64, u64),
    stop: &(dyn Fn() -> bool + Sync),
) -> Vec<(i64, Vec<usize>)> {
    let steps = (share * STEPS * question.points() as f64).ceil() as u64;
    let chains = CHAINS.par_iter().enumerate().map(|(chain, hot)| {
        let mut random = stream(named_seed(seed, "anneal", chain as u64));
        chain_of(question, first, count, (steps, *hot), &mut random, stop)
    });
    let met: Vec<BTreeSet<(i64, Vec<usize>)>> = chains.collect();
    let met: BTreeSet<(i64, Vec<usize>)> =
        met.into_iter().flatten().map(|(cost, order)| (cost, question.one_way(order))).collect();
    met.into_iter().rev().take(count).collect()
}

/// One chain of Metropolis steps: worse by d is taken with probability e^(−d/T), T falling geometrically from `hot` to
/// [`COLD`] times the largest cost. Orders without a way are passed through at a fine of that cost, never kept.
fn chain_of(
    question: &Question,
    first: &[usize],
    count: usize,
    (steps, hot): (u64, f64),
    random: &mut Stream,
    stop: &(dyn Fn() -> bool + Sync),
) -> BTreeSet<(i64, Vec<usize>)> {
    let Question { arcs, triples, .. } = question;
    let mut now = Order { points: question.points(), path: first.to_vec() };
    // Sparse graphs hang together by orders that have no way: they are gone through, and not kept.
    let fine = arcs.largest().max(triples.largest()).max(1);
    let mut worth = triples.worth(arcs, first, fine).value;
    let mut best = BTreeSet::from([(worth, first.to_vec())]);
    let mut next = now.clone();
    for step in 0..steps {
        if step % STEPS_A_LOOK == 0 && stop() {
            break;
        }
        next.path.clone_from(&now.path);
        next.change(random);
        if !question.allows(&next.path) {
            continue;
        }
        let found = triples.worth(arcs, &next.path, fine);
        let done = step as f64 / steps as f64;
        let temperature = fine as f64 * hot * libm::pow(COLD / hot, done);
        if found.value >= worth || unit(random) < libm::exp((found.value - worth) as f64 / temperature) {
            worth = found.value;
            now.path.clone_from(&next.path);
            let lightest = best.first().map_or(i64::MIN, |(cost, _)| *cost);
            if found.way && (best.len() < count || worth > lightest) {
                best.insert((worth, now.path.clone()));
                if best.len() > count {
                    best.pop_first();
                }
            }
        }
    }
    best
}

/// An order of some of the points.
#[derive(Debug, Clone)]
struct Order {
    points: usize,
    path: Vec<usize>,
}

impl Order {
    /// One change of it, drawn; sometimes none.
    ///
    /// A point is drawn. If it is in the order: left out (1 of 8), a stretch turned (3 of 8), two exchanged (1 of 8),
    /// else up to three from it on moved elsewhere; if not, put in the place of another or between two. Nothing is
    /// drawn again if it does not change the order.
    fn change(&mut self, random: &mut Stream) {
        let length = self.path.len();
        let below = |bound: usize, random: &mut Stream| (random.next_u64() % bound.max(1) as u64) as usize;
        let point = below(self.points, random);
        let (a, b) = (below(length, random), below(length, random));
        if let Some(place) = self.path.iter().position(|known| *known == point) {
            match below(8, random) {
                0 if length > 1 => drop(self.path.remove(place)),
                1..=3 => self.path[a.min(b)..=a.max(b)].reverse(),
                4 => self.path.swap(a, b),
                _ => {
                    // Up to three points in a row go elsewhere, turned or not.
                    let end = (place + 1 + below(3, random)).min(length);
                    let mut taken: Vec<usize> = self.path.drain(place..end).collect();
                    if below(2, random) == 0 {
                        taken.reverse();
                    }
                    let to = below(self.path.len() + 1, random);
                    self.path.splice(to..to, taken);
                }
            }
        } else if below(2, random) == 0 {
            self.path[a] = point;
        } else {
            let to = below(length + 1, random);
            self.path.insert(to, point);
        }
    }
}
