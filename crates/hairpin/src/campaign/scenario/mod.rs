//! The scenario: every key of a scenario file, with its default. These types are the contract: the parser,
//! the JSON Schema and the commented files of `hairpin new` all come from them. Units are in the names.
//!
//! What the robot is decides which keys there are: [`FlightScenario`] for what flies, [`DriveScenario`] for what
//! drives, [`ArmScenario`] for arms.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use thiserror::Error;

mod arm;
mod check;
pub(crate) mod distribution;
mod drive;
mod findings;
mod flaky;
mod flight;
mod in_common;
mod path;
mod robot_source;
mod search;
mod vary;

pub use arm::*;
pub use distribution::Distribution;
pub use drive::*;
pub use flaky::FlakySection;
pub use flight::*;
pub use in_common::Executor;
pub use path::KeyPath;
pub use robot_source::RobotSource;
pub use search::*;

/// A value that a key must not have.
#[derive(Debug, Clone, PartialEq, Error)]
#[error("{key} = {value}: must be {bound}")]
pub struct Mistake {
    /// Dotted key: `generate.search.width`, `world.obstacles[0].box.size_m`.
    pub key: String,
    /// The value as given.
    pub value: String,
    /// What it must be.
    pub bound: String,
}

/// A scenario file; the robot's `kind` tells which.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
#[serde(untagged)]
pub enum Scenario {
    /// Of what flies.
    Flight(Box<FlightScenario>),
    /// Of what drives.
    Drive(Box<DriveScenario>),
    /// Of an arm.
    Arm(Box<ArmScenario>),
}

impl<'de> Deserialize<'de> for Scenario {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        use serde::de::Error;
        let value = serde_json::Value::deserialize(deserializer)?;
        read(value).map_err(D::Error::custom)
    }
}

/// Not generic, so that the readers of all sections are compiled once, with this crate.
fn read(value: serde_json::Value) -> serde_json::Result<Scenario> {
    let kind = value.get("robot").and_then(|robot| robot.get("kind")).and_then(|kind| kind.as_str());
    match RobotKind::of_word(kind) {
        RobotKind::Ground => serde_json::from_value(value).map(Scenario::Drive),
        RobotKind::Arm => serde_json::from_value(value).map(Scenario::Arm),
        RobotKind::Flyer => serde_json::from_value(value).map(Scenario::Flight),
    }
}

/// What `robot.kind` says of a scenario's keys.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RobotKind {
    /// It flies, or does not say.
    Flyer,
    /// It drives.
    Ground,
    /// It stands and reaches.
    Arm,
}

impl RobotKind {
    /// The kind of robot files whose `kind` is `word`.
    pub fn of_word(word: Option<&str>) -> Self {
        match word {
            Some(kind) if GroundDescription::KINDS.contains(&kind) => Self::Ground,
            Some("arm") => Self::Arm,
            _ => Self::Flyer,
        }
    }
}
