//! The papers' experiments and those that they left open; tables as CSV, figures as SVG.
//!
//! One file per paper. Each takes the experiment's sheet (`experiments/NAME.toml`) and gives back an outcome; what is
//! written and told of it is decided once.

mod conduct;
mod defaults;
mod outcome;
mod robtest;
mod rover;
mod sheet;
mod stressful;
mod watched;

pub use conduct::{ExperimentSettings, conduct, names};
