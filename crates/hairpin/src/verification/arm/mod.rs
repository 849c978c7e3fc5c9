//! An arm's moves followed by equations of their own: those of a program, and those of a whole graph, sampled densely, against the arm's bounds and the cell.
//!
//! Shares nothing with what proved them: places of links by products of the joints' frames, straight moves and arcs by Gauss-Newton steps on the geometric
//! Jacobian from sample to sample, corners that are cut by points of their triangles, distances of points from solids by formulas of their own. What is
//! proven to keep a distance everywhere keeps it at every sample, so that no true claim is refused; a false one is found where samples see it.
//!
//! Samples are 2 mm, 0.01 rad or 0.01 rad of a joint apart, points of bodies and corners 5 mm: a rod thinner than that
//! between two samples may be missed here, which the claim's own bounds between samples may not.

mod chain;
mod claim;
mod corner;
mod solids;

#[cfg(test)]
mod tests;

use nalgebra::{Isometry3, Point3};

pub use claim::{
    ArmBodyClaim, ArmJointClaim, ArmMoveClaim, ArmMoveFinding, ArmMovesClaim, ArmSolidClaim, ArmSolidForm,
};

use chain::{Round, apart, between, links, place, reach};
use corner::corner;
use solids::{box_around, distance};

/// Samples of a straight move are this near, m and rad; of a joint move this, rad.
const STEP: [f64; 3] = [2e-3, 0.01, 0.01];
/// Points on a body's axis, and of a corner, are this near, m.
const ALONG: f64 = 5e-3;
/// Room for rounding, m and rad.
const ROUNDING: f64 = 1e-6;
/// A move of a graph arrives within this of the angles that the next one begins at, rad.
const ARRIVES: f64 = 1e-3;

/// A share of a move, and what does not hold there.
type Wrong = (f64, String);

/// The first thing on each move, and on the corner at its end, that does not hold; the moves after one that cannot be followed are not looked at.
pub fn verify_arm_moves(claim: &ArmMovesClaim) -> Vec<ArmMoveFinding> {
    let mut findings = Vec::new();
    let boxes = boxes(claim);
    let mut at = claim.start;
    let mut places = vec![place(claim, &at)];
    for (index, one) in claim.moves.iter().enumerate() {
        let found = |(at, what): Wrong| ArmMoveFinding { index, at, what };
        match followed(claim, &boxes, &at, one) {
            Ok((end, wrong)) => {
                at = end;
                findings.extend(wrong.map(found));
            }
            Err(lost) => {
                findings.push(found(lost));
                return findings;
            }
        }
        places.push(place(claim, &at));
    }
    for (index, zone) in claim.zones.iter().enumerate().filter(|(_, zone)| **zone > 0.0) {
        let straight = |one: Option<&ArmMoveClaim>| matches!(one, Some(ArmMoveClaim::Straight(_)));
        let wrong = if straight(claim.moves.get(index)) && straight(claim.moves.get(index + 1)) {
            let way = [index, index + 1, index + 2].map(|k| Point3::from(places[k].translation.vector));
            corner(claim, &way, *zone)
        } else {
            Some("a corner is cut that is not between two straight moves".into())
        };
        findings.extend(wrong.map(|what| ArmMoveFinding { index, at: 1.0, what }));
    }
    findings.sort_by_key(|finding| finding.index);
    findings
}

/// A move of a graph, by the numbers of its points.
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

/// The first thing that does not hold on each move of a graph, numbered as in `moves`: posture `postures[k]` (rad) must have the tool at
/// `poses[k]`, and every move must lead from one posture to the other. Of `claim` its moves and zones are not looked at.
pub fn verify_arm_graph(
    claim: &ArmMovesClaim,
    postures: &[[f64; 6]],
    poses: &[Isometry3<f64>],
    moves: &[ArmWayClaim],
) -> Vec<ArmMoveFinding> {
    let boxes = boxes(claim);
    let one = |(index, ArmWayClaim { from, to, way }): (usize, &ArmWayClaim)| {
        let found = |(at, what): Wrong| ArmMoveFinding { index, at, what };
        let (off, turn) = apart(&place(claim, &postures[*from]), &poses[*from]);
        if off > ROUNDING || turn > ROUNDING {
            return Some(found((0.0, format!("the tool is {off:.2e} m and {turn:.2e} rad off its point"))));
        }
        let target = poses[*to];
        let way = match way {
            ArmWay::Joints => ArmMoveClaim::Joints(postures[*to], Some(target)),
            ArmWay::Straight => ArmMoveClaim::Straight(target),
            ArmWay::Through(via) => ArmMoveClaim::Arc(poses[*via].translation.vector.into(), target),
        };
        match followed(claim, &boxes, &postures[*from], &way) {
            Err(lost) => Some(found(lost)),
            Ok((_, Some(wrong))) => Some(found(wrong)),
            Ok((end, None)) => {
                let axis = (0..6).find(|k| (end[*k] - postures[*to][*k]).abs() > ARRIVES)?;
                Some(found((1.0, format!("axis {} arrives at {:.3}°", axis + 1, end[axis].to_degrees()))))
            }
        }
    };
    moves.iter().enumerate().filter_map(one).collect()
}

