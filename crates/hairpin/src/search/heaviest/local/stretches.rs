//! Stretches that are moved: short ones to anywhere, neighbouring ones in each other's place.
//!
//! Both look at candidates under potentials first, as an arc that does not beat the one given up cannot begin a move
//! that gains.

use super::Local;

/// Longest stretch that is moved as one.
const STRETCH: usize = 3;

impl Local<'_> {
    /// Moves a short stretch that begins or ends at `point` next to a candidate, turned or not.
    pub(super) fn stretch(&mut self, point: u32) -> bool {
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

    /// Takes `length` points out and puts them, either way round, between two neighbours elsewhere (Or-opt, Or 1976),
    /// the first move of a gain. Only neighbours of one end's nearest candidates are looked at, and only where the arc
    /// to it, less its potential, outweighs the arc given up there.
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
    ///
    /// Or-3opt: a(→b…d)(c…e)→f becomes a(→c…e)(b…d)→f, the only 3-opt move that turns nothing, so that it serves
    /// directed costs. O(candidates²).
    pub(super) fn exchange_stretches(&mut self, point: u32) -> bool {
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
}
