//! The controllers of ours that sail.

mod angle;
mod kind;
mod line_of_sight;
mod tracking;

use super::command::{BoatCommand, BoatState};
use crate::robot::boat::Boat;
use crate::simulation::SimulationError;
use crate::simulation::controller::{Controller, Fault, Reference, Schedule};
use line_of_sight::LineOfSight;
use tracking::Tracking;

pub use kind::{BoatController, BoatControllerKind};

/// The controller of a run, if it is one of ours.
#[derive(Debug, Clone)]
pub(in crate::simulation::boat) enum Helmsman {
    LineOfSight(LineOfSight),
    Tracking(Tracking),
}

impl Helmsman {
    /// For the boat that the run was planned with.
    ///
    /// # Errors
    /// A speed that is not positive.
    ///
    /// The speed is checked whichever controller is named; `tracking` has the plan's.
    pub(super) fn new(controller: &BoatController, nominal: &Boat) -> Result<Self, SimulationError> {
        let speed = controller.speed.unwrap_or(nominal.default_speed);
        if !(speed.is_finite() && speed > 0.0) {
            return Err(SimulationError::new("speed", speed.to_string(), "finite and > 0 m/s"));
        }
        Ok(match controller.kind {
            BoatControllerKind::LineOfSight => Self::LineOfSight(LineOfSight::new(nominal, speed)),
            BoatControllerKind::Tracking => Self::Tracking(Tracking::new(nominal)),
        })
    }
}

impl Controller<Boat> for Helmsman {
    fn reset(&mut self, reference: &Reference<Boat>) -> Result<(), Fault> {
        match self {
            Self::LineOfSight(controller) => controller.reset(reference),
            Self::Tracking(controller) => controller.reset(reference),
        }
    }

    fn control(&mut self, dt: f64, now: &BoatState, to: &Reference<Boat>) -> Result<BoatCommand, Fault> {
        match self {
            Self::LineOfSight(controller) => controller.control(dt, now, to),
            Self::Tracking(controller) => controller.control(dt, now, to),
        }
    }

    fn schedule(&self) -> Option<Schedule> {
        match self {
            Self::LineOfSight(controller) => controller.schedule(),
            Self::Tracking(controller) => controller.schedule(),
        }
    }
}
