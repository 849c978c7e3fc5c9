//! The reachability graph: which moves between the points of a cloud are possible, at what cost, and why the others are
//! not.

use super::refusal::Refusal;

/// For every ordered pair of N points: possible at a cost, or refused with a reason.
///
/// n² entries; a reason is a number into a list of refusals.
///
/// What [`crate::search::heaviest`] takes is its [`matrix`](Self::matrix). Directed where moves are (joint mode), alike
/// both ways in Cartesian mode.
#[derive(Debug, Clone, PartialEq)]
pub struct ReachabilityGraph {
    points: usize,
    /// Row = from; 0 is free, k is `refusals[k − 1]`.
    reasons: Vec<u32>,
    refusals: Vec<Refusal>,
    /// Row = from; of refused moves 0.
    costs: Vec<i64>,
    /// Questions to the obstacles, all pairs together.
    queries: u64,
    /// What one unit of `costs` is.
    unit: &'static str,
}

impl ReachabilityGraph {
    /// Of `points` points, with the reason of every ordered pair, row = from: 0 for free, k for `refusals[k − 1]`.
    pub(super) fn new(points: usize, reasons: Vec<u32>, refusals: Vec<Refusal>, queries: u64) -> Self {
        assert!(reasons.len() == points * points, "a reason for every ordered pair");
        Self { points, reasons, refusals, costs: vec![0; points * points], queries, unit: "µm" }
    }

    /// Sets the costs of the moves that are possible.
    ///
    /// `cost(from, to)` ≥ 0, asked once for each possible move, row by row.
    pub fn with_costs(mut self, unit: &'static str, mut cost: impl FnMut(usize, usize) -> i64) -> Self {
        self.unit = unit;
        for from in 0..self.points {
            for to in 0..self.points {
                if self.is_free(from, to) {
                    self.costs[from * self.points + to] = cost(from, to);
                }
            }
        }
        self
    }

    /// With other reasons in the place of those that it has: what a part of the cell stands for its caller knows.
    pub fn with_reasons(mut self, other: impl Fn(Refusal) -> Refusal) -> Self {
        self.refusals.iter_mut().for_each(|refusal| *refusal = other(*refusal));
        self
    }

    /// How many points there are.
    pub fn points(&self) -> usize {
        self.points
    }

    /// Whether the move is possible; from a point to itself none is.
    ///
    /// # Panics
    /// If a point does not exist.
    pub fn is_free(&self, from: usize, to: usize) -> bool {
        from != to && self.reasons[from * self.points + to] == 0
    }

    /// Cost of a possible move in [`unit`](Self::unit), ≥ 0.
    ///
    /// `None` of a refused move.
    pub fn cost(&self, from: usize, to: usize) -> Option<i64> {
        self.is_free(from, to).then(|| self.costs[from * self.points + to])
    }

    /// All costs, row = from: what searches take.
    ///
    /// Row = from, n² entries; `None` of refused moves and on the diagonal.
    pub fn matrix(&self) -> Vec<Option<i64>> {
        let pairs = (0..self.points).flat_map(|from| (0..self.points).map(move |to| (from, to)));
        pairs.map(|(from, to)| self.cost(from, to)).collect()
    }

    /// What one unit of a cost is, such as `µm` or `µs`.
    pub fn unit(&self) -> &'static str {
        self.unit
    }

    /// Why a move is refused.
    ///
    /// `None` of a possible move, and of a point to itself.
    pub fn refusal(&self, from: usize, to: usize) -> Option<&Refusal> {
        let reason = self.reasons[from * self.points + to];
        (from != to && reason > 0).then(|| &self.refusals[reason as usize - 1])
    }

    /// Share of the ordered pairs of different points that are possible; 0 with fewer than two points.
    ///
    /// O(n²).
    pub fn density(&self) -> f64 {
        let pairs = self.points * self.points.saturating_sub(1);
        let free =
            (0..self.points).flat_map(|i| (0..self.points).map(move |j| (i, j))).filter(|&(i, j)| self.is_free(i, j));
        if pairs == 0 { 0.0 } else { free.count() as f64 / pairs as f64 }
    }

    /// Questions to obstacles per ordered pair.
    ///
    /// What the filter leaves for intervals shows in it; 0 without pairs.
    pub fn queries_per_pair(&self) -> f64 {
        let pairs = self.points * self.points.saturating_sub(1);
        if pairs == 0 { 0.0 } else { self.queries as f64 / pairs as f64 }
    }
}
