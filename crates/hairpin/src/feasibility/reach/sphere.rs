//! `sphere`: whatever lies within top speed times step of the current waypoint (the paper's "Approx KD").

use nalgebra::Vector3;

use super::step::StepSet;

/// A ball around the current waypoint.
///
/// |d| ≤ radius, whatever the velocity: neither drag nor momentum.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sphere {
    /// Radius, m: top speed × step.
    pub radius: f64,
}

impl StepSet for Sphere {
    fn bounding_box(&self) -> (Vector3<f64>, Vector3<f64>) {
        (Vector3::repeat(-self.radius), Vector3::repeat(self.radius))
    }
    fn contains(&self, d: &Vector3<f64>) -> bool {
        d.norm_squared() <= self.radius * self.radius
    }
    fn carry(&self) -> f64 {
        0.0
    }
}
