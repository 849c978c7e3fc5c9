//! Costs of triples, and what a given order of points costs at most.

use thiserror::Error;

use crate::search::heaviest::{Arcs, Ends};

/// Stands for what cannot be: two of it, or one and any sum of costs, add up to less than nothing.
pub(super) const IMPOSSIBLE: i64 = i64::MIN / 4;

/// More points than a table of triples has room for: n³ numbers in 1 GB.
pub const MOST_TRIPLE_POINTS: usize = 500;

/// What is searched.
///
/// Arcs and triples are of the same points.
#[derive(Debug, Clone, Copy)]
pub(super) struct Question<'a> {
    pub(super) arcs: &'a Arcs,
    pub(super) triples: &'a Triples,
    pub(super) ends: Ends,
}

impl Question<'_> {
    /// n, home among them where there is one.
    pub(super) fn points(&self) -> usize {
        self.arcs.points()
    }

    /// The one of an order and its reverse that stands for both, where nothing tells directions apart.
    pub(super) fn one_way(&self, mut order: Vec<usize>) -> Vec<usize> {
        let turns = self.arcs.symmetric() && self.triples.symmetric() && self.ends == Ends::default();
        if turns && order.first() > order.last() {
            order.reverse();
        }
        order
    }

    /// Whether an order begins and ends where it may.
    pub(super) fn allows(&self, order: &[usize]) -> bool {
        order.first().is_some_and(|point| self.ends.may_start(*point))
            && order.last().is_some_and(|point| self.ends.may_end(*point))
    }
}

/// Triples that are no problem.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum TriplesMistake {
    /// More points than can be held.
    #[error(
        "{points} points, must be at most {MOST_TRIPLE_POINTS} where moves pass points: the table of triples has points³ costs"
    )]
    TooMany {
        /// Points asked for.
        points: usize,
    },
    /// A triple of points that do not exist, or in which a point comes twice.
    #[error("the triple {from}→{via}→{to}, must be of three different points less than {points}")]
    Points {
        /// Where it starts.
        from: usize,
        /// What it passes.
        via: usize,
        /// Where it ends.
        to: usize,
        /// Points.
        points: usize,
    },
    /// A cost below 0, or so large that sums could leave 64-bit integers.
    #[error("cost {cost} of the triple {from}→{via}→{to}, must be 0 … {bound}")]
    Cost {
        /// Where it starts.
        from: usize,
        /// What it passes.
        via: usize,
        /// Where it ends.
        to: usize,
        /// Its cost.
        cost: i64,
        /// The largest cost allowed.
        bound: i64,
    },
}

/// Costs of triples: t(i, k, j) ≥ 0 of the move from i through k to j, or no such move.
///
/// n³ numbers of 8 bytes: 1 GB at 500 points.
///
/// `largest` and symmetry are known from the beginning. Costs are in the unit of the [`Arcs`] beside them.
///
/// ```
/// use hairpin::search::heaviest::{Arcs, HeaviestSettings, Triples, heaviest_with_triples};
///
/// // Over three points straight on costs 2; an arc through the middle one is worth 5.
/// let arcs = Arcs::new(3, &[None, Some(1), None, None, None, Some(1), None, None, None])?;
/// let triples = Triples::new(3, &[([0, 1, 2], 5)])?;
/// assert_eq!(triples.best_on(&arcs, &[0, 1, 2]), Some((5, vec![1]))); // the point at place 1 is passed
/// let answer = heaviest_with_triples(&arcs, &triples, &HeaviestSettings::default(), &|| false)?;
/// assert!(answer.proven && answer.paths[0] == (5, vec![0, 1, 2]) && answer.passed[0] == [1]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Triples {
    points: usize,
    /// t(i, k, j) at (i·points + k)·points + j.
    costs: Vec<i64>,
    largest: i64,
    symmetric: bool,
}

impl Triples {
    /// Of `moves` \[from, via, to\] with their costs, among `points` points.
    ///
    /// A move that is given twice has its last cost. The largest cost allowed is that of [`Arcs`].
    ///
    /// # Errors
    /// Too many points, points that do not exist or come twice, a cost that is negative or whose sums could overflow.
    pub fn new(points: usize, moves: &[([usize; 3], i64)]) -> Result<Self, TriplesMistake> {
        if points > MOST_TRIPLE_POINTS {
            return Err(TriplesMistake::TooMany { points });
        }
        let bound = i64::MAX / (32 * (points as i64 + 2));
        let mut costs = vec![IMPOSSIBLE; points * points * points];
        for &([from, via, to], cost) in moves {
            if from.max(via).max(to) >= points || from == via || via == to || from == to {
                return Err(TriplesMistake::Points { from, via, to, points });
            }
            if !(0..=bound).contains(&cost) {
                return Err(TriplesMistake::Cost { from, via, to, cost, bound });
            }
            costs[(from * points + via) * points + to] = cost;
        }
        let mut triples = Self { points, costs, largest: 0, symmetric: true };
        triples.largest = moves.iter().map(|(_, cost)| *cost).max().unwrap_or(0);
        triples.symmetric =
            moves.iter().all(|([from, via, to], _)| triples.raw(*from, *via, *to) == triples.raw(*to, *via, *from));
        Ok(triples)
    }

