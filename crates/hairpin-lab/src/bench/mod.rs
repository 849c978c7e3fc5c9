//! The speeds that hairpin promises, measured here and now on one core, beside their targets.

mod arm;
mod arm_controller;
mod commands;
mod controls;
mod exact;
mod flyer;
mod ground;
mod max_load;
mod memory;
mod questions;
mod reach;
mod row;
mod search;
mod simulation;
mod speeds;
mod steer;
mod witness;
mod worst;

pub use commands::{CommandsSettings, list_commands, measure_commands};
pub use questions::write_questions;
pub use row::BenchSettings;
pub use speeds::measure;
pub use worst::{WORST, measure_worst};
