//! The guide says where along the plan the vehicle is and how fast to go, and each controller of ours turns that into a
//! curvature.

use super::kind::GroundController;
use super::predictive::Predictive;
use super::stanley::Stanley;
use crate::robot::rover::Rover;
use crate::simulation::controller::{Controller, Fault, Reference, Schedule};
use crate::simulation::ground::command::{DriveCommand, DriveState};
use crate::simulation::ground::guide::{Along, Guide, Task};
use crate::simulation::ground::pursuit::PurePursuit;

/// A controller in a run: it follows the plan, by its schedule.
///
/// Speeds are the guide's alone; what a driver of ours decides is curvature.
pub(in crate::simulation::ground) struct Guided<'a> {
    /// Where along the plan, and how fast.
    pub(in crate::simulation::ground) guide: Guide<'a>,
    /// How to steer.
    pub(in crate::simulation::ground) driver: Driver<'a>,
}

impl Guided<'_> {
    /// What it says now, for the next `dt` s.
    pub(in crate::simulation::ground) fn command(&mut self, dt: f64, now: &DriveState) -> DriveCommand {
        let command = match self.guide.task(now, dt) {
            Task::Hold(command) => command,
            Task::Follow(along) => {
                let curvature = self.driver.steer(now, &along, dt);
                DriveCommand { speed: along.sign * along.speed, curvature, turn_rate: 0.0, direction: along.direction }
            }
        };
        self.driver.note(now, &command);
        command
    }
}

impl Controller<Rover> for Guided<'_> {
    fn control(&mut self, dt: f64, now: &DriveState, _to: &Reference<Rover>) -> Result<DriveCommand, Fault> {
        Ok(self.command(dt, now))
    }

    fn schedule(&self) -> Option<Schedule> {
        Some(Schedule { leg: self.guide.leg(), over: self.guide.over() })
    }
}

/// How it steers.
///
/// Each answers with a curvature within the vehicle's largest.
pub(in crate::simulation::ground) enum Driver<'a> {
    PurePursuit(PurePursuit),
    Stanley(Stanley),
    Predictive(Box<Predictive<'a>>),
}

impl<'a> Driver<'a> {
    /// For the vehicle as it was planned with; `latency` (s), which time stamps tell, is used where commands under way
    /// are looked at.
    pub(in crate::simulation::ground) fn new(controller: &GroundController<'a>, nominal: &Rover, latency: f64) -> Self {
        match controller {
            GroundController::PurePursuit => Driver::PurePursuit(PurePursuit::new(nominal)),
            GroundController::Stanley => Driver::Stanley(Stanley::new(nominal)),
            GroundController::Predictive(solve) => {
                Driver::Predictive(Box::new(Predictive::new(nominal, latency, *solve)))
            }
        }
    }

    /// The curvature to steer for the next `dt` s, 1/m.
    fn steer(&mut self, measured: &DriveState, along: &Along, dt: f64) -> f64 {
        match self {
            Driver::PurePursuit(pursuit) => pursuit.steer(measured, along),
            Driver::Stanley(stanley) => stanley.steer(measured, along),
            Driver::Predictive(predictive) => predictive.steer(measured, along, dt),
        }
    }

    /// Takes note of what is commanded at `measured.t`.
    fn note(&mut self, measured: &DriveState, command: &DriveCommand) {
        if let Driver::Predictive(predictive) = self {
            predictive.note(measured, command);
        }
    }
}
