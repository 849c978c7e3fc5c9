//! What stands under a robot that drives, for logs and missions whose heights are not their own.

/// The ground under a robot.
///
/// m and rad, world frame.
pub trait Footing {
    /// Height of the ground at (x, y), m; `None` where there is none.
    fn ground(&self, x: f64, y: f64) -> Option<f64>;

    /// Heights (m) of the robot's origin where it rests at each \[x, y, ψ\] of a way, as plans and runs have it;
    /// `None` where it finds no rest.
    fn resting(&self, way: &[[f64; 3]]) -> Vec<Option<f64>>;
}
