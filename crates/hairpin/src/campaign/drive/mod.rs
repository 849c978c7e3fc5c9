//! What drives: rovers on elevation maps, cars and differential drives.

mod alter;
mod ask;
mod assumptions;
mod backwards;
mod check;
mod claim;
mod draw;
mod drawing;
mod execute;
mod figure;
mod fit;
mod held;
mod knobs;
mod legs;
mod losses;
mod passes;
mod place;
mod plan;
mod replan;
mod say;
mod setup;
mod site;
mod solve;
mod steered;
mod stepwise;
mod surround;
#[cfg(test)]
mod tests;
mod verify;
mod walking;

pub use held::{broken, steerable};
pub use setup::DriveSetup;
pub use site::{Site, drive_piece, flat_claim, replay_flat, replay_pieces};
