//! Ground vehicles as they drive: the plant that a planner does not know, controllers, and the loop closed over them.
//!
//! [`drive`] is the one verb. The true vehicle may slip, lag and delay otherwise than the one that was planned with.
//!
//! A plan's commands lead the vehicle that was planned with exactly to its goals. The one that drives may be loaded,
//! slip more, answer later and be pulled at; a controller sees where it is, knows the plan, and nothing of that.

mod close_loop;
mod controllers;
mod guide;
mod plan;
mod plant;
mod pursuit;
mod recorder;

#[cfg(test)]
mod tests;

pub use close_loop::{DriveSettings, GroundConditions, GroundSortie, drive};
pub use controllers::{GroundController, GroundControllerKind, Resolve};
pub use plan::planned_track;
