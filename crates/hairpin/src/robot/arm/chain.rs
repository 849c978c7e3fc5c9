//! A serial chain of six turning joints: link frames, Jacobian, and numeric inverse kinematics by continuation.
//!
//! The one description of an arm's geometry that everything else is derived from; arms with a closed inverse are chains
//! too ([`super::Opw::chain`]), so that links, Jacobian and bounds are computed once for all.

use nalgebra::{Isometry3, Matrix6, Point3, Vector3, Vector6};

use super::joints::{AXES, Joints};
use crate::math::rotation::{from_rotation_vector, rotation_vector};

/// One turning joint.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Joint {
    /// Pose of the joint, at angle 0, in the link before it.
    pub origin: Isometry3<f64>,
    /// Axis of rotation in that pose, of length 1.
    pub axis: Vector3<f64>,
}

/// Six joints one after the other, and the flange on the last link.
///
/// base_from_link_k = Π_{j ≤ k} origin_j · Rot(axis_j, q_j); base_from_flange = base_from_link_6 · flange. Lengths in
/// m, angles in rad. Any arm's forward kinematics are computed here, whatever its inverse.
#[derive(Debug, Clone, PartialEq)]
pub struct Chain {
    /// The joints, from the base on.
    pub joints: [Joint; AXES],
    /// Pose of the flange in the last link.
    pub flange: Isometry3<f64>,
}

/// `base_from_link`: index 0 is the base, index k the link that joint k moves.
pub type Frames = [Isometry3<f64>; AXES + 1];

/// What a numeric solution took.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Iterated {
    /// Joint angles, rad.
    pub joints: Joints,
    /// Newton steps.
    pub iterations: u32,
}

/// Newton steps at most; continuation from a near pose takes two or three.
const MOST_ITERATIONS: u32 = 30;
/// Length (m) and angle (rad) below which a pose is met.
const MET: f64 = 1e-11;
/// Longest step of a joint per iteration, rad.
const LONGEST_STEP: f64 = 0.3;

impl Chain {
    /// All link frames at the joint angles `q`, rad.
    ///
    /// Six products of transforms; every other quantity of a posture starts from these.
    pub fn frames(&self, q: &Joints) -> Frames {
        let mut frames = [Isometry3::identity(); AXES + 1];
        for (k, joint) in self.joints.iter().enumerate() {
            frames[k + 1] = frames[k] * joint.origin * from_rotation_vector(&(joint.axis * q[k]));
        }
        frames
    }

    /// `base_from_flange` at the joint angles `q`, rad.
    pub fn forward(&self, q: &Joints) -> Isometry3<f64> {
        self.frames(q)[AXES] * self.flange
    }

    /// Origin and direction of every axis in the base, given the frames.
    pub fn axes(&self, frames: &Frames) -> [(Point3<f64>, Vector3<f64>); AXES] {
        std::array::from_fn(|k| {
            // Turning about the axis moves neither its point nor its direction.
            (frames[k + 1].translation.vector.into(), frames[k + 1].rotation * self.joints[k].axis)
        })
    }

    /// The Jacobian at `point` of the last link: column k is (a_k × (p − o_k), a_k), m/rad above 1.
    ///
    /// The geometric Jacobian: (ṗ, ω) = J q̇ in the base frame, `point` fixed to the last link, m. Rows 0-2 in m/rad,
    /// 3-5 pure.
    pub fn jacobian(&self, frames: &Frames, point: &Point3<f64>) -> Matrix6<f64> {
        let mut jacobian = Matrix6::zeros();
        for (k, (origin, axis)) in self.axes(frames).iter().enumerate() {
            jacobian.fixed_view_mut::<3, 1>(0, k).copy_from(&axis.cross(&(point - origin)));
            jacobian.fixed_view_mut::<3, 1>(3, k).copy_from(axis);
        }
        jacobian
    }

    /// Where the first joint carries the second around: the centre of that circle, base frame, and its radius, m.
    ///
    /// The foot of the perpendicular from the second joint to the first axis, which may stand aside of the base or
    /// lean.
    pub fn shoulder(&self) -> (Point3<f64>, f64) {
        let frames = self.frames(&[0.0; AXES]);
        let [(foot, axis), ..] = self.axes(&frames);
        let joint: Point3<f64> = (self.joints[0].origin * self.joints[1].origin).translation.vector.into();
        let centre = foot + axis * (joint - foot).dot(&axis);
        let out = joint - centre;
        (centre, libm::hypot(libm::hypot(out.x, out.y), out.z))
    }

    /// Upper bound of the distance from the first axis to the flange, m, and from the centre of [`Chain::shoulder`].
    ///
    /// ```text
    /// reach = r₂ + Σ_{k=3…6} |origin_k| + |flange|,   r₂ how far the second joint is from the first axis
    /// ```
    ///
    /// No posture has the flange farther out. A scale, not the largest distance. What the arm stands on does not count,
    /// nor where along its first axis the first joint is said to be: neither moves the flange against the axis.
    pub fn reach(&self) -> f64 {
        self.shoulder().1 + self.joints[2..].iter().map(offset).sum::<f64>() + self.flange.translation.vector.norm()
    }

    /// Whether a flange there is farther off than any posture has it.
    pub fn is_beyond(&self, flange: &Point3<f64>) -> bool {
        // For the rounding of the sum.
        (flange - self.shoulder().0).norm() > self.reach() * (1.0 + 1e-9)
    }

