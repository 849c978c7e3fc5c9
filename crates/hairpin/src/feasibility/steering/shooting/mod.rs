//! Boundary-value trajectories of ground vehicles: find controls whose motion ends where it was asked to.

pub mod cc;
mod control;
pub mod families;
pub mod flat;
pub mod query;
pub mod rough;
pub mod solve;

pub use control::Control;
pub use query::{Curvatures, Goal, Precision, Query, Refusal};
