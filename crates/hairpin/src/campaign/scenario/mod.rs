//! The scenario: every key of a scenario file, with its default. These types are the contract: the parser,
//! the JSON Schema and the commented files of `hairpin new` all come from them. Units are in the names.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use thiserror::Error;

use crate::robot::quadrotor::QuadrotorDescription;

mod check;
pub(crate) mod distribution;
mod execute;
mod generate;
mod path;
mod spec;
mod world;

pub use distribution::Distribution;
pub use execute::*;
pub use generate::*;
pub use path::KeyPath;
pub use spec::*;
pub use world::*;

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

/// A scenario file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Scenario {
    /// Format of the file: 1.
    pub hairpin: u32,
    /// A shipped robot's name, a robot file, or the robot's own table.
    pub robot: RobotSource,
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
    /// What is within spec.
    #[serde(default)]
    pub spec: SpecSection,
}

/// Where the robot's numbers come from. Resolved scenarios hold the table.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
#[serde(untagged)]
pub enum RobotSource {
    /// A shipped name or a path.
    Name(String),
    /// The numbers themselves.
    Inline(Box<QuadrotorDescription>),
}

impl<'de> Deserialize<'de> for RobotSource {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Visitor;
        impl<'de> serde::de::Visitor<'de> for Visitor {
            type Value = RobotSource;
            fn expecting(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
                f.write_str("a robot's name, a robot file, or a table with its numbers")
            }
            fn visit_str<E>(self, name: &str) -> Result<RobotSource, E> {
                Ok(RobotSource::Name(name.into()))
            }
            fn visit_map<A: serde::de::MapAccess<'de>>(self, map: A) -> Result<RobotSource, A::Error> {
                QuadrotorDescription::deserialize(serde::de::value::MapAccessDeserializer::new(map))
                    .map(|description| RobotSource::Inline(Box::new(description)))
            }
        }
        deserializer.deserialize_any(Visitor)
    }
}
