//! A drive in pieces whose curvature can be changed where they meet.
//!
//! κ_i(s) += b_{i−1} + (b_i − b_{i−1}) s/h_i on piece i, b₀ = 0 at the start, then s is stretched by 1 + ε:
//! aₖ ↦ aₖ/(1 + ε)ᵏ, lengths by 1 + ε. So κ stays continuous where it was, and the start's curvature stays the wheels'.

use nalgebra::SVector;

use crate::feasibility::steering::shooting::flat::extremes::largest;
use crate::feasibility::steering::shooting::query::Curvatures;
use crate::trajectory::drive::{Motion, Segment, SegmentList};

/// Pieces of a drive.
pub(in super::super) const PIECES: usize = 16;
/// A bend at every piece's end, and the stretch.
pub(in super::super) const UNKNOWNS: usize = PIECES + 1;
/// What bounds may be exceeded by, relative: rounding, as the flat solver has it.
const KEPT: f64 = 1.0 + 1e-9;

/// What is added to κ at the pieces' ends, 1/m, linear between, and ε of the lengths (1 + ε)L.
pub(in super::super) type Change = SVector<f64, UNKNOWNS>;

/// Whether a drive is in one gear, without turns in place, in [`PIECES`] at most.
pub(in super::super) fn refinable(segments: &[Segment]) -> bool {
    let drives =
        |s: &Segment| matches!(s.motion, Motion::Arc { .. }) && s.gear == segments[0].gear && s.length_m() > 0.0;
    (1..=PIECES).contains(&segments.len()) && segments.iter().all(drives)
}

/// The same drive in [`PIECES`] pieces, the longest halved first.
///
/// `None` for drives that are not [`refinable`]. The path is the same to rounding.
pub(in super::super) fn divided(segments: &SegmentList) -> Option<SegmentList> {
    if !refinable(segments) {
        return None;
    }
    let mut divided = *segments;
    while divided.len() < PIECES {
        let longest = (0..divided.len()).max_by(|&i, &j| divided[i].length_m().total_cmp(&divided[j].length_m()))?;
        let (first, second) = halves(&divided[longest]);
        divided[longest] = first;
        divided.push(second).ok()?;
        divided[longest + 1..].rotate_right(1);
    }
    Some(divided)
}

/// An arc in two of half its length.
fn halves(segment: &Segment) -> (Segment, Segment) {
    let Motion::Arc { length_m, curvature } = segment.motion else { return (*segment, *segment) };
    let half = 0.5 * length_m;
    // The polynomial about the middle: Horner's scheme, again and again.
    let mut second = curvature;
    for first in 0..5 {
        for k in (first..5).rev() {
            second[k] += half * second[k + 1];
        }
    }
    let piece = |curvature| Segment { motion: Motion::Arc { length_m: half, curvature }, gear: segment.gear };
    (piece(curvature), piece(second))
}

/// Adds `change` to a drive.
///
/// ε > −1 is the caller's to see to.
pub(in super::super) fn changed(segments: &mut SegmentList, change: &Change) {
    let stretch = 1.0 + change[PIECES];
    let mut before = 0.0;
    for (segment, &after) in segments.iter_mut().zip(change.iter()) {
        let Motion::Arc { length_m, curvature } = &mut segment.motion else { continue };
        curvature[0] += before;
        curvature[1] += (after - before) / *length_m;
        before = after;
        let mut power = 1.0;
        for a in curvature {
            *a /= power;
            power *= stretch;
        }
        *length_m *= stretch;
    }
}

/// By what share a segment exceeds its bounds at most; 0 if it keeps them.
///
/// By the exact extremes of κ and κ′; the larger of both.
pub(super) fn excess(segment: &Segment, bounds: &Curvatures) -> f64 {
    let Motion::Arc { length_m, curvature } = segment.motion else { return 0.0 };
    let mut power = 1.0;
    let shares = curvature.map(|a| {
        let share = a * power;
        power *= length_m;
        share
    });
    let [_, a, b, c, d, e] = shares;
    let rates = [a, 2.0 * b, 3.0 * c, 4.0 * d, 5.0 * e, 0.0];
    let worst = (largest(&shares) / bounds.most).max(largest(&rates) / (bounds.most_rate * length_m));
    if worst <= KEPT { 0.0 } else { worst - 1.0 }
}

