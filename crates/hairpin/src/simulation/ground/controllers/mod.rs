//! The controllers of ours that drive.

mod guided;
mod kind;
mod predictive;
mod stanley;

pub(super) use guided::{Driver, Guided};
pub use kind::{GroundController, GroundControllerKind, Resolve};
