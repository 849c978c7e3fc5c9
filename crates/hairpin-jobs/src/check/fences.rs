//! A mission against its own geofence.

use hairpin::campaign::{Broken, Certainty, Passage};
use hairpin::world::terrain::{KeepOut, KeepOutShape, KeepOuts};
use hairpin_formats::missions::{Mission, Outline};

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
            // Of a keep-in fence both ends are inside: whether the line between them is, is not asked of a bay.
            legs.into_iter().find(|k| !fence.keeps_in && outline.segment_distance(place(*k), place(k + 1)) <= 0.0)
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
