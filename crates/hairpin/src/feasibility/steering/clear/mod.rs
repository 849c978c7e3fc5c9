//! Drives that stay clear of places to keep out of: the shortest of the ways around, and detours where none is clear.

mod detour;
mod generate;
mod ground;
mod hazards;
mod solve;
mod ways;

#[cfg(test)]
mod tests;

pub use generate::generate;
pub use ground::{Around, ClearedOnGround, motion, solve_on_ground};
pub use hazards::{Hazards, Intrusion, MotionCheck, footprint};
pub use solve::{Cleared, solve};
