//! All the ways around that are known between two states, shortest first.
//!
//! What is known are Dubins' ways as smooth arcs, turn–drive–turn, and the words of Reeds and Shepp (or Dubins, in one
//! gear) with clothoids: places are got around by taking another of them, not by bending one.

use crate::feasibility::steering::shooting::cc::{self, Gears};
use crate::feasibility::steering::shooting::preference::Effort;
use crate::feasibility::steering::shooting::query::{Curvatures, Query};
use crate::feasibility::steering::shooting::solve::{
    Choices, Method, listed, single_arcs, turn_drive_turn, with_turns,
};
use crate::trajectory::drive::{Segment, SegmentList};

/// A drive to the goal.
///
/// Lengths are metres driven; a smooth arc is preferred to words of clothoids up to a quarter more.
#[derive(Debug, Clone, Copy)]
pub(super) struct Way {
    /// In the frame of the start.
    pub(super) segments: SegmentList,
    /// Which kind it is.
    pub(super) method: Method,
    /// m.
    pub(super) length: f64,
}

/// Shares of the largest curvature that circles are tried with: gentler ones swing wider.
///
/// A share is left out where an end of the question bends more than it allows.
const SHARES: [f64; 3] = [1.0, 0.6, 0.35];
/// A smooth arc counts as this much shorter than it is.
const SMOOTH: f64 = 0.8;

/// Every way of every kind that `choices` allow.
///
/// Three circle sizes, the gears that are allowed, arcs, words, turns in place; unjudged against places.
///
/// Allocates its list; sorted by metres driven, single arcs counted at 0.8 of theirs, equals of the closed forms by
/// [`Effort`].
pub(super) fn every(query: &Query, bounds: &Curvatures, choices: &Choices) -> Vec<Way> {
    let mut ways = Vec::new();
    if choices.arcs {
        single_arcs(query, bounds, choices, |segments| ways.push(Way::new(segments, Method::SingleArc)));
    }
    if choices.turns {
        let other = choices.reversals.then(|| choices.gear.opposite());
        for gear in [Some(choices.gear), other].into_iter().flatten() {
            ways.push(Way::new(turn_drive_turn(query, bounds, gear), Method::TurnDriveTurn));
        }
    }
    let sharpest = query.start_curvature.abs().max(query.goal.curvature.abs());
    for share in SHARES {
        let gentler = Curvatures { most: share * bounds.most, ..*bounds };
        if share == 1.0 || sharpest <= gentler.most {
            cc::every(query, &gentler, gears(choices), |path| ways.push(Way::of(&path)));
        }
    }
    let rank = |way: &Way| if way.method == Method::SingleArc { SMOOTH * way.length } else { way.length };
    ways.sort_by(|a, b| rank(a).total_cmp(&rank(b)));
    // Closed forms that are equally long to rounding, each run of them by what they turn and how often they stand.
    let alike = |a: &Way, b: &Way| a.method != Method::SingleArc && b.method != Method::SingleArc && same_length(a, b);
    for run in ways.chunk_by_mut(alike) {
        run.sort_by(|a, b| Effort::of(&a.segments).against_in_turns(&Effort::of(&b.segments)));
    }
    ways
}

/// Whether lengths differ by rounding alone.
fn same_length(a: &Way, b: &Way) -> bool {
    Effort::of(&a.segments).is_as_long_as(&Effort::of(&b.segments))
}

/// The shortest way in closed form.
///
/// Where turns in place are allowed, as [`with_turns`] has it.
pub(super) fn shortest(query: &Query, bounds: &Curvatures, choices: &Choices) -> Option<Way> {
    if choices.turns {
        let (segments, method) = with_turns(query, bounds, choices);
        return Some(Way::new(segments, method));
    }
    cc::steer(query, bounds, gears(choices)).map(|path| Way::of(&path))
}

/// Both where reversals are allowed, else the preferred one.
fn gears(choices: &Choices) -> Gears {
    if choices.reversals { Gears::Both } else { Gears::Only(choices.gear) }
}

impl Way {
    fn new(segments: SegmentList, method: Method) -> Self {
        Self { length: segments.iter().map(Segment::length_m).sum(), segments, method }
    }

    fn of(path: &cc::Path) -> Self {
        Self::new(listed(path), Method::Clothoids)
    }
}
