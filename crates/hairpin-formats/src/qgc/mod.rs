//! What ground stations and the autopilots behind them keep: missions as QGroundControl's `.plan` and as QGC WPL 110,
//! the text that it shares with Mission Planner and pymavlink, and parameter files.
//!
//! Neither PX4 nor ArduPilot has missions in local frames: everything here stands on Earth, and heights are above the
//! home that the mission states.

mod follow;
mod item;
pub mod mission;
pub mod parameters;
pub mod plan;
pub mod read_plan;
pub mod read_wpl;
mod uploaded;
mod words;
pub mod wpl;

pub use item::Wrong;
pub use uploaded::{Ending, Open, Station, Uploaded};

#[cfg(test)]
mod tests;
