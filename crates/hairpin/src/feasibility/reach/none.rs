//! `none`: every waypoint follows every other; no dynamics at all (the paper's "No KD").

use nalgebra::Vector3;

use super::step::StepSet;

/// The whole space.
///
/// Nothing is claimed by it: cases keep the evidence [`crate::campaign`] calls unchecked.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Everywhere;

impl StepSet for Everywhere {
    fn bounding_box(&self) -> (Vector3<f64>, Vector3<f64>) {
        (Vector3::repeat(f64::NEG_INFINITY), Vector3::repeat(f64::INFINITY))
    }
    fn contains(&self, _d: &Vector3<f64>) -> bool {
        true
    }
    fn carry(&self) -> f64 {
        0.0
    }
}
