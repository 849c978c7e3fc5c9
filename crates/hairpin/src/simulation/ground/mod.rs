//! Ground vehicles as they drive: the plant that a planner does not know, controllers, and the loop closed over them.
//!
//! [`drive`] is the one verb, [`drive_with`] the same by a controller of the caller's own. The true vehicle may slip,
//! lag and delay otherwise than the one that was planned with.
//!
//! ```text
//! Drive ── nominal vehicle ──▶ Plan (sections of stations, a Track)
//!                                │
//!           Guide: where, how fast ──▶ driver: curvature ──▶ latency ──▶ Plant (true vehicle on the map) ──▶ log
//!                     ▲                                                       │
//!                     └────────────────── pose, with noise ───────────────────┘
//! ```
//!
//! | room | is |
//! | --- | --- |
//! | `plan` | where the commands lead the vehicle that was planned with |
//! | `guide`, `controllers` | what a controller of ours does with it |
//! | `plant` | suspension at every step, slip, lags, torque |
//! | `watch`, `recorder` | what ends a run, and its log |
//! | `rehearsal` | many runs of one plan, and what is said along a motion |

mod close_loop;
mod command;
mod controllers;
mod guide;
mod plan;
mod plant;
mod pursuit;
mod recorder;
mod rehearsal;
mod sortie;
mod watch;

#[cfg(feature = "unit-tests")]
mod tests;

pub use close_loop::{drive, drive_with};
pub use command::{DriveCommand, DriveState};
pub use controllers::{GroundController, GroundControllerKind, Resolve};
pub use plan::planned_track;
pub use rehearsal::{Moment, Rehearsal};
pub use sortie::{DriveSettings, GroundConditions, GroundSortie};
