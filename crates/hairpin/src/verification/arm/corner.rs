//! A corner that a blend cuts: the tool's point may be anywhere in a triangle.

use nalgebra::Point3;

use super::solids::distance;
use super::{ALONG, ArmClaim, ROUNDING};

/// What the tool's point would meet in the triangle that a blend of `zone` m at the middle of `way` stays in, a half of
/// either leg at most.
///
/// `way` is the tool's point at the beginning of the move, in the corner, and at the end of the next, m. The triangle
/// is sampled at [`ALONG`] and its points hold a ball of the tool's radius; `None` where all keep their distance, or
/// the arm has no tool.
pub(super) fn corner(claim: &ArmClaim, way: &[Point3<f64>; 3], zone: f64) -> Option<String> {
    let tool = claim.bodies.iter().find(|body| body.tool)?;
    let [before, at, after] = way;
    let leave = |other: &Point3<f64>| {
        let leg = other - at;
        let length = leg.norm();
        // A leg without length has no direction and no blend.
        if length > 0.0 { at + leg * (zone.min(0.5 * length) / length) } else { *at }
    };
    let (u, v) = (leave(before) - at, leave(after) - at);
    let count = (u.norm().max(v.norm()).max((u - v).norm()) / ALONG).ceil().max(1.0) as usize;
    let share = |i: usize| i as f64 / count as f64;
    let places = (0..=count).flat_map(|i| (0..=count - i).map(move |j| (i, j)));
    let points: Vec<Point3<f64>> = places.map(|(i, j)| at + u * share(i) + v * share(j)).collect();
    let room = tool.radius + claim.clearance;
    claim.solids.iter().find_map(|solid| {
        let least = points.iter().map(|p| distance(&solid.form, p)).fold(f64::INFINITY, f64::min);
        let kept = 1e3 * (least - tool.radius);
        (least < room - ROUNDING).then(|| {
            let asked = 1e3 * claim.clearance;
            format!("where its corner is cut, {} keeps {kept:.2} mm from {}, not {asked:.2} mm", tool.name, solid.name)
        })
    })
}
