//! Which postures of the arm reach a target, and which of them the target demands.

use nalgebra::Isometry3;

use super::finding::Fit;
use crate::feasibility::reachability::Refusal;
use crate::robot::arm::{AXES, Arm, Joints};

/// Quadrants of angles this near (rad) to their border are both right: targets are rounded.
const BORDER: f64 = 1e-3;

/// All postures within the limits that put the flange there, on every turn of every axis.
///
/// `flange` is `base_from_flange`; `near` is where arms without a closed inverse begin to look.
pub(super) fn within_limits(arm: &Arm, flange: &Isometry3<f64>, near: &Joints) -> Vec<Joints> {
    arm.inverse(flange, near).iter().flat_map(|q| arm.turns_of(q)).collect()
}

/// Whether `q` has the configuration, quadrants as far as rounding lets one tell.
///
/// cf1, cf4, cf6 are ⌊angle / 90°⌋ of the axes; within 10⁻³ rad of a border both neighbours are right. Of arms whose
/// cfx is not known the quadrants alone are looked at.
pub(super) fn has(arm: &Arm, q: &Joints, configuration: &[i32; 4]) -> bool {
    let quadrant = |axis: usize, cf: i32| {
        let from = f64::from(cf) * std::f64::consts::FRAC_PI_2;
        (from - BORDER..=from + std::f64::consts::FRAC_PI_2 + BORDER).contains(&q[axis])
    };
    let [cf1, cf4, cf6, cfx] = *configuration;
    quadrant(0, cf1) && quadrant(3, cf4) && quadrant(5, cf6) && is_branch(arm, q, cfx)
}

/// Whether `q` is in the branch, as far as one knows.
fn is_branch(arm: &Arm, q: &Joints, cfx: i32) -> bool {
    !arm.knows_configurations() || i32::from(arm.branch(q).cfx()) == cfx
}

/// A posture as what would do instead, if there is a configuration to ask for it by.
fn fit(arm: &Arm, q: &Joints) -> Option<Fit> {
    arm.knows_configurations().then(|| Fit { configuration: arm.configuration(q).numbers(), margin: room(arm, q) })
}

/// Least distance of any axis from its bounds, rad.
pub(super) fn room(arm: &Arm, q: &Joints) -> f64 {
    arm.limits.iter().zip(q).map(|(limit, angle)| limit.margin(*angle)).fold(f64::INFINITY, f64::min)
}

/// Σ |Δq|, rad.
fn distance(a: &Joints, b: &Joints) -> f64 {
    (0..AXES).map(|k| (a[k] - b[k]).abs()).sum()
}

/// The posture at a target: the demanded one, else the one nearest to `near`.
///
/// The refusal, from the strongest reason down: nothing reaches the pose at all; of the solutions in the demanded
/// branch one is beyond a bound, told with the bound that is passed by least; the pose can be met but not so demanded.
/// Of an arm without a closed inverse it is told that no posture was found, unless the pose is farther off than the arm
/// is long.
///
/// # Errors
/// Why there is none, and the posture with the most room that would do instead.
pub(super) fn choose(
    arm: &Arm,
    flange: &Isometry3<f64>,
    demanded: Option<[i32; 4]>,
    near: &Joints,
) -> Result<Joints, (Refusal, Option<Fit>)> {
    let possible = within_limits(arm, flange, near);
    let fitting = possible.iter().filter(|q| demanded.is_none_or(|configuration| has(arm, q, &configuration)));
    if let Some(q) = fitting.min_by(|a, b| distance(a, near).total_cmp(&distance(b, near))) {
        return Ok(*q);
    }
    let best = possible.iter().max_by(|a, b| room(arm, a).total_cmp(&room(arm, b)));
    let fit = best.and_then(|q| fit(arm, q));
    if possible.is_empty() && !arm.has_closed_inverse() {
        return Err((Refusal::unmet(arm, flange, 1.0), None));
    }
    let solutions = arm.inverse(flange, &[0.0; AXES]);
    if solutions.is_empty() {
        return Err((Refusal::OutOfReach { at: 1.0 }, None));
    }
    // Of the solutions that the target means, the one that is least far beyond a bound.
    let meant = |q: &&Joints| demanded.is_none_or(|cf| is_branch(arm, q, cf[3]));
    let beyond = solutions.iter().filter(meant).filter_map(|q| Some((q, arm.outside_limits(q)?)));
    match (beyond.min_by(|(_, (_, a)), (_, (_, b))| a.total_cmp(b)), demanded) {
        (Some((q, (axis, _))), _) => {
            let limit = &arm.limits[axis];
            let bound = if q[axis] > limit.upper { limit.upper } else { limit.lower };
            Err((Refusal::JointLimit { axis, angle: q[axis], bound, at: 1.0 }, fit))
        }
        (None, Some(demanded)) => Err((Refusal::NoSuchConfiguration { demanded }, fit)),
        (None, None) => Err((Refusal::OutOfReach { at: 1.0 }, fit)),
    }
}

/// The first axis outside its bounds.
pub(super) fn beyond(arm: &Arm, q: &Joints, at: f64) -> Option<Refusal> {
    let (axis, _) = arm.outside_limits(q)?;
    let limit = &arm.limits[axis];
    let bound = if q[axis] > limit.upper { limit.upper } else { limit.lower };
    Some(Refusal::JointLimit { axis, angle: q[axis], bound, at })
}
