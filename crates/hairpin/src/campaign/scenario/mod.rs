//! The scenario: every key of a scenario file, with its default. These types are the contract: the parser,
//! the JSON Schema and the commented files of `hairpin new` all come from them. Units are in the names.
//!
//! What the robot is decides which keys there are: [`FlightScenario`] for what flies, [`DriveScenario`] for what drives,
//! [`ArmScenario`] for arms.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use thiserror::Error;

use crate::campaign::learn;
use crate::campaign::user_score::{self, UserScore};

mod arm;
mod check;
pub(crate) mod distribution;
mod drive;
mod findings;
mod flaky;
mod flight;
mod path;
mod search;
mod vary;

pub use arm::*;
pub use distribution::Distribution;
pub use drive::*;
pub use flaky::FlakySection;
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

/// A point counts as reached within this distance of an arm's tool, m.
const ARRIVED: f64 = 1e-3;

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
    /// Further runs of every violation, with other noise.
    pub reruns: u64,
}

impl Scenario {
    /// The scenario of a flight.
    pub fn flight(&self) -> Option<&FlightScenario> {
        match self {
            Self::Flight(scenario) => Some(scenario),
            Self::Drive(_) | Self::Arm(_) => None,
        }
    }

    /// The scenario of a drive.
    pub fn drive(&self) -> Option<&DriveScenario> {
        match self {
            Self::Drive(scenario) => Some(scenario),
            Self::Flight(_) | Self::Arm(_) => None,
        }
    }

    /// The scenario of an arm.
    pub fn arm(&self) -> Option<&ArmScenario> {
        match self {
            Self::Arm(scenario) => Some(scenario),
            Self::Flight(_) | Self::Drive(_) => None,
        }
    }

    /// The score of the user's own, if that is what it scores by.
    pub fn user_score(&self) -> Option<&UserScore> {
        match self {
            Self::Flight(scenario) => scenario.generate.user_score.as_ref(),
            Self::Drive(scenario) => scenario.generate.search.user_score.as_ref(),
            Self::Arm(_) => None,
        }
    }

    /// Names and contents of the files that a resolved scenario keeps in its campaign's folder: its map, its cloud, its costs, its baseline,
    /// its model.
    pub fn files(&self) -> Vec<(&str, &[u8])> {
        let kept = match self {
            Self::Flight(scenario) => {
                let model = scenario.generate.model.as_ref();
                let user = scenario.generate.user_score.as_ref();
                vec![
                    (Some(learn::NAME), model.map(|kept| &*kept.bytes)),
                    (Some(user_score::NAME), user.map(|user| &*user.bytes)),
                ]
            }
            Self::Drive(scenario) => {
                let terrain = &scenario.world.terrain;
                let model = scenario.generate.search.model.as_ref();
                let user = scenario.generate.search.user_score.as_ref();
                vec![
                    (terrain.file.as_deref(), terrain.bytes.as_deref()),
                    (Some(learn::NAME), model.map(|kept| &*kept.bytes)),
                    (Some(user_score::NAME), user.map(|user| &*user.bytes)),
                ]
            }
            Self::Arm(scenario) => {
                let points = match &scenario.task.points {
                    PointsSource::File(file) => Some(file.as_str()),
                    PointsSource::List(_) | PointsSource::Drawn(_) => None,
                };
                let table = match &scenario.generate.cost {
                    CostSection::Table(table) => (Some(table.table.as_str()), table.bytes.as_deref()),
                    CostSection::Learned(cost) => (Some(learn::NAME), cost.model.as_ref().map(|kept| &*kept.bytes)),
                    CostSection::Named(_) | CostSection::Weighted(_) => (None, None),
                };
                let regression = scenario.spec.regression.as_ref();
                let baseline = (
                    regression.map(|limit| limit.baseline.as_str()),
                    regression.and_then(|limit| limit.bytes.as_deref()),
                );
                vec![(points, scenario.task.bytes.as_deref()), table, baseline]
            }
        };
        kept.into_iter().filter_map(|(file, bytes)| file.zip(bytes)).collect()
    }

    /// Root seed of the campaign.
    pub fn seed(&self) -> u64 {
        match self {
            Self::Flight(scenario) => scenario.seed,
            Self::Drive(scenario) => scenario.seed,
            Self::Arm(scenario) => scenario.seed,
        }
    }

    /// Waypoints of a trajectory, both ends included; `None` where they are as many as load the robot most.
    pub fn length(&self) -> Option<u64> {
        match self {
            Self::Flight(scenario) => Some(scenario.task.length),
            Self::Drive(scenario) => Some(scenario.task.length),
            Self::Arm(_) => None,
        }
    }

