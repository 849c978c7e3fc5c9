//! A rigid body carried from one rest on the ground to the next by what is commanded of its twist.
//!
//! Commanded are vx, vy and ωz in the body; vz, ωx and ωy are whatever keeps the wheels on the ground. So the next rest
//! is the one that a motion with these three leads to: it is looked for, and the twist is measured between the two
//! poses as a screw. No rates of angles, no gradient of the suspension.
//!
//! log of the relative pose: rotation R₀ᵀR₁ as axis times angle, translation by the screw's mean frame. Three numbers
//! of it are commanded, three are the ground's.

use nalgebra::{Matrix3, Vector3};

use super::stand::{NoRest, Rest, Stand, turn};
use crate::world::terrain::Terrain;

/// How the body leans.
pub(super) struct Place {
    /// sin φ, cos φ.
    pub(super) roll: (f64, f64),
    /// sin θ, cos θ.
    pub(super) pitch: (f64, f64),
}

impl Place {
    /// Of angles in rad.
    pub(super) fn new(roll: f64, pitch: f64) -> Self {
        Self { roll: libm::sincos(roll), pitch: libm::sincos(pitch) }
    }
}

/// Tries of a rest.
const TRIES: usize = 60;
/// Differences of vx, vy, ωz over a step that rests themselves are not known to, and from which a body counts as
/// carried, m and rad.
const CLOSED: f64 = 3e-9;
const ENOUGH: f64 = 1e-6;

/// The place (x, y, ψ) after a step of `h` from `from`, where the body has come to `rest`, at the rates that `body`
/// gives for how it leans halfway; `rest` is then the one there. It is looked for from `ahead`.
///
/// `body` gives vx, vy (m) and ωz (rad) per unit of `h`. A fixed-point iteration on the place: what the twist lacks is
/// added, turned into the world; it contracts as steps are small beside the ground's curvature. `NoRest` where the body
/// finds no rest, or 60 tries leave more than 10⁻⁶.
///
/// ```text
/// R₀ᵀ R₁ = exp([θ]×),   R_m = R₀ exp([θ/2]×)
/// R_mᵀ (p₁ − p₀) = (h vx, h vy, ·),   θ_z = h ωz          three equations for (x, y, ψ) of the next rest
/// ```
///
/// R₀, p₀ are the body's attitude and place (world) at the first rest, R₁, p₁ at the next; dots are whatever the
/// ground makes of them. The commanded rates are asked at the mean of both rolls and pitches. One rest a try. Ends
/// at 3 · 10⁻⁹.
pub(super) fn carry<T: Terrain>(
    stand: &Stand,
    terrain: &T,
    rest: &mut Rest,
    [from, ahead]: [[f64; 3]; 2],
    h: f64,
    body: impl Fn(&Place) -> [f64; 3],
) -> Result<[f64; 3], NoRest> {
    rest.carry_on(stand, terrain, from)?;
    let (begun, origin) = (attitude(rest, from[2]), Vector3::new(from[0], from[1], rest.height()));
    let leant = [rest.roll(), rest.pitch()];
    let mut place = ahead;
    let mut left = f64::INFINITY;
    for _ in 0..TRIES {
        rest.carry_on(stand, terrain, place)?;
        let (ended, there) = (attitude(rest, place[2]), Vector3::new(place[0], place[1], rest.height()));
        let turned = small_turn(&(begun.transpose() * ended));
        // In the frame halfway between the two.
        let halfway = begun * rotation(&(0.5 * turned));
        let moved = halfway.transpose() * (there - origin);
        let middle = Place::new(0.5 * (leant[0] + rest.roll()), 0.5 * (leant[1] + rest.pitch()));
        let asked = body(&middle).map(|rate| h * rate);
        let lacks = Vector3::new(asked[0] - moved.x, asked[1] - moved.y, asked[2] - turned.z);
        left = lacks.amax();
        if left < CLOSED {
            return Ok(place);
        }
        let over = halfway * Vector3::new(lacks.x, lacks.y, 0.0);
        place = [place[0] + over.x, place[1] + over.y, place[2] + lacks.z];
    }
    if left < ENOUGH { Ok(place) } else { Err(NoRest::NotFound) }
}

/// Axis times angle of a rotation of less than a right angle, from its antisymmetric part, which is axis times sine.
///
/// Below a sine of 10⁻⁸ the sine is the angle to a double's digits. Angles beyond a right one would come out as their
/// supplement: steps are far smaller.
fn small_turn(rotation: &Matrix3<f64>) -> Vector3<f64> {
    let odd = 0.5 * (rotation - rotation.transpose());
    let sines = Vector3::new(odd[(2, 1)], odd[(0, 2)], odd[(1, 0)]);
    let sine = sines.norm();
    if sine < 1e-8 { sines } else { sines * (libm::asin(sine.min(1.0)) / sine) }
}

/// The rotation about an axis by its length (Rodrigues).
fn rotation(turn: &Vector3<f64>) -> Matrix3<f64> {
    let angle = turn.norm();
    if angle == 0.0 {
        return Matrix3::identity();
    }
    let (sin, cos) = libm::sincos(angle);
    let across = (turn / angle).cross_matrix();
    Matrix3::identity() + sin * across + (1.0 - cos) * across * across
}

/// world_from_body = Rz(ψ) Ry(θ) Rx(φ).
fn attitude(rest: &Rest, yaw: f64) -> Matrix3<f64> {
    turn(2, yaw) * turn(1, rest.pitch()) * turn(0, rest.roll())
}
