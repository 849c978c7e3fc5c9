//! Which parts of a path a sample can belong to in the best assignment: what no best one has need not be looked at.
//!
//! Costs are not negative. So in a rising assignment of least cost no sample costs more than any one rising assignment
//! does in all, and whoever has such a one, good or bad, may leave out every pair of a sample and a part that costs
//! more. What is left is a narrow band where the motion is near its path, found in linear time; where it is not, it is
//! wide, and the answer the same.

use std::ops::Range;

/// Parts of the path that the quick assignment looks ahead at least, and by those that each sample passes in the mean.
const AHEAD: usize = 8;
/// Room for the rounding of sums that are added in another order.
const ROUNDING: f64 = 1.0 + 1e-9;

/// The parts of `windows` that sample number i can have in a rising assignment of least cost, Σ `cost`(i, part);
/// windows rise at both ends.
///
/// O(samples + parts) costs, where the quick assignment is near the path. All that are of least cost up to rounding are
/// within what is left.
pub(super) fn narrowed(
    windows: impl ExactSizeIterator<Item = Range<usize>> + Clone,
    cost: impl Fn(usize, usize) -> f64,
) -> Vec<Range<usize>> {
    let samples = windows.len();
    let end = windows.clone().last().map_or(0, |window| window.end);
    let ahead = AHEAD * (1 + end / samples.max(1));
    // Each sample takes the cheapest part a little ahead of the last one's.
    let (mut at, mut sum) = (0, 0.0);
    for (sample, window) in windows.clone().enumerate() {
        at = window.start.max(at);
        let (mut least, mut best) = (f64::INFINITY, at);
        for part in at..window.end.min(at + ahead) {
            let own = cost(sample, part);
            if own < least {
                (least, best) = (own, part);
            }
        }
        (at, sum) = (best, sum + least);
    }
    let most = sum * ROUNDING;
    let mut first = 0;
    let mut narrow: Vec<Range<usize>> = Vec::with_capacity(samples);
    for (sample, window) in windows.enumerate() {
        first = window.start.max(first);
        while first + 1 < window.end && cost(sample, first) > most {
            first += 1;
        }
        narrow.push(first..window.end);
    }
    let mut last = end;
    for (sample, window) in narrow.iter_mut().enumerate().rev() {
        last = window.end.min(last);
        while last > window.start + 1 && cost(sample, last - 1) > most {
            last -= 1;
        }
        window.end = last;
    }
    narrow
}
