//! What QGroundControl and the autopilots behind it read: missions as `.plan` and as WPL 110, and parameter files.
//!
//! Neither PX4 nor ArduPilot has missions in local frames: everything here stands on Earth, and heights are above the
//! home that the mission states.

pub mod mission;
pub mod parameters;
pub mod plan;
pub mod wpl;

#[cfg(test)]
mod tests;
