//! What sails: boats in a stretch of water with a current.

mod assumptions;
mod check;
mod claim;
mod drawing;
mod execute;
pub mod keys;
mod knobs;
mod legs;
mod losses;
mod passes;
mod plan;
mod say;
mod setup;
mod solve;
mod steered;
#[cfg(test)]
mod tests;
mod through;
mod verify;

pub use keys::BoatScenario;
pub use setup::BoatSetup;
