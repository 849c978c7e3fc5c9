//! The moves of a whole graph, each from posture to posture.

use nalgebra::Isometry3;

use super::claim::{ArmClaim, ArmMoveFinding};
use super::course::{Course, ToolCourse, apart};
use super::posture::Asked;
use super::{Arm, NO_ARC, ROUNDING, Wrong};

/// A move arrives within this of the angles that the next one begins at, rad.
const ARRIVES: f64 = 1e-3;

/// A move of a graph, by the numbers of its points.
///
/// Points index postures and poses alike.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ArmWayClaim {
    /// Where it starts.
    pub from: usize,
    /// Where it ends.
    pub to: usize,
    /// How it leads there.
    pub way: ArmWay,
}

/// How a move of a graph leads from point to point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ArmWay {
    /// In joints.
    Joints,
    /// Straight.
    Straight,
    /// On an arc through a point.
    Through(usize),
}

/// The first thing that does not hold on each move of a graph, numbered as in `moves`: posture `postures[k]` (rad) must
/// have the tool at `poses[k]`, and every move must lead from one posture to the other.
///
/// A move starts where posture and pose say, is followed in its own way, and must arrive at the target's pose (1e-6 m
/// and rad or so, what rounding may take) and within 1e-3 rad of the target's posture, so that the next move begins
/// where this one ended. Bounds and clearance are asked at every sample, singularities not. O(moves · samples · bodies
/// · solids).
///
/// `poses[k]` is `base_from_tcp`; indices beyond the lists are the caller's mistake and panic.
pub fn verify_arm_graph(
    claim: &ArmClaim,
    postures: &[[f64; 6]],
    poses: &[Isometry3<f64>],
    moves: &[ArmWayClaim],
) -> Vec<ArmMoveFinding> {
    let arm = Arm::of(claim);
    let one = |(index, way): (usize, &ArmWayClaim)| {
        let wrong = wrong(&arm, postures, poses, way)?;
        Some(ArmMoveFinding { index, at: wrong.0, what: wrong.1 })
    };
    moves.iter().enumerate().filter_map(one).collect()
}

/// The first thing wrong with one move: start, way, target, posture, in this order.
fn wrong(
    arm: &Arm,
    postures: &[[f64; 6]],
    poses: &[Isometry3<f64>],
    ArmWayClaim { from, to, way }: &ArmWayClaim,
) -> Option<Wrong> {
    let tool = arm.claim.flange * arm.claim.tool;
    let (begun, wanted) = (&postures[*from], &postures[*to]);
    let start = arm.place(&tool, begun);
    let (off, turn) = apart(&start, &poses[*from]);
    if off > ROUNDING || turn > ROUNDING {
        return Some((0.0, format!("the tool is {off:.2e} m and {turn:.2e} rad off its point")));
    }
    let target = poses[*to];
    let course = match way {
        ArmWay::Joints => Course::Joints([*begun, *wanted]),
        ArmWay::Straight => Course::Tool(ToolCourse::straight(start, target)),
        ArmWay::Through(via) => match ToolCourse::arc(start, &poses[*via].translation.vector.into(), target) {
            Some(arc) => Course::Tool(arc),
            None => return Some((0.0, NO_ARC.into())),
        },
    };
    let asked = Asked { clearance: Some(arm.claim.clearance), around: &[], singularity: 0.0 };
    let leg = match arm.follow(course, tool, begun) {
        Ok(leg) => leg,
        Err(lost) => return Some(lost),
    };
    let arrives = || {
        let axis = (0..6).find(|k| (leg.end()[*k] - wanted[*k]).abs() > ARRIVES)?;
        Some((1.0, format!("axis {} arrives at {:.3}°", axis + 1, leg.end()[axis].to_degrees())))
    };
    arm.first_wrong(&leg, &asked).or_else(|| arm.off_target(&leg, &target)).or_else(arrives)
}
