//! A controller of the caller's own in the place of the scenario's.

use super::{Mistake, Scenario};
use crate::robot::quadrotor::Quadrotor;
use crate::robot::rover::Rover;
use crate::simulation::OwnController;

/// Keys that say of our controllers what no other knows.
const OF_OURS: [&str; 3] = ["execute.controller", "execute.fixed_velocity_m_s", "execute.segment_times"];

/// A controller of the caller's own, of what flies or of what drives.
#[derive(Debug, Clone)]
pub enum AnyController {
    /// It flies.
    Flight(OwnController<Quadrotor>),
    /// It drives.
    Drive(OwnController<Rover>),
}

impl From<OwnController<Quadrotor>> for AnyController {
    fn from(controller: OwnController<Quadrotor>) -> Self {
        Self::Flight(controller)
    }
}

impl From<OwnController<Rover>> for AnyController {
    fn from(controller: OwnController<Rover>) -> Self {
        Self::Drive(controller)
    }
}

impl AnyController {
    /// Its name in reports.
    pub fn name(&self) -> &str {
        match self {
            Self::Flight(controller) => controller.name(),
            Self::Drive(controller) => controller.name(),
        }
    }

    /// Why it cannot execute `scenario`.
    pub(super) fn mistake(&self, scenario: &Scenario) -> Option<Mistake> {
        let wrong =
            |key: &str, value: String, bound: &str| Some(Mistake { key: key.into(), value, bound: bound.into() });
        let quoted = format!("\"{}\"", self.name());
        match (self, scenario) {
            _ if self.name().trim().is_empty() => return wrong("execute.controller", quoted, "a name for reports"),
            (Self::Flight(_), Scenario::Flight(_)) | (Self::Drive(_), Scenario::Drive(_)) => {}
            (Self::Flight(_), _) => {
                return wrong("execute.controller", quoted, "one of what the scenario is about: it flies");
            }
            (Self::Drive(_), _) => {
                return wrong("execute.controller", quoted, "one of what the scenario is about: it drives");
            }
        }
        if let (Some(command), None) = (scenario.executor().command, scenario.controller()) {
            let bound = "left out where a controller of the caller's executes: one of the two";
            return wrong("execute.command", format!("\"{command}\""), bound);
        }
        let varied = OF_OURS.into_iter().find(|key| scenario.vary().contains_key(*key))?;
        wrong(&format!("vary.\"{varied}\""), "given".into(), "left out where a controller of the caller's executes")
    }
}