    /// Σ of the lengths of all offsets from the base to the flange, m.
    pub fn length(&self) -> f64 {
        self.joints.iter().map(offset).sum::<f64>() + self.flange.translation.vector.norm()
    }

    /// Joint angles near `seed` whose flange is at `target`, by damped Newton steps
    /// Δq = Jᵀ(J Jᵀ + λ²I)⁻¹ e on the twist e from the flange to the target, λ² falling with |e|.
    ///
    /// `None` if 30 steps do not meet the target within 1e-11 m and rad. (Nakamura, Hanafusa, "Inverse kinematic
    /// solutions with singularity robustness for robot manipulator control", 1986; damping by the error: Sugihara,
    /// 2011.)
    ///
    /// The error is of the pose: shift in m and rotation vector in rad, weighed alike. Steps are cut to 0.3 rad a
    /// joint. Quadratic near the solution; deterministic.
    pub fn inverse_near(&self, target: &Isometry3<f64>, seed: &Joints) -> Option<Iterated> {
        let mut q = *seed;
        for iterations in 0..=MOST_ITERATIONS {
            let frames = self.frames(&q);
            let flange = frames[AXES] * self.flange;
            let shift = target.translation.vector - flange.translation.vector;
            let turn = rotation_vector(&(target.rotation * flange.rotation.inverse()));
            let error = Vector6::new(shift.x, shift.y, shift.z, turn.x, turn.y, turn.z);
            if shift.norm() < MET && turn.norm() < MET {
                return Some(Iterated { joints: q, iterations });
            }
            let jacobian = self.jacobian(&frames, &flange.translation.vector.into());
            let damping = (1e-3 * error.norm_squared()).max(1e-18);
            let normal = jacobian * jacobian.transpose() + Matrix6::identity() * damping;
            let step = jacobian.transpose() * normal.cholesky()?.solve(&error);
            let scale = (LONGEST_STEP / step.amax()).min(1.0);
            for (angle, change) in q.iter_mut().zip(step.iter()) {
                *angle += scale * change;
            }
        }
        None
    }
}

/// From the joint before, m.
fn offset(joint: &Joint) -> f64 {
    joint.origin.translation.vector.norm()
}

#[cfg(feature = "unit-tests")]
mod tests {
    use nalgebra::UnitQuaternion;

    use super::*;

    #[test]
    fn the_second_joint_goes_around_the_first_axis_wherever_that_stands() {
        let at = |x: f64, y: f64, z: f64| Isometry3::translation(x, y, z);
        let leaning = Isometry3::from_parts(
            nalgebra::Translation3::new(0.3, -0.1, 0.2),
            UnitQuaternion::from_euler_angles(0.4, 1.2, 0.0),
        );
        for (first, second) in [(at(0.0, 0.0, 0.1), at(0.2, 0.0, 0.3)), (leaning, at(-0.25, 0.1, 0.05))] {
            let mut joints = [Joint { origin: at(0.0, 0.0, 0.2), axis: Vector3::z() }; AXES];
            (joints[0].origin, joints[1].origin) = (first, second);
            let chain = Chain { joints, flange: Isometry3::identity() };
            let (centre, radius) = chain.shoulder();
            for turn in 0..24 {
                let mut q = [0.0; AXES];
                q[0] = f64::from(turn) * 0.26;
                let joint: Point3<f64> = chain.frames(&q)[2].translation.vector.into();
                assert!(((joint - centre).norm() - radius).abs() < 1e-12, "{turn}");
            }
        }
    }

    /// A leaning base of 3 m, and the first joint's place along its axis: neither is a length of the arm.
    #[test]
    fn what_an_arm_stands_on_is_no_part_of_its_reach() {
        let at = |x: f64, y: f64, z: f64| Isometry3::translation(x, y, z);
        let mut joints = [Joint { origin: at(0.0, 0.0, 0.2), axis: Vector3::z() }; AXES];
        joints[1] = Joint { origin: at(0.3, 0.0, 0.05), axis: Vector3::y() };
        joints[3].axis = Vector3::x();
        joints[4].axis = Vector3::y();
        let chain = Chain { joints, flange: at(0.0, 0.05, 0.0) };
        assert!((chain.reach() - (0.3 + 4.0 * 0.2 + 0.05)).abs() < 1e-12, "{}", chain.reach());
        let mut stands = chain.clone();
        let base =
            Isometry3::from_parts(at(0.5, -1.0, 3.0).translation, UnitQuaternion::from_euler_angles(0.4, 1.2, 0.0));
        stands.joints[0].origin = base * chain.joints[0].origin;
        let mut slid = chain.clone();
        slid.joints[0].origin.translation.vector.z -= 2.0;
        slid.joints[1].origin.translation.vector.z += 2.0;
        for other in [&stands, &slid] {
            assert!((other.reach() - chain.reach()).abs() < 1e-12, "{}", other.reach());
            assert!(other.length() > chain.length() + 2.0);
            for turn in 0..50 {
                let q = std::array::from_fn(|k| f64::from(turn) * (0.3 + 0.2 * k as f64));
                assert!(!other.is_beyond(&other.forward(&q).translation.vector.into()), "{q:?}");
            }
            let (centre, _) = other.shoulder();
            assert!(other.is_beyond(&(centre + Vector3::x() * (chain.reach() + 1e-6))));
        }
    }
}
