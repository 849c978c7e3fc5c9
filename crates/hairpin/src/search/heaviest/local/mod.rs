//! Iterated local search: good paths soon, without proof.
//!
//! Chains of 2-opt moves (Lin & Kernighan 1973) where costs are symmetric, moves of short stretches (Or 1976) and of
//! any stretch without turning it (Or-3opt) everywhere; points are put in, taken out and exchanged; kicks swap two
//! neighbouring stretches. Every move looks only at each point's candidates.
//!
//! Only points whose surroundings changed are looked at again. Missing arcs cost a penalty, so that a tour may pass
//! through what is no path and come out of it. Nothing of the proof depends on this room: the cost of a path that it
//! finds is summed anew.

mod chain;
mod stretches;
mod visits;

use rand::Rng;

use super::problem::{Arcs, Ends};
use super::tour::{Table, Tour};
use crate::math::random::Stream;

/// Candidates of each point: where a move may lead it.
const CANDIDATES: usize = 8;
/// Longest stretch that a kick moves.
const KICKED: usize = 10;

/// A local search that can be gone on with.
///
/// A tour is a path closed over the dummy, n, and may leave points out. `total` counts penalties, `heaviest` does not.
pub(super) struct Local<'a> {
    arcs: &'a Arcs,
    ends: Ends,
    table: Table,
    candidates: Vec<u32>,
    each: usize,
    potentials: Vec<i64>,
    tour: Tour,
    best: Tour,
    total: i64,
    best_total: i64,
    queue: Vec<u32>,
    queued: Vec<bool>,
    found: Vec<(i64, Vec<usize>)>,
    /// Cost of the best path found, −1 without.
    heaviest: i64,
    random: Stream,
}

impl<'a> Local<'a> {
    /// Begins at `path`, with [`Local::rank`].
    ///
    /// Potentials are in units of cost: of each point, then of the dummy. The path is improved at once, before any
    /// kick; all draws come from `random`, in an order that the table and the settings decide.
    pub(super) fn new(
        arcs: &'a Arcs,
        ends: Ends,
        path: &[usize],
        potentials: &[i64],
        random: Stream,
        stop: &(dyn Fn() -> bool + Sync),
    ) -> Self {
        let table = Table::new(arcs, ends);
        let tour = Tour::of_path(&table, path);
        let total = tour.total(&table);
        let mut local = Self {
            arcs,
            ends,
            candidates: Vec::new(),
            each: 0,
            potentials: Vec::new(),
            best: tour.clone(),
            tour,
            total,
            best_total: total,
            queue: Vec::new(),
            queued: vec![false; table.size],
            found: Vec::new(),
            heaviest: -1,
            random,
            table,
        };
        local.rank(potentials);
        local.note();
        local.wake_all();
        local.improve(stop);
        local.keep();
        local
    }

    /// Ranks the candidates by c(i, j) − p(i) − p(j) with these potentials of the points and the dummy. Potentials move
    /// no tour's rank where all points are in it, but close to the multipliers of the bound they show which arcs are
    /// out of place.
    pub(super) fn rank(&mut self, potentials: &[i64]) {
        self.potentials.clear();
        self.potentials.extend_from_slice(potentials);
        let n = self.arcs.points();
        self.each = CANDIDATES.min(n);
        self.candidates.clear();
        let mut others: Vec<(i64, u32)> = Vec::new();
        for i in 0..n {
            others.clear();
            let near = (0..n).filter(|j| *j != i && self.table.cost(i as u32, *j as u32) >= 0);
            others.extend(near.map(|j| (potentials[j] - self.table.cost(i as u32, j as u32), j as u32)));
            let keep = self.each.min(others.len());
            if keep > 0 && keep < others.len() {
                others.select_nth_unstable(keep - 1);
            }
            others.truncate(keep);
            others.sort_unstable();
            self.candidates.extend(others.iter().map(|(_, j)| *j));
            // The dummy is everybody's candidate, and fills the rows of points with few arcs.
            self.candidates.resize((i + 1) * self.each, n as u32);
        }
        self.candidates.extend((0..self.each as u32).map(|i| i % n as u32));
    }

    /// The paths found since it was last asked, each better than those before.
    pub(super) fn take_found(&mut self) -> Vec<(i64, Vec<usize>)> {
        std::mem::take(&mut self.found)
    }

    /// Goes on from a path that was found elsewhere, if it is heavier.
    pub(super) fn offer(&mut self, path: &[usize]) {
        let tour = Tour::of_path(&self.table, path);
        let total = tour.total(&self.table);
        if total > self.best_total {
            (self.best_total, self.total) = (total, total);
            self.tour.copy_from(&tour);
            self.best = tour;
            self.note();
        }
    }

    /// Goes on from `path`, improved, if that is no worse than the best.
    ///
    /// It may pass missing arcs, at their penalty, and points may be left out.
    pub(super) fn mend(&mut self, path: &[usize], stop: &(dyn Fn() -> bool + Sync)) {
        self.tour = Tour::of_path(&self.table, path);
        self.total = self.tour.total(&self.table);
        self.wake_all();
        self.improve(stop);
        self.keep();
    }

