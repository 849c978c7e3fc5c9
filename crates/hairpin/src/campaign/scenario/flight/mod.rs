//! Scenarios of flights: keys, defaults, bounds.

mod environment;
mod execute;
mod generate;
mod head;
mod spec;
mod world;

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Distribution, RobotSource, Spec};
use crate::robot::quadrotor::QuadrotorDescription;

pub use environment::*;
pub use execute::*;
pub use generate::*;
pub use spec::*;
pub use world::*;

/// A scenario of flights.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FlightScenario {
    /// Format of the file: 1.
    pub hairpin: u32,
    /// A shipped robot's name, a robot file, or the robot's own table.
    pub robot: RobotSource<QuadrotorDescription>,
    /// Root seed of the campaign.
    #[serde(default)]
    pub seed: u64,
    /// The space.
    pub world: WorldSection,
    /// What is to be flown.
    pub task: TaskSection,
    /// How trajectories are searched for.
    #[serde(default)]
    pub generate: GenerateSection,
    /// How they are executed.
    #[serde(default)]
    pub execute: ExecuteSection,
    /// Any scenario key may have a distribution.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub vary: BTreeMap<String, Distribution>,
    /// What is within spec; `"none"`: nothing is judged.
    #[serde(default)]
    pub spec: Spec<SpecSection>,
}
