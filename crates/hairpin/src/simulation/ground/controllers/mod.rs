//! Path-following controllers: each turns where the vehicle is along its plan into a curvature.

mod predictive;
mod stanley;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::guide::{Along, Measured};
use super::plant::Command;
use super::pursuit::PurePursuit;
use crate::robot::rover::Rover;
use crate::trajectory::Direction;
use crate::trajectory::drive::{Gear, Planar, SegmentList};

/// Solves for the commands of one gear that lead the nominal vehicle, lags included but without latency, from a pose and
/// curvature to another, both in the world, while its direction of travel turns evenly; `None`: no answer.
pub type Resolve<'a> = dyn Fn(&Planar, &Planar, Gear, Direction) -> Option<SegmentList> + Sync + 'a;

/// The controllers of ground vehicles.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum GroundControllerKind {
    /// Steers along the circle to a point of the path ahead.
    PurePursuit,
    /// Steers by heading and distance of a leading axle from its path.
    Stanley,
    /// Solves anew to the path ahead, from where the vehicle will be when the answer acts.
    Predictive,
}

impl GroundControllerKind {
    /// The word in scenarios.
    pub fn word(self) -> &'static str {
        match self {
            GroundControllerKind::PurePursuit => "pure-pursuit",
            GroundControllerKind::Stanley => "stanley",
            GroundControllerKind::Predictive => "predictive",
        }
    }
}

/// Which controller drives.
#[derive(Clone, Copy)]
pub enum GroundController<'a> {
    /// [`GroundControllerKind::PurePursuit`].
    PurePursuit,
    /// [`GroundControllerKind::Stanley`].
    Stanley,
    /// [`GroundControllerKind::Predictive`] with its solver.
    Predictive(&'a Resolve<'a>),
}

/// A controller in a run.
pub(super) enum Driver<'a> {
    PurePursuit(PurePursuit),
    Stanley(stanley::Stanley),
    Predictive(Box<predictive::Predictive<'a>>),
}

impl<'a> Driver<'a> {
    /// For the vehicle as it was planned with; `latency` (s), which time stamps tell, is used where commands under way are
    /// looked at.
    pub(super) fn new(controller: &GroundController<'a>, nominal: &Rover, latency: f64) -> Self {
        match controller {
            GroundController::PurePursuit => Driver::PurePursuit(PurePursuit::new(nominal)),
            GroundController::Stanley => Driver::Stanley(stanley::Stanley::new(nominal)),
            GroundController::Predictive(solve) => {
                Driver::Predictive(Box::new(predictive::Predictive::new(nominal, latency, *solve)))
            }
        }
    }

    /// The curvature to steer for the next `dt` s, 1/m.
    pub(super) fn steer(&mut self, measured: &Measured, along: &Along, dt: f64) -> f64 {
        match self {
            Driver::PurePursuit(pursuit) => pursuit.steer(measured, along),
            Driver::Stanley(stanley) => stanley.steer(measured, along),
            Driver::Predictive(predictive) => predictive.steer(measured, along, dt),
        }
    }

    /// Takes note of what is commanded at `measured.t`.
    pub(super) fn note(&mut self, measured: &Measured, command: &Command) {
        if let Driver::Predictive(predictive) = self {
            predictive.note(measured, command);
        }
    }
}
