//! A return that an autopilot begins by itself, anywhere on a mission: up, level and straight to above home, down.

use nalgebra::Point3;

/// Where it may begin, and what it keeps.
///
/// Who begins it above the height of returning does not come down for it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Returning<'a> {
    /// The way on whose legs it may begin, world frame, m.
    pub way: &'a [Point3<f64>],
    /// Where it ends, on the ground, m.
    pub home: Point3<f64>,
    /// The least height of returning and the greatest, world frame, m.
    pub heights: [f64; 2],
    /// What the robot keeps from obstacles, beyond its radius, m; above 0.
    pub apart: f64,
}
