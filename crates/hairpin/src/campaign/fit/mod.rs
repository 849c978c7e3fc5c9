//! A robot's numbers from logs of its flights: the closed loop is simulated over each mission, undisturbed, and what it
//! says is held against what was logged (docs/fit.md).
//!
//! What is measured of a log is its motion leg by leg: who flies from waypoint to waypoint begins each leg when it has
//! reached the last one, so both motions are counted from there. A gust that made the vehicle late on one leg is then
//! not an error on all that follow. Loops of drives swing, and end in other swings: no sample of a simulation can be
//! held against one of a log. They are imitated instead, noise and all, and compared by signs.
//!
//! ```text
//! missions, logs ─▶ Compared: legs, samples (k + ½) · period, outputs y by a line through the samples around
//! Loops: setup with θ in its keys, no chance ─▶ simulate ─▶ f(θ), sampled alike
//! stretches, whiten: r = y − f(θ), filtered leg by leg ─▶ math::output_error ─▶ θ̂, profile intervals
//! imitated: log ─▶ signs s; Loops with θ and noise, drawn ─▶ signs s_k ─▶ math::imitation ─▶ θ̂, intervals
//! gap: distances log by log, given, fitted, and fitted to the others
//! ```
//!
//! θ are the kind's adjustable numbers, each within its bounds, in its own unit. Deterministic: what is drawn is drawn
//! from seeds of its own. Cost: simulations of all missions, two a number for the derivatives of a turn, and of what is
//! imitated some two thousand; shared out over threads.

mod answer;
mod compare;
mod error;
mod estimate;
mod found;
mod gap;
mod imitated;
mod output_error;
mod outputs;
mod passages;
mod simulate;
mod stretches;
mod whiten;

pub use answer::{Confounded, Estimate, Fit, Reading};
pub use compare::Flown;
pub use error::FitError;
pub use estimate::{FitSettings, fit};
pub use gap::{Deviation, Gap};

#[cfg(feature = "unit-tests")]
mod tests;
