//! Whether a leg stays in the waters and clear of every place to keep out of, everywhere and not just at samples.
//!
//! The path is a convex combination of its Bernstein control points: it stays in their box, and no farther from its
//! chord than they do. Both gaps fall with the square of a piece's length, so that halving decides.

use super::limits::{BoatInfeasible, BoatLimit};
use super::waters::BoatWaters;
use crate::math::polynomial::{control_points, halve};
use crate::trajectory::ProfileLeg;
use crate::world::terrain::KeepOuts;

/// Halvings after which a path that is neither clear nor in violation counts as unproven: 1/4096 of the leg.
const DEPTH: u32 = 12;
/// Touching a margin is allowed; this is what rounding may make of touching, m.
const TOUCH: f64 = 1e-9;

/// The waters that the origin of a hull's disc may use.
#[derive(Debug, Clone)]
pub(super) struct FreeWaters {
    low: f64,
    high: [f64; 2],
    clearance: f64,
    keep_outs: KeepOuts,
}

/// Control points of a piece of path, and the times at which it begins and ends.
struct Piece {
    points: [[f64; 8]; 2],
    from: f64,
    to: f64,
}

impl Piece {
    fn point(&self, i: usize) -> [f64; 2] {
        [self.points[0][i], self.points[1][i]]
    }

    /// Bound of the distance between the path and its chord.
    fn bulge(&self) -> f64 {
        let (a, b) = (self.point(0), self.point(7));
        let off = |i: usize| {
            let (share, p) = (i as f64 / 7.0, self.point(i));
            libm::hypot(p[0] - a[0] - (b[0] - a[0]) * share, p[1] - a[1] - (b[1] - a[1]) * share)
        };
        (1..7).map(off).fold(0.0, f64::max)
    }

    fn halves(&self) -> [Piece; 2] {
        let [(x_left, x_right), (y_left, y_right)] = [0, 1].map(|axis| halve(&self.points[axis]));
        let middle = 0.5 * (self.from + self.to);
        [
            Piece { points: [x_left, y_left], from: self.from, to: middle },
            Piece { points: [x_right, y_right], from: middle, to: self.to },
        ]
    }
}

impl FreeWaters {
    /// `clearance`: the radius of the hull's disc, m.
    pub(super) fn new(waters: &BoatWaters, clearance: f64) -> Self {
        let high = waters.size.map(|side| side - waters.keep_in);
        Self { low: waters.keep_in, high, clearance, keep_outs: waters.keep_outs.clone() }
    }

    /// Proves that the whole leg lies in the free waters.
    ///
    /// # Errors
    /// What is violated, or nearer than 1/4096 of the leg can resolve.
    pub(super) fn contains(&self, leg: &ProfileLeg) -> Result<(), BoatInfeasible> {
        let points = [0, 1].map(|axis| control_points(&leg.coefficients[axis], leg.duration));
        self.check(&Piece { points, from: 0.0, to: leg.duration }, DEPTH)
    }

    /// Whether the place `p`, where the path is `at` s after it began, is free.
    ///
    /// # Errors
    /// What is too near.
    pub(super) fn allows(&self, p: [f64; 2], at: f64) -> Result<(), BoatInfeasible> {
        let wall = self.wall_margin(p);
        if wall.is_nan() || wall < -TOUCH {
            return Err(BoatInfeasible::Violates { limit: BoatLimit::Waters, at, margin: wall });
        }
        let margin = self.keep_outs.distance(p[0], p[1]) - self.clearance;
        if margin < 0.0 {
            return Err(BoatInfeasible::Violates { limit: BoatLimit::KeepOut, at, margin });
        }
        Ok(())
    }

    fn check(&self, piece: &Piece, depth: u32) -> Result<(), BoatInfeasible> {
        self.allows(piece.point(0), piece.from)?;
        self.allows(piece.point(7), piece.to)?;
        let Some(limit) = self.undecided(piece) else { return Ok(()) };
        if depth == 0 {
            let p = piece.point(0);
            let margin = match limit {
                BoatLimit::Waters => self.wall_margin(p),
                _ => self.keep_outs.distance(p[0], p[1]) - self.clearance,
            };
            return Err(BoatInfeasible::at(limit, piece.from, margin));
        }
        piece.halves().iter().try_for_each(|half| self.check(half, depth - 1))
    }

    /// The first limit that the control points do not show to hold.
    fn undecided(&self, piece: &Piece) -> Option<BoatLimit> {
        let inside =
            |axis: usize| piece.points[axis].iter().all(|c| (self.low - TOUCH..=self.high[axis] + TOUCH).contains(c));
        if !(inside(0) && inside(1)) {
            return Some(BoatLimit::Waters);
        }
        if self.keep_outs.is_empty() {
            return None;
        }
        let nearest = self.keep_outs.segment_distance(piece.point(0), piece.point(7));
        let clear = nearest - piece.bulge() >= self.clearance + TOUCH;
        (!clear).then_some(BoatLimit::KeepOut)
    }

    /// m; below 0 beyond the margin of an edge.
    fn wall_margin(&self, p: [f64; 2]) -> f64 {
        let of = |axis: usize| (p[axis] - self.low).min(self.high[axis] - p[axis]);
        of(0).min(of(1))
    }
}
