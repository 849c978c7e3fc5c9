//! Points that are put in and left out.

use super::Local;

/// Longer tours are searched for places of a point only near its candidates.
const SCANNED: usize = 200;

impl Local<'_> {
    /// Takes a point that is in the tour out of it, gain or not, and wakes its neighbours.
    ///
    /// gain = c(before, after) − c(before, point) − c(point, after), penalties of missing arcs included; O(n) for the
    /// places behind it.
    pub(super) fn take_out(&mut self, point: u32) {
        let (before, after) = (self.tour.previous(point), self.tour.next(point));
        self.total += self.table.cost(before, after) - self.table.cost(before, point) - self.table.cost(point, after);
        self.tour.remove(point);
        self.wake(before);
        self.wake(after);
    }

    /// Leaves `point` out if c(before, after) > c(before, point) + c(point, after), never the dummy; whether it did.
    pub(super) fn leave_out(&mut self, point: u32) -> bool {
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
    ///
    /// One sweep in the order of the points, each put where it gains most; O(n) places each in tours of at most
    /// [`SCANNED`].
    pub(super) fn put_in(&mut self) -> bool {
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
    ///
    /// ```text
    /// beside       c(before, point) + c(point, next) − c(before, next)
    /// in place     c(before, point) + c(point, after) − c(before, next) − c(next, after)      never of the dummy
    /// ```
    ///
    /// `best` is (gain, before, whether in place); only a larger gain replaces it.
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
