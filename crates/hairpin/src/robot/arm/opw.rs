//! Six-axis arms with an ortho-parallel basis and a spherical wrist: the closed inverse kinematics, all eight
//! solutions.
//!
//! c = p − c4 R e_z; f = ±√(c_x² + c_y² − b²); θ1 = atan2(c_y, c_x) − atan2(b, f); two links c2 and k = √(a2² + c3²) in
//! the arm's plane; the wrist from W = R₀₃ᵀR = Rz(θ4) Ry(θ5) Rz(θ6). Three signs, eight solutions, no iteration.

use std::f64::consts::{PI, TAU};

use nalgebra::{Isometry3, Matrix3, Point3, Translation3, UnitQuaternion, Vector3};

use super::chain::{Chain, Joint};
use super::configuration::Branch;
use super::joints::{AXES, Joints};
use crate::math::power::square;
use crate::math::rotation::from_rotation_vector;

/// Dimensions (m) of an ortho-parallel basis with a spherical wrist, and how its axes count.
///
/// In the angles θ_k = sign_k·q_k − offset_k the arm points straight up at θ = 0; axes 1, 4, 6 turn about z, axes 2, 3,
/// 5 about y. The shoulder lies at (a1, b, c1), the elbow c2 above it, the wrist centre at (a2, c3) from the elbow, the
/// flange c4 beyond. (Brandstötter, Angerer, Hofbaur, "An analytical solution of the inverse kinematics problem of
/// industrial serial manipulators with an ortho-parallel basis and a spherical wrist", Austrian Robotics Workshop
/// 2014.)
///
/// Offsets in rad, signs ±1, both by axis; `a2` is negative where the forearm lies above the elbow, as on many arms.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Opw {
    /// Shoulder before axis 1.
    pub a1: f64,
    /// Forearm's axis before the elbow.
    pub a2: f64,
    /// Sideways offset of the arm's plane.
    pub b: f64,
    /// Shoulder above the base.
    pub c1: f64,
    /// Upper arm.
    pub c2: f64,
    /// Forearm.
    pub c3: f64,
    /// Wrist centre to flange.
    pub c4: f64,
    /// θ = sign·q − offset, rad.
    pub offsets: Joints,
    /// ±1 an axis.
    pub signs: Joints,
}

/// Where the wrist centre lies, as seen by the joints.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WristCentre {
    /// Horizontal distance from axis 1 in the arm's plane, m; negative behind axis 1.
    pub forward: f64,
    /// From the shoulder, in the arm's plane, m.
    pub from_shoulder: [f64; 2],
    /// The elbow's angle between upper arm and the line to the wrist centre, rad.
    pub elbow: f64,
    /// θ5, rad.
    pub bend: f64,
}

impl Opw {
    /// Length of the line from the elbow to the wrist centre, m.
    pub fn forearm(&self) -> f64 {
        libm::hypot(self.a2, self.c3)
    }

    /// Angle of that line against the forearm's axis, rad.
    fn slant(&self) -> f64 {
        libm::atan2(self.a2, self.c3)
    }

    /// θ of the joint angles `q`.
    fn paper(&self, q: &Joints) -> Joints {
        std::array::from_fn(|k| self.signs[k] * q[k] - self.offsets[k])
    }

    /// The same arm as a chain of joints.
    ///
    /// Offsets turn the joints' frames at rest by −offset about their axes and signs turn the axes round, so that q
    /// counts as the file has it: frames at q are those of θ = sign · q − offset.
    pub fn chain(&self) -> Chain {
        let (y, z) = (Vector3::y(), Vector3::z());
        let axes = [z, y, y, z, y, z];
        let shifts = [
            [0.0; 3],
            [self.a1, self.b, self.c1],
            [0.0, 0.0, self.c2],
            [self.a2, 0.0, 0.0],
            [0.0, 0.0, self.c3],
            [0.0; 3],
        ];
        let joints = std::array::from_fn(|k| Joint {
            origin: Isometry3::from_parts(
                Translation3::from(Vector3::from(shifts[k])),
                from_rotation_vector(&(axes[k] * -self.offsets[k])),
            ),
            axis: axes[k] * self.signs[k],
        });
        Chain { joints, flange: Isometry3::translation(0.0, 0.0, self.c4) }
    }

    /// The wrist centre at the joint angles `q`.
    ///
    /// ```text
    /// e = θ₃ + atan2(a2, c3),   (x, z) = c2 (sin θ₂, cos θ₂) + k (sin(θ₂ + e), cos(θ₂ + e)),   forward = x + a1
    /// ```
    pub fn wrist_centre(&self, q: &Joints) -> WristCentre {
        let theta = self.paper(q);
        let elbow = theta[2] + self.slant();
        let (s2, c2) = libm::sincos(theta[1]);
        let (s3, c3) = libm::sincos(theta[1] + elbow);
        let k = self.forearm();
        let from_shoulder = [self.c2 * s2 + k * s3, self.c2 * c2 + k * c3];
        WristCentre { forward: from_shoulder[0] + self.a1, from_shoulder, elbow, bend: theta[4] }
    }

    /// Which of the eight solutions `q` is.
    pub fn branch(&self, q: &Joints) -> Branch {
        let at = self.wrist_centre(q);
        Branch {
            behind_axis_1: at.forward < 0.0,
            behind_lower_arm: libm::sin(at.elbow) < 0.0,
            axis_5_negative: self.signs[4] * libm::sin(at.bend) < 0.0,
        }
    }

