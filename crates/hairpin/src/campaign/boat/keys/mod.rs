//! Scenarios of boats: keys and defaults. On the floor of the scenario, below what is made of it.

mod execute;
mod generate;
mod head;
mod world;

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::campaign::scenario::{Distribution, RobotSource, Spec, SpecSection};
use crate::robot::boat::BoatDescription;

pub use execute::BoatExecute;
pub(in crate::campaign::boat) use generate::ACROSS_CURRENT;
pub use generate::{BoatGenerate, BoatLimitsSection, BoatTask};
pub use world::WatersSection;

/// A scenario of boats.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BoatScenario {
    /// Format of the file: 1.
    pub hairpin: u32,
    /// A shipped robot's name, a robot file, or the robot's own table.
    pub robot: RobotSource<BoatDescription>,
    /// Root seed of the campaign.
    #[serde(default)]
    pub seed: u64,
    /// The waters.
    pub world: WatersSection,
    /// What is to be sailed.
    pub task: BoatTask,
    /// How trajectories are searched for.
    #[serde(default)]
    pub generate: BoatGenerate,
    /// How they are executed.
    #[serde(default)]
    pub execute: BoatExecute,
    /// Any scenario key may have a distribution.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub vary: BTreeMap<String, Distribution>,
    /// What is within spec; `"none"`: nothing is judged.
    #[serde(default)]
    pub spec: Spec<SpecSection>,
}
