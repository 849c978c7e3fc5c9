//! Boats in our own simulator: the hull's equations with what the claim leaves out, thrusters that lag and end, forces
//! from outside, noise in what is measured; and two controllers.
//!
//! The current is part of the claim; one that was drawn differs from the one that was planned with.

mod close_loop;
mod command;
mod controllers;
mod plant;
mod recorder;
mod sortie;
#[cfg(feature = "unit-tests")]
mod tests;
mod watch;

pub use close_loop::{sail, sail_with};
pub use command::{BoatCommand, BoatState};
pub use controllers::{BoatController, BoatControllerKind};
pub use plant::BoatPlant;
pub use sortie::{BoatConditions, BoatSortie, SailSettings};
