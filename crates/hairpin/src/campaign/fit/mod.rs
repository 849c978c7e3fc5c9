//! A robot's numbers from logs of its flights: the closed loop is simulated over each mission, undisturbed, and what it
//! says is held against what was logged (docs/fit.md).
//!
//! What is measured of a log is its motion leg by leg: who flies from waypoint to waypoint begins each leg when it has
//! reached the last one, so both motions are counted from there. A gust that made the vehicle late on one leg is then
//! not an error on all that follow.

mod compare;
mod error;
mod estimate;
mod gap;
mod passages;
mod simulate;
mod stretches;
mod whiten;

pub use compare::Flown;
pub use error::FitError;
pub use estimate::{Confounded, Estimate, Fit, FitSettings, Reading, fit};
pub use gap::{Deviation, Gap};

#[cfg(test)]
mod tests;
