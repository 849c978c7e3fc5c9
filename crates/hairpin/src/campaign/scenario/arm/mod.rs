//! Scenarios of arms: a cell, a cloud of points, and the programs that load the arm most; keys, defaults, bounds.

mod execute;
mod frames;
mod generate;
mod head;
mod spec;
mod task;
mod world;

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Distribution, RobotSource, Spec};
use crate::robot::arm::ArmDescription;

pub use execute::*;
pub(in crate::campaign) use frames::{frame_of, mistake};
pub use generate::*;
pub use spec::*;
pub use task::*;
pub use world::*;

/// A scenario of an arm.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ArmScenario {
    /// Format of the file: 1.
    pub hairpin: u32,
    /// A shipped arm's name, a robot file, or the arm's own table.
    pub robot: RobotSource<ArmDescription>,
    /// Root seed of the campaign.
    #[serde(default)]
    pub seed: u64,
    /// The cell: tool, work object, and what is in the way.
    #[serde(default)]
    pub world: CellSection,
    /// The cloud of points.
    pub task: ArmTask,
    /// How programs are searched for.
    #[serde(default)]
    pub generate: ArmGenerate,
    /// How they are executed.
    #[serde(default)]
    pub execute: ArmExecute,
    /// What runs read may have a distribution: keys of `execute` and `spec`, and of the robot's `joints`, `opw` and
    /// `chain`.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub vary: BTreeMap<String, Distribution>,
    /// What is within spec; `"none"`: nothing is judged.
    #[serde(default)]
    pub spec: Spec<ArmSpec>,
}
