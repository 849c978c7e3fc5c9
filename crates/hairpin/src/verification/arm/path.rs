//! The path of a program: its moves with sharp corners, and the corners that zones cut.
//!
//! About a corner C a zone of radius r, cut to half of either move beside it, adds the end of one move and the
//! beginning of the next, as w runs from 0 to 1: u = 1 − (r/ℓ₁)(1 − w)², v = (r/ℓ₂)w², p = p₁(u) + p₂(v) − C, R = R₁(u)
//! R_C⁻¹ R₂(v); joints in the same way where one of both is a move of joints, or the tool is another one
//! (docs/virtual-controller.md).

use nalgebra::Isometry3;

use super::Arm;
use super::claim::{ArmClaim, ArmMoveFinding, ArmProgramClaim};
use super::follow::Leg;

/// Moves and cuts shorter than this (m) are none.
const NOTHING: f64 = 1e-9;

/// A piece of a path: a share of a move, or a corner that is cut.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ArmPiece {
    /// Of move `.0` what lies between two of its shares.
    Along(usize, [f64; 2]),
    /// The corner between move `.0` and the next.
    Corner(usize),
}

/// A program's path, as far as it could be followed.
pub struct ArmPath<'a> {
    pub(super) arm: Arm<'a>,
    pub(super) legs: Vec<Leg>,
    /// How far (m) from each move's end its corner is cut; 0 where it is met.
    cuts: Vec<f64>,
    /// What each move adds to the path's parameter, m.
    lengths: Vec<f64>,
    /// What was found on the way.
    pub(super) findings: Vec<ArmMoveFinding>,
}

impl<'a> ArmPath<'a> {
    /// The path of `program`.
    ///
    /// Moves are followed until one cannot be; what was found wrong on the way stays with the path. A corner's cut is
    /// min(zone, half of this move, half of the next), lengths in the path's parameter.
    pub fn of(claim: &'a ArmClaim<'a>, program: &ArmProgramClaim) -> Self {
        let arm = Arm::of(claim);
        let (legs, findings) = arm.legs(program);
        let lengths: Vec<f64> = legs.iter().map(|leg| arm.length(leg)).collect();
        let zones = program.moves.iter().map(|one| one.zone);
        let beside = lengths.iter().zip(lengths.iter().skip(1).map(Some).chain(std::iter::once(None)));
        let cut = |(zone, (own, next)): (f64, (&f64, Option<&f64>))| {
            let cut = next.map_or(0.0, |next| zone.min(0.5 * own).min(0.5 * next));
            if cut < NOTHING { 0.0 } else { cut }
        };
        let cuts = zones.zip(beside).map(cut).collect();
        Self { arm, legs, cuts, lengths, findings }
    }

    /// Its pieces, in order.
    ///
    /// Shares of moves, and corners between them, that lie end to end: where one ends the next begins.
    pub fn pieces(&self) -> Vec<ArmPiece> {
        let mut pieces = Vec::with_capacity(2 * self.legs.len());
        let mut entry = 0.0;
        for (index, cut) in self.cuts.iter().enumerate() {
            let exit = if *cut > 0.0 { 1.0 - cut / self.lengths[index] } else { 1.0 };
            pieces.push(ArmPiece::Along(index, [entry, exit]));
            if *cut > 0.0 {
                pieces.push(ArmPiece::Corner(index));
            }
            entry = if *cut > 0.0 { cut / self.lengths[index + 1] } else { 0.0 };
        }
        pieces
    }

    /// Joint angles (rad) and `base_from_tcp` at the share w of a piece; `None` where the tool cannot be led there.
    ///
    /// w in 0 … 1 over the piece. Of moves in joints the pose is where these joints have the tool.
    pub fn at(&self, piece: ArmPiece, w: f64) -> Option<([f64; 6], Isometry3<f64>)> {
        match piece {
            ArmPiece::Along(index, [from, to]) => {
                let (leg, share) = (&self.legs[index], (1.0 - w) * from + w * to);
                let joints = self.arm.stand(leg, share)?;
                Some((joints, leg.pose(share).unwrap_or_else(|| self.arm.place(leg.tool(), &joints))))
            }
            ArmPiece::Corner(index) => self.cut_at(index, w),
        }
    }

    /// How far (m) from its end the corner of a move is cut.
    pub(super) fn cut(&self, index: usize) -> f64 {
        self.cuts[index]
    }

    /// Whether the tool, and not the joints, is led about the corner of a move.
    pub(super) fn leads(&self, index: usize) -> bool {
        let [before, after] = [&self.legs[index], &self.legs[index + 1]];
        before.pose(1.0).is_some() && after.pose(0.0).is_some() && before.tool() == after.tool()
    }

    /// The equations of this file's head.
    ///
    /// f = r/ℓ₁ and g = r/ℓ₂ are at most a half each. Angles are those of the sum of both moves in joints; where the
    /// tool is led they begin Newton's iteration to the pose, and `None` is a pose that it does not come to.
    fn cut_at(&self, index: usize, w: f64) -> Option<([f64; 6], Isometry3<f64>)> {
        let [before, after] = [&self.legs[index], &self.legs[index + 1]];
        let [f, g] = [index, index + 1].map(|leg| self.cuts[index] / self.lengths[leg]);
        let (u, v) = (1.0 - f * (1.0 - w) * (1.0 - w), g * w * w);
        let (a, b, corner) = (self.arm.stand(before, u)?, self.arm.stand(after, v)?, after.begin());
        let sum: [f64; 6] = std::array::from_fn(|k| a[k] + b[k] - corner[k]);
        let tools = self.leads(index).then(|| Some([before.pose(u)?, after.pose(0.0)?, after.pose(v)?])).flatten();
        let Some([end, corner, begin]) = tools else {
            let tool = if w <= 0.5 { before.tool() } else { after.tool() };
            return Some((sum, self.arm.place(tool, &sum)));
        };
        let place = end.translation.vector + begin.translation.vector - corner.translation.vector;
        let turn = end.rotation * corner.rotation.conjugate() * begin.rotation;
        let pose = Isometry3::from_parts(place.into(), turn);
        // What both add up to in joints is near what they add up to in space.
        Some((self.arm.reach(before.tool(), &sum, &pose)?, pose))
    }
}
