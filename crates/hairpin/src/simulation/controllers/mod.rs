//! The controllers of ours that fly: each turns the measured state and where to go into what the inner loops take.

mod anafi;
mod cascade;
mod curve;
mod fixed_velocity;
mod geometric;
mod kind;
mod minimum_snap;
mod pilot;
pub(super) mod stable_waypoint;
mod unstable_waypoint;

pub(super) use cascade::Cascade;
pub use curve::SegmentTimes;
pub use kind::{ControllerKind, ControllerSettings};
pub use minimum_snap::minimum_snap_curve;
pub(super) use pilot::Pilot;
