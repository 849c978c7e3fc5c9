//! The model that a scenario scores by: as it was read, and whether it fits.

use std::sync::Arc;

use serde::Serialize;

use super::moves::ARM_MOVES;
use super::{ScoreModel, Subject};
use crate::campaign::Scenario;
use crate::campaign::scenario::{ArmScenario, DriveScenario, FlightScenario, GroundReach, ReachName};

/// Name of the model's file in a campaign folder.
pub const NAME: &str = "score-model.json";

/// What a score that is learned begins with in scenarios.
const PREFIX: &str = "learned:";

/// A model and the file that it was read from.
#[derive(Debug, Clone, PartialEq)]
pub struct KeptModel {
    /// The model.
    pub model: Arc<ScoreModel>,
    /// The file's contents.
    pub bytes: Arc<[u8]>,
    /// The score as the scenario named it, which mistakes are told with; the scenario itself then names the copy in its
    /// folder.
    pub given: String,
}

impl KeptModel {
    /// The file that a score of a scenario names: `learned:FILE`.
    pub fn file_of(score: &str) -> Option<&str> {
        score.strip_prefix(PREFIX)
    }

    /// The score of a resolved scenario, whose folder holds the model.
    pub fn score() -> String {
        format!("{PREFIX}{NAME}")
    }
}

/// Whose legs a scenario is about.
pub(in crate::campaign) fn subject(scenario: &Scenario) -> Subject {
    match scenario {
        Scenario::Flight(scenario) => of_flight(scenario),
        Scenario::Drive(scenario) => of_drive(scenario),
        Scenario::Arm(scenario) => of_arm(scenario),
    }
}

/// Whose moves a scenario of arms is about.
pub(in crate::campaign) fn of_arm(scenario: &ArmScenario) -> Subject {
    let controller = if scenario.execute.logs.is_some() { "recorded" } else { "virtual" };
    let subject = of_robot(scenario.robot.resolved().ok(), |robot| &robot.name, true, Some(controller));
    Subject { speeds: ARM_MOVES.into(), ..subject }
}

/// Whose legs a scenario of flights is about.
pub(in crate::campaign) fn of_flight(scenario: &FlightScenario) -> Subject {
    let at_ends = scenario.generate.reach == ReachName::Witness;
    let controller = scenario.execute.controller_in_force().map(|controller| controller.word());
    of_robot(scenario.robot.resolved().ok(), |robot| &robot.name, at_ends, controller)
}

/// Whose legs a scenario of drives is about.
pub(in crate::campaign) fn of_drive(scenario: &DriveScenario) -> Subject {
    let at_ends = scenario.generate.reach == GroundReach::Witness;
    let controller = scenario.execute.controller_in_force().map(|controller| controller.word());
    of_robot(scenario.robot.resolved().ok(), |robot| robot.name(), at_ends, controller)
}

fn of_robot<R: Serialize>(robot: Option<&R>, name: fn(&R) -> &str, at_ends: bool, controller: Option<&str>) -> Subject {
    let numbers = serde_json::to_vec(&robot).unwrap_or_default();
    Subject {
        robot: robot.map_or(String::new(), |robot| name(robot).to_owned()),
        robot_hash: blake3::hash(&numbers).to_hex().to_string(),
        speeds: if at_ends { "at the leg's ends" } else { "leg over step" }.into(),
        controller: controller.unwrap_or("command").into(),
    }
}
