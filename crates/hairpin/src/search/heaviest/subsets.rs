//! Dynamic programming over subsets of points: exact whatever the costs, for as many points as memory has room.
//!
//! f(S, j) = max over paths through exactly the points of S that end in j; f(S ∪ {j}, j) = max_k f(S, k) + c(k, j).
//! All j of one S are lanes of a vector. Held & Karp, *A dynamic programming approach to sequencing problems*, 1962.
//!
//! 2ⁿ n² additions in lanes over the last point, and 2ⁿ rows of n numbers, rounded up to what fills a vector: 84 MB for
//! 20 points in 4-byte cells. The path is followed back through the table, so that no predecessor is stored.

use super::problem::{Arcs, Ends, NONE};
use crate::math::simd::{Simd, kernel};

/// More points than any memory has room for.
pub const MOST_SUBSET_POINTS: usize = 28;

/// Bytes that dynamic programming over subsets takes: 2^n rows of one number a point, rounded up to what fills a
/// vector.
///
/// 4-byte cells where the largest cost times the points is below 2²⁹, else 8.
pub fn subset_bytes(arcs: &Arcs) -> u128 {
    let cell = if narrow(arcs) { 4 } else { 8 };
    (1u128 << arcs.points().min(100)) * lanes(arcs.points()) as u128 * cell
}

/// The heaviest path, and `None` if there is none. The caller has asked [`subset_bytes`] whether it fits.
///
/// Any set may be the last, as points may be left out; of equal paths the one of the greatest (set, last point) as
/// numbers.
pub(super) fn best_by_subsets(arcs: &Arcs, ends: Ends) -> Option<Vec<usize>> {
    if arcs.points() == 1 {
        return (ends.may_start(0) && ends.may_end(0)).then(|| vec![0]);
    }
    if narrow(arcs) { narrow_table(arcs, ends) } else { wide_table(arcs, ends) }
}

/// Whether sums fit into half of 32 bits, whose other half marks what cannot be.
///
/// (largest cost) · n < 2²⁹.
fn narrow(arcs: &Arcs) -> bool {
    (arcs.largest() as i128) * (arcs.points() as i128) < (1 << 29)
}

/// Points, rounded up to what fills a vector.
///
/// Eight lanes at least, then a multiple of four, at most 28: one compiled sweep for each.
fn lanes(points: usize) -> usize {
    points.next_multiple_of(if points <= 8 { 8 } else { 4 })
}

/// One width of numbers: fills the table and follows it back.
macro_rules! table {
    ($name:ident, $fill:ident, $sweep:ident, $number:ty) => {
        fn $name(arcs: &Arcs, ends: Ends) -> Option<Vec<usize>> {
            const IMPOSSIBLE: $number = <$number>::MIN / 2;
            let (n, width) = (arcs.points(), lanes(arcs.points()));
            let mut costs = vec![IMPOSSIBLE / 2; n * width];
            for (from, row) in costs.chunks_mut(width).enumerate() {
                for (to, cost) in row.iter_mut().enumerate().take(n) {
                    if arcs.raw(from, to) != NONE {
                        *cost = arcs.raw(from, to) as $number;
                    }
                }
            }
            let mut best = vec![IMPOSSIBLE; (1usize << n) * width];
            for start in (0..n).filter(|start| ends.may_start(*start)) {
                best[(1 << start) * width + start] = 0;
            }
            $fill(Simd::Widest, &mut best, &costs, n, width);
            let reached = |(set, last): &(usize, usize)| best[set * width + last];
            let states = (1..1usize << n).flat_map(|set| (0..n).map(move |last| (set, last)));
            let allowed = states.filter(|(set, last)| set >> last & 1 == 1 && ends.may_end(*last));
            let (mut set, mut last) = allowed.max_by_key(reached).filter(|state| reached(state) >= 0)?;
            let mut path = vec![last];
            while set != 1 << last {
                let rest = set & !(1 << last);
                let value = best[set * width + last];
                let before = (0..n).filter(|k| rest >> k & 1 == 1 && arcs.raw(*k, last) != NONE);
                let came = before.filter(|k| best[rest * width + k] + costs[k * width + last] == value).next();
                (set, last) = (rest, came.expect("every state but a first one came from another"));
                path.push(last);
            }
            path.reverse();
            Some(path)
        }

        kernel! {
            fn $fill(best: &mut [$number], costs: &[$number], n: usize, width: usize) {
                match width {
                    8 => $sweep::<8>(best, costs, n),
                    12 => $sweep::<12>(best, costs, n),
                    16 => $sweep::<16>(best, costs, n),
                    20 => $sweep::<20>(best, costs, n),
                    24 => $sweep::<24>(best, costs, n),
                    _ => $sweep::<28>(best, costs, n),
                }
            }
        }

        /// Every set hands its values on to the sets with one point more; each of those states is written once.
        #[inline(always)]
        fn $sweep<const WIDTH: usize>(best: &mut [$number], costs: &[$number], n: usize) {
            const IMPOSSIBLE: $number = <$number>::MIN / 2;
            for set in 1..(1usize << n) - 1 {
                let (done, open) = best.split_at_mut((set + 1) * WIDTH);
                let row = &done[set * WIDTH..];
                let mut next = [IMPOSSIBLE; WIDTH];
                let mut members = set;
                while members != 0 {
                    let last = members.trailing_zeros() as usize;
                    members &= members - 1;
                    let (so_far, arc) = (row[last], &costs[last * WIDTH..][..WIDTH]);
                    for lane in 0..WIDTH {
                        next[lane] = next[lane].max(so_far + arc[lane]);
                    }
                }
                let mut others = !set & ((1 << n) - 1);
                while others != 0 {
                    let lane = others.trailing_zeros() as usize;
                    others &= others - 1;
                    // What cannot be stays below zero however often costs are added: they sum to less than a quarter.
                    open[((set | 1 << lane) - set - 1) * WIDTH + lane] = next[lane];
                }
            }
        }
    };
}

table!(narrow_table, fill_narrow, sweep_narrow, i32);
table!(wide_table, fill_wide, sweep_wide, i64);
