//! The scenario: every key of a scenario file, with its default. These types are the contract: the parser,
//! the JSON Schema and the commented files of `hairpin new` all come from them. Units are in the names.
//!
//! What the robot is decides which keys there are: [`FlightScenario`] for what flies, [`DriveScenario`] for what drives.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use thiserror::Error;

mod check;
pub(crate) mod distribution;
mod drive;
mod findings;
mod flight;
mod path;
mod search;
mod vary;

pub use distribution::Distribution;
pub use drive::*;
pub use flight::*;
pub use path::KeyPath;
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
}

impl<'de> Deserialize<'de> for Scenario {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        use serde::de::Error;
        let value = serde_json::Value::deserialize(deserializer)?;
        let kind = value.get("robot").and_then(|robot| robot.get("kind")).and_then(|kind| kind.as_str());
        if kind.is_some_and(|kind| GroundDescription::KINDS.contains(&kind)) {
            serde_json::from_value(value).map(Self::Drive).map_err(D::Error::custom)
        } else {
            serde_json::from_value(value).map(Self::Flight).map_err(D::Error::custom)
        }
    }
}

/// Who executes a campaign's trajectories, and how often: what flights and drives have in common.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Executor<'a> {
    /// A program that speaks the executor protocol; `None`: our own simulator.
    pub command: Option<&'a str>,
    /// Runs per case.
    pub repeat: u64,
    /// Wall-clock limit per mission of `command`, s.
    pub timeout: f64,
    /// Workers of `command`.
    pub workers: Option<u64>,
    /// A waypoint counts as reached inside this radius, m.
    pub accept: f64,
}

impl Scenario {
    /// The scenario of a flight.
    pub fn flight(&self) -> Option<&FlightScenario> {
        match self {
            Self::Flight(scenario) => Some(scenario),
            Self::Drive(_) => None,
        }
    }

    /// The scenario of a drive.
    pub fn drive(&self) -> Option<&DriveScenario> {
        match self {
            Self::Flight(_) => None,
            Self::Drive(scenario) => Some(scenario),
        }
    }

    /// Root seed of the campaign.
    pub fn seed(&self) -> u64 {
        match self {
            Self::Flight(scenario) => scenario.seed,
            Self::Drive(scenario) => scenario.seed,
        }
    }

    /// Waypoints of a trajectory, both ends included.
    pub fn length(&self) -> u64 {
        match self {
            Self::Flight(scenario) => scenario.task.length,
            Self::Drive(scenario) => scenario.task.length,
        }
    }

    /// How graphs are searched.
    pub fn search(&self) -> SearchSection {
        match self {
            Self::Flight(scenario) => scenario.generate.search.clone(),
            Self::Drive(scenario) => scenario.generate.search.section(),
        }
    }

    /// The score's name.
    pub fn score(&self) -> &str {
        match self {
            Self::Flight(scenario) => &scenario.generate.score,
            Self::Drive(scenario) => &scenario.generate.search.score,
        }
    }