    /// Kicks and improves `times`, or until `stop` says so, which is asked now and then. Returns how often.
    ///
    /// `stop` is asked every 64 kicks. A kick costs the few points that it woke, not a look at the whole tour.
    pub(super) fn kick(&mut self, times: u64, stop: &(dyn Fn() -> bool + Sync)) -> u64 {
        for time in 0..times {
            if time % 64 == 63 && stop() {
                return time;
            }
            if self.tour.len() < 4 && self.arcs.points() < 4 {
                return times;
            }
            self.disturb();
            self.improve(stop);
            self.keep();
        }
        times
    }

    /// Goes on from here if it is no worse, else from the best.
    fn keep(&mut self) {
        if self.total >= self.best_total {
            let better = self.total > self.best_total;
            self.best.copy_from(&self.tour);
            self.best_total = self.total;
            if better || self.heaviest < 0 {
                self.note();
            }
        } else {
            self.tour.copy_from(&self.best);
            self.total = self.best_total;
        }
    }

    /// Takes the tour for the answer if it is a path: without missing arcs, ends where they are wanted.
    fn note(&mut self) {
        let mut path = self.tour.path(self.table.dummy());
        let (Some(first), Some(last)) = (path.first(), path.last()) else { return };
        if self.table.symmetric && !(self.ends.may_start(*first) && self.ends.may_end(*last)) {
            path.reverse();
        }
        let (first, last) = (path[0], path[path.len() - 1]);
        if !self.ends.may_start(first) || !self.ends.may_end(last) {
            return;
        }
        if let Some(total) = self.arcs.total(&path).filter(|total| *total > self.heaviest) {
            self.heaviest = total;
            self.found.push((total, path));
        }
    }

    /// A whole number in 0 … bound − 1, uniform up to 2⁻⁶⁴ · bound (Lemire's multiplication, without rejection).
    fn below(&mut self, bound: usize) -> usize {
        ((u128::from(self.random.next_u64()) * bound as u128) >> 64) as usize
    }

    /// The point's moves are to be looked at again; those that are left out of the tour have none.
    fn wake(&mut self, point: u32) {
        if !self.queued[point as usize] && self.tour.has(point) {
            self.queued[point as usize] = true;
            self.queue.push(point);
        }
    }

    fn wake_all(&mut self) {
        for point in 0..self.table.size as u32 {
            self.wake(point);
        }
    }

    /// Swaps two neighbouring stretches, or takes a few points out.
    fn disturb(&mut self) {
        let n = self.tour.len();
        if n < 5 || (n < self.table.size && self.below(4) == 0) {
            let times = 1 + self.below(3);
            for _ in 0..times {
                if self.tour.len() < 3 {
                    break;
                }
                let at = self.below(self.tour.len());
                let point = self.tour.order[at];
                if point != self.table.dummy() {
                    self.take_out(point);
                }
            }
            return;
        }
        let longest = KICKED.min((n - 2) / 2);
        let (at, first, second) = (self.below(n), 1 + self.below(longest), 1 + self.below(longest));
        self.move_stretch(at, first, second);
    }

    /// Exchanges the stretch of `first` points at place `at` with the `second` points behind it.
    fn move_stretch(&mut self, at: usize, first: usize, second: usize) {
        let n = self.tour.len();
        let point = |place: usize| self.tour.order[place % n];
        let (before, a, b) = (point(at + n - 1), point(at), point(at + first - 1));
        let (c, d, after) = (point(at + first), point(at + first + second - 1), point(at + first + second));
        let cost = |x, y| self.table.cost(x, y);
        let (lost, won) = if after == before && first + second == n {
            return;
        } else {
            (cost(before, a) + cost(b, c) + cost(d, after), cost(before, c) + cost(d, a) + cost(b, after))
        };
        self.tour.rotate(at, first, second);
        self.total += won - lost;
        [before, a, b, c, d, after].into_iter().for_each(|point| self.wake(point));
    }

    /// Until no move helps, or `stop` says so, which is asked every 256 points: of thousands the first time is long.
    fn improve(&mut self, stop: &(dyn Fn() -> bool + Sync)) {
        let mut looked = 0;
        loop {
            while let Some(point) = self.queue.pop() {
                self.queued[point as usize] = false;
                while self.tour.has(point) && self.improve_at(point) {}
                looked += 1;
                if looked % 256 == 0 && stop() {
                    return;
                }
            }
            if self.tour.len() == self.table.size || !self.put_in() {
                return;
            }
        }
    }

    /// Chains first, as they gain most where costs are symmetric; leaving a point out is looked at only where points
    /// are left out already or an arc of it is missing: in a full tour of arcs that there are, it rarely gains.
    fn improve_at(&mut self, point: u32) -> bool {
        (self.table.symmetric && self.chain(point))
            || self.stretch(point)
            || self.exchange_stretches(point)
            || (self.tour.len() < self.table.size || self.penalised(point)) && self.leave_out(point)
    }

    /// Whether one of its two arcs is missing: only those cost less than 0 in the table.
    fn penalised(&self, point: u32) -> bool {
        self.table.cost(self.tour.previous(point), point) < 0 || self.table.cost(point, self.tour.next(point)) < 0
    }
}