fn boxes(claim: &ArmMovesClaim) -> Vec<Option<ArmSolidForm<'static>>> {
    claim.solids.iter().map(|solid| box_around(&solid.form)).collect()
}

/// Where a move from the angles `begun` ends, and the first thing on it that does not hold.
///
/// # Errors
/// Where it cannot be followed.
fn followed(
    claim: &ArmMovesClaim,
    boxes: &[Option<ArmSolidForm>],
    begun: &[f64; 6],
    one: &ArmMoveClaim,
) -> Result<([f64; 6], Option<Wrong>), Wrong> {
    let start = place(claim, begun);
    let round = match one {
        ArmMoveClaim::Arc(via, to) => {
            let ends = [start, *to].map(|pose| Point3::from(pose.translation.vector));
            Some(
                Round::through(&ends[0], via, &ends[1])
                    .ok_or((0.0, "three points of an arc lie on a line".to_owned()))?,
            )
        }
        _ => None,
    };
    let (mut at, mut wrong) = (*begun, None);
    let count = samples(claim, &at, one, round.as_ref());
    for sample in 0..=count {
        let share = sample as f64 / count as f64;
        let pose = match one {
            ArmMoveClaim::Joints(..) => None,
            ArmMoveClaim::Straight(to) => Some(between(&start, to, share)),
            ArmMoveClaim::Arc(_, to) => {
                let mut pose = between(&start, to, share);
                pose.translation = round.as_ref().map_or(pose.translation, |round| round.at(share).coords.into());
                Some(pose)
            }
        };
        at = match (one, pose) {
            (ArmMoveClaim::Joints(end, _), _) => std::array::from_fn(|k| begun[k] + share * (end[k] - begun[k])),
            (_, Some(pose)) => reach(claim, &at, &pose).ok_or((share, "the tool cannot be led on".to_owned()))?,
            (_, None) => at,
        };
        wrong = wrong.or_else(|| wrong_at(claim, boxes, &at).map(|what| (share, what)));
    }
    if let ArmMoveClaim::Joints(_, Some(pose)) = one {
        let (off, turn) = apart(&place(claim, &at), pose);
        if off > ROUNDING || turn > ROUNDING {
            let what = format!("the tool arrives {off:.2e} m and {turn:.2e} rad off its target");
            wrong = wrong.or(Some((1.0, what)));
        }
    }
    Ok((at, wrong))
}

fn samples(claim: &ArmMovesClaim, from: &[f64; 6], one: &ArmMoveClaim, round: Option<&Round>) -> usize {
    let steps = match one {
        ArmMoveClaim::Joints(end, _) => (0..6).map(|k| (end[k] - from[k]).abs()).fold(0.0, f64::max) / STEP[2],
        ArmMoveClaim::Straight(to) | ArmMoveClaim::Arc(_, to) => {
            let (off, turn) = apart(&place(claim, from), to);
            (round.map_or(off, Round::length) / STEP[0]).max(turn / STEP[1])
        }
    };
    (steps.ceil() as usize).clamp(1, 100_000)
}

/// What is wrong with a posture.
fn wrong_at(claim: &ArmMovesClaim, boxes: &[Option<ArmSolidForm>], q: &[f64; 6]) -> Option<String> {
    for (k, joint) in claim.joints.iter().enumerate() {
        if q[k] < joint.bounds[0] - ROUNDING || q[k] > joint.bounds[1] + ROUNDING {
            return Some(format!("axis {} is at {:.3}°, beyond its bound", k + 1, q[k].to_degrees()));
        }
    }
    let frames = links(claim, q);
    for body in claim.bodies {
        let [a, b] = body.axis.map(|end| frames[body.link] * end);
        let count = ((b - a).norm() / ALONG).ceil().max(1.0);
        let points: Vec<Point3<f64>> = (0..=count as usize).map(|i| a + (b - a) * (i as f64 / count)).collect();
        for (solid, hull) in claim.solids.iter().zip(boxes).filter(|(solid, _)| body.tool || !solid.tool_only) {
            let room = body.radius + claim.clearance;
            // Triangles are many: where their box is far, they are.
            if hull.as_ref().is_some_and(|hull| points.iter().all(|p| distance(hull, p) > room)) {
                continue;
            }
            let least = points.iter().map(|p| distance(&solid.form, p)).fold(f64::INFINITY, f64::min);
            if least < room - ROUNDING {
                let (left, asked) = (1e3 * (least - body.radius), 1e3 * claim.clearance);
                return Some(format!("{} keeps {left:.2} mm from {}, not {asked:.2} mm", body.name, solid.name));
            }
        }
    }
    None
}