    /// Joint angles in (−π, π] at which the flange is at `flange`, in one branch; `None` out of reach.
    ///
    /// Where the wrist is stretched (sin θ5 = 0) only θ4 + θ6 is determined, and `q4` (rad) is taken for axis 4.
    ///
    /// Angles satisfy [`Opw::forward`] to rounding, about 1e-15 of a turn away from singularities; limits are not
    /// looked at.
    pub fn solve(&self, flange: &Isometry3<f64>, branch: Branch, q4: f64) -> Option<Joints> {
        let rotation = flange.rotation.to_rotation_matrix();
        let r = rotation.matrix();
        let centre: Point3<f64> = (flange.translation.vector - r.column(2) * self.c4).into();
        // The arm's plane passes b beside axis 1.
        let square_forward = square(centre.x) + square(centre.y) - square(self.b);
        if square_forward < 0.0 {
            return None;
        }
        let forward = if branch.behind_axis_1 { -square_forward.sqrt() } else { square_forward.sqrt() };
        let theta1 = libm::atan2(centre.y, centre.x) - libm::atan2(self.b, forward);
        // Two links in that plane.
        let (x, z, k) = (forward - self.a1, centre.z - self.c1, self.forearm());
        let cos_elbow = (square(x) + square(z) - square(self.c2) - square(k)) / (2.0 * self.c2 * k);
        if cos_elbow.abs() > 1.0 {
            return None;
        }
        let sin_elbow = (1.0 - square(cos_elbow)).max(0.0).sqrt() * if branch.behind_lower_arm { -1.0 } else { 1.0 };
        let theta2 = libm::atan2(x, z) - libm::atan2(k * sin_elbow, self.c2 + k * cos_elbow);
        let theta3 = libm::atan2(sin_elbow, cos_elbow) - self.slant();
        // What the forearm leaves of the rotation is Rz(θ4) Ry(θ5) Rz(θ6).
        let (s1, c1) = libm::sincos(theta1);
        let (s, c) = libm::sincos(theta2 + theta3);
        let forearm = Matrix3::new(c1 * c, -s1, c1 * s, s1 * c, c1, s1 * s, -s, 0.0, c);
        let wrist = forearm.transpose() * r;
        let sin5 = libm::hypot(wrist[(0, 2)], wrist[(1, 2)]);
        let negative = branch.axis_5_negative != (self.signs[4] < 0.0);
        let sign = if negative { -1.0 } else { 1.0 };
        let theta5 = libm::atan2(sign * sin5, wrist[(2, 2)]);
        let (theta4, theta6) = if sin5 > 1e-12 {
            let theta4 = libm::atan2(sign * wrist[(1, 2)], sign * wrist[(0, 2)]);
            (theta4, libm::atan2(sign * wrist[(2, 1)], -sign * wrist[(2, 0)]))
        } else {
            let theta4 = self.signs[3] * q4 - self.offsets[3];
            let (s4, c4) = libm::sincos(theta4);
            // The columns of Rz(−θ4) W, W = Rz(θ4) Ry(0 or π) Rz(θ6).
            let sine = -s4 * wrist[(0, 0)] + c4 * wrist[(1, 0)];
            let cosine = -s4 * wrist[(0, 1)] + c4 * wrist[(1, 1)];
            (theta4, libm::atan2(sine, cosine))
        };
        let theta = [theta1, theta2, theta3, theta4, theta5, theta6];
        Some(std::array::from_fn(|k| half_turn(self.signs[k] * (theta[k] + self.offsets[k]))))
    }

    /// Every solution at which the flange is at `flange`, in the order of cfx; see [`Opw::solve`] for `q4`.
    ///
    /// At most eight; fewer where the wrist centre is too near axis 1 or out of the two links' reach.
    pub fn solutions(&self, flange: &Isometry3<f64>, q4: f64) -> impl Iterator<Item = Joints> {
        (0..8).filter_map(move |cfx| self.solve(flange, Branch::from_cfx(cfx), q4))
    }

    /// `base_from_flange` in closed form: what [`Chain::forward`] computes by its product of transforms.
    pub fn forward(&self, q: &Joints) -> Isometry3<f64> {
        let theta = self.paper(q);
        let at = self.wrist_centre(q);
        let turn = |axis: Vector3<f64>, angle: f64| from_rotation_vector(&(axis * angle));
        let (y, z) = (Vector3::y(), Vector3::z());
        let rotation: UnitQuaternion<f64> = turn(z, theta[0])
            * turn(y, theta[1] + theta[2])
            * turn(z, theta[3])
            * turn(y, theta[4])
            * turn(z, theta[5]);
        let (s1, c1) = libm::sincos(theta[0]);
        let centre =
            Vector3::new(at.forward * c1 - self.b * s1, at.forward * s1 + self.b * c1, at.from_shoulder[1] + self.c1);
        Isometry3::from_parts(Translation3::from(centre + rotation * Vector3::new(0.0, 0.0, self.c4)), rotation)
    }
}

/// The same direction in (−π, π].
///
/// NaN stays NaN. −π itself becomes π.
fn half_turn(angle: f64) -> f64 {
    let turned = angle - TAU * (angle / TAU).round();
    if turned <= -PI { turned + TAU } else { turned }
}

/// The angle of the same direction as `angle` that is nearest to `reference`, rad.
pub fn nearest_turn(angle: f64, reference: f64) -> f64 {
    angle + TAU * ((reference - angle) / TAU).round()
}

/// Every angle of `q` on the turn nearest to `reference`.
pub fn nearest_turns(q: &Joints, reference: &Joints) -> Joints {
    std::array::from_fn::<f64, AXES, _>(|k| nearest_turn(q[k], reference[k]))
}
