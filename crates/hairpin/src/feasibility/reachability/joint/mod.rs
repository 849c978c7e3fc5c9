//! Joint mode: moves of the whole arm, every link and the tool, followed in one configuration and proven between
//! samples.
//!
//! Around a sample q(s₀) of a move and half width h:
//!
//! ```text
//! |q_k(s) − q_k(s₀)| ≤ rate_k h                          (robot::arm::Arm::bounds_around)
//! limits: margin_k > rate_k h        links: distance > radius + clearance + Σ turns (Chain::displacement)
//! ```
//!
//! hold on the whole piece or it is halved, down to 2⁻¹⁴ of the move. Distances are doubles with 1 nm of room: proven
//! between samples, and up to rounding.

mod arcs;
mod bodies;
mod circle;
mod costs;
mod follow;
mod motion;
mod stations;
mod worth;

#[cfg(feature = "unit-tests")]
mod tests;

pub use arcs::{ArcGraph, arcs, arcs_until};
pub use bodies::{Bodies, TOOL};
pub use circle::{Circle, CircleError};
pub use costs::{Cost, Trapezoid, time_law};
pub use follow::{FollowSettings, Followed, follow};
pub use motion::Motion;
pub use stations::{Alternative, JointGraph, JointSettings, MoveKind, Station, joint, joint_until, moved, postures};
pub use worth::{Worth, is_known};
