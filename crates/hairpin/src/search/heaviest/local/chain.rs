//! Chains of 2-opt moves, where costs are symmetric.
//!
//! Lin-Kernighan's idea with a depth of eight: each move may lose as long as the sum so far gains; what follows the
//! best prefix is undone.

use super::Local;

/// Moves in a chain.
const DEPTH: usize = 8;

impl Local<'_> {
    /// A chain of 2-opt moves that ends with a gain.
    pub(super) fn chain(&mut self, first: u32) -> bool {
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
    ///
    /// `first` … `open` is the tour as a path; an arc open–to is put in and the arc to–end taken out, where `end` is
    /// the neighbour of `to` on the side of `open`. Greatest gain g + c(open, to) − c(to, end) wins; moves that do not
    /// gain under the potentials are not looked at (Lin and Kernighan's gain criterion).
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
}
