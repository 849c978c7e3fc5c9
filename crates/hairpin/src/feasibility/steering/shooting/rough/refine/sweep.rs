//! How the end of a motion moves with the commands, from one look along it.
//!
//! In the plane and along the predicted way; slopes, slip and lag change it by little, which is learned. Steering that
//! lags is taken for one that follows `behind` metres late.

use nalgebra::SMatrix;

use super::pieces::{Change, PIECES, UNKNOWNS, bend};
use crate::feasibility::steering::shooting::rough::outcome::Driven;
use crate::trajectory::drive::{Planar, Segment};

/// How the end, (x, y, ψ, κ), moves with a change.
pub(in super::super) type Tangent = SMatrix<f64, 4, UNKNOWNS>;

/// Where pieces end, m.
///
/// Entries beyond the last piece stay 0.
pub(super) fn ends_of(segments: &[Segment]) -> [f64; PIECES] {
    let mut ends = [0.0; PIECES];
    let mut total = 0.0;
    for (end, segment) in ends.iter_mut().zip(segments) {
        total += segment.length_m();
        *end = total;
    }
    ends
}

/// δκ of the bends at `s` of pieces with these `ends`; the stretch has none.
///
/// Hat functions: at most two bends count at any place. `s` beyond the end continues the last piece.
pub(super) fn bent_at(ends: &[f64; PIECES], s: f64) -> Change {
    let s = s.max(0.0);
    let piece = ends.iter().position(|&end| s <= end).unwrap_or(PIECES - 1);
    let start = if piece > 0 { ends[piece - 1] } else { 0.0 };
    let share = (s - start) / (ends[piece] - start);
    bend(piece, 1.0 - share, share)
}

/// ∫δκ, ∫x δκ, ∫y δκ along a prediction, for each unknown's δκ.
pub(super) struct Sweep {
    from: Planar,
    /// Where the pieces end, m.
    ends: [f64; PIECES],
    /// Metres by which the steering is behind.
    ///
    /// Time constant times top speed.
    behind: f64,
    sign: f64,
    done: f64,
    moments: [Change; 3],
}

impl Sweep {
    /// A sweep from `from` along `segments`, whose steering is `behind` metres late.
    pub(super) fn new(from: &Planar, behind: f64, segments: &[Segment]) -> Self {
        Self {
            from: *from,
            ends: ends_of(segments),
            behind,
            sign: segments.first().map_or(1.0, |first| first.gear.sign()),
            done: 0.0,
            moments: [Change::zeros(); 3],
        }
    }

    /// δκ of the unknowns at `s`, where the vehicle has the curvature `curvature`.
    ///
    /// Its last entry is the curvature itself: a stretch by ε adds κ ε per metre to the turn.
    fn effect(&self, s: f64, curvature: f64) -> Change {
        let mut effect = bent_at(&self.ends, s - self.behind);
        effect[PIECES] = curvature;
        effect
    }

    pub(super) fn add(&mut self, driven: &Driven) {
        // Steps are seen at their middles.
        let h = 2.0 * (driven.s - self.done);
        self.done += h;
        let effect = h * self.sign * self.effect(driven.s, driven.at.curvature);
        self.moments[0] += effect;
        self.moments[1] += (driven.at.x - self.from.x) * effect;
        self.moments[2] += (driven.at.y - self.from.y) * effect;
    }

    /// δx = ∫ (y − y_end) δκ ds and δy = ∫ (x_end − x) δκ ds by the three moments; stretching moves the end along the
    /// way from the start as well.
    pub(super) fn tangent(&self, end: &Planar) -> Tangent {
        let (x, y) = (end.x - self.from.x, end.y - self.from.y);
        let [turned, along, across] = self.moments;
        let (mut east, mut north) = (across - y * turned, x * turned - along);
        east[PIECES] += x;
        north[PIECES] += y;
        // Stretching leaves the last curvature.
        let last = self.effect(self.ends[PIECES - 1], 0.0);
        Tangent::from_rows(&[east.transpose(), north.transpose(), turned.transpose(), last.transpose()])
    }
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::super::pieces::{changed, divided};
    use super::*;
    use crate::feasibility::steering::shooting::rough::course::{Course, Steps};
    use crate::feasibility::steering::shooting::rough::predict::predict;
    use crate::robot::rover::RoverDescription;
    use crate::trajectory::drive::{Gear, SegmentList};
    use crate::world::terrain::Flat;

    #[test]
    fn in_the_plane_tangents_are_the_differences_of_predictions() {
        let path = format!("{}/../../data/robots/rover/generic.toml", env!("CARGO_MANIFEST_DIR"));
        let text = std::fs::read_to_string(path).expect("a shipped rover");
        let rover = toml::from_str::<RoverDescription>(&text).expect("its keys").build().expect("its numbers");
        let steps = Steps { length: 0.002, angle: 0.002, least: 50 };
        let course = Course { rover: &rover, terrain: &Flat, speed: 0.3.into(), direction: 0.0.into(), steps };
        for gear in [Gear::Forward, Gear::Reverse] {
            let from = Planar { x: 3.0, y: -2.0, yaw: 0.7, curvature: 0.1 };
            let mut drive = SegmentList::default();
            drive.add(Segment::clothoid(2.0, 0.1, 0.8, gear));
            drive.add(Segment::clothoid(1.0, 0.8, -0.1, gear));
            let drive = divided(&drive).expect("pieces");
            let mut sweep = Sweep::new(&from, 0.0, &drive);
            let end = predict(&course, &from, &drive, |driven| sweep.add(driven)).expect("a way").end;
            let tangent = sweep.tangent(&end);
            for unknown in 0..UNKNOWNS {
                let moved = |size: f64| {
                    let mut change = Change::zeros();
                    change[unknown] = size;
                    let mut other = drive;
                    changed(&mut other, &change);
                    let end = predict(&course, &from, &other, |_| {}).expect("a way").end;
                    [end.x, end.y, end.yaw, end.curvature]
                };
                for (row, (more, less)) in moved(1e-4).into_iter().zip(moved(-1e-4)).enumerate() {
                    let (expected, found) = ((more - less) / 2e-4, tangent[(row, unknown)]);
                    assert!((expected - found).abs() < 2e-4, "{gear:?} ({row}, {unknown}): {found}, not {expected}");
                }
            }
        }
    }
}
