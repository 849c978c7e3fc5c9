//! Straight and circular moves followed in one branch of the inverse kinematics, sample by sample.

use nalgebra::{Isometry3, Point3, Translation3, UnitQuaternion, Vector3};

use super::finding::Fault;
use crate::math::rotation::{from_rotation_vector, rotation_vector};
use crate::robot::arm::{AXES, Arm, Joints};
use crate::trajectory::program::Arc;

/// What is asked of a move.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FollowSettings {
    /// Least margin to every singularity ([`Arm::margin`]).
    pub margin: f64,
    /// Samples are this near to each other, m.
    pub step: f64,
    /// And this, rad.
    pub turn: f64,
}

impl Default for FollowSettings {
    /// |sin| of 1.7° from a singularity; 1 mm and 0.3°.
    fn default() -> Self {
        Self { margin: 0.03, step: 1e-3, turn: 5e-3 }
    }
}

/// Samples of one move at most.
const MOST_SAMPLES: f64 = 100_000.0;
/// Neighbouring samples whose joints differ by more (rad) lie on two sides of a singularity.
const JUMP: f64 = 1.0;

/// The way of a tool: p(s) on a line or an arc, turning evenly about one axis; s in [0, 1].
pub(super) struct Way {
    start: Isometry3<f64>,
    shift: Vector3<f64>,
    arc: Option<Arc>,
    turn: Vector3<f64>,
}

/// Where a move ends.
pub(super) struct Followed {
    /// Joint angles there.
    pub(super) end: Joints,
    /// Least distance of any axis from its bounds on the way, rad.
    pub(super) room: f64,
}

impl Way {
    /// From one pose of the tool to another.
    pub(super) fn straight(start: &Isometry3<f64>, end: &Isometry3<f64>) -> Self {
        Self {
            start: *start,
            shift: end.translation.vector - start.translation.vector,
            arc: None,
            turn: turn(&start.rotation, &end.rotation),
        }
    }

    /// Through `via`, whose orientation is not met; `None` where there is no arc.
    pub(super) fn circular(start: &Isometry3<f64>, via: &Isometry3<f64>, end: &Isometry3<f64>) -> Option<Self> {
        let [a, b, c] = [start, via, end].map(|pose| Point3::from(pose.translation.vector));
        let arc = Arc::through(&a, &b, &c)?;
        Some(Self { arc: Some(arc), ..Self::straight(start, end) })
    }

    fn pose(&self, s: f64) -> Isometry3<f64> {
        let place = match &self.arc {
            Some(arc) => arc.point(s).coords,
            None => self.start.translation.vector + self.shift * s,
        };
        Isometry3::from_parts(Translation3::from(place), self.start.rotation * from_rotation_vector(&(self.turn * s)))
    }

    fn samples(&self, settings: &FollowSettings) -> usize {
        let length = self.arc.as_ref().map_or(self.shift.norm(), Arc::length);
        let count = (length / settings.step).max(self.turn.norm() / settings.turn).ceil();
        count.clamp(1.0, MOST_SAMPLES) as usize
    }
}

fn turn(from: &UnitQuaternion<f64>, to: &UnitQuaternion<f64>) -> Vector3<f64> {
    rotation_vector(&(from.inverse() * to))
}

/// Follows the way from the joint angles `start` in their branch.
///
/// # Errors
/// The first sample that cannot be reached, is outside a joint's bounds or too near to a singularity.
pub(super) fn follow(
    arm: &Arm,
    tcp: &Isometry3<f64>,
    way: &Way,
    start: &Joints,
    settings: &FollowSettings,
) -> Result<Followed, Fault> {
    let (branch, flange_from_tcp) = (arm.branch(start), tcp.inverse());
    let count = way.samples(settings);
    let (mut last, mut room) = (*start, f64::INFINITY);
    for sample in 0..=count {
        let at = sample as f64 / count as f64;
        let solved = arm.inverse_in(&(way.pose(at) * flange_from_tcp), branch, &last);
        let q = solved.ok_or(Fault::OutOfReach { at })?.joints;
        if let Some(fault) = beyond(arm, &q, at) {
            return Err(fault);
        }
        let margin = arm.margin(&q);
        let jumps = (0..AXES).any(|axis| (q[axis] - last[axis]).abs() > JUMP);
        if margin.value < settings.margin || jumps {
            return Err(Fault::Singular { margin, least: settings.margin, at });
        }
        room = room.min(super::posture::room(arm, &q));
        last = q;
    }
    Ok(Followed { end: last, room })
}

/// The first axis outside its bounds.
pub(super) fn beyond(arm: &Arm, q: &Joints, at: f64) -> Option<Fault> {
    let (axis, _) = arm.outside_limits(q)?;
    let limit = &arm.limits[axis];
    let bound = if q[axis] > limit.upper { limit.upper } else { limit.lower };
    Some(Fault::JointLimit { axis, angle: q[axis], bound, at })
}
