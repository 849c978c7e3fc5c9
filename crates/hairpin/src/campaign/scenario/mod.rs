//! The scenario: every key of a scenario file, with its default. These types are the contract: the parser,
//! the JSON Schema and the commented files of `hairpin new` all come from them. Units are in the names.
//!
//! What the robot is decides which keys there are: [`FlightScenario`] for what flies, [`DriveScenario`] for what
//! drives, [`ArmScenario`] for arms.

use thiserror::Error;

mod arm;
mod distribution;
mod drive;
mod environment;
mod flaky;
mod flight;
mod head;
mod kinds;
mod named;
mod path;
mod record;
mod robot_source;
mod search;
mod sections;
mod spec;
mod steering;
mod subject;
mod terms;

pub use arm::*;
pub use distribution::{Distribution, shapes_the_plan};
pub(super) use distribution::{runs, zip};
pub use drive::*;
pub use environment::Environment;
pub use flaky::FlakySection;
pub use flight::*;
pub(super) use head::{BASELINE, TIMEOUT_S};
pub use head::{Executor, Head, Keys, Patience};
pub(super) use kinds::kinds_of_robots;
pub use kinds::{RobotKind, Scenario};
pub use named::{Named, NamedMesh};
pub use path::KeyPath;
pub use record::Record;
pub use robot_source::RobotSource;
pub use search::*;
pub(super) use sections::{SECTIONS, sections};
pub use spec::{Asked, Spec};
pub use steering::{COMMAND, CONTROLLER_KEY, Steering, UserSteering};
pub use subject::{ARM_MOVES, Subject};
pub use terms::Terms;

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
