//! The model that a scenario scores by: as it was read, and whether it fits.

use std::sync::Arc;

use super::{ModelMistake, ScoreModel, Subject};
use crate::campaign::Scenario;
use crate::campaign::scenario::{GroundReach, ReachName};

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

    /// Whether the model fits the legs of `scenario`.
    ///
    /// # Errors
    /// [`ModelMistake`].
    pub fn check(&self, scenario: &Scenario) -> Result<(), ModelMistake> {
        self.model.check(&subject(scenario))
    }
}

/// Whose legs a scenario is about.
pub(in crate::campaign) fn subject(scenario: &Scenario) -> Subject {
    let (name, numbers, at_ends) = match scenario {
        Scenario::Flight(scenario) => {
            let robot = scenario.robot.resolved().ok();
            let name = robot.map_or(String::new(), |robot| robot.name.clone());
            (name, serde_json::to_vec(&robot), scenario.generate.reach == ReachName::Witness)
        }
        Scenario::Drive(scenario) => {
            let robot = scenario.robot.resolved().ok();
            let name = robot.map_or(String::new(), |robot| robot.name().to_owned());
            (name, serde_json::to_vec(&robot), scenario.generate.reach == GroundReach::Witness)
        }
        Scenario::Arm(scenario) => {
            let robot = scenario.robot.resolved().ok();
            let name = robot.map_or(String::new(), |robot| robot.name.clone());
            (name, serde_json::to_vec(&robot), true)
        }
    };
    Subject {
        robot: name,
        robot_hash: blake3::hash(&numbers.unwrap_or_default()).to_hex().to_string(),
        speeds: if at_ends { "at the leg's ends" } else { "leg over step" }.into(),
        controller: scenario.controller().unwrap_or("command").into(),
    }
}
