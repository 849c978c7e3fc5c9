//! Delta debugging: from a list that fails to a short part of it that still does.
//!
//! Zeller, Hildebrandt: Simplifying and isolating failure-inducing input, IEEE Transactions on Software Engineering 28,
//! 2002.
//!
//! Deterministic, and lazy: `fails` is asked in one order, part after part, so that a caller may remember answers and
//! go on after an interruption.

/// A part of `items`, in their order, that `fails` and from which no single item can be taken any more; `items`
/// themselves are known to fail and are not asked about. `fails` gives `None` to stop early: the shortest part so far
/// is the answer.
///
/// In rounds of finer and finer pieces: each piece alone, then all but one piece; whatever fails goes on in the place
/// of the whole. Asks about n² + 3n parts at most, and about few where failing is local.
///
/// 1-minimal, not minimal: a smaller part elsewhere in the list may fail too.
///
/// ```
/// use hairpin::search::ddmin;
///
/// // Fails wherever both 3 and 7 are.
/// let list: Vec<u32> = (0..16).collect();
/// let part = ddmin(&list, &mut |part| Some(part.contains(&3) && part.contains(&7)));
/// assert_eq!(part, [3, 7]);
/// ```
pub fn ddmin<T: Copy>(items: &[T], fails: &mut dyn FnMut(&[T]) -> Option<bool>) -> Vec<T> {
    let mut kept = items.to_vec();
    let mut pieces = 2;
    while kept.len() >= 2 {
        match round(&kept, pieces, fails) {
            None => return kept,
            Some(Smaller::Piece(piece)) => (kept, pieces) = (piece, 2),
            Some(Smaller::Rest(rest)) => (kept, pieces) = (rest, (pieces - 1).max(2)),
            Some(Smaller::Nothing) if pieces >= kept.len() => break,
            Some(Smaller::Nothing) => pieces = (2 * pieces).min(kept.len()),
        }
    }
    kept
}

/// What a round found.
enum Smaller<T> {
    Piece(Vec<T>),
    Rest(Vec<T>),
    Nothing,
}

/// One round of ddmin (Zeller & Hildebrandt, IEEE TSE 28, 2002): each piece alone, then each piece's rest; `None` where
/// the test could not be asked any more.
fn round<T: Copy>(kept: &[T], pieces: usize, fails: &mut dyn FnMut(&[T]) -> Option<bool>) -> Option<Smaller<T>> {
    let pieces = pieces.min(kept.len());
    let bound = |piece: usize| piece * kept.len() / pieces;
    for piece in 0..pieces {
        let alone = &kept[bound(piece)..bound(piece + 1)];
        if fails(alone)? {
            return Some(Smaller::Piece(alone.to_vec()));
        }
    }
    // With two pieces each is the other's rest.
    for piece in (0..pieces).filter(|_| pieces > 2) {
        let rest = [&kept[..bound(piece)], &kept[bound(piece + 1)..]].concat();
        if fails(&rest)? {
            return Some(Smaller::Rest(rest));
        }
    }
    Some(Smaller::Nothing)
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;

    #[test]
    fn finds_exactly_what_is_needed() {
        let all: Vec<u32> = (0..40).collect();
        for needed in [vec![7], vec![0, 39], vec![3, 4, 5], vec![1, 13, 22, 38]] {
            let mut asked = 0;
            let found = ddmin(&all, &mut |part| {
                asked += 1;
                Some(needed.iter().all(|item| part.contains(item)))
            });
            assert_eq!(found, needed);
            assert!(asked < 40 * 40 + 3 * 40, "{asked}");
        }
    }

    #[test]
    fn what_is_left_is_minimal_where_parts_interact() {
        // Fails where an odd number of multiples of three is left, and at least one even number.
        let fails = |part: &[u32]| {
            part.iter().filter(|x| *x % 3 == 0).count() % 2 == 1 && part.iter().any(|x| x.is_multiple_of(2))
        };
        let all: Vec<u32> = (0..29).collect();
        assert!(!fails(&all));
        let all: Vec<u32> = (0..28).chain([30]).collect();
        assert!(fails(&all));
        let found = ddmin(&all, &mut |part| Some(fails(part)));
        assert!(fails(&found));
        for gone in 0..found.len() {
            let mut less = found.clone();
            less.remove(gone);
            assert!(!fails(&less), "{found:?} without item {gone} fails too");
        }
    }

    #[test]
    fn keeps_the_best_when_stopped() {
        let all: Vec<u32> = (0..64).collect();
        let mut left = 3;
        let found = ddmin(&all, &mut |part| {
            left -= 1;
            (left >= 0).then(|| part.contains(&60))
        });
        assert!(found.contains(&60) && found.len() < 64, "{found:?}");
        assert_eq!(ddmin(&[1, 2], &mut |_| None), [1, 2]);
        assert_eq!(ddmin(&[5], &mut |_| panic!("nothing to ask")), [5]);
    }
}
