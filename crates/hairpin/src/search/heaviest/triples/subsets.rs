//! Dynamic programming over subsets, backwards, and the heaviest orders of points one after the other.
//!
//! b(S, i) is the most that can still come at i when the points of S (i among them) were met:
//! b(S, i) = max(0 where a path may end in i, max_j c(i, j) + b(S ∪ j, j), max_{k, j} t(i, k, j) + b(S ∪ k ∪ j, j)).
//!
//! Held and Karp's recursion with moves of two lengths. Sets are visited from the largest down, so that both S ∪ j and
//! S ∪ k ∪ j are known; O(2ⁿ n³) at most, the inner loop a row of t.

use std::collections::BinaryHeap;

use super::problem::{IMPOSSIBLE, Question, at_least_zero, possible};

/// Sets of points between two looks at the clock.
const SETS_A_LOOK: usize = 1024;

/// b(S, i) for all S and i in S.
pub(super) struct Subsets<'a> {
    question: Question<'a>,
    points: usize,
    best: Vec<i64>,
}

/// Bytes that the table takes: 2ⁿ n numbers.
pub(super) fn table_bytes(points: usize) -> u128 {
    (1u128 << points.min(100)) * points as u128 * 8
}

impl<'a> Subsets<'a> {
    /// Fills the table; `None` if `stop` ended it.
    ///
    /// `after` holds b(S ∪ {via, to}, to) for all ordered pairs of points outside S, so that the inner loop of every
    /// last point runs along one row of triples.
    pub(super) fn new(question: Question<'a>, stop: &(dyn Fn() -> bool + Sync)) -> Option<Self> {
        let Question { arcs, triples, ends } = question;
        let n = question.points();
        let mut table = Self { question, points: n, best: vec![IMPOSSIBLE; (1 << n) * n] };
        // What is left when the triple's last two points are met, for all pairs of points that are open.
        let mut after = vec![IMPOSSIBLE; n * n];
        for set in (1..1usize << n).rev() {
            if set % SETS_A_LOOK == 0 && stop() {
                return None;
            }
            let open: Vec<usize> = (0..n).filter(|point| set >> point & 1 == 0).collect();
            for (a, &via) in open.iter().enumerate() {
                for (b, &to) in open.iter().enumerate().filter(|(_, to)| **to != via) {
                    after[a * n + b] = table.rest(set | 1 << via | 1 << to, to);
                }
            }
            for last in (0..n).filter(|point| set >> point & 1 == 1) {
                let mut best = if ends.may_end(last) { 0 } else { IMPOSSIBLE };
                for (a, &next) in open.iter().enumerate() {
                    best = best.max(possible(arcs, last, next) + table.rest(set | 1 << next, next));
                    let (row, after) = (triples.row(last, next), &after[a * n..]);
                    for (b, &to) in open.iter().enumerate().filter(|(b, _)| *b != a) {
                        best = best.max(row[to] + after[b]);
                    }
                }
                table.best[set * n + last] = at_least_zero(best);
            }
        }
        Some(table)
    }

    /// b(`set`, `last`); [`IMPOSSIBLE`] where no allowed end can be reached.
    fn rest(&self, set: usize, last: usize) -> i64 {
        self.best[set * self.points + last]
    }

    /// The heaviest `count` orders of points with what they cost, pairwise different, backwards being the same order
    /// where nothing tells directions apart; and whether `stop` did not end it.
    ///
    /// Beginnings are looked at in the order of what they can come to, which the table knows exactly.
    pub(super) fn heaviest(&self, count: usize, stop: &(dyn Fn() -> bool + Sync)) -> (Vec<(i64, Vec<usize>)>, bool) {
        let mut found: Vec<(i64, Vec<usize>)> = Vec::new();
        let starts = (0..self.points).filter(|point| self.question.ends.may_start(*point));
        let mut open: BinaryHeap<Beginning> = starts.filter_map(|point| self.beginning(None, point)).collect();
        while let Some(top) = open.pop() {
            if top.whole {
                let order = self.question.one_way(top.order);
                if !found.iter().any(|(_, known)| *known == order) {
                    found.push((top.bound, order));
                }
                if found.len() == count {
                    break;
                }
                if stop() {
                    return (found, false);
                }
                continue;
            }
            let last = top.order[top.order.len() - 1];
            if self.question.ends.may_end(last) && top.ended >= 0 {
                open.push(Beginning { bound: top.ended, whole: true, ..top.clone() });
            }
            let next = (0..self.points).filter(|point| top.set >> point & 1 == 0);
            open.extend(next.filter_map(|point| self.beginning(Some(&top), point)));
        }
        (found, true)
    }

    /// `before` and one point more; `None` where it leads nowhere.
    ///
    /// ```text
    /// ended(p·j)   = max(ended(p) + c(last, j),  passing(p) + t(earlier, last, j))
    /// passing(p·j) = ended(p)
    /// ```
    fn beginning(&self, before: Option<&Beginning>, point: usize) -> Option<Beginning> {
        let Some(before) = before else {
            let bound = self.bound(1 << point, None, point, 0, IMPOSSIBLE);
            let (order, set) = (vec![point], 1 << point);
            return (bound >= 0).then_some(Beginning {
                bound,
                order,
                set,
                ended: 0,
                passing: IMPOSSIBLE,
                whole: false,
            });
        };
        let (set, last) = (before.set | 1 << point, before.order[before.order.len() - 1]);
        let earlier = before.order.len().checked_sub(2).map(|place| before.order[place]);
        let through =
            earlier.map_or(IMPOSSIBLE, |earlier| before.passing + self.question.triples.raw(earlier, last, point));
        let ended = at_least_zero(through.max(before.ended + possible(self.question.arcs, last, point)));
        let passing = before.ended;
        let bound = self.bound(set, Some(last), point, ended, passing);
        let order = before.order.iter().copied().chain([point]).collect();
        (bound >= 0).then_some(Beginning { bound, order, set, ended, passing, whole: false })
    }

    /// What a beginning that ends in `earlier`, `last` can come to.
    ///
    /// max(`ended` + b(S, last), `passing` + max_j t(earlier, last, j) + b(S ∪ j, j)): exact, so that the first whole
    /// order that comes off the heap is the heaviest.
    fn bound(&self, set: usize, earlier: Option<usize>, last: usize, ended: i64, passing: i64) -> i64 {
        let open = (0..self.points).filter(|point| set >> point & 1 == 0);
        let through = earlier.map_or(IMPOSSIBLE, |earlier| {
            let row = self.question.triples.row(earlier, last);
            passing + open.map(|to| row[to] + self.rest(set | 1 << to, to)).max().unwrap_or(IMPOSSIBLE).max(IMPOSSIBLE)
        });
        through.max(ended + self.rest(set, last))
    }
}

/// An order of points that may go on.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Beginning {
    /// What it can come to; where it is whole, what it costs.
    bound: i64,
    order: Vec<usize>,
    set: usize,
    /// The most that it costs if a move ends at its last point.
    ended: i64,
    /// The most if the last point is passed: up to the point before.
    passing: i64,
    /// Whether it goes on no more.
    whole: bool,
}

impl Ord for Beginning {
    /// By what they come to; of equals whole ones, then long ones, then those of small numbers.
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        let key = |one: &Self| (one.bound, one.whole, one.order.len());
        key(self).cmp(&key(other)).then_with(|| other.order.cmp(&self.order))
    }
}

impl PartialOrd for Beginning {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}
