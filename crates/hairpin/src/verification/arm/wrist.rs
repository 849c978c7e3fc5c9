//! Wrists whose three axes meet.

use nalgebra::{Point3, Vector3};

use super::screws::Screws;

/// Lines (m) and directions that differ by less are the same.
const SAME: f64 = 1e-9;

/// Three axes through one point.
#[derive(Debug, Clone)]
pub(super) struct Wrist {
    /// That point, at rest.
    pub(super) centre: Point3<f64>,
}

impl Wrist {
    /// Of an arm whose axes lie as subproblems ask: 2 and 3 side by side and square to 1, 4 and 6 square to 5, all
    /// three through one point.
    ///
    /// `None` where one of the conditions is off by 10⁻⁹ or more: then angles are those claimed, or those that a
    /// straight way leads to.
    pub(super) fn of(screws: &Screws) -> Option<Self> {
        let direction = |k: usize| screws.lines[k].1;
        let square = |a: usize, b: usize| direction(a).dot(&direction(b)).abs() < SAME;
        let (fourth, fifth) = (screws.lines[3], screws.lines[4]);
        // Square to each other, the lines meet where line 4 is nearest to a point of line 5.
        let centre = fourth.0 + fourth.1 * (fifth.0 - fourth.0).dot(&fourth.1);
        let on = |(point, direction): (Point3<f64>, Vector3<f64>)| (centre - point).cross(&direction).norm() < SAME;
        let beside = direction(1).cross(&direction(2)).norm() < SAME;
        let fits = beside && square(0, 1) && square(3, 4) && square(4, 5) && on(fifth) && on(screws.lines[5]);
        fits.then_some(Self { centre })
    }
}
