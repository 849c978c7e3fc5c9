//! Whose legs a scenario is about: what models are learned of, and serve no other's than.

use serde::{Deserialize, Serialize};

use super::RobotSource;

/// Whose legs a model is about. A model serves no other's.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Subject {
    /// The robot's name.
    pub robot: String,
    /// BLAKE3 of the robot's numbers, hexadecimal.
    pub robot_hash: String,
    /// What speeds at a leg's ends mean: `leg over step` or `at the leg's ends`; [`ARM_MOVES`] of arms.
    pub speeds: String,
    /// Who executed.
    pub controller: String,
}

/// What the subjects of models of moves have in place of a meaning of speeds.
pub const ARM_MOVES: &str = "moves of an arm";

impl Subject {
    /// Of a robot that is called `name`, whose legs have the speeds that they really have, or else their length over
    /// the step.
    pub(in crate::campaign) fn of<D: Serialize>(
        robot: &RobotSource<D>,
        name: impl Fn(&D) -> &str,
        at_ends: bool,
        controller: Option<&str>,
    ) -> Self {
        let robot = robot.resolved().ok();
        let numbers = serde_json::to_vec(&robot).unwrap_or_default();
        Self {
            robot: robot.map_or(String::new(), |robot| name(robot).to_owned()),
            robot_hash: blake3::hash(&numbers).to_hex().to_string(),
            speeds: if at_ends { "at the leg's ends" } else { "leg over step" }.into(),
            controller: controller.unwrap_or("command").into(),
        }
    }
}
