//! Whether what a drive's scenario places lies on its map.

use crate::campaign::check::{Findings, check_places_within};
use crate::campaign::scenario::{DriveScenario, GroundReach};
use crate::feasibility::reach::drive::DriveSite;
use crate::robot::rover::Rover;
use crate::world::terrain::{ElevationMap, KeepOuts, Terrain};

/// It must be possible to stand at both ends, and to come near every keep-out.
///
/// On the map is where a patch of it has heights: within its extent, and not on a cell without data. Heights and slopes
/// there are not looked at; the search tells whether the body stands. Where legs keep out of keep-outs, so do the ends,
/// by the circle that holds the vehicle.
pub(super) fn check(
    keys: &DriveScenario,
    (rover, keep_out): (Option<&Rover>, Option<&KeepOuts>),
    map: &ElevationMap,
    found: &mut Findings,
) {
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
        let (Some(rover), Some(places)) = (rover, keep_out) else { continue };
        let radius = DriveSite::new(rover, map, places).radius;
        let near = places.nearest(x, y).filter(|near| near.distance < radius);
        if let Some(near) = near.filter(|_| keys.generate.reach == GroundReach::Witness) {
            let (name, by) = (&near.keep_out.name, near.distance);
            let is = if by < 0.0 { format!("{:.3} m inside", -by) } else { format!("{by:.3} m from it") };
            let bound = format!("at least {radius:.3} m, the vehicle's radius, from `{name}`; it is {is}");
            found.require(false, key, format!("({x}, {y})"), &bound);
        }
    }
    if let Some(places) = keep_out {
        check_places_within(places, [low, high], "on the map", found);
    }
}