    /// How graphs are searched.
    pub fn search(&self) -> SearchSection {
        match self {
            Self::Flight(scenario) => scenario.generate.search.clone(),
            Self::Drive(scenario) => scenario.generate.search.section(),
            Self::Arm(scenario) => scenario.generate.search.section(scenario.task.count()),
        }
    }

    /// The score's name.
    pub fn score(&self) -> &str {
        match self {
            Self::Flight(scenario) => &scenario.generate.score,
            Self::Drive(scenario) => &scenario.generate.search.score,
            Self::Arm(scenario) => scenario.generate.cost.word(),
        }
    }

    /// The word of the reach set, or of what is proven clear.
    pub fn reach(&self) -> &'static str {
        match self {
            Self::Flight(scenario) => scenario.generate.reach.word(),
            Self::Drive(scenario) => scenario.generate.reach.word(),
            Self::Arm(scenario) => scenario.generate.mode.word(),
        }
    }

    /// Who executes, and how often.
    pub fn executor(&self) -> Executor<'_> {
        match self {
            Self::Flight(scenario) => {
                let ExecuteSection { command, repeat, timeout_s, workers, accept_m, flaky, .. } = &scenario.execute;
                let reruns = flaky.map_or(0, |flaky| flaky.reruns);
                let command = command.as_deref();
                Executor { command, repeat: *repeat, timeout: *timeout_s, workers: *workers, accept: *accept_m, reruns }
            }
            Self::Drive(scenario) => {
                let DriveExecute { command, repeat, timeout_s, workers, accept_m, flaky, .. } = &scenario.execute;
                let reruns = flaky.map_or(0, |flaky| flaky.reruns);
                let command = command.as_deref();
                let repeat = repeat.unwrap_or(if scenario.vary.is_empty() { 1 } else { 2 });
                Executor { command, repeat, timeout: *timeout_s, workers: *workers, accept: *accept_m, reruns }
            }
            Self::Arm(scenario) => {
                let repeat = scenario.execute.repeat;
                let reruns = scenario.execute.flaky.map_or(0, |flaky| flaky.reruns);
                Executor { command: None, repeat, timeout: f64::INFINITY, workers: None, accept: ARRIVED, reruns }
            }
        }
    }

    /// The word of the controller of ours that executes; `None` where a command does.
    pub fn controller(&self) -> Option<&'static str> {
        match self {
            Self::Flight(scenario) => scenario.execute.controller_in_force().map(|controller| controller.word()),
            Self::Drive(scenario) => scenario.execute.controller_in_force().map(|controller| controller.word()),
            Self::Arm(scenario) => scenario.execute.logs.is_none().then_some("virtual controller"),
        }
    }

    /// Where on Earth the world stands.
    pub fn origin(&self) -> Option<Origin> {
        match self {
            Self::Flight(scenario) => scenario.world.origin,
            Self::Drive(scenario) => scenario.world.origin,
            Self::Arm(_) => None,
        }
    }

    /// Distributions, by key.
    pub fn vary(&self) -> &BTreeMap<String, Distribution> {
        match self {
            Self::Flight(scenario) => &scenario.vary,
            Self::Drive(scenario) => &scenario.vary,
            Self::Arm(scenario) => &scenario.vary,
        }
    }

    /// The same scenario with these distributions.
    pub fn with_vary(mut self, vary: BTreeMap<String, Distribution>) -> Self {
        *self.vary_mut() = vary;
        self
    }

    /// The same for changes.
    pub(in crate::campaign) fn vary_mut(&mut self) -> &mut BTreeMap<String, Distribution> {
        match self {
            Self::Flight(scenario) => &mut scenario.vary,
            Self::Drive(scenario) => &mut scenario.vary,
            Self::Arm(scenario) => &mut scenario.vary,
        }
    }

    /// Share of cases that may violate the limits.
    pub fn violation_share(&self) -> Option<f64> {
        match self {
            Self::Flight(scenario) => scenario.spec.violation_share,
            Self::Drive(scenario) => scenario.spec.limits.violation_share,
            Self::Arm(scenario) => scenario.spec.violation_share,
        }
    }

    /// Confidence of the share's interval, where one is given.
    pub fn confidence(&self) -> Option<f64> {
        match self {
            Self::Flight(scenario) => scenario.spec.confidence,
            Self::Drive(scenario) => scenario.spec.limits.confidence,
            Self::Arm(scenario) => scenario.spec.confidence,
        }
    }

    /// Limit of the deviation, m.
    pub fn deviation_limit(&self) -> Option<f64> {
        match self {
            Self::Flight(scenario) => scenario.spec.deviation.map(|limit| limit.max_m),
            Self::Drive(scenario) => scenario.spec.limits.path_deviation_m,
            Self::Arm(scenario) => scenario.spec.path.map(|limit| limit.max_mm * 1e-3),
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
