//! Floor 5, the act: plants with what the claim leaves out, controllers, and the loop closed over them.
//!
//! One verb a kind of robot: [`fly`] flies a robot along a course (or [`Airborne`], leg by leg), [`ground::drive`]
//! drives a vehicle along its plan, and each says what happened; [`fly_with`] and [`ground::drive_with`] do so by a
//! [`Controller`] of the caller's own. The act shares the robot's numbers with the claim and nothing else.
//!
//! | robot | planned as | flown or driven by | plant adds |
//! | --- | --- | --- | --- |
//! | quadrotor | waypoints, a [`Profile`](crate::trajectory::Profile) | [`fly`] | rotor lag, wind, gusts, noise |
//! | rover, car | a [`Drive`](crate::trajectory::Drive) | [`ground::drive`] | slip, steering lag, latency, noise |
//! | arm | a program's moves | [`arm::Plan`] | servo lag, faults, noise of the instrument |
//!
//! Every run by a controller of ours is a pure function of its arguments and a seed. What it gives is a
//! [`Track`](crate::trajectory::Track), poses with named channels, which the judge reads as it reads a log of a real
//! robot.

mod airborne;
pub mod arm;
pub mod boat;
mod close_loop;
mod command;
mod controller;
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
mod run;
mod step;

#[cfg(feature = "unit-tests")]
pub(crate) mod tests;

use thiserror::Error;

pub use airborne::Airborne;
pub use close_loop::{FlySettings, Sortie};
pub use command::{Demand, FlightCommand, FlightState};
pub use controller::{Acceptance, Controlled, Controller, Fault, Misbehaviour, OwnController, Reference, Schedule};
pub use controllers::{ControllerKind, ControllerSettings, SegmentTimes, minimum_snap_curve};
pub use disturbance::{Conditions, DiscreteGust, Disturbances, Gusts};
pub use plant::{Plant, PlantState};
pub use run::{fly, fly_with};
pub use step::{Motion, Stepper};

/// Why a run cannot be simulated.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum SimulationError {
    /// A setting out of bounds.
    #[error("{field} = {value}: must be {bound}")]
    Setting {
        /// The setting.
        field: &'static str,
        /// The offending value, or what is wrong with it.
        value: String,
        /// What it must be.
        bound: &'static str,
    },
    /// A controller that gave no command.
    #[error("controller `{name}` at t = {t} s: {why}")]
    Controller {
        /// Its name in reports.
        name: String,
        /// When, s.
        t: f64,
        /// What was wrong.
        why: Misbehaviour,
    },
}

impl SimulationError {
    /// A mistake in `field`.
    pub(crate) fn new(field: &'static str, value: String, bound: &'static str) -> Self {
        Self::Setting { field, value, bound }
    }

    /// Of a run's settings: nothing, if each of `positive` is finite and > 0, and `linger` (s) finite and ≥ 0.
    ///
    /// # Errors
    /// The first that is not.
    pub(crate) fn unless_timed(positive: &[(&'static str, f64)], linger: f64) -> Result<(), Self> {
        for (field, value) in positive {
            if !(value.is_finite() && *value > 0.0) {
                return Err(Self::new(field, value.to_string(), "finite and > 0"));
            }
        }
        if !(linger.is_finite() && linger >= 0.0) {
            return Err(Self::new("linger", linger.to_string(), "finite and ≥ 0 s"));
        }
        Ok(())
    }

    /// The setting that is out of bounds; `controller` where none is.
    pub fn field(&self) -> &'static str {
        match self {
            Self::Setting { field, .. } => field,
            Self::Controller { .. } => "controller",
        }
    }
}
