//! A chain of clothoids: curvature piecewise linear in arc length. Its bounds on κ and κ′ are exact at the knots, and
//! it comes near every curve that keeps them, so it finds what a single polynomial cannot bend to.
//!
//! θ(s) = ∫κ ds, κ linear between 17 knots of which both ends are prescribed: 15 knots and the length are free.
//! `position` ends it, `bordered` solves its systems, `descent` fits it.

mod bordered;
mod descent;
mod position;

pub(super) use descent::descend;

use super::dubins::Word;
use super::ends::{Bends, Ends};
use crate::feasibility::steering::shooting::query::Curvatures;

/// Pieces.
pub(super) const PIECES: usize = 16;

/// κ at the knots and the length; the shares of the pieces stay as they are.
///
/// |κ| is largest at a knot, |κ′| constant on a piece.
#[derive(Debug, Clone, Copy)]
pub(super) struct Chain {
    /// κ at the beginning of each piece, 1/m; the first is prescribed.
    curvatures: [f64; PIECES],
    /// κ at the end, 1/m; prescribed.
    end: f64,
    /// L, m.
    pub(super) length: f64,
    /// Lengths of the pieces over L; their sum is 1.
    shares: [f64; PIECES],
}

impl Chain {
    /// A start value: the curvature of `word`, averaged over what it takes to steer, on a path longer by that.
    ///
    /// κ at a knot is the word's mean curvature over a window to both sides, half the steering's way or a piece of the
    /// word long, scaled by swept/length so that the whole turn stays about the word's.
    pub(super) fn along(ends: &Ends, word: &Word, bounds: &Curvatures) -> Self {
        let ramp = bounds.most / bounds.most_rate;
        let radius = 1.0 / bounds.most;
        let swept = word.length() * radius;
        let length = swept + ramp;
        let shares = shares(length, radius, ramp);
        let window = (swept * shares[0]).max(0.5 * ramp).min(0.5 * swept).max(1e-9 * length);
        let turned = |s: f64| {
            let mut rest = (s * bounds.most).clamp(0.0, word.length());
            let mut sum = 0.0;
            for (sign, piece) in word.signs.iter().zip(&word.pieces) {
                sum += sign * piece.min(rest);
                rest -= piece.min(rest);
            }
            sum
        };
        let mut curvatures = [ends.start; PIECES];
        let mut at = 0.0;
        for (share, slot) in shares.iter().zip(curvatures.iter_mut().skip(1)) {
            at += share * swept;
            let (from, to) = ((at - window).max(0.0), (at + window).min(swept));
            *slot = (turned(to) - turned(from)) / (2.0 * window) * (swept / length);
        }
        Self { curvatures, end: ends.end, length, shares }
    }

    /// Length (m), κ at its beginning and at its end (1/m) of each piece.
    pub(super) fn pieces(&self) -> impl Iterator<Item = (f64, f64, f64)> + '_ {
        (0..PIECES).map(|i| (self.piece(i), self.knot(i), self.knot(i + 1)))
    }

    /// Length of piece `i`, m.
    #[inline(always)]
    fn piece(&self, i: usize) -> f64 {
        self.length * self.shares[i]
    }

    /// κ at knot `i` of PIECES + 1.
    #[inline(always)]
    fn knot(&self, i: usize) -> f64 {
        if i < PIECES { self.curvatures[i] } else { self.end }
    }

    /// The largest bends.
    ///
    /// Exact, for κ is linear between knots.
    pub(super) fn bends(&self, bounds: &Curvatures) -> Bends {
        let mut bends = Bends { curvature: self.end.abs() / bounds.most, rate: 0.0 };
        for (length, from, to) in self.pieces() {
            bends.curvature = bends.curvature.max(from.abs() / bounds.most);
            bends.rate = bends.rate.max((to - from).abs() / (length * bounds.most_rate));
        }
        bends
    }
}

/// Equal pieces, but on long paths no longer than it takes to resolve a full circle at either end, with the rest
/// between.
///
/// `length`, `radius` and `ramp` in m. Seven fine pieces at either end and two long ones in the middle where the path
/// is long; 16 equal ones otherwise. They sum to 1.
fn shares(length: f64, radius: f64, ramp: f64) -> [f64; PIECES] {
    let fine = (std::f64::consts::TAU * radius + ramp) / (PIECES / 2 - 1) as f64;
    let even = 1.0 / PIECES as f64;
    if fine >= length * even {
        return [even; PIECES];
    }
    let mut shares = [fine / length; PIECES];
    let rest = 0.5 - (PIECES / 2 - 1) as f64 * (fine / length);
    shares[PIECES / 2 - 1] = rest;
    shares[PIECES / 2] = rest;
    shares
}
