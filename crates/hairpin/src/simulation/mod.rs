//! Floor 5, the act: plants with what the claim leaves out, controllers, and the loop closed over them.
//!
//! One verb a kind of robot: [`fly`] flies a robot along a course (or [`Airborne`], leg by leg), [`ground::drive`] drives a vehicle along its plan, and each says
//! what happened. The act shares the robot's numbers with
//! the claim and nothing else.

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
