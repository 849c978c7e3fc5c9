//! Floor 5, the act: plants with what the claim leaves out, controllers, and the loop closed over them.
//!
//! One verb a kind of robot: [`fly`] flies a robot along a course (or [`Airborne`], leg by leg), [`ground::drive`] drives a vehicle along its plan, and each says
//! what happened. The act shares the robot's numbers with
//! the claim and nothing else.
//!
//! | robot | plant beyond the claim | loop | what it gives |
//! | --- | --- | --- | --- |
//! | quadrotor | rotor lag, wind, gusts, noise | rates 1 kHz, attitude 250 Hz | [`crate::trajectory::Flight`] |
//! | ground vehicle | slip, latency, lags, torque, force | each centimetre, 20 to 100 ms | the same |
//! | arm | servo lag, faults, waits, noise | set points every 2 ms | [`arm::Run`] |
//!
//! Data flow: a sortie (robot, world, waypoints, plan) + a controller's settings + conditions + a seed → a track with
//! channels, when each waypoint was reached, and why it ended. The same arguments give the same bytes on any machine
//! and any number of threads. A run is a pure function: nothing is read from a clock, and nothing of the claim (limits,
//! certifiers, planners) is asked.
//!
//! What is nobody's numbers but ours says so: gains are fixed by step responses (`tests/step_responses.rs`), an arm's
//! accelerations and lags are settings with defaults that stand in for a controller's.

mod airborne;
pub mod arm;
mod close_loop;
mod controllers;
mod course;
mod disturbance;
pub mod ground;
mod hazard;
mod inner_loop;
mod lanes;
mod mixer;
mod plant;
mod recorder;
mod step;

#[cfg(test)]
mod tests;

use thiserror::Error;

pub use airborne::{Airborne, fly};
pub use close_loop::{FlySettings, Sortie};
pub use controllers::{ControllerKind, ControllerSettings, SegmentTimes};
pub use disturbance::{Conditions, DiscreteGust, Disturbances, Gusts};
pub use plant::{Plant, PlantState};
pub use step::{Motion, Stepper};

/// Why a flight cannot be simulated.
///
/// The caller's mistake, found before the first step; what happens in flight is in [`crate::trajectory::Ended`].
#[derive(Debug, Clone, PartialEq, Error)]
#[error("{field} = {value}: must be {bound}")]
pub struct SimulationError {
    /// The setting.
    pub field: &'static str,
    /// The offending value, or what is wrong with it.
    pub value: String,
    /// What it must be.
    pub bound: &'static str,
}

impl SimulationError {
    /// A mistake in `field`.
    pub(crate) fn new(field: &'static str, value: String, bound: &'static str) -> Self {
        Self { field, value, bound }
    }
}