    /// Cost of the move from `from` through `via` to `to`.
    ///
    /// `None` also for points that do not exist.
    pub fn cost(&self, from: usize, via: usize, to: usize) -> Option<i64> {
        let known = from.max(via).max(to) < self.points;
        known.then(|| self.raw(from, via, to)).filter(|cost| *cost >= 0)
    }

    /// The most that the points cost in this order, and the places in it of the points that are passed on the way;
    /// `None` where there is no way.
    ///
    /// best_k = max(best_{k−1} + c(p_{k−1}, p_k), best_{k−2} + t(p_{k−2}, p_{k−1}, p_k)); of equals the arc.
    ///
    /// Linear in the order's length.
    pub fn best_on(&self, arcs: &Arcs, order: &[usize]) -> Option<(i64, Vec<usize>)> {
        if order.is_empty() || order.iter().any(|point| *point >= self.points) {
            return None;
        }
        let mut best = vec![0i64; order.len()];
        for k in 1..order.len() {
            let straight = best[k - 1] + possible(arcs, order[k - 1], order[k]);
            let through = if k > 1 { best[k - 2] + self.raw(order[k - 2], order[k - 1], order[k]) } else { IMPOSSIBLE };
            best[k] = at_least_zero(straight.max(through));
        }
        let cost = best[order.len() - 1];
        if cost < 0 {
            return None;
        }
        let (mut passed, mut k) = (Vec::new(), order.len() - 1);
        while k > 0 {
            if best[k] == best[k - 1] + possible(arcs, order[k - 1], order[k]) {
                k -= 1;
            } else {
                passed.push(k - 1);
                k -= 2;
            }
        }
        passed.reverse();
        Some((cost, passed))
    }

    /// What [`Self::best_on`] costs, where every arc that is missing costs −`fine` and makes the order one without a
    /// way.
    ///
    /// The better of both cuts at each point, by value, and of equals the arc; whether it is a way goes with the cut
    /// that was taken. A missing triple is never fined, as its two arcs can stand for it. O(length).
    pub(super) fn worth(&self, arcs: &Arcs, order: &[usize], fine: i64) -> Worth {
        let (mut before, mut last) = (Worth { value: IMPOSSIBLE, way: false }, Worth { value: 0, way: true });
        for k in 1..order.len() {
            let straight = match arcs.cost(order[k - 1], order[k]) {
                Some(cost) => Worth { value: last.value + cost, ..last },
                None => Worth { value: last.value - fine, way: false },
            };
            let triple = if k > 1 { self.raw(order[k - 2], order[k - 1], order[k]) } else { IMPOSSIBLE };
            let through = if triple < 0 { IMPOSSIBLE } else { before.value + triple };
            (before, last) =
                (last, if through > straight.value { Worth { value: through, ..before } } else { straight });
        }
        last
    }

    /// n: points that triples may name.
    pub(super) fn points(&self) -> usize {
        self.points
    }

    /// t(from, via, to), [`IMPOSSIBLE`] without such a move.
    pub(super) fn raw(&self, from: usize, via: usize, to: usize) -> i64 {
        self.costs[(from * self.points + via) * self.points + to]
    }

    /// t(from, via, ·).
    pub(super) fn row(&self, from: usize, via: usize) -> &[i64] {
        &self.costs[(from * self.points + via) * self.points..][..self.points]
    }

    /// The largest cost, 0 without triples.
    pub(super) fn largest(&self) -> i64 {
        self.largest
    }

    /// Whether t(i, k, j) = t(j, k, i) everywhere.
    pub(super) fn symmetric(&self) -> bool {
        self.symmetric
    }
}

/// What an order costs, fines and all.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Worth {
    /// Cost of the best cut, less the fines.
    pub(super) value: i64,
    /// Whether no arc of it is missing.
    pub(super) way: bool,
}

/// c(from, to), [`IMPOSSIBLE`] without the arc.
pub(super) fn possible(arcs: &Arcs, from: usize, to: usize) -> i64 {
    arcs.cost(from, to).unwrap_or(IMPOSSIBLE)
}

/// Sums with something impossible in them are below zero: one number stands for them all.
pub(super) fn at_least_zero(value: i64) -> i64 {
    if value < 0 { IMPOSSIBLE } else { value }
}
