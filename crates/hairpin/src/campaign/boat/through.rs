//! Witnesses over other waypoints: each is passed with the velocity that the plan had at the one in whose place it
//! comes.

use nalgebra::Point3;

use super::BoatSetup;
use crate::campaign::{Case, Evidence};
use crate::feasibility::boat::BoatJudge;
use crate::trajectory::Profile;

/// The witness over `points`, of which the k-th comes in the place of waypoint number `indices[k]` of `profile`: at
/// rest at both ends, the shortest leg times of `rungs`. `None` where there is none.
///
/// `judge.judge` is asked rung by rung, the shortest first: at most rungs × legs judgements.
///
/// Velocities over ground at `indices` are read from the end of the leg before. `None` also where a waypoint in between
/// would be at rest in still water, where its heading is not defined.
pub(super) fn through(
    judge: &BoatJudge,
    rungs: &[f64],
    profile: &Profile,
    indices: &[usize],
    points: &[Point3<f64>],
) -> Option<Profile> {
    let velocity = |number: usize| match number.checked_sub(1).map(|before| profile.legs.get(before)) {
        Some(Some(leg)) => leg.derivative(leg.duration, 1),
        _ => nalgebra::Vector3::zeros(),
    };
    let last = points.len() - 1;
    let state = |(k, point): (usize, &Point3<f64>)| {
        if k == 0 || k == last {
            return Some(judge.end(point, [0.0; 2]));
        }
        let passing = velocity(indices[k]);
        judge.between(point, [passing.x, passing.y])
    };
    let ends = points.iter().enumerate().map(state).collect::<Option<Vec<_>>>()?;
    let leg = |pair: &[_]| rungs.iter().find_map(|rung| judge.judge(&pair[0], &pair[1], *rung).ok());
    let legs: Option<Vec<_>> = ends.windows(2).map(leg).collect();
    Some(Profile { legs: legs? })
}

/// `case` with `points` in the place of its waypoints, if they are feasible as its own were. Of waypoints made
/// elsewhere nothing was claimed but that they lie in free water, if they did.
///
/// Every leg is judged anew, as all of its times may change; longer than `max_time_s` it is none.
pub(super) fn replan(setup: &BoatSetup, case: &Case, indices: &[usize], points: &[Point3<f64>]) -> Option<Case> {
    let unwitnessed = Case {
        waypoints: points.to_vec(),
        leg_times: Vec::new(),
        witness: None,
        bound: None,
        certified: None,
        ..case.clone()
    };
    if case.evidence != Evidence::Witnessed {
        let free = |points: &[Point3<f64>]| points.iter().all(|p| is_free(setup, p));
        return (free(points) || !free(&case.waypoints)).then_some(unwitnessed);
    }
    let profile = through(&setup.judge(), &setup.timing().rungs(), case.profile()?, indices, points)?;
    if profile.duration() > setup.longest() {
        return None;
    }
    let leg_times = profile.legs.iter().map(|leg| leg.duration).collect();
    Some(Case { leg_times, witness: Some(profile.into()), ..unwitnessed })
}

/// Whether the hull's disc may lie at `place`.
///
/// Its middle at least the margin within every edge, and the hull's radius from every keep-out; touching is free.
pub(super) fn is_free(setup: &BoatSetup, place: &Point3<f64>) -> bool {
    let world = &setup.scenario.world;
    let margin = world.keep_in_margin_m;
    let inside = (0..2).all(|axis| place[axis] >= margin && place[axis] <= world.size_m[axis] - margin);
    inside && setup.keep_out.distance(place.x, place.y) >= setup.boat.radius
}
