//! Which rotor speeds a polynomial demands, by arithmetic on truncated Taylor series.
//!
//! Thrust vector F = m (p̈ + g e₃) + (c₁ + c₂|v|) v, attitude R with z_b = F/|F| and yaw 0, ω from Ṙ = R [ω]×,
//! τ = I ω̇ + ω × Iω + c_a |ω| ω. All as series in time to the order needed, so that no derivative is written out.
//!
//! The same physics as `feasibility`'s flatness map, by another calculus: there derivatives are written out and
//! bounded, here series are multiplied. A sign wrong in either shows as a flight that does not arrive.

use nalgebra::{Vector3, Vector4};

use super::body::{Body, Mixer};
use super::claim::Leg;
use super::jet::{Jet, JetVector, cross, dot, times};
use crate::math::power::square;

/// The robot's state and rotor speeds that the polynomial demands at one moment.
#[derive(Debug, Clone, Copy)]
pub(super) struct Demand {
    /// Squared rotor speeds; negative ones cannot be flown.
    pub(super) squares: [f64; 4],
}

/// Why there is no demand: the quantity that vanishes, N or pure number.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Singular {
    /// Free fall: the thrust vector vanishes and the attitude is undefined.
    FreeFall(f64),
    /// Yaw is undefined.
    Yaw(f64),
}

/// Smallest thrust as a share of the weight, and smallest sine, that count as not singular.
const SMALL: f64 = 1e-6;

/// The demand of `leg` at τ.
///
/// `tau` in s from the leg's start. p to fourth order gives F to second, R to second, ω to first and τ. `Singular`
/// where |F| falls below 10⁻⁶ of the weight or the thrust points along ±y, where yaw 0 has no meaning.
pub(super) fn demand(body: &Body, mixer: &Mixer, leg: &Leg, tau: f64) -> Result<Demand, Singular> {
    let taylor = leg.taylor(tau);
    let velocity: JetVector = taylor.map(|p| Jet([p[1], 2.0 * p[2], 3.0 * p[3]]));
    let mut force: JetVector = taylor.map(|p| Jet([2.0 * p[2], 6.0 * p[3], 12.0 * p[4]]).scaled(body.mass));
    force[2].0[0] += body.mass * body.gravity;
    let drag = drag(body, &velocity);
    let force: JetVector = std::array::from_fn(|axis| force[axis] + drag[axis]);

    let thrust_squared = dot(&force, &force);
    let weight = body.mass * body.gravity.abs().max(1.0);
    if thrust_squared.value() <= square(SMALL * weight) {
        return Err(Singular::FreeFall(thrust_squared.value().max(0.0).sqrt()));
    }
    let thrust = thrust_squared.sqrt();
    let z = times(&force, thrust.recip());
    let (x, y) = heading(&z)?;

    // ω_x = ẏ·z, ω_y = ż·x, ω_z = ẋ·y, to first order.
    let rate = |axis: &JetVector| axis.map(Jet::rate);
    let omega = [dot(&rate(&y), &z), dot(&rate(&z), &x), dot(&rate(&x), &y)];
    let rates = Vector3::from(omega.map(Jet::value));
    let turning = Vector3::from(omega.map(|jet| jet.0[1]));
    let inertia = Vector3::from(body.inertia);
    let moments = inertia.component_mul(&turning)
        + rates.cross(&inertia.component_mul(&rates))
        + rates * (body.aerodynamic_moment * rates.norm());
    let wrench = Vector4::new(thrust.value(), moments.x, moments.y, moments.z);
    Ok(Demand { squares: mixer.squares(&wrench) })
}

/// (c₁ + c₂|v|) v. At v = 0, |v| has no series but |v| v has: |a| a t² with v = a t + ….
///
/// As a series to second order, N. Below |v|² = 10⁻²⁰⁰ the first coefficients of |v| v vanish and its second is |a| a,
/// which is one-sided in time: exact for τ after the moment of rest.
pub(super) fn drag(body: &Body, velocity: &JetVector) -> JetVector {
    let square = dot(velocity, velocity);
    let quadratic = if square.value() > 1e-200 {
        times(velocity, square.sqrt())
    } else {
        let acceleration = Vector3::from(velocity.map(|jet| jet.0[1]));
        (acceleration * acceleration.norm()).map(|c| Jet([0.0, 0.0, c])).into()
    };
    std::array::from_fn(|axis| velocity[axis].scaled(body.drag_linear) + quadratic[axis].scaled(body.drag_quadratic))
}

/// Body x and y for yaw 0 (z-y-x Euler angles): body x has no component along world y.
///
/// ```text
/// x = (z₃, 0, −z₁)/hypot(z₁, z₃),   y = z × x
/// ```
///
/// x is across z and has no component along world y; it points forward as long as the thrust points up (z₃ > 0). `Yaw`
/// where the hypotenuse, the sine between thrust and world y, is 10⁻⁶ or less.
fn heading(z: &JetVector) -> Result<(JetVector, JetVector), Singular> {
    let along: JetVector = [z[2], Jet::ZERO, Jet::ZERO - z[0]];
    let square = dot(&along, &along);
    if square.value() <= SMALL * SMALL {
        return Err(Singular::Yaw(square.value().max(0.0).sqrt()));
    }
    let x = times(&along, square.sqrt().recip());
    Ok((x, cross(z, &x)))
}
