//! Ground vehicles as they drive: the plant that a planner does not know, controllers, and the loop closed over them.
//!
//! [`drive`] is the one verb, [`drive_with`] the same by a controller of the caller's own. The true vehicle may slip,
//! lag and delay otherwise than the one that was planned with.

mod close_loop;
mod command;
mod controllers;
mod guide;
mod plan;
mod plant;
mod pursuit;
mod recorder;
mod sortie;
mod watch;

#[cfg(test)]
mod tests;

pub use close_loop::{drive, drive_with};
pub use command::{DriveCommand, DriveState};
pub use controllers::{GroundController, GroundControllerKind, Resolve};
pub use plan::planned_track;
pub use sortie::{DriveSettings, GroundConditions, GroundSortie};
