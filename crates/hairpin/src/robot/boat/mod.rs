//! Boats: numbers, checks, and the manoeuvring model in three degrees of freedom, surge, sway and yaw.
//!
//! ```text
//! ẋ = u cosψ − v sinψ + c_x     ẏ = u sinψ + v cosψ + c_y     ψ̇ = r
//! M ν̇ + C(ν) ν + D(ν) ν = τ      ν = (u, v, r) through the water, τ = (X, Y, N)
//! ```
//!
//! Fossen, "Handbook of Marine Craft Hydrodynamics and Motion Control" (2011), ch. 6 and 7, with all coefficients of
//! Skjetne, Smogeli and Fossen, "A nonlinear ship manoeuvering model" (Modeling, Identification and Control 25(1),
//! 2004). A steady current c is irrotational, so that the rigid body's equations hold for the velocity through the
//! water as they do for that over ground (Fossen's property 8.1), and the current only carries the boat along.
//!
//! That paper's axes are x forward, y to starboard, z down; ours are x forward, y to port, z up. Both v and r, and Y
//! and N, change their sign, so that every coefficient is the same in both. Thrust answers at once here; its lag, noise
//! and forces from outside are the plant's (`simulation`).

mod description;
mod hull;
mod model;
#[cfg(feature = "unit-tests")]
mod tests;

pub use description::{BoatDescription, BoatError, BoatKind, Hydrodynamics, ThrustDescription};
pub use hull::{Boat, Thrust};
pub use model::{Damping, Inertia};
#[cfg(feature = "unit-tests")]
pub(crate) use tests::cybership;
