//! A body at rest on the ground: height, roll, pitch and joints, and how they change with its place.
//!
//! F_i = z_i − c(x_i, y_i) for wheel i's centre in the world; ∂F/∂(angle) = (axis × b)·Rᵀ∇F for a wheel at b in the
//! body. The same linear system gives Newton's step and the gradient by the place.

use nalgebra::{Matrix3, Vector3};
use thiserror::Error;

use crate::world::terrain::NoGround;

/// A pose at rest on the ground.
///
/// A rest is a local one: rough ground has several, and which is found depends on the guess, as where a rover stands
/// depends on where it came from.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Settled {
    /// Height of the body's origin, m.
    pub z: f64,
    /// φ, rad.
    pub roll: f64,
    /// θ, rad, nose down positive.
    pub pitch: f64,
    /// Rocker (left positive, right opposite), left and right bogie, rad; 0 where there is none.
    pub joints: [f64; 3],
}

/// How a settled pose changes with (x, y, ψ) while the wheels stay on the ground, by the implicit function theorem:
/// F(q; x, y, ψ) = 0 gives dq = −F_q⁻¹ F_(x, y, ψ) d(x, y, ψ).
///
/// Exact for six-wheelers (F = 0 is square); for four wheels that of the Gauss-Newton model, which is exact where the
/// gaps vanish. The map is C¹, so it jumps at cell borders.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Gradient {
    /// Rows z, φ, θ, rocker, bogies; columns x, y (1/m), ψ (1/rad).
    pub by_place: [[f64; 3]; 6],
}

impl Gradient {
    /// Change of (z, φ, θ, rocker, bogies) to first order where the place moves by (x, y, ψ).
    ///
    /// `moved` in m, m, rad; out: m, then rad.
    pub fn over(&self, moved: [f64; 3]) -> [f64; 6] {
        self.by_place.map(|row| row[0] * moved[0] + row[1] * moved[1] + row[2] * moved[2])
    }

    /// dφ/d(x, y, ψ).
    pub fn roll(&self) -> [f64; 3] {
        self.by_place[1]
    }

    /// dθ/d(x, y, ψ).
    pub fn pitch(&self) -> [f64; 3] {
        self.by_place[2]
    }
}

/// Why a body finds no rest.
///
/// Evidence, not an error of the caller's: a drive through such a place is refused for this reason.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum Unsettled {
    /// A wheel has no ground below it.
    #[error(transparent)]
    NoGround(#[from] NoGround),
    /// The contacts do not determine the pose.
    #[error("the wheels' contacts do not determine the pose")]
    Singular,
    /// All wheels would touch the ground only with a bogie on its head.
    #[error("a rocker or bogie would stand on its head")]
    OnItsHead,
    /// Newton's method ended with a gap.
    #[error("a wheel stays {gap:.4} m off the ground")]
    NotConverged {
        /// Largest |gap|, m.
        gap: f64,
    },
}

impl Settled {
    /// This pose moved by (z, φ, θ, rocker, bogies).
    pub fn moved(&self, step: &[f64; 6]) -> Self {
        Self {
            z: self.z + step[0],
            roll: self.roll + step[1],
            pitch: self.pitch + step[2],
            joints: [self.joints[0] + step[3], self.joints[1] + step[4], self.joints[2] + step[5]],
        }
    }
}

/// R = Rz(ψ) Ry(θ) Rx(φ), with the axes about which each angle turns the body.
pub(super) struct Attitude {
    pub(super) world_from_body: Matrix3<f64>,
    pitch_axis: Vector3<f64>,
    yaw_axis: Vector3<f64>,
}

impl Attitude {
    pub(super) fn new(roll: f64, pitch: f64, yaw: f64) -> Self {
        let ((sf, cf), (st, ct), (sp, cp)) = (libm::sincos(roll), libm::sincos(pitch), libm::sincos(yaw));
        Self {
            world_from_body: Matrix3::new(
                cp * ct,
                cp * st * sf - sp * cf,
                cp * st * cf + sp * sf,
                sp * ct,
                sp * st * sf + cp * cf,
                sp * st * cf - cp * sf,
                -st,
                ct * sf,
                ct * cf,
            ),
            pitch_axis: Vector3::new(0.0, cf, -sf),
            yaw_axis: Vector3::new(-st, ct * sf, ct * cf),
        }
    }

    /// ∂F/∂(φ, θ, ψ) for `lever` = b × Rᵀ∇F: the derivative of R b by an angle is R (axis × b).
    ///
    /// Axes in the body: x for φ, (0, cos φ, −sin φ) for θ, the world's z for ψ.
    pub(super) fn by_angles(&self, lever: &Vector3<f64>) -> [f64; 3] {
        [lever.x, self.pitch_axis.dot(lever), self.yaw_axis.dot(lever)]
    }
}
