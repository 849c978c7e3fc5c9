//! The way of a drive seen from above as chords, and how far it stays from places, between its steps too.

use super::place::{FlatPlace, around};

/// Chords of a way in order, each with what the way leaves it by, m.
///
/// A step that turns the body by Δψ, and its direction of travel by Δδ, leaves its chord c by no more than
/// c (|Δψ| + |Δδ|)/4, as a curve does whose direction changes by so much.
#[derive(Debug)]
pub(super) struct Way {
    chords: Vec<([[f64; 2]; 2], f64)>,
    last: [f64; 3],
    crab_rate: f64,
}

impl Way {
    /// Begun at x, y (m), ψ (rad), where the direction of travel turns by `crab_rate`, rad/m.
    pub(super) fn begun(start: [f64; 3], crab_rate: f64) -> Self {
        Self { chords: vec![([[start[0], start[1]]; 2], 0.0)], last: start, crab_rate }
    }

    /// One chord that nothing leaves.
    pub(super) fn straight(ends: [[f64; 2]; 2]) -> Self {
        Self { chords: vec![(ends, 0.0)], last: [ends[1][0], ends[1][1], 0.0], crab_rate: 0.0 }
    }

    /// On to x, y (m), ψ (rad).
    pub(super) fn pass(&mut self, here: [f64; 3]) {
        let last = self.last;
        let chord = libm::hypot(here[0] - last[0], here[1] - last[1]);
        let turned = (here[2] - last[2]).abs() + self.crab_rate.abs() * chord;
        self.chords.push(([[last[0], last[1]], [here[0], here[1]]], 0.25 * chord * turned));
        self.last = here;
    }

    /// Distance of `place`, m; +∞ where it is `wanted` or more by boxes around both, −∞ where it is no number.
    pub(super) fn distance(&self, place: &FlatPlace, wanted: f64) -> f64 {
        let (ends, leaves) = (self.chords.iter().flat_map(|(chord, _)| chord), self.chords.iter().map(|(_, by)| *by));
        let leaves = leaves.fold(0.0, f64::max);
        let bounds = place.bounds();
        if gap(&around(ends), &bounds) - leaves >= wanted {
            return f64::INFINITY;
        }
        let far = |(chord, by): &&([[f64; 2]; 2], f64)| gap(&around(chord.iter()), &bounds) - by >= wanted;
        let near = self.chords.iter().filter(|one| !far(one));
        let distances = near.map(|(chord, by)| place.distance_of_line(chord) - by);
        distances.fold(f64::INFINITY, |least, d| if d.is_nan() { f64::NEG_INFINITY } else { least.min(d) })
    }
}

/// How far two boxes are apart at least, m; NaN where one has none.
fn gap([low, high]: &[[f64; 2]; 2], [below, above]: &[[f64; 2]; 2]) -> f64 {
    let apart = [0, 1].map(|i| {
        let (ahead, behind) = (below[i] - high[i], low[i] - above[i]);
        if ahead > behind { ahead } else { behind }
    });
    if apart.iter().any(|apart| apart.is_nan()) { f64::NAN } else { apart[0].max(apart[1]) }
}
