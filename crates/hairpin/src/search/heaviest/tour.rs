//! A path as a closed tour through a dummy point, so that both ends move like any other place; points may be left out.
//!
//! An array and its inverse: successors, predecessors and "between" in O(1), turning a stretch in O(its length), of the
//! shorter side where costs are symmetric.

use super::problem::{Arcs, Ends, NONE};

/// Costs between points and the dummy, which is point number n. What must not be driven costs a penalty.
pub(super) struct Table {
    /// Points with the dummy.
    pub(super) size: usize,
    costs: Vec<i64>,
    /// Whether a tour costs as much backwards.
    pub(super) symmetric: bool,
}

impl Table {
    /// The table with the dummy as point n: its arcs cost 0 where a path may begin or end, and a missing arc costs more
    /// than any two arcs bring in, so that no gain is bought with one.
    ///
    /// Of a symmetric table the dummy's arcs are symmetric too: an end that is fixed has the penalty added there, so
    /// that it pays to keep it beside the dummy, whichever side it is on.
    pub(super) fn new(arcs: &Arcs, ends: Ends) -> Self {
        let n = arcs.points();
        // Worth more than any two arcs that a repair could lose.
        let penalty = 2 * arcs.largest() + 1;
        let mut costs = vec![-penalty; (n + 1) * (n + 1)];
        for i in 0..n {
            for j in 0..n {
                if arcs.raw(i, j) != NONE {
                    costs[i * (n + 1) + j] = arcs.raw(i, j);
                }
            }
            if ends.may_end(i) {
                costs[i * (n + 1) + n] = 0;
            }
            if ends.may_start(i) {
                costs[n * (n + 1) + i] = 0;
            }
        }
        // Backwards is as good if the table is symmetric and the ends are alike; a path is then turned in the end.
        // Where one end is fixed, its arc with the dummy is worth having.
        let symmetric = arcs.symmetric();
        if symmetric {
            for i in 0..n {
                let fixed = ends.start == Some(i) || ends.end == Some(i);
                let cost = costs[i * (n + 1) + n].max(costs[n * (n + 1) + i]) + if fixed { penalty } else { 0 };
                costs[i * (n + 1) + n] = cost;
                costs[n * (n + 1) + i] = cost;
            }
        }
        Self { size: n + 1, costs, symmetric }
    }

    /// Below 0 for what is missing, and only for that.
    #[inline]
    pub(super) fn cost(&self, from: u32, to: u32) -> i64 {
        self.costs[from as usize * self.size + to as usize]
    }

    /// n: the number of points.
    pub(super) fn dummy(&self) -> u32 {
        self.size as u32 - 1
    }
}

/// Where a point is that is left out.
const OUT: u32 = u32::MAX;

/// Points in cyclic order, and where each is.
///
/// Points that are left out have no place. The dummy is always in.
#[derive(Clone, PartialEq, Eq)]
pub(super) struct Tour {
    /// Points in the order of the tour, from any of them on.
    pub(super) order: Vec<u32>,
    place: Vec<u32>,
}

impl Tour {
    /// The tour of a path; the dummy comes last.
    pub(super) fn of_path(table: &Table, path: &[usize]) -> Self {
        let order = path.iter().map(|point| *point as u32).chain([table.dummy()]).collect();
        let mut tour = Self { order, place: vec![OUT; table.size] };
        tour.renumber(0);
        tour
    }

    /// The points after the dummy, in order.
    pub(super) fn path(&self, dummy: u32) -> Vec<usize> {
        let at = self.place[dummy as usize] as usize;
        let (head, tail) = self.order.split_at(at);
        tail[1..].iter().chain(head).map(|point| *point as usize).collect()
    }

    /// Without an allocation, once it was as long.
    pub(super) fn copy_from(&mut self, other: &Self) {
        self.order.clone_from(&other.order);
        self.place.copy_from_slice(&other.place);
    }

