//! The controllers of ours that drive: the guide says where along the plan the vehicle is and how fast to go, and each turns that
//! into a curvature.

mod predictive;
mod stanley;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::command::{DriveCommand, DriveState};
use super::guide::{Along, Guide, Task};
use super::pursuit::PurePursuit;
use crate::robot::rover::Rover;
use crate::simulation::controller::{Controller, Fault, Reference, Schedule};
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

impl GroundController<'_> {
    /// The word in scenarios.
    pub(super) fn word(&self) -> &'static str {
        match self {
            GroundController::PurePursuit => GroundControllerKind::PurePursuit,
            GroundController::Stanley => GroundControllerKind::Stanley,
            GroundController::Predictive(_) => GroundControllerKind::Predictive,
        }
        .word()
    }
}

/// A controller in a run: it follows the plan, by its schedule.
pub(super) struct Guided<'a> {
    pub(super) guide: Guide<'a>,
    pub(super) driver: Driver<'a>,
}

impl Controller<Rover> for Guided<'_> {
    fn control(&mut self, dt: f64, now: &DriveState, _to: &Reference<Rover>) -> Result<DriveCommand, Fault> {
        let command = match self.guide.task(now, dt) {
            Task::Hold(command) => command,
            Task::Follow(along) => {
                let curvature = self.driver.steer(now, &along, dt);
                DriveCommand { speed: along.sign * along.speed, curvature, turn_rate: 0.0, direction: along.direction }
            }
        };
        self.driver.note(now, &command);
        Ok(command)
    }

    fn schedule(&self) -> Option<Schedule> {
        Some(Schedule { leg: self.guide.leg(), over: self.guide.over() })
    }
}

/// How it steers.
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
    pub(super) fn steer(&mut self, measured: &DriveState, along: &Along, dt: f64) -> f64 {
        match self {
            Driver::PurePursuit(pursuit) => pursuit.steer(measured, along),
            Driver::Stanley(stanley) => stanley.steer(measured, along),
            Driver::Predictive(predictive) => predictive.steer(measured, along, dt),
        }
    }

    /// Takes note of what is commanded at `measured.t`.
    pub(super) fn note(&mut self, measured: &DriveState, command: &DriveCommand) {
        if let Driver::Predictive(predictive) = self {
            predictive.note(measured, command);
        }
    }
}
