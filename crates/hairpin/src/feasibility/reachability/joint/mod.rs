//! Joint mode: moves of the whole arm, every link and the tool, followed in one configuration and proven between samples.

mod arcs;
mod bodies;
mod circle;
mod costs;
mod follow;
mod motion;
mod stations;

#[cfg(test)]
mod tests;

pub use arcs::{ArcGraph, arcs};
pub use bodies::{Bodies, TOOL};
pub use circle::{Circle, CircleError};
pub use costs::{Cost, Trapezoid, time_law};
pub use follow::{FollowSettings, Followed, follow};
pub use motion::Motion;
pub use stations::{Alternative, JointGraph, JointSettings, MoveKind, Station, joint, moved};
