//! The kinds of suspension, and where a search for rest begins.
//!
//! Three ways in, by what is known: [`Suspension::settle`] from a guess, [`Suspension::settle_cold`] from the ground
//! alone, [`Suspension::carry_on`] along a drive, where a body may fall from one rest to another. All three are
//! deterministic, allocate nothing, and try in a fixed order.

use std::f64::consts::FRAC_PI_2;

use nalgebra::Vector3;

use super::RockerBogie;
use super::four_wheel::FourWheel;
use super::rest::{Gradient, Settled, Unsettled};
use crate::world::terrain::Terrain;

/// The kinds of suspension.
///
/// `Level` is for motion in the plane: z, φ, θ are 0 whatever the terrain says.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Suspension {
    /// The body is a point on the ground, level whatever lies below: motion in the plane.
    Level,
    /// Four wheels on a rigid body: the plane of least squares through the four contacts.
    FourWheel(FourWheel),
    /// Six wheels on a rocker-bogie.
    RockerBogie(RockerBogie),
}

/// How far above the ground's height a search for rest begins when it found none from there, m.
const ABOVE: f64 = 0.3;
/// Joints, and the angles (rad) by which they are folded before the rest of a body that falls is looked for, in turn.
const FALLS: [(usize, f64); 12] = [
    (1, 0.6),
    (1, -0.6),
    (2, 0.6),
    (2, -0.6),
    (0, 0.6),
    (0, -0.6),
    (1, 0.3),
    (1, -0.3),
    (2, 0.3),
    (2, -0.3),
    (0, 0.3),
    (0, -0.3),
];
/// Gaps from which one more step of Newton ends at rounding errors, m.
const EXACT: f64 = 1e-6;

impl Suspension {
    /// The pose in which the wheels touch the ground at (x, y, ψ) = `at`, from `guess`, and its gradient.
    ///
    /// Newton's last step is taken from gaps of at most `coarse` (m): what it leaves is of the order of their square,
    /// by 1/m.
    ///
    /// `at` = [x, y, ψ] in m, m, rad in the world. Quadratic convergence: `coarse` of 1 mm leaves about a micrometre on
    /// ground with bends of 1/m, for one look less.
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
            Self::RockerBogie(body) => {
                let (settled, gradient) = body.settle(terrain, at, guess, coarse)?;
                // The contacts know wheels, not links: they are met by links turned upside down as well.
                if settled.joints.iter().any(|joint| joint.abs() > FRAC_PI_2) {
                    return Err(Unsettled::OnItsHead);
                }
                Ok((settled, gradient))
            }
        }
    }

    /// The same without a guess: from the plane that the ground has below the body.
    ///
    /// Up to six guesses: the tangent plane below the origin, level, between, and the same from 0.3 m above.
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
        // A single spot can lie in a pit or on a rock; level is the second try, and then what lies between and above.
        let mut found = self.settle(terrain, at, &guess, EXACT);
        for (share, above) in [(0.0, 0.0), (0.5, 0.0), (1.0, ABOVE), (0.0, ABOVE), (0.5, ABOVE)] {
            if found.is_ok() || matches!(found, Err(Unsettled::NoGround(_))) {
                break;
            }
            let Settled { z, roll, pitch, joints } = guess;
            found = self.settle(
                terrain,
                at,
                &Settled { z: z + above, roll: share * roll, pitch: share * pitch, joints },
                EXACT,
            );
        }
        found
    }

    /// The pose at a place near the last one, from `guess`, that one carried on: where the body falls over an edge, a
    /// rest that it comes to. `coarse` as for [`Self::settle`].
    ///
    /// After the guess and a cold start, one joint folded by ±0.6 and ±0.3 rad, bogies first: the links' own ways of
    /// falling (docs/rover-generator.md, "Where a body falls").
    ///
    /// # Errors
    /// [`Unsettled`]: no ground, or no rest found.
    pub fn carry_on<T: Terrain>(
        &self,
        terrain: &T,
        at: [f64; 3],
        guess: &Settled,
        coarse: f64,
    ) -> Result<(Settled, Gradient), Unsettled> {
        let found = self.settle(terrain, at, guess, coarse).or_else(|_| self.settle_cold(terrain, at));
        if found.is_ok() || matches!(found, Err(Unsettled::NoGround(_))) || !matches!(self, Self::RockerBogie(_)) {
            return found;
        }
        let fallen = |(joint, angle): (usize, f64)| {
            let mut folded = *guess;
            folded.joints[joint] += angle;
            self.settle(terrain, at, &folded, EXACT).ok()
        };
        FALLS.into_iter().find_map(fallen).map_or(found, Ok)
    }

    /// Centres of the wheels in the body frame for given joints, how many there are, and their radius, m.
    pub fn wheels(&self, joints: &[f64; 3]) -> ([Vector3<f64>; 6], usize, f64) {
        let mut places = [Vector3::zeros(); 6];
        match self {
            Self::Level => (places, 0, 0.0),
            Self::FourWheel(body) => {
                places[..4].copy_from_slice(&body.wheels);
                (places, 4, body.wheel_radius)
            }
            Self::RockerBogie(body) => (body.wheels(joints), 6, body.wheel_radius),
        }
    }

    /// Radius of the circle about the body's origin that passes through the outermost wheel's centre, m; 0 without
    /// wheels.
    ///
    /// Joints at 0; the wheels' own radius is not added.
    pub fn outer_radius(&self) -> f64 {
        let (wheels, count, _) = self.wheels(&[0.0; 3]);
        wheels[..count].iter().map(|wheel| libm::hypot(wheel.x, wheel.y)).fold(0.0, f64::max)
    }

    /// Distance between the foremost and the rearmost axle, m; `None` without wheels.
    pub fn wheelbase(&self) -> Option<f64> {
        let (wheels, count, _) = self.wheels(&[0.0; 3]);
        let x = || wheels[..count].iter().map(|w| w.x);
        (count > 0).then(|| x().fold(f64::MIN, f64::max) - x().fold(f64::MAX, f64::min))
    }

    /// Height of the body's origin over level ground, m.
    ///
    /// r less the mean height of the wheels' centres in the body frame, joints at 0.
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
