//! The heaviest circulation: the relaxation of paths that may come back to points, solved exactly.
//!
//! Point n is a dummy that closes a path. Choose arcs x_ij ∈ {0, 1} with as many into each point as out of it, at most
//! `visits`, and one out of the dummy and one into it; whether all hang together is left out. With loops x_ii ∈ {0 …
//! visits} of no cost for what a point is not visited this is a transport problem,
//!
//!   max Σ c_ij x_ij,   Σ_j x_ij = s_i,   Σ_i x_ij = s_j,   s = visits (1 of the dummy),
//!
//! whose optimum is whole: successive shortest paths (Ford & Fulkerson; Edmonds & Karp 1972), one a unit. Its prices
//! prove it: for any whole numbers a_i (rows) and b_j (columns) no circulation is heavier than
//!
//!   Σ s_i a_i + Σ s_j b_j + Σ_open (c_ij − a_i − b_j)⁺ + Σ_in (c_ij − a_i − b_j) + Σ_loops visits · (−a_i − b_i)⁺.
//!
//! At most n · visits augmentations of O(n²) each. Integer prices prove optimality, and infeasibility by a bound that
//! falls without end.

use super::problem::{Arcs, Ends, NONE};

/// What a branch says of an arc.
///
/// Arcs that do not exist are out from the beginning.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum State {
    Open,
    In,
    Out,
}

/// Arcs between points and the dummy, n + 1 by n + 1, and what is decided of each.
#[derive(Debug, Clone)]
pub(super) struct Net {
    /// Points and the dummy, which is the last.
    pub(super) nodes: usize,
    /// Times that a path may meet a point, K.
    pub(super) visits: i64,
    costs: Vec<i64>,
    states: Vec<State>,
}

/// A heaviest circulation, or the proof that there is none.
///
/// Prices are kept for both answers: they are the certificate, by [`Net::bound`].
#[derive(Debug, Clone)]
pub(super) struct Circulation {
    /// Its arcs; `None` if there is none.
    pub(super) arcs: Option<Vec<(usize, usize)>>,
    /// Prices of rows, then of columns.
    pub(super) prices: Vec<i64>,
}

impl Net {
    /// Arcs from the dummy to where a path may begin, and to it from where one may end, cost nothing. That sums of them
    /// stay within 64 bits is checked before.
    ///
    /// n + 1 rows and columns; arcs that are missing and the diagonal are out, where the diagonal of a point stands
    /// for its loop.
    pub(super) fn new(arcs: &Arcs, ends: Ends, visits: i64) -> Self {
        let n = arcs.points();
        let nodes = n + 1;
        let mut costs = vec![NONE; nodes * nodes];
        for from in 0..n {
            for to in (0..n).filter(|to| *to != from) {
                costs[from * nodes + to] = arcs.raw(from, to);
            }
            if ends.may_start(from) {
                costs[n * nodes + from] = 0;
            }
            if ends.may_end(from) {
                costs[from * nodes + n] = 0;
            }
        }
        let states = costs.iter().map(|cost| if *cost == NONE { State::Out } else { State::Open }).collect();
        Self { nodes, visits, costs, states }
    }

    /// Number of the point that closes paths.
    pub(super) fn dummy(&self) -> usize {
        self.nodes - 1
    }

    /// What is decided of an arc, O(1).
    pub(super) fn state(&self, (from, to): (usize, usize)) -> State {
        self.states[from * self.nodes + to]
    }

    /// Decides an arc that there is.
    pub(super) fn decide(&mut self, (from, to): (usize, usize), state: State) {
        let index = from * self.nodes + to;
        if self.costs[index] != NONE {
            self.states[index] = state;
        }
    }

    /// Of an arc that there is.
    pub(super) fn cost(&self, (from, to): (usize, usize)) -> i64 {
        self.costs[from * self.nodes + to]
    }

    /// s of a row or a column.
    fn supply(&self, node: usize) -> i64 {
        if node == self.dummy() { 1 } else { self.visits }
    }

    /// The bound of the head of this file.
    ///
    /// Of any prices at all, optimal or not; 128 bits, so that it cannot overflow. O(n²). Below 0 it proves that there
    /// is no circulation, as none costs less than 0.
    pub(super) fn bound(&self, prices: &[i64]) -> i128 {
        let n = self.nodes;
        let price = |index: usize| i128::from(prices[index]);
        let mut bound: i128 = (0..n).map(|node| i128::from(self.supply(node)) * (price(node) + price(n + node))).sum();
        for from in 0..n {
            for to in 0..n {
                let reduced = || i128::from(self.costs[from * n + to]) - price(from) - price(n + to);
                bound += match self.states[from * n + to] {
                    State::Open => reduced().max(0),
                    State::In => reduced(),
                    State::Out if from == to && from != self.dummy() => {
                        i128::from(self.visits) * (-price(from) - price(n + from)).max(0)
                    }
                    State::Out => 0,
                };
            }
        }
        bound
    }

    /// The heaviest circulation that keeps what is decided.
    pub(super) fn heaviest(&self) -> Circulation {
        Transport::new(self).solve()
    }
}

/// Residual capacities; reduced costs c_ij − a_i − b_j are at most 0 where more could be sent, at least 0 where
/// something is.
struct Transport<'a> {
    net: &'a Net,
    sent: Vec<i64>,
    supply: Vec<i64>,
    demand: Vec<i64>,
    prices: Vec<i64>,
    /// Distances of rows, then of columns.
    distance: Vec<i64>,
    before: Vec<usize>,
    done: Vec<bool>,
}

const FAR: i64 = i64::MAX;

