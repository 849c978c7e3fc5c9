//! The jobs of hairpin over folders: plain settings in, plain results out. Nothing here parses arguments, knows a terminal, ends the process or keeps a
//! global of its own: what stops a job and who sees how far it is comes in as a [`Watch`].

pub mod differences;
mod problem;
pub mod sets;
pub mod steer;
pub mod terrain;
mod watch;
pub mod work;

pub use problem::Problem;
pub use watch::{Deadline, Unwatched, Watch, not_waiting_for};
