//! A bound for any number of points: walks that may come back, at a price for every point.
//!
//! With prices λ ≥ 0 every path costs at most Σλ plus the heaviest walk of at most n points, where each visit of a
//! point i costs λ_i; a walk may come to a point several times, so that f(m, j) = max(max_i f(m−1, i) + c(i, j),
//! max_{i, k} f(m−2, i) + t(i, k, j) − λ_k) − λ_j finds it. Prices go along the subgradient 1 − visits. After N.
//! Christofides, A. Mingozzi, P. Toth, *State-space relaxation procedures for the computation of bounds to routing
//! problems*, Networks 11 (1981).
//!
//! One step costs n · (arcs + triples) additions; the number of steps is what [`WORK`] of them allow.

use super::problem::{IMPOSSIBLE, Question, possible};

/// Additions that all steps together may take, about.
const WORK: usize = 8_000_000_000;
/// Fewest and most steps of the prices.
const STEPS: [usize; 2] = [20, 2000];
/// Steps without a better bound after which they get shorter.
const PATIENCE: usize = 30;
/// Costs are scaled up to about so much: prices are whole numbers.
const FINE: i64 = 1 << 24;

/// Prices on their way down, and the best bound so far.
pub(super) struct Prices<'a> {
    walks: Walks<'a>,
    /// Costs are times this here.
    scale: i64,
    prices: Vec<i64>,
    best: i64,
    best_prices: Vec<i64>,
    /// Of the next step, and steps since the bound fell.
    length: f64,
    waited: usize,
    steps: usize,
}

impl<'a> Prices<'a> {
    /// Before the first step the bound is what n − 1 of the largest costs come to.
    pub(super) fn new(question: Question<'a>) -> Self {
        let walks = Walks::new(question);
        let n = walks.points;
        // A triple stands for two arcs.
        let (arc, triple) = (walks.largest, question.triples.largest());
        let simple = n.saturating_sub(1) as i64 * arc.max((triple + 1) / 2);
        let scale = (FINE / (arc.max(triple) + 1)).max(1);
        let steps = (WORK / (n * (n * n + walks.triples.len())).max(1)).clamp(STEPS[0], STEPS[1]);
        let (prices, best_prices) = (vec![0; n], vec![0; n]);
        Self { walks, scale, prices, best: simple.saturating_mul(scale), best_prices, length: 1.0, waited: 0, steps }
    }

    /// No path costs more.
    pub(super) fn bound(&self) -> i64 {
        self.best.div_euclid(self.scale)
    }

    /// Takes a `share` of all its steps towards `reached`, which a path is known to cost.
    ///
    /// Polyak's step: length · (bound − goal)/Σ (visits − 1)², down again to the best prices and half the length after
    /// [`PATIENCE`] steps in vain. Ends early where the bound meets `reached`, which is then proven, or where the walk
    /// visits every point once.
    ///
    /// Prices stay whole numbers of 0 and more. A price rises where the walk comes to its point more than once and
    /// falls where it does not come.
    pub(super) fn step(&mut self, share: f64, reached: i64, stop: &(dyn Fn() -> bool + Sync)) {
        let goal = (reached.max(0) * self.scale) as f64;
        for _ in 0..((share * self.steps as f64).ceil() as usize) {
            if stop() || self.bound() <= reached {
                return;
            }
            let (value, visits) = self.walks.heaviest(&self.prices, self.scale);
            if value < self.best {
                (self.best, self.waited) = (value, 0);
                self.best_prices.clone_from(&self.prices);
            } else {
                self.waited += 1;
            }
            if self.waited == PATIENCE {
                (self.length, self.waited) = (0.5 * self.length, 0);
                self.prices.clone_from(&self.best_prices);
                continue;
            }
            let against: i64 = visits.iter().map(|count| (count - 1) * (count - 1)).sum();
            if against == 0 {
                return;
            }
            let step = self.length * (value as f64 - goal).max(self.scale as f64) / against as f64;
            for (price, count) in self.prices.iter_mut().zip(&visits) {
                *price = (*price + (step * (count - 1) as f64).round() as i64).max(0);
            }
        }
    }
}

/// What walks go by.
struct Walks<'a> {
    question: Question<'a>,
    points: usize,
    /// \[from, via, to\] with their costs, ordered by where they end.
    triples: Vec<([usize; 3], i64)>,
    largest: i64,
}

impl<'a> Walks<'a> {
    fn new(question: Question<'a>) -> Self {
        let (arcs, triples, n) = (question.arcs, question.triples, question.points());
        let mut list = Vec::new();
        for to in 0..n {
            for from in 0..n {
                let vias = (0..n).filter_map(|via| Some(([from, via, to], triples.cost(from, via, to)?)));
                list.extend(vias);
            }
        }
        let largest = (0..n * n).filter_map(|index| arcs.cost(index / n, index % n)).max().unwrap_or(0);
        Self { question, points: n, triples: list, largest }
    }

    /// Σλ plus the heaviest walk's cost, times `scale`, and how often it comes to each point.
    ///
    /// O(n · (n² + triples)) additions, n² numbers and as many predecessors.
    fn heaviest(&self, prices: &[i64], scale: i64) -> (i64, Vec<i64>) {
        let n = self.points;
        // f(m, ·), and where each came from: the point before, and the one on the way.
        let mut best = vec![IMPOSSIBLE; (n + 1) * n];
        let mut came = vec![(usize::MAX, usize::MAX); (n + 1) * n];
        for start in (0..n).filter(|point| self.question.ends.may_start(*point)) {
            best[n + start] = -prices[start];
        }
        let (mut top, mut at) = (IMPOSSIBLE, (0, 0));
        for m in 1..=n {
            if m > 1 {
                self.step(m, prices, scale, &mut best, &mut came);
            }
            for last in (0..n).filter(|point| self.question.ends.may_end(*point)) {
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
    ///
    /// `best` and `came` are rows of n numbers, row m of walks of m points; rows m − 1 and m − 2 are known. Row m
    /// begins as impossible.
    fn step(&self, m: usize, prices: &[i64], scale: i64, best: &mut [i64], came: &mut [(usize, usize)]) {
        let n = self.points;
        let (done, row) = best.split_at_mut(m * n);
        let (row, came) = (&mut row[..n], &mut came[m * n..][..n]);
        let (two, one) = (&done[(m - 2) * n..][..n], &done[(m - 1) * n..][..n]);
        for (to, (value, from)) in row.iter_mut().zip(came.iter_mut()).enumerate() {
            for (before, so_far) in one.iter().enumerate().filter(|(before, _)| *before != to) {
                let arc = possible(self.question.arcs, before, to);
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