impl<'a> Transport<'a> {
    /// Sets out from prices with which no open arc has a positive reduced cost: all b_j = 0, a_i the most in its row.
    fn new(net: &'a Net) -> Self {
        let n = net.nodes;
        let mut supply: Vec<i64> = (0..n).map(|node| net.supply(node)).collect();
        let mut demand = supply.clone();
        for index in (0..n * n).filter(|index| net.states[*index] == State::In) {
            supply[index / n] -= 1;
            demand[index % n] -= 1;
        }
        let mut transport = Self {
            net,
            sent: vec![0; n * n],
            supply,
            demand,
            prices: vec![0; 2 * n],
            distance: vec![FAR; 2 * n],
            before: vec![usize::MAX; 2 * n],
            done: vec![false; 2 * n],
        };
        for from in 0..n {
            let most = (0..n).filter(|to| transport.capacity(from, *to) > 0).map(|to| transport.value(from, to)).max();
            transport.prices[from] = most.unwrap_or(0);
        }
        transport
    }

    /// How much may be sent in all.
    ///
    /// One unit of an open arc, K of a point's loop, nothing where a branch has decided: what is in has been sent
    /// beforehand.
    ///
    /// The dummy has no loop: every circulation passes it once.
    fn capacity(&self, from: usize, to: usize) -> i64 {
        match self.net.state((from, to)) {
            State::Open => 1,
            State::Out if from == to && from != self.net.dummy() => self.net.visits,
            State::In | State::Out => 0,
        }
    }

    /// Cost of an arc; loops have none.
    fn value(&self, from: usize, to: usize) -> i64 {
        if from == to { 0 } else { self.net.costs[from * self.net.nodes + to] }
    }

    /// One shortest augmenting way a unit of supply; with no way left the prices grow into a proof that there is no
    /// circulation.
    fn solve(mut self) -> Circulation {
        let n = self.net.nodes;
        let overfull = (0..n).find(|node| self.supply[*node] < 0);
        if let Some(index) = overfull.or_else(|| (0..n).find(|node| self.demand[*node] < 0).map(|node| n + node)) {
            return self.overfull(index);
        }
        for row in 0..n {
            while self.supply[row] > 0 {
                match self.shortest(row) {
                    Some(column) => self.send(row, column),
                    None => return self.cut_off(),
                }
            }
        }
        let pairs = (0..n).flat_map(|from| (0..n).map(move |to| (from, to)));
        let used = pairs.filter(|(from, to)| {
            from != to && (self.net.state((*from, *to)) == State::In || self.sent[from * n + to] > 0)
        });
        Circulation { arcs: Some(used.collect()), prices: self.prices }
    }

    /// Dijkstra from a row to the nearest column with demand left, over rows (0 … n) and columns (n …).
    ///
    /// Lengths are reduced costs, ≥ 0 as prices keep every arc that could send more at a reduced value ≤ 0 and every
    /// one that could send less at ≥ 0; they then move by what is left to the distance found, which keeps this. O(n²).
    fn shortest(&mut self, row: usize) -> Option<usize> {
        let n = self.net.nodes;
        self.distance.fill(FAR);
        self.before.fill(usize::MAX);
        self.done.fill(false);
        self.distance[row] = 0;
        loop {
            let next = (0..2 * n).filter(|node| !self.done[*node]).min_by_key(|node| self.distance[*node]);
            let node = next.filter(|node| self.distance[*node] < FAR)?;
            self.done[node] = true;
            let here = self.distance[node];
            if node >= n && self.demand[node - n] > 0 {
                // Prices move so that all shortest ways have reduced cost 0.
                for (index, price) in self.prices.iter_mut().enumerate() {
                    let by = here - self.distance[index].min(here);
                    *price += if index < n { -by } else { by };
                }
                return Some(node - n);
            }
            for other in 0..n {
                let (from, to, beyond) = if node < n { (node, other, n + other) } else { (other, node - n, other) };
                let sent = self.sent[from * n + to];
                let free = if node < n { self.capacity(from, to) - sent } else { sent };
                if free <= 0 || self.done[beyond] {
                    continue;
                }
                let reduced = self.value(from, to) - self.prices[from] - self.prices[n + to];
                let there = here + if node < n { -reduced } else { reduced };
                if there < self.distance[beyond] {
                    (self.distance[beyond], self.before[beyond]) = (there, node);
                }
            }
        }
    }

    /// One unit along the way that [`Transport::shortest`] found, backwards over `before`.
    fn send(&mut self, row: usize, column: usize) {
        let n = self.net.nodes;
        self.supply[row] -= 1;
        self.demand[column] -= 1;
        let mut node = n + column;
        while node != row {
            let before = self.before[node];
            if node >= n {
                self.sent[before * n + node - n] += 1;
            } else {
                self.sent[node * n + before - n] -= 1;
            }
            node = before;
        }
    }

    /// More arcs are in at a row or a column than it may have: prices that prove it, for the bound falls as that one's
    /// rises.
    fn overfull(mut self, index: usize) -> Circulation {
        self.prices[index] += self.far();
        Circulation { arcs: None, prices: self.prices }
    }

    /// No way is left from a row with supply: prices that prove it, for all that leads out of what was reached is full.
    /// Its rows' prices fall, its columns' rise, and the bound falls with them.
    fn cut_off(mut self) -> Circulation {
        let (n, far) = (self.net.nodes, self.far());
        for (index, price) in self.prices.iter_mut().enumerate().filter(|(index, _)| self.distance[*index] < FAR) {
            *price += if index < n { -far } else { far };
        }
        Circulation { arcs: None, prices: self.prices }
    }

    /// More than the bound is above 0.
    ///
    /// max(bound, 0) + 1: moving a price by it brings the bound below 0, as it falls by one unit or more for each.
    fn far(&self) -> i64 {
        i64::try_from(self.net.bound(&self.prices).max(0)).map_or(i64::MAX / 8, |bound| bound + 1)
    }
}
