//! Good paths of many points by simulated annealing over orders: what is turned, moved, exchanged, put in and left out is drawn.
//!
//! S. Kirkpatrick, C. D. Gelatt, M. P. Vecchi, *Optimization by simulated annealing*, Science 220 (1983).

use std::collections::BTreeSet;

use rand::Rng;
use rayon::prelude::*;

use super::problem::Triples;
use crate::math::random::{Stream, named_seed, stream, unit};
use crate::search::heaviest::{Arcs, Ends};

/// Chains that are annealed beside each other.
const CHAINS: u64 = 4;
/// Steps of a chain per point.
const STEPS: u64 = 30_000;
/// Steps between two looks at the clock.
const STEPS_A_LOOK: u64 = 256;
/// Temperatures at the beginning and at the end, as shares of the largest cost.
const TEMPERATURES: [f64; 2] = [0.3, 1e-3];

/// The heaviest orders that were met, the heaviest first, at most `count`: `first` is among them or worse than they are.
pub(super) fn annealed(
    arcs: &Arcs,
    triples: &Triples,
    ends: Ends,
    (first, count, seed): (&[usize], usize, u64),
    stop: &(dyn Fn() -> bool + Sync),
) -> Vec<(i64, Vec<usize>)> {
    let chains = (0..CHAINS).into_par_iter().map(|chain| {
        let mut random = stream(named_seed(seed, "anneal", chain));
        chain_of(arcs, triples, ends, first, count, &mut random, stop)
    });
    let turns = arcs.symmetric() && triples.symmetric() && ends == Ends::default();
    let met: BTreeSet<(i64, Vec<usize>)> = chains
        .collect::<Vec<_>>()
        .into_iter()
        .flatten()
        .map(|(cost, mut order)| {
            if turns && order.first() > order.last() {
                order.reverse();
            }
            (cost, order)
        })
        .collect();
    met.into_iter().rev().take(count).collect()
}

fn chain_of(
    arcs: &Arcs,
    triples: &Triples,
    ends: Ends,
    first: &[usize],
    count: usize,
    random: &mut Stream,
    stop: &(dyn Fn() -> bool + Sync),
) -> BTreeSet<(i64, Vec<usize>)> {
    let steps = STEPS * arcs.points() as u64;
    let mut now = Order { points: arcs.points(), path: first.to_vec() };
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
        let allowed = next.path.first().is_some_and(|point| ends.may_start(*point))
            && next.path.last().is_some_and(|point| ends.may_end(*point));
        if !allowed {
            continue;
        }
        let found = triples.worth(arcs, &next.path, fine);
        let done = step as f64 / steps as f64;
        let temperature = fine as f64 * TEMPERATURES[0] * libm::pow(TEMPERATURES[1] / TEMPERATURES[0], done);
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
