//! Other waypoints for a case, on the claim that the case stands on.

use nalgebra::Point3;

use super::FlightSetup;
use super::certificates::Certifier;
use super::stepwise::Stepwise;
use super::witness::Witness;
use crate::campaign::scenario::ReachName;
use crate::campaign::{Case, Evidence};
use crate::feasibility::certify::Certificate;

/// `case` with `points` in the place of its waypoints, if they are feasible as its own were: witnessed where it was, by
/// the same reach set where that was all. Of waypoints made elsewhere nothing was claimed but what every waypoint is
/// held to, that it is in the world and clear of obstacles, if they were. `None`: they are not, or nothing shows it.
///
/// Bounds and certificates are of the old waypoints and are dropped, but for a witness that is found again.
///
/// Cost: of a witness a certificate of the whole sequence, else one question a leg. Waypoints made elsewhere may lie
/// where no plan would put them; those that did before may again.
pub(super) fn replan(setup: &FlightSetup, case: &Case, points: &[Point3<f64>]) -> Option<Case> {
    let generate = &setup.scenario.generate;
    let made_elsewhere = case.leg_times.is_empty();
    let whole_legs = case.evidence != Evidence::Witnessed;
    if !free(setup, points, whole_legs) && (!made_elsewhere || free(setup, &case.waypoints, whole_legs)) {
        return None;
    }
    let unwitnessed = |leg_times| {
        Some(Case {
            waypoints: points.to_vec(),
            leg_times,
            witness: None,
            bound: None,
            certified: None,
            ..case.clone()
        })
    };
    match case.evidence {
        Evidence::Witnessed => {
            let answer = match generate.reach {
                ReachName::Witness => Witness::new(setup).ok()?.through(points),
                _ => Certifier::new(setup).ok()?.answer(points),
            };
            let Certificate::Yes(profile) = answer else { return None };
            let leg_times = profile.legs.iter().map(|leg| leg.duration).collect();
            Some(Case { witness: Some(profile.into()), certified: case.certified, ..unwitnessed(leg_times)? })
        }
        _ if made_elsewhere => unwitnessed(Vec::new()),
        _ => {
            let set = Stepwise::new(setup).ok()?;
            let legs = points.len() - 1;
            let longest = generate.limits.max_flight_time_s.unwrap_or(f64::INFINITY);
            let feasible = legs as f64 * set.step() <= longest && set.follows(points).is_some();
            feasible.then(|| unwitnessed(vec![set.step(); legs])).flatten()
        }
    }
}

/// Whether all points are in free space and, where no witness proves more, all straight legs are clear.
///
/// Points keep the keep-in margin from the walls, and all the robot's radius from obstacles.
fn free(setup: &FlightSetup, points: &[Point3<f64>], whole_legs: bool) -> bool {
    let radius = setup.robot.clearance_radius;
    let inside = points.iter().all(|p| setup.world.is_free(p, radius));
    let clear = || points.windows(2).all(|leg| setup.world.segment_distance(&leg[0], &leg[1]) >= radius);
    inside && (!whole_legs || clear())
}
