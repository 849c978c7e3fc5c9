//! The virtual controller of arms: a program's moves in, poses every 10 ms out, and what was planned for the judge.
//!
//! [`Plan::new`] lays the path and its time law; [`Plan::execute`] lets servos follow it. Equations: docs/virtual-controller.md.

mod clock;
mod curve;
mod execute;
mod faults;
mod follow;
mod grid;
mod order;
mod path;
mod plan;
mod profile;
mod program;
mod servo;
mod settings;
mod sharp;

#[cfg(test)]
mod tests;

pub use execute::{Run, Status};
pub use faults::Fault;
pub use follow::{Reason, Stop};
pub use order::{Order, Speed, Target, Zone};
pub use plan::{Load, Plan};
pub use settings::{Noise, PlanSettings, RunSettings, Shape};
