//! Where a chain's links are, by products of exponentials: every joint turns about a line that is known where all
//! angles are 0.
//!
//! ```text
//! E_k = exp(ξ₁q₁) … exp(ξ_k q_k),   base_from_link k = E_k · rest_k,   column k of J = (ω_k × (p − r_k), ω_k)
//! ```
//!
//! Brockett, "Robotic manipulators and the product of exponentials formula" (1984). The claim multiplies frames from
//! joint to joint instead, so that a sign wrong in either shows.

use nalgebra::{Isometry3, Matrix6, Point3, Quaternion, UnitQuaternion, Vector3};

use super::claim::ArmJointClaim;

/// The lines that the joints turn about, and the links, where all angles are 0.
#[derive(Debug, Clone)]
pub(super) struct Screws {
    /// A point and the direction of each line, base frame.
    pub(super) lines: [(Point3<f64>, Vector3<f64>); 6],
    /// `base_from_link` of the base and the six links.
    pub(super) rest: [Isometry3<f64>; 7],
}

/// How far all joints up to each have carried what was there at rest: E_k = exp(ξ₁q₁) … exp(ξ_k q_k).
#[derive(Debug, Clone)]
pub(super) struct Carried([Isometry3<f64>; 7]);

impl Screws {
    /// Links at angles 0, by the frames of the joints one after the other.
    pub(super) fn of(joints: &[ArmJointClaim; 6]) -> Self {
        let mut rest = [Isometry3::identity(); 7];
        for (k, joint) in joints.iter().enumerate() {
            rest[k + 1] = rest[k] * joint.parent_from_joint;
        }
        let line = |k: usize| (rest[k + 1].translation.vector.into(), rest[k + 1].rotation * joints[k].axis);
        Self { lines: std::array::from_fn(line), rest }
    }

    /// E₀ = 1 to E₆, of angles in rad.
    pub(super) fn carried(&self, q: &[f64; 6]) -> Carried {
        let mut all = [Isometry3::identity(); 7];
        for (k, angle) in q.iter().enumerate() {
            all[k + 1] = all[k] * self.turn(k, *angle);
        }
        Carried(all)
    }

    /// exp(ξ_k q) = (R, p − R p): the turn by q about line k.
    ///
    /// As a quaternion of half the angle; `direction` is of length 1.
    pub(super) fn turn(&self, k: usize, angle: f64) -> Isometry3<f64> {
        let (point, direction) = self.lines[k];
        let (sine, cosine) = libm::sincos(0.5 * angle);
        let turn = UnitQuaternion::new_unchecked(Quaternion::from_parts(cosine, direction * sine));
        Isometry3::from_parts((point - turn * point).into(), turn)
    }
}

impl Carried {
    /// `base_from_link` of link k, 0 the base.
    pub(super) fn link(&self, screws: &Screws, k: usize) -> Isometry3<f64> {
        self.0[k] * screws.rest[k]
    }

    /// Line k as joints 0 … k have carried it: a point and its direction.
    pub(super) fn line(&self, screws: &Screws, k: usize) -> (Point3<f64>, Vector3<f64>) {
        let (point, direction) = screws.lines[k];
        (self.0[k] * point, self.0[k] * direction)
    }

    /// A point that was at `point` at rest and that the first `k` joints carry.
    pub(super) fn point(&self, k: usize, point: &Point3<f64>) -> Point3<f64> {
        self.0[k] * point
    }

    /// Velocity of the last link's point at `place` (m/rad) above its angular velocity, a column a joint.
    pub(super) fn jacobian(&self, screws: &Screws, place: &Vector3<f64>) -> Matrix6<f64> {
        let mut jacobian = Matrix6::zeros();
        for k in 0..6 {
            let (point, direction) = self.line(screws, k);
            jacobian.fixed_view_mut::<3, 1>(0, k).copy_from(&direction.cross(&(place - point.coords)));
            jacobian.fixed_view_mut::<3, 1>(3, k).copy_from(&direction);
        }
        jacobian
    }
}
