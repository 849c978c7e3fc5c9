//! Where a chain's links are, and the angles that lead its tool somewhere.

use nalgebra::{Isometry3, Matrix6, Point3, Vector3, Vector6};

use super::claim::ArmMovesClaim;
use crate::math::rotation::{from_rotation_vector, rotation_vector};

/// Distance and angle between two poses.
pub(super) fn apart(a: &Isometry3<f64>, b: &Isometry3<f64>) -> (f64, f64) {
    ((a.translation.vector - b.translation.vector).norm(), rotation_vector(&(a.rotation.inverse() * b.rotation)).norm())
}

pub(super) fn between(from: &Isometry3<f64>, to: &Isometry3<f64>, share: f64) -> Isometry3<f64> {
    let turn = rotation_vector(&(from.rotation.inverse() * to.rotation)) * share;
    let point = from.translation.vector + (to.translation.vector - from.translation.vector) * share;
    Isometry3::from_parts(point.into(), from.rotation * from_rotation_vector(&turn))
}

/// `base_from_link` of the base and the six links.
///
/// The product of exponentials, frame by frame: T_k = T_{k−1} · parent_from_joint · exp(q_k [axis_k]).
pub(super) fn links(claim: &ArmMovesClaim, q: &[f64; 6]) -> [Isometry3<f64>; 7] {
    let mut frames = [Isometry3::identity(); 7];
    for (k, joint) in claim.joints.iter().enumerate() {
        frames[k + 1] = frames[k] * joint.parent_from_joint * from_rotation_vector(&(joint.axis * q[k]));
    }
    frames
}

pub(super) fn place(claim: &ArmMovesClaim, q: &[f64; 6]) -> Isometry3<f64> {
    links(claim, q)[6] * claim.tool
}

/// Joint angles near `q` with the tool at `pose`.
pub(super) fn reach(claim: &ArmMovesClaim, q: &[f64; 6], pose: &Isometry3<f64>) -> Option<[f64; 6]> {
    let mut q = *q;
    for _ in 0..30 {
        let frames = links(claim, &q);
        let tool = frames[6] * claim.tool;
        let shift = pose.translation.vector - tool.translation.vector;
        let turn = rotation_vector(&(pose.rotation * tool.rotation.inverse()));
        if shift.norm() < 1e-10 && turn.norm() < 1e-10 {
            return Some(q);
        }
        let mut jacobian = Matrix6::zeros();
        for (k, joint) in claim.joints.iter().enumerate() {
            let frame = frames[k + 1];
            let axis = frame.rotation * joint.axis;
            let arm = tool.translation.vector - frame.translation.vector;
            jacobian.fixed_view_mut::<3, 1>(0, k).copy_from(&axis.cross(&arm));
            jacobian.fixed_view_mut::<3, 1>(3, k).copy_from(&axis);
        }
        let wanted = Vector6::new(shift.x, shift.y, shift.z, turn.x, turn.y, turn.z);
        let step = jacobian.lu().solve(&wanted)?;
        // A step that large has lost the way.
        if step.norm().is_nan() || step.norm() > 1.0 {
            return None;
        }
        (0..6).for_each(|k| q[k] += step[k]);
    }
    None
}

/// A circle by its centre, two axes of its plane of its radius' length, and the angle of an arc of it, rad.
pub(super) struct Round {
    centre: Point3<f64>,
    axes: [Vector3<f64>; 2],
    angle: f64,
}

impl Round {
    /// The arc from `a` over `via` to `b`; `None` where they lie on a line. With u and w from a to the others and n = u × w the centre is
    /// a + (|w|² n × u + |u|² w × n) / 2|n|²; seen against n, b comes after via.
    pub(super) fn through(a: &Point3<f64>, via: &Point3<f64>, b: &Point3<f64>) -> Option<Self> {
        let (u, w) = (via - a, b - a);
        let n = u.cross(&w);
        let square = n.norm_squared();
        if square.is_nan() || square <= 1e-12 * u.norm_squared() * w.norm_squared() {
            return None;
        }
        let centre = a + (n.cross(&u) * w.norm_squared() + w.cross(&n) * u.norm_squared()) / (2.0 * square);
        let out = a - centre;
        let aside = n.cross(&out) / n.norm();
        let end = b - centre;
        let angle = libm::atan2(end.dot(&aside), end.dot(&out));
        let angle = if angle > 0.0 { angle } else { angle + std::f64::consts::TAU };
        Some(Self { centre, axes: [out, aside], angle })
    }

    pub(super) fn at(&self, share: f64) -> Point3<f64> {
        let angle = share * self.angle;
        self.centre + self.axes[0] * libm::cos(angle) + self.axes[1] * libm::sin(angle)
    }

    pub(super) fn length(&self) -> f64 {
        self.axes[0].norm() * self.angle
    }
}
