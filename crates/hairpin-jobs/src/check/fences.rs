//! A mission against its own geofence.

use hairpin::campaign::{Broken, Certainty, Passage};
use hairpin::world::terrain::{KeepOut, KeepOutShape, KeepOuts};
use hairpin_formats::missions::{Mission, Outline};
use nalgebra::Point2;

/// Adds to `passage` the first waypoint or leg that crosses a fence of `mission`.
pub(super) fn hold(mission: &Mission, passage: &mut Passage) {
    for (number, fence) in mission.fences.iter().enumerate() {
        let shape = match &fence.outline {
            Outline::Circle(center, radius) => {
                KeepOutShape::Circle { center_m: [center.x, center.y], radius_m: *radius }
            }
            Outline::Polygon(corners) => {
                KeepOutShape::Polygon { points_m: corners.iter().map(|p| [p.x, p.y]).collect() }
            }
        };
        // One without an area keeps nobody in or out.
        let Ok(outline) = KeepOuts::new(vec![KeepOut { name: format!("fence {number}"), shape }]) else { continue };
        let place = |k: usize| [mission.waypoints[k].x, mission.waypoints[k].y];
        let outside = |k: usize| {
            let distance = outline.distance(place(k)[0], place(k)[1]);
            if fence.keeps_in { distance } else { -distance }
        };
        let side = if fence.keeps_in { "outside" } else { "inside" };
        let found = (0..mission.waypoints.len()).find(|k| outside(*k) > 0.0);
        let crossed = || {
            let legs = 0..mission.waypoints.len() - 1;
            legs.into_iter().find(|k| match (fence.keeps_in, &fence.outline) {
                (false, _) => outline.segment_distance(place(*k), place(k + 1)) <= 0.0,
                // Between two places in a circle there is nothing outside of it.
                (true, Outline::Circle(..)) => false,
                (true, Outline::Polygon(corners)) => leaves(&outline, corners, place(*k), place(k + 1)),
            })
        };
        let broken = |waypoint: usize, leg: Option<usize>, excess: Option<f64>, words: String| Broken {
            waypoint,
            leg,
            limit: "fence",
            unit: "m",
            excess,
            certainty: Certainty::Proven,
            words,
        };
        let one = match (found, crossed()) {
            (Some(waypoint), _) => {
                let excess = outside(waypoint);
                let words = format!("it lies {excess:.2} m {side} of the mission's own fence {number}");
                broken(waypoint, None, Some(excess), words)
            }
            (None, Some(leg)) => {
                broken(leg + 1, Some(leg), None, format!("its straight line crosses the mission's own fence {number}"))
            }
            (None, None) => continue,
        };
        if passage.broken.as_ref().is_none_or(|known| one.waypoint < known.waypoint) {
            passage.broken = Some(one);
            passage.witness = None;
        }
    }
}

/// Farther outside than this between two edges a leg is outside, m: one along an edge is not.
const OUTSIDE_M: f64 = 1e-6;

/// Whether the straight line from `a` to `b`, which are inside, leaves the polygon of `corners`: between two of the
/// places where it meets edges all of it is on one side.
fn leaves(outline: &KeepOuts, corners: &[Point2<f64>], a: [f64; 2], b: [f64; 2]) -> bool {
    let (from, way) = (Point2::from(a), Point2::from(b) - Point2::from(a));
    let edges = corners.iter().zip(corners.iter().cycle().skip(1));
    let meets = edges.filter_map(|(start, end)| {
        let edge = end - start;
        let across = way.perp(&edge);
        let (t, s) = ((start - from).perp(&edge) / across, (start - from).perp(&way) / across);
        // Parallel ones are met at no number; their ends belong to the edges beside them.
        ((0.0..=1.0).contains(&t) && (0.0..=1.0).contains(&s)).then_some(t)
    });
    let mut places: Vec<f64> = meets.chain([0.0, 1.0]).collect();
    places.sort_unstable_by(f64::total_cmp);
    places.windows(2).any(|pair| {
        let middle = from + way * (0.5 * (pair[0] + pair[1]));
        outline.distance(middle.x, middle.y) > OUTSIDE_M
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A U that opens to the top: from one arm to the other across the bay, and around through the bottom.
    #[test]
    fn a_leg_across_a_bay_leaves_the_fence() {
        let corners = [
            [0.0, 0.0],
            [30.0, 0.0],
            [30.0, 20.0],
            [20.0, 20.0],
            [20.0, 10.0],
            [10.0, 10.0],
            [10.0, 20.0],
            [0.0, 20.0],
        ];
        let shape = KeepOutShape::Polygon { points_m: corners.to_vec() };
        let outline = KeepOuts::new(vec![KeepOut { name: "u".into(), shape }]).unwrap();
        let corners = corners.map(Point2::from);
        for (a, b, out) in [
            ([5.0, 15.0], [25.0, 15.0], true),
            ([5.0, 12.0], [25.0, 2.0], false),
            ([5.0, 19.0], [25.0, 9.0], true),
            ([5.0, 5.0], [25.0, 5.0], false),
            // Along the bay's bottom edge, and along the outer one.
            ([5.0, 10.0], [25.0, 10.0], false),
            ([0.0, 0.0], [30.0, 0.0], false),
            ([5.0, 10.5], [25.0, 10.5], true),
        ] {
            assert_eq!(leaves(&outline, &corners, a, b), out, "{a:?} {b:?}");
        }
    }
}