    /// The reach set's word.
    pub fn reach(&self) -> &'static str {
        match self {
            Self::Flight(scenario) => scenario.generate.reach.word(),
            Self::Drive(scenario) => scenario.generate.reach.word(),
        }
    }

    /// Who executes, and how often.
    pub fn executor(&self) -> Executor<'_> {
        match self {
            Self::Flight(scenario) => {
                let ExecuteSection { command, repeat, timeout_s, workers, accept_m, .. } = &scenario.execute;
                let command = command.as_deref();
                Executor { command, repeat: *repeat, timeout: *timeout_s, workers: *workers, accept: *accept_m }
            }
            Self::Drive(scenario) => {
                let DriveExecute { command, repeat, timeout_s, workers, accept_m, .. } = &scenario.execute;
                let command = command.as_deref();
                let repeat = repeat.unwrap_or(if scenario.vary.is_empty() { 1 } else { 2 });
                Executor { command, repeat, timeout: *timeout_s, workers: *workers, accept: *accept_m }
            }
        }
    }

    /// The word of the controller of ours that executes; `None` where a command does.
    pub fn controller(&self) -> Option<&'static str> {
        match self {
            Self::Flight(scenario) => scenario.execute.controller_in_force().map(|controller| controller.word()),
            Self::Drive(scenario) => scenario.execute.controller_in_force().map(|controller| controller.word()),
        }
    }

    /// Where on Earth the world stands.
    pub fn origin(&self) -> Option<Origin> {
        match self {
            Self::Flight(scenario) => scenario.world.origin,
            Self::Drive(scenario) => scenario.world.origin,
        }
    }

    /// Distributions, by key.
    pub fn vary(&self) -> &BTreeMap<String, Distribution> {
        match self {
            Self::Flight(scenario) => &scenario.vary,
            Self::Drive(scenario) => &scenario.vary,
        }
    }

    /// The same for changes.
    pub(in crate::campaign) fn vary_mut(&mut self) -> &mut BTreeMap<String, Distribution> {
        match self {
            Self::Flight(scenario) => &mut scenario.vary,
            Self::Drive(scenario) => &mut scenario.vary,
        }
    }

    /// Share of cases that may violate the limits.
    pub fn violation_share(&self) -> Option<f64> {
        match self {
            Self::Flight(scenario) => scenario.spec.violation_share,
            Self::Drive(scenario) => scenario.spec.limits.violation_share,
        }
    }

    /// Confidence of the share's interval, where one is given.
    pub fn confidence(&self) -> Option<f64> {
        match self {
            Self::Flight(scenario) => scenario.spec.confidence,
            Self::Drive(scenario) => scenario.spec.limits.confidence,
        }
    }

    /// Limit of the deviation, m.
    pub fn deviation_limit(&self) -> Option<f64> {
        match self {
            Self::Flight(scenario) => scenario.spec.deviation.map(|limit| limit.max_m),
            Self::Drive(scenario) => scenario.spec.limits.path_deviation_m,
        }
    }
}

/// Where the robot's numbers come from. Resolved scenarios hold the table.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
#[serde(untagged)]
pub enum RobotSource<D> {
    /// A shipped name or a path.
    Name(String),
    /// The numbers themselves.
    Inline(Box<D>),
}

impl<'de, D: Deserialize<'de>> Deserialize<'de> for RobotSource<D> {
    fn deserialize<S: serde::Deserializer<'de>>(deserializer: S) -> Result<Self, S::Error> {
        struct Visitor<D>(std::marker::PhantomData<D>);
        impl<'de, D: Deserialize<'de>> serde::de::Visitor<'de> for Visitor<D> {
            type Value = RobotSource<D>;
            fn expecting(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
                f.write_str("a robot's name, a robot file, or a table with its numbers")
            }
            fn visit_str<E>(self, name: &str) -> Result<RobotSource<D>, E> {
                Ok(RobotSource::Name(name.into()))
            }
            fn visit_map<A: serde::de::MapAccess<'de>>(self, map: A) -> Result<RobotSource<D>, A::Error> {
                D::deserialize(serde::de::value::MapAccessDeserializer::new(map))
                    .map(|description| RobotSource::Inline(Box::new(description)))
            }
        }
        deserializer.deserialize_any(Visitor(std::marker::PhantomData))
    }
}

impl<D> RobotSource<D> {
    /// The numbers.
    ///
    /// # Errors
    /// A name that was not resolved before.
    pub(in crate::campaign) fn resolved(&self) -> Result<&D, Mistake> {
        match self {
            Self::Inline(description) => Ok(description),
            Self::Name(name) => Err(Mistake {
                key: "robot".into(),
                value: format!("\"{name}\""),
                bound: "resolved to its numbers first".into(),
            }),
        }
    }
}
