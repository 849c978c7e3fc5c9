//! The generator on real ground: motion predicted with suspension, slip and delay, and controls found whose motion ends
//! at the goal.
//!
//! The flat solver stays the one that shapes paths and keeps their bounds. What the ground changes is put into its
//! goal: find the flat goal g so that the controls that reach g in the plane reach the true goal on the ground.
//!
//! ```text
//! g ← g + B (goal − E(S(g)))       S the flat solver, E the predicted end, B ≈ (∂(E∘S)/∂g)⁻¹, first the identity
//! ```
//!
//! Two or three predictions a drive on smooth ground. Where S jumps between ways around, the best commands are bent on
//! by themselves, with derivatives along the predicted way; where a body falls from one rest to another, finer steps
//! are believed. Only what a replay of its own confirms counts as solved (`verification`).
//!
//! What is neglected is what the model of the vehicle neglects: dynamics beyond the steering's lag and the latency,
//! sinkage, load transfer. Costs are counted in predictions, each of which integrates the drive once; everything else
//! is small beside them.

mod answer;
mod bend_on;
mod cheaper;
mod cost;
mod course;
mod frame;
mod learn_goal;
mod miss;
mod model;
mod outcome;
mod predict;
mod refine;
mod solve;
mod steering_lag;
mod wait;

#[cfg(feature = "unit-tests")]
mod tests;

pub use answer::{Answer, Settings, Status};
pub use cost::{GroundCost, cost_along};
pub use course::{Course, Steps};
pub use outcome::{Blocked, Cause, Driven, Prediction};
pub use predict::{predict, predict_while, tilt};
pub use solve::{solve, solve_until};
pub use wait::Waiting;
