//! The jobs of hairpin over folders: plain settings in, plain results out. Nothing here parses arguments, knows a
//! terminal, ends the process or keeps a global of its own: what stops a job and who sees how far it is comes in as a
//! [`Watch`].

#![cfg_attr(not(test), deny(clippy::unwrap_used))] // tests may, what meets users' data may not

mod baseline;
pub mod bounds;
mod budget;
pub mod calibrate;
pub mod certificate;
pub mod check;
pub mod check_executor;
pub mod cluster;
pub mod compare;
pub mod consent;
mod copies;
pub mod differences;
pub mod execute;
pub mod explain;
pub mod export;
pub mod fit;
pub mod generate;
pub mod import;
pub mod judge;
pub mod judge_log;
pub mod learn;
pub mod max_load;
pub mod missions;
pub mod names;
pub mod next;
pub mod optimum;
mod problem;
mod program;
pub mod replay;
pub mod report;
mod rounds;
pub mod saved;
pub mod select;
pub mod sets;
pub mod shrink;
pub mod simulate;
mod spelling;
pub mod steer;
pub mod stress;
pub mod terrain;
#[cfg(test)]
mod testing;
pub mod verify;
mod watch;
pub mod work;

pub use budget::{Budget, Spent};
pub use problem::Problem;
pub use watch::{Deadline, Seen, Unwatched, Watch};
