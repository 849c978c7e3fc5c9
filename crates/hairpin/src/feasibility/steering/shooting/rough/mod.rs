//! The generator on real ground: motion predicted with suspension, slip and delay, and controls found whose motion ends at
//! the goal.
//!
//! The flat solver stays the one that shapes paths and keeps their bounds. What the ground changes is put into its goal:
//! find the flat goal g so that the controls that reach g in the plane reach the true goal on the ground.

mod cheaper;
mod cost;
mod miss;
mod model;
mod predict;
mod refine;
mod solve;
mod steering_lag;
mod wait;

#[cfg(test)]
mod tests;

pub use cost::{GroundCost, cost_along};
pub use predict::{Blocked, Cause, Course, Driven, Prediction, Steps, predict, predict_while, tilt};
pub use solve::{Answer, Settings, Status, solve, solve_until};
pub use wait::Waiting;