/// `before` of the bend at a piece's start and `after` of that at its end.
pub(in super::super) fn bend(piece: usize, before: f64, after: f64) -> Change {
    let mut row = Change::zeros();
    if piece > 0 {
        row[piece - 1] = before;
    }
    row[piece] = after;
    row
}

/// κ and κ′ at the start, the middle and the end of every piece: how they change, what they are, their bounds.
///
/// Each row is the derivative of the value by the change; of κ′ also by the stretch, to first order −κ′. Six limits a
/// piece.
pub(super) fn for_each_limit(segments: &[Segment], bounds: &Curvatures, mut limit: impl FnMut(&Change, f64, f64)) {
    for (piece, segment) in segments.iter().enumerate() {
        let Motion::Arc { length_m, curvature } = segment.motion else { continue };
        for share in [0.0, 0.5, 1.0] {
            let (mut value, mut rate) = (0.0, 0.0);
            for a in curvature.iter().rev() {
                rate = rate * share * length_m + value;
                value = value * share * length_m + a;
            }
            limit(&bend(piece, 1.0 - share, share), value, bounds.most);
            let mut steeper = bend(piece, -1.0 / length_m, 1.0 / length_m);
            steeper[PIECES] = -rate;
            limit(&steeper, rate, bounds.most_rate);
        }
    }
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;
    use crate::trajectory::drive::Gear;

    fn drive() -> SegmentList {
        let mut drive = SegmentList::default();
        let curvature = [0.3, -0.5, 0.4, 0.2, -0.1, 0.05];
        drive.add(Segment { motion: Motion::Arc { length_m: 1.6, curvature }, gear: Gear::Forward });
        drive.add(Segment::clothoid(0.7, 0.2, -0.4, Gear::Forward));
        drive
    }

    /// κ at `s` metres of the whole drive.
    fn curvature(drive: &SegmentList, mut s: f64) -> f64 {
        let last = drive.len() - 1;
        for segment in &drive[..last] {
            if s <= segment.length_m() {
                return segment.curvature_at(s);
            }
            s -= segment.length_m();
        }
        drive[last].curvature_at(s)
    }

    #[test]
    fn division_leaves_the_drive_as_it_is() {
        let (whole, divided) = (drive(), divided(&drive()).expect("pieces"));
        assert_eq!(divided.len(), PIECES);
        for i in 0..230 {
            let s = 0.005 + 0.01 * f64::from(i);
            assert!((curvature(&whole, s) - curvature(&divided, s)).abs() < 1e-12, "at {s}");
        }
    }

    #[test]
    fn turns_and_reversals_are_left_alone() {
        let mut both = drive();
        both.add(Segment::straight(1.0, Gear::Reverse));
        assert!(divided(&both).is_none() && divided(&SegmentList::default()).is_none());
    }

    #[test]
    fn a_change_bends_joints_stretches_lengths_and_leaves_the_start() {
        let before = divided(&drive()).expect("pieces");
        let mut after = before;
        let mut change = Change::zeros();
        (change[4], change[PIECES - 1], change[PIECES]) = (0.1, -0.2, 0.25);
        changed(&mut after, &change);
        for (piece, (old, new)) in before.iter().zip(after.iter()).enumerate() {
            assert!((new.length_m() - 1.25 * old.length_m()).abs() < 1e-12);
            for share in [0.0, 0.3, 1.0] {
                let added = bend(piece, 1.0 - share, share).dot(&change);
                let found = new.curvature_at(share * new.length_m()) - old.curvature_at(share * old.length_m());
                assert!((found - added).abs() < 1e-12, "piece {piece} at {share}: {found}, not {added}");
            }
        }
    }

    #[test]
    fn an_excess_is_the_share_by_which_a_bound_is_broken() {
        let bounds = Curvatures { most: 0.5, most_rate: 1.0 };
        let bent = |start, end| excess(&Segment::clothoid(0.5, start, end, Gear::Forward), &bounds);
        assert!(bent(0.0, 0.5) == 0.0 && (bent(0.2, 0.6) - 0.2).abs() < 1e-8 && (bent(-0.5, 0.5) - 1.0).abs() < 1e-8);
    }
}
