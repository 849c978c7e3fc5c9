//! Scenarios of drives: rovers on elevation maps, cars and differential drives; keys, defaults, bounds.

mod direction;
mod environment;
mod execute;
mod generate;
mod head;
mod keep_out;
mod search;
mod spec;
mod task;
mod world;

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Distribution, RobotSource, Spec};
use crate::robot::ground::{CarDescription, DifferentialDriveDescription};
use crate::robot::rover::{Rover, RoverDescription, RoverError};

pub use direction::DirectionDeg;
pub use environment::*;
pub use execute::*;
pub use generate::*;
pub use keep_out::*;
pub use search::*;
pub use spec::*;
pub use task::*;
pub use world::*;

/// A scenario of drives.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DriveScenario {
    /// Format of the file: 1.
    pub hairpin: u32,
    /// A shipped robot's name, a robot file, or the robot's own table.
    pub robot: RobotSource<GroundDescription>,
    /// Root seed of the campaign.
    #[serde(default)]
    pub seed: u64,
    /// The ground.
    pub world: GroundSection,
    /// What is to be driven.
    pub task: DriveTask,
    /// How trajectories are searched for.
    #[serde(default)]
    pub generate: DriveGenerate,
    /// How they are executed.
    #[serde(default)]
    pub execute: DriveExecute,
    /// Any scenario key may have a distribution.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub vary: BTreeMap<String, Distribution>,
    /// What is within spec; `"none"`: nothing is judged.
    #[serde(default)]
    pub spec: Spec<DriveSpec>,
}

/// A ground vehicle as a file has it, told apart by `kind`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum GroundDescription {
    /// `kind = "rover"`.
    Rover(Box<RoverDescription>),
    /// `kind = "car"`.
    Car(CarDescription),
    /// `kind = "differential-drive"`.
    DifferentialDrive(DifferentialDriveDescription),
}

impl GroundDescription {
    /// Words of `kind`.
    pub const KINDS: &'static [&'static str] = &["rover", "car", "differential-drive"];

    /// Its word of `kind`.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Rover(_) => Self::KINDS[0],
            Self::Car(_) => Self::KINDS[1],
            Self::DifferentialDrive(_) => Self::KINDS[2],
        }
    }

    /// The robot's name.
    pub fn name(&self) -> &str {
        match self {
            Self::Rover(robot) => &robot.name,
            Self::Car(robot) => &robot.name,
            Self::DifferentialDrive(robot) => &robot.name,
        }
    }

    /// The vehicle that the generator of drives and the plant take it for.
    ///
    /// # Errors
    /// The first key whose value is out of bounds, with the bound.
    pub fn build(&self) -> Result<Rover, RoverError> {
        match self {
            Self::Rover(robot) => robot.build(),
            Self::Car(robot) => robot.build().map(|car| car.vehicle()),
            Self::DifferentialDrive(robot) => robot.build().map(|drive| drive.vehicle()),
        }
    }
}
