//! Whether what a drive's scenario places lies on its map.

use crate::campaign::check::{Findings, check_places_within};
use crate::campaign::scenario::{DriveScenario, GroundReach};
use crate::world::terrain::{ElevationMap, KeepOuts, Terrain};

/// It must be possible to stand at both ends, and to come near every keep-out.
///
/// On the map is where a patch of it has heights: within its extent, and not on a cell without data. Heights and slopes
/// there are not looked at; the search tells whether the body stands. Where legs keep out of keep-outs, no end lies in
/// one.
pub(super) fn check(keys: &DriveScenario, keep_out: Option<&KeepOuts>, map: &ElevationMap, found: &mut Findings) {
    let (task, (low, high)) = (&keys.task, map.extent());
    for (key, place) in [("task.start", Some([task.start.x_m, task.start.y_m])), ("task.end_m", task.end_m)] {
        let Some([x, y]) = place else { continue };
        if let Err(error) = map.patch(x, y) {
            let bound = format!(
                "on the map, x {} … {} m, y {} … {} m, and not on a cell without data: {error}",
                low[0], high[0], low[1], high[1]
            );
            found.require(false, key, format!("({x}, {y})"), &bound);
        }
        let Some(places) = keep_out else { continue };
        let near = places.nearest(x, y).filter(|near| near.distance < 0.0);
        if let Some(near) = near.filter(|_| keys.generate.reach == GroundReach::Witness) {
            let bound = format!("outside `{}`; it is {:.3} m inside", near.keep_out.name, -near.distance);
            found.require(false, key, format!("({x}, {y})"), &bound);
        }
    }
    if let Some(places) = keep_out {
        check_places_within(places, [low, high], "on the map", found);
    }
}
