//! What each command means; one file each: arguments become the settings of a job, and its result words.

mod answer;
pub(crate) mod bench;
pub(crate) mod compare;
pub(crate) mod completions;
pub(crate) mod demo;
pub(crate) mod execute;
pub(crate) mod experiment;
pub(crate) mod explain;
pub(crate) mod export;
pub(crate) mod generate;
pub(crate) mod import;
pub(crate) mod judge;
pub(crate) mod learn;
pub(crate) mod max_load;
pub(crate) mod new;
pub(crate) mod replay;
pub(crate) mod report;
pub(crate) mod requirements;
pub(crate) mod schema;
pub(crate) mod select;
pub(crate) mod show;
pub(crate) mod shrink;
pub(crate) mod simulate;
pub(crate) mod steer;
pub(crate) mod stress;
mod terrain;
pub(crate) mod verify;
