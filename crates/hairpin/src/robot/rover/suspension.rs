//! How the body rests on the ground: height, roll, pitch and joints from the wheels' contacts.

use nalgebra::{Matrix3, Vector3};
use thiserror::Error;

use super::RockerBogie;
use super::four_wheel::FourWheel;
use crate::world::terrain::{NoGround, Terrain};

/// The kinds of suspension.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Suspension {
    /// The body is a point on the ground, level whatever lies below: motion in the plane.
    Level,
    /// Four wheels on a rigid body: the plane of least squares through the four contacts.
    FourWheel(FourWheel),
    /// Six wheels on a rocker-bogie.
    RockerBogie(RockerBogie),
}

/// A pose at rest on the ground.
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
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Gradient {
    /// Rows z, φ, θ, rocker, bogies; columns x, y (1/m), ψ (1/rad).
    pub by_place: [[f64; 3]; 6],
}

impl Gradient {
    /// Change of (z, φ, θ, rocker, bogies) to first order where the place moves by (x, y, ψ).
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
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum Unsettled {
    /// A wheel has no ground below it.
    #[error(transparent)]
    NoGround(#[from] NoGround),
    /// The contacts do not determine the pose.
    #[error("the wheels' contacts do not determine the pose")]
    Singular,
    /// Newton's method ended with a gap.
    #[error("a wheel stays {gap:.4} m off the ground")]
    NotConverged {
        /// Largest |gap|, m.
        gap: f64,
    },
}

/// Gaps from which one more step of Newton ends at rounding errors, m.
const EXACT: f64 = 1e-6;

impl Suspension {
    /// The pose in which the wheels touch the ground at (x, y, ψ) = `at`, from `guess`, and its gradient.
    ///
    /// Newton's last step is taken from gaps of at most `coarse` (m): what it leaves is of the order of their square, by 1/m.
    ///
    /// # Errors
    /// [`Unsettled`]: no ground, or no rest found.
    #[inline]
    pub fn settle<T: Terrain>(
        &self,
        terrain: &T,
        at: [f64; 3],
        guess: &Settled,
        coarse: f64,
    ) -> Result<(Settled, Gradient), Unsettled> {
        match self {
            Self::Level => Ok((Settled::default(), Gradient::default())),
            Self::FourWheel(body) => body.settle(terrain, at, guess, coarse),
            Self::RockerBogie(body) => body.settle(terrain, at, guess, coarse),
        }
    }

    /// The same without a guess: from the plane that the ground has below the body.
    ///
    /// # Errors
    /// [`Unsettled`]: no ground, or no rest found.
    pub fn settle_cold<T: Terrain>(&self, terrain: &T, at: [f64; 3]) -> Result<(Settled, Gradient), Unsettled> {
        if matches!(self, Self::Level) {
            return Ok((Settled::default(), Gradient::default()));
        }
        let ground = terrain.patch(at[0], at[1])?;
        let (sin, cos) = libm::sincos(at[2]);
        let forward = cos * ground.slope[0] + sin * ground.slope[1];
        let left = cos * ground.slope[1] - sin * ground.slope[0];
        let pitch = -libm::atan(forward);
        let guess = Settled {
            z: ground.height + self.ride_height(),
            roll: libm::atan(left * libm::cos(pitch)),
            pitch,
            joints: [0.0; 3],
        };
        // A single spot can lie in a pit or on a rock; level is the second try.
        self.settle(terrain, at, &guess, EXACT).or_else(|error| match error {
            Unsettled::NoGround(_) => Err(error),
            _ => self.settle(terrain, at, &Settled { z: guess.z, ..Settled::default() }, EXACT),
        })
    }

    /// Distance between the foremost and the rearmost axle, m; `None` without wheels.
    pub fn wheelbase(&self) -> Option<f64> {
        let span = |x: &[f64]| x.iter().fold(f64::MIN, |a, b| a.max(*b)) - x.iter().fold(f64::MAX, |a, b| a.min(*b));
        match self {
            Self::Level => None,
            Self::FourWheel(body) => Some(span(&body.wheels.map(|w| w.x))),
            Self::RockerBogie(body) => Some(span(&body.wheels(&[0.0; 3]).map(|w| w.x))),
        }
    }

    /// Height of the body's origin over level ground, m.
    pub fn ride_height(&self) -> f64 {
        match self {
            Self::Level => 0.0,
            Self::FourWheel(body) => body.ride_height(),
            Self::RockerBogie(body) => {
                let wheels = body.wheels(&[0.0; 3]);
                body.wheel_radius - wheels.iter().map(|w| w.z).sum::<f64>() / 6.0
            }
        }
    }
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
    pub(super) fn by_angles(&self, lever: &Vector3<f64>) -> [f64; 3] {
        [lever.x, self.pitch_axis.dot(lever), self.yaw_axis.dot(lever)]
    }
}
