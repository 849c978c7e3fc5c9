//! Iterated local search: good paths soon, without proof.
//!
//! Chains of 2-opt moves (Lin & Kernighan 1973) where costs are symmetric, moves of short stretches (Or 1976) and of any
//! stretch without turning it (Or-3opt) everywhere; points are put in, taken out and exchanged; kicks swap two
//! neighbouring stretches. Every move looks only at each point's candidates.

use rand::Rng;

use super::problem::{Arcs, Ends};
use super::tour::{Table, Tour};
use crate::math::random::Stream;

/// Candidates of each point: where a move may lead it.
const CANDIDATES: usize = 8;
/// Moves in a chain.
const DEPTH: usize = 8;
/// Longest stretch that is moved as one.
const STRETCH: usize = 3;
/// Longest stretch that a kick moves.
const KICKED: usize = 10;
/// Longer tours are searched for places of a point only near its candidates.
const SCANNED: usize = 200;

/// A local search that can be gone on with.
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
    pub(super) fn new(arcs: &'a Arcs, ends: Ends, path: &[usize], potentials: &[i64], random: Stream) -> Self {
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
        local.improve();
        local.keep();
        local
    }

    /// Ranks the candidates by c(i, j) − p(i) − p(j) with these potentials of the points and the dummy. Potentials move no
    /// tour's rank where all points are in it, but close to the multipliers of the bound they show which arcs are out of place.
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

    /// Kicks and improves `times`, or until `stop` says so, which is asked now and then. Returns how often.
    pub(super) fn kick(&mut self, times: u64, stop: &(dyn Fn() -> bool + Sync)) -> u64 {
        for time in 0..times {
            if time % 64 == 63 && stop() {
                return time;
            }
            if self.tour.len() < 4 && self.arcs.points() < 4 {
                return times;
            }
            self.disturb();
            self.improve();
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

    fn below(&mut self, bound: usize) -> usize {
        ((u128::from(self.random.next_u64()) * bound as u128) >> 64) as usize
    }

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

    fn take_out(&mut self, point: u32) {
        let (before, after) = (self.tour.previous(point), self.tour.next(point));
        self.total += self.table.cost(before, after) - self.table.cost(before, point) - self.table.cost(point, after);
        self.tour.remove(point);
        self.wake(before);
        self.wake(after);
    }

    /// Until no move helps.
    fn improve(&mut self) {
        loop {
            while let Some(point) = self.queue.pop() {
                self.queued[point as usize] = false;
                while self.tour.has(point) && self.improve_at(point) {}
            }
            if self.tour.len() == self.table.size || !self.put_in() {
                return;
            }
        }
    }

    fn improve_at(&mut self, point: u32) -> bool {
        (self.table.symmetric && self.chain(point))
            || self.stretch(point)
            || self.exchange_stretches(point)
            || (self.tour.len() < self.table.size || self.penalised(point)) && self.leave_out(point)
    }

    fn penalised(&self, point: u32) -> bool {
        self.table.cost(self.tour.previous(point), point) < 0 || self.table.cost(point, self.tour.next(point)) < 0
    }

    /// A chain of 2-opt moves that ends with a gain.
    fn chain(&mut self, first: u32) -> bool {
        for begin_forward in [true, false] {
            let mut forward = begin_forward;
            let mut done = [(0, 0, false); DEPTH];
            let mut depth = 0;
            // The tour is seen as a path from `first` to `open`, whose joining arc is taken away.
            let mut open = if forward { self.tour.next(first) } else { self.tour.previous(first) };
            let mut gain = -self.table.cost(first, open);
            let (mut best_gain, mut best_depth) = (0, 0);
            while depth < DEPTH {
                let Some((opened, end)) = self.link(first, open, gain, forward) else { break };
                // Seen forward: first, open … end, to. Turning open … end makes `end` the open end.
                let (a, b) = if forward { (open, end) } else { (end, open) };
                let mirrored = self.tour.reverse(a, b, true);
                forward ^= mirrored;
                done[depth] = (a, b, mirrored);
                depth += 1;
                (gain, open) = (opened, end);
                let closed = gain + self.table.cost(open, first);
                if closed > best_gain {
                    (best_gain, best_depth) = (closed, depth);
                }
            }
            for (a, b, mirrored) in done[best_depth..depth].iter().rev().copied() {
                let (a, b) = if mirrored { (a, b) } else { (b, a) };
                self.tour.reverse(a, b, true);
            }
            if best_gain > 0 {
                self.total += best_gain;
                for (a, b, _) in done.into_iter().take(best_depth) {
                    for point in [a, b] {
                        [self.tour.previous(point), point, self.tour.next(point)]
                            .into_iter()
                            .for_each(|point| self.wake(point));
                    }
                }
                self.wake(first);
                return true;
            }
        }
        false
    }

    /// The best next arc of a chain: the gain with its follower taken away, and the new open end.
    fn link(&self, first: u32, open: u32, gain: i64, forward: bool) -> Option<(i64, u32)> {
        let mut chosen = None;
        for at in 0..self.each {
            let to = self.candidates[open as usize * self.each + at];
            if to == first || to == open || !self.tour.has(to) {
                continue;
            }
            let with = gain + self.table.cost(open, to);
            let end = if forward { self.tour.previous(to) } else { self.tour.next(to) };
            if end == open || with + self.potentials[first as usize] - self.potentials[to as usize] <= 0 {
                continue;
            }
            let opened = with - self.table.cost(to, end);
            if chosen.is_none_or(|(most, _)| opened > most) {
                chosen = Some((opened, end));
            }
        }
        chosen
    }

    /// Moves a short stretch that begins or ends at `point` next to a candidate, turned or not.
    fn stretch(&mut self, point: u32) -> bool {
        let n = self.tour.len();
        for length in 1..=STRETCH.min(n.saturating_sub(3)) {
            for begins in [true, false] {
                if length == 1 && !begins {
                    continue;
                }
                let place = self.tour.at(point);
                let from = if begins {
                    place
                } else if place + 1 >= length {
                    place + 1 - length
                } else {
                    place + n + 1 - length
                };
                if self.move_short(from, length, begins) {
                    return true;
                }
            }
        }
        false
    }

    fn move_short(&mut self, from: usize, length: usize, begins: bool) -> bool {
        let n = self.tour.len();
        let point = |place: usize| self.tour.order[if place >= n { place - n } else { place }];
        let (first, last) = (point(from), point(from + length - 1));
        let (before, after) = (point(if from == 0 { n - 1 } else { from - 1 }), point(from + length));
        let cost = |x, y| self.table.cost(x, y);
        let freed = cost(before, after) - cost(before, first) - cost(last, after);
        let mut turn = 0;
        if !self.table.symmetric {
            for place in from..from + length - 1 {
                turn += cost(point(place + 1), point(place)) - cost(point(place), point(place + 1));
            }
        }
        let since = |place: usize| if place >= from { place - from } else { place + n - from };
        let (near, old) = if begins { (first, before) } else { (last, after) };
        let missed = cost(old, near).max(cost(near, old)) - self.potentials[old as usize];
        for at in 0..self.each {
            let to = self.candidates[near as usize * self.each + at];
            if !self.tour.has(to) {
                continue;
            }
            let away = since(self.tour.at(to));
            if away < length || cost(near, to).max(cost(to, near)) - self.potentials[to as usize] <= missed {
                continue;
            }
            // Behind `to` or before it: `near` touches it in one case as it lies, in the other turned.
            for behind in [true, false] {
                let turned = behind != begins;
                let (left, right) = if behind { (to, self.tour.next(to)) } else { (self.tour.previous(to), to) };
                if left == last || right == first {
                    continue;
                }
                let (head, tail, inner) = if turned { (last, first, turn) } else { (first, last, 0) };
                let gain = freed + inner + cost(left, head) + cost(tail, right) - cost(left, right);
                if gain > 0 {
                    self.total += gain;
                    let by = since(self.tour.at(left)) + 1 - length;
                    self.tour.rotate(from, length, by);
                    if turned {
                        self.tour.reverse(first, last, false);
                    }
                    [before, after, first, last, left, right].into_iter().for_each(|point| self.wake(point));
                    return true;
                }
            }
        }
        false
    }

    /// Exchanges two neighbouring stretches of any length, neither turned: three arcs for three.
    fn exchange_stretches(&mut self, point: u32) -> bool {
        let n = self.tour.len();
        if n < 5 {
            return false;
        }
        let (base, second) = (self.tour.at(point), self.tour.next(point));
        let away = |other: u32| {
            let at = self.tour.at(other);
            if at >= base { at - base } else { at + n - base }
        };
        let cost = |x, y| self.table.cost(x, y);
        for at in 0..self.each {
            // point second … d to … e f: becomes point to … e second … d f.
            let to = self.candidates[point as usize * self.each + at];
            if to == second || to == point || !self.tour.has(to) {
                continue;
            }
            let gain = cost(point, to) - cost(point, second);
            if gain + self.potentials[second as usize] - self.potentials[to as usize] <= 0 {
                continue;
            }
            let d = self.tour.previous(to);
            let gain = gain - cost(d, to);
            for deeper in 0..self.each {
                let f = self.candidates[d as usize * self.each + deeper];
                if f == to || !self.tour.has(f) {
                    continue;
                }
                let place = if f == point { n } else { away(f) };
                if place <= away(to) {
                    continue;
                }
                let gain = gain + cost(d, f);
                if gain + self.potentials[second as usize] - self.potentials[f as usize] <= 0 {
                    continue;
                }
                let e = self.tour.previous(f);
                let whole = gain + cost(e, second) - cost(e, f);
                if whole > 0 {
                    let (first_length, second_length) = (away(d), away(e) + 1 - away(to));
                    self.total += whole;
                    self.tour.rotate((base + 1) % n, first_length, second_length);
                    [point, second, d, to, e, f].into_iter().for_each(|point| self.wake(point));
                    return true;
                }
            }
        }
        false
    }

    fn leave_out(&mut self, point: u32) -> bool {
        if point == self.table.dummy() || self.tour.len() < 3 {
            return false;
        }
        let (before, after) = (self.tour.previous(point), self.tour.next(point));
        let cost = |x, y| self.table.cost(x, y);
        let helps = cost(before, after) > cost(before, point) + cost(point, after);
        if helps {
            self.take_out(point);
        }
        helps
    }

    /// Puts points that are left out where they help most, beside another or in its place; whether any did.
    fn put_in(&mut self) -> bool {
        let mut any = false;
        for point in 0..self.table.dummy() {
            if self.tour.has(point) {
                continue;
            }
            let mut best = (0, 0, false);
            if self.tour.len() <= SCANNED {
                for place in 0..self.tour.len() {
                    self.try_beside(self.tour.order[place], point, &mut best);
                }
            } else {
                for at in 0..self.each {
                    let near = self.candidates[point as usize * self.each + at];
                    if self.tour.has(near) {
                        self.try_beside(near, point, &mut best);
                        self.try_beside(self.tour.previous(near), point, &mut best);
                        let before = self.tour.previous(self.tour.previous(near));
                        self.try_beside(before, point, &mut best);
                    }
                }
            }
            let (gain, before, instead) = best;
            if gain > 0 {
                let next = self.tour.next(before);
                if instead {
                    self.tour.replace(next, point);
                } else {
                    self.tour.insert_after(before, point);
                }
                self.total += gain;
                let after = self.tour.next(point);
                [before, point, after].into_iter().for_each(|point| self.wake(point));
                any = true;
            }
        }
        any
    }

    /// Keeps in `best` what `point` gains behind `before`, or in the place of the point that is there.
    fn try_beside(&self, before: u32, point: u32, best: &mut (i64, u32, bool)) {
        let cost = |x, y| self.table.cost(x, y);
        let next = self.tour.next(before);
        let gain = cost(before, point) + cost(point, next) - cost(before, next);
        if gain > best.0 {
            *best = (gain, before, false);
        }
        if next != self.table.dummy() {
            let after = self.tour.next(next);
            let gain = cost(before, point) + cost(point, after) - cost(before, next) - cost(next, after);
            if gain > best.0 {
                *best = (gain, before, true);
            }
        }
    }
}
