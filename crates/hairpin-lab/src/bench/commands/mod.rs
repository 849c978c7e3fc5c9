//! Whole commands as they are typed, each a process of this binary, beside the kernels that do their work.
//!
//! What a command takes on top of its kernel (reading, checking, replaying, writing) is seen here alone. Ratios of both
//! hold on busy machines, where neither number does.

mod campaigns;
mod cores;
mod drives;
mod inputs;
mod line;
mod programs;
mod row;
mod scratch;
mod size;
mod table;

pub use table::{CommandsSettings, list_commands, measure_commands};
