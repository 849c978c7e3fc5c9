//! Points of a body, as near to one another as distances are looked at: fewer than it has, so that no true claim is
//! refused.

use std::collections::BTreeSet;

use nalgebra::Point3;

use super::claim::ArmBodyClaim;

/// Points of one body in its link's frame, m.
pub(super) struct Samples {
    pub(super) points: Vec<Point3<f64>>,
    /// The middle of a ball around them, and its radius.
    pub(super) center: Point3<f64>,
    pub(super) reach: f64,
}

/// Points of hulls are one in each cube of this edge, m.
const CELL: f64 = 1e-2;

impl Samples {
    /// Along every line between two of the points that the body is the hull of, every `step` (m) or nearer; of hulls of
    /// more than two one in each of the cubes that space is parted into.
    pub(super) fn of(body: &ArmBodyClaim, step: f64) -> Self {
        let points = match &body.points[..] {
            [a, b] => along(a, b, step).collect(),
            corners => of_hull(corners, step),
        };
        let first = body.points.first().copied().unwrap_or_else(Point3::origin);
        let (low, high) = points.iter().fold((first, first), |(low, high), p| (low.inf(p), high.sup(p)));
        let center = nalgebra::center(&low, &high);
        let reach = points.iter().map(|p| (p - center).norm()).fold(0.0, f64::max);
        Self { points, center, reach }
    }
}

/// Both ends and what lies between evenly, `step` m apart or nearer.
fn along(a: &Point3<f64>, b: &Point3<f64>, step: f64) -> impl Iterator<Item = Point3<f64>> {
    let (a, way) = (*a, b - a);
    let count = (way.norm() / step).ceil().max(1.0);
    (0..=count as usize).map(move |i| a + way * (i as f64 / count))
}

/// All corners, and of the lines between any two the first point that falls into each cube of 10 mm; O(corners²)
/// lines. Inside and faces are not filled: a solid smaller than what lies between may be passed by.
fn of_hull(corners: &[Point3<f64>], step: f64) -> Vec<Point3<f64>> {
    let mut taken = BTreeSet::new();
    let mut points = corners.to_vec();
    for (i, a) in corners.iter().enumerate() {
        for b in &corners[i + 1..] {
            points.extend(
                along(a, b, step).filter(|p| taken.insert([p.x, p.y, p.z].map(|part| (part / CELL).floor() as i64))),
            );
        }
    }
    points
}
