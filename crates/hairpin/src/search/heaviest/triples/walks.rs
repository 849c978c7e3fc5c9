//! A bound for any number of points: walks that may come back, at a price for every point.
//!
//! With prices λ ≥ 0 every path costs at most Σλ plus the heaviest walk of at most n points, where each visit of a point i costs λ_i; a walk may come to a
//! point several times, so that f(m, j) = max(max_i f(m−1, i) + c(i, j), max_{i, k} f(m−2, i) + t(i, k, j) − λ_k) − λ_j finds it. Prices go along the
//! subgradient 1 − visits. After N. Christofides, A. Mingozzi, P. Toth, *State-space relaxation procedures for the computation of bounds to routing
//! problems*, Networks 11 (1981).

use super::problem::{IMPOSSIBLE, Triples, possible};
use crate::search::heaviest::{Arcs, Ends};

/// Additions that all steps together may take, about.
const WORK: usize = 8_000_000_000;
/// Fewest and most steps of the prices.
const STEPS: [usize; 2] = [20, 2000];
/// Steps without a better bound after which they get shorter.
const PATIENCE: usize = 30;
/// Costs are scaled up to about so much: prices are whole numbers.
const FINE: i64 = 1 << 24;

/// No path of at most all points costs more. `reached` is what one is known to cost; the best prices so far are the answer where `stop` ends it, and
/// before the first step what n − 1 of the largest costs come to.
pub(super) fn bound(arcs: &Arcs, triples: &Triples, ends: Ends, reached: i64, stop: &(dyn Fn() -> bool + Sync)) -> i64 {
    let walks = Walks::new(arcs, triples, ends);
    let n = walks.points;
    let longest = n.saturating_sub(1) as i64;
    // A triple stands for two arcs.
    let simple = longest * walks.largest.max((triples.largest() + 1) / 2);
    let steps = (WORK / (n * (n * n + walks.triples.len())).max(1)).clamp(STEPS[0], STEPS[1]);
    let scale = (FINE / (walks.largest.max(triples.largest()) + 1)).max(1);
    let goal = (reached.max(0) * scale) as f64;
    let (mut prices, mut best, mut best_prices) = (vec![0i64; n], simple.saturating_mul(scale), vec![0i64; n]);
    let (mut length, mut waited) = (1.0, 0);
    for _ in 0..steps {
        if stop() {
            break;
        }
        let (value, visits) = walks.heaviest(&prices, scale);
        if value < best {
            (best, waited) = (value, 0);
            best_prices.clone_from(&prices);
        } else {
            waited += 1;
        }
        if waited == PATIENCE {
            (length, waited) = (0.5 * length, 0);
            prices.clone_from(&best_prices);
            continue;
        }
        let against: i64 = visits.iter().map(|count| (count - 1) * (count - 1)).sum();
        if against == 0 || best / scale <= reached {
            break;
        }
        let step = length * (value as f64 - goal).max(scale as f64) / against as f64;
        for (price, count) in prices.iter_mut().zip(&visits) {
            *price = (*price + (step * (count - 1) as f64).round() as i64).max(0);
        }
    }
    best.div_euclid(scale).max(reached)
}

/// What walks go by.
struct Walks<'a> {
    arcs: &'a Arcs,
    ends: Ends,
    points: usize,
    /// \[from, via, to\] with their costs, ordered by where they end.
    triples: Vec<([usize; 3], i64)>,
    largest: i64,
}

impl<'a> Walks<'a> {
    fn new(arcs: &'a Arcs, triples: &Triples, ends: Ends) -> Self {
        let n = arcs.points();
        let mut list = Vec::new();
        for to in 0..n {
            for from in 0..n {
                let vias = (0..n).filter_map(|via| Some(([from, via, to], triples.cost(from, via, to)?)));
                list.extend(vias);
            }
        }
        let largest = (0..n * n).filter_map(|index| arcs.cost(index / n, index % n)).max().unwrap_or(0);
        Self { arcs, ends, points: n, triples: list, largest }
    }

    /// Σλ plus the heaviest walk's cost, times `scale`, and how often it comes to each point.
    fn heaviest(&self, prices: &[i64], scale: i64) -> (i64, Vec<i64>) {
        let n = self.points;
        // f(m, ·), and where each came from: the point before, and the one on the way.
        let mut best = vec![IMPOSSIBLE; (n + 1) * n];
        let mut came = vec![(usize::MAX, usize::MAX); (n + 1) * n];
        for start in (0..n).filter(|point| self.ends.may_start(*point)) {
            best[n + start] = -prices[start];
        }
        let (mut top, mut at) = (IMPOSSIBLE, (0, 0));
        for m in 1..=n {
            if m > 1 {
                self.step(m, prices, scale, &mut best, &mut came);
            }
            for last in (0..n).filter(|point| self.ends.may_end(*point)) {
                if best[m * n + last] > top {
                    (top, at) = (best[m * n + last], (m, last));
                }
            }
        }
        let sum: i64 = prices.iter().sum();
        let mut visits = vec![0; n];
        let (mut m, mut last) = at;
        while m > 0 {
            visits[last] += 1;
            let (before, via) = came[m * n + last];
            if before == usize::MAX {
                break;
            }
            if via == usize::MAX {
                m -= 1;
            } else {
                visits[via] += 1;
                m -= 2;
            }
            last = before;
        }
        // Without any walk there is no path either: nothing is a bound.
        (if top > IMPOSSIBLE / 2 { sum + top } else { 0 }, visits)
    }

    /// f(m, ·) of f(m−1, ·) and f(m−2, ·).
    fn step(&self, m: usize, prices: &[i64], scale: i64, best: &mut [i64], came: &mut [(usize, usize)]) {
        let n = self.points;
        let (done, row) = best.split_at_mut(m * n);
        let (row, came) = (&mut row[..n], &mut came[m * n..][..n]);
        let (two, one) = (&done[(m - 2) * n..][..n], &done[(m - 1) * n..][..n]);
        for (to, (value, from)) in row.iter_mut().zip(came.iter_mut()).enumerate() {
            for (before, so_far) in one.iter().enumerate().filter(|(before, _)| *before != to) {
                let arc = possible(self.arcs, before, to);
                if arc >= 0 && so_far + scale * arc > *value {
                    (*value, *from) = (so_far + scale * arc, (before, usize::MAX));
                }
            }
        }
        for ([before, via, to], cost) in &self.triples {
            let reached = two[*before] + scale * cost - prices[*via];
            if reached > row[*to] {
                (row[*to], came[*to]) = (reached, (*before, *via));
            }
        }
        for (value, price) in row.iter_mut().zip(prices) {
            *value = if *value > IMPOSSIBLE / 2 { *value - price } else { IMPOSSIBLE };
        }
    }
}
