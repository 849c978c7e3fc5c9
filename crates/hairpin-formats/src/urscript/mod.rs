//! URScript of Universal Robots, out and in: metres, radians, rotation vectors, poses in the base.
//!
//! What is written reads back to the same moves. Of other programs what the file calls is followed, and the moves up to
//! the first line that says more are certain.

mod arguments;
mod blocks;
mod moves;
mod names;
mod read;
mod write;

#[cfg(test)]
mod tests;

pub use read::{NoProgram, read};
pub use write::{Settings, UrscriptError, slower, text};

/// What is said at the head of every program.
const CONVENTIONS: [&str; 3] = [
    "Poses p[x,y,z,rx,ry,rz] in the controller's base, m and rad (rotation vector); joints in rad.",
    "Joint moves take the speed of the leading axis below, not the programmed one of the tool's centre point;",
    "to a pose they go by the inverse kinematics nearest to where the arm is.",
];