    /// Points in the tour, the dummy counted.
    pub(super) fn len(&self) -> usize {
        self.order.len()
    }

    /// Whether the point is in the tour, O(1).
    #[inline]
    pub(super) fn has(&self, point: u32) -> bool {
        self.place[point as usize] != OUT
    }

    /// Place in [`Tour::order`] of a point that is in the tour.
    #[inline]
    pub(super) fn at(&self, point: u32) -> usize {
        self.place[point as usize] as usize
    }

    /// Successor, cyclically; of the last point of a path the dummy.
    #[inline]
    pub(super) fn next(&self, point: u32) -> u32 {
        let at = self.at(point) + 1;
        self.order[if at == self.order.len() { 0 } else { at }]
    }

    /// Predecessor, cyclically; of the first point of a path the dummy.
    #[inline]
    pub(super) fn previous(&self, point: u32) -> u32 {
        let at = self.at(point);
        self.order[if at == 0 { self.order.len() - 1 } else { at - 1 }]
    }

    /// Σ c around the tour, penalties included. O(n).
    pub(super) fn total(&self, table: &Table) -> i64 {
        let after = self.order.iter().skip(1).chain(self.order.first());
        self.order.iter().zip(after).map(|(a, b)| table.cost(*a, *b)).sum()
    }

    /// Turns the stretch from `first` to `last` (going forward). If `mirror` allows it and the rest is shorter, turns
    /// the rest, which gives the same tour seen from the other side; returns whether it did.
    pub(super) fn reverse(&mut self, first: u32, last: u32, mirror: bool) -> bool {
        let n = self.order.len();
        let (mut i, mut j) = (self.at(first), self.at(last));
        let mut inside = if j >= i { j - i + 1 } else { j + n - i + 1 };
        let mirrored = mirror && 2 * inside > n;
        if mirrored {
            (i, j) = (if j + 1 == n { 0 } else { j + 1 }, if i == 0 { n - 1 } else { i - 1 });
            inside = n - inside;
        }
        for _ in 0..inside / 2 {
            self.order.swap(i, j);
            self.place[self.order[i] as usize] = i as u32;
            self.place[self.order[j] as usize] = j as u32;
            i = if i + 1 == n { 0 } else { i + 1 };
            j = if j == 0 { n - 1 } else { j - 1 };
        }
        mirrored
    }

    /// Puts a point that is left out behind `before`.
    pub(super) fn insert_after(&mut self, before: u32, point: u32) {
        let at = self.at(before) + 1;
        self.order.insert(at, point);
        self.renumber(at);
    }

    /// Leaves a point out.
    pub(super) fn remove(&mut self, point: u32) {
        let at = self.at(point);
        self.order.remove(at);
        self.place[point as usize] = OUT;
        self.renumber(at);
    }

    /// Puts `point`, which is left out, in the place of `old`.
    pub(super) fn replace(&mut self, old: u32, point: u32) {
        let at = self.at(old);
        self.order[at] = point;
        self.place[old as usize] = OUT;
        self.place[point as usize] = at as u32;
    }

    /// Moves the stretch of `length` points that begins at place `at` forward by `by` places, without turning it.
    ///
    /// Places count cyclically. O(length + by) where that does not pass the array's end, else O(n).
    pub(super) fn rotate(&mut self, at: usize, length: usize, by: usize) {
        let n = self.order.len();
        if at + length + by <= n {
            self.order[at..at + length + by].rotate_left(length);
            for place in at..at + length + by {
                self.place[self.order[place] as usize] = place as u32;
            }
        } else {
            self.order.rotate_left(at);
            self.order[..length + by].rotate_left(length);
            self.renumber(0);
        }
    }

    /// Writes the places of all from `from` on.
    fn renumber(&mut self, from: usize) {
        for place in from..self.order.len() {
            self.place[self.order[place] as usize] = place as u32;
        }
    }
}
