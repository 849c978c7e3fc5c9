//! Controls in closed form: the single arc, and turn–drive–turn.

use super::ends::tame;
use super::miss::miss;
use super::settings::{Answer, Limit, Settings, Status};
use crate::feasibility::steering::shooting::query::{Curvatures, Goal, Query};
use crate::trajectory::drive::{Gear, Motion, Segment, SegmentList};

/// The circular arc through the goal's position: κ = 2y/(x² + y²), turn 2 atan2(y, x).
///
/// Wheels are steered before it begins, so that neither the start's curvature nor κ′ counts. Straight behind the start
/// there is none: `NotConverged`. A heading or an end curvature other than the arc's is `Infeasible`.
///
/// Of several failures the first of: position (only where no arc exists), curvature, heading, end curvature. A goal at
/// the start is an empty drive. Angles up to ±2π: a goal behind is reached by the long arc.
pub(super) fn arc(query: &Query, bounds: &Curvatures, settings: &Settings) -> Answer {
    let bounds = tame(bounds);
    let Goal { x, y, .. } = query.goal;
    let squared = x * x + y * y;
    let mut segments = SegmentList::EMPTY;
    let mut curvature: f64 = 0.0;
    if y == 0.0 && x > 0.0 {
        segments.add(Segment::straight(x, Gear::Forward));
    } else if y != 0.0 && squared > 0.0 {
        curvature = 2.0 * y / squared;
        let length_m = 2.0 * libm::atan2(y, x) / curvature;
        segments.add(Segment::clothoid(length_m, curvature, curvature, Gear::Forward));
    }
    let missed = miss(settings.simd, &segments, query);
    let precision = &settings.precision;
    let over = |limit, excess: f64| Status::Infeasible { limit, excess };
    let status = if missed.position > precision.position {
        Status::NotConverged { residual: missed.position }
    } else if curvature.abs() > bounds.most {
        over(Limit::Curvature, curvature.abs() - bounds.most)
    } else if missed.yaw.abs() > precision.yaw {
        over(Limit::Yaw, missed.yaw.abs())
    } else if missed.curvature.abs() > precision.curvature {
        over(Limit::EndCurvature, missed.curvature.abs())
    } else {
        Status::Ok
    };
    Answer { status, segments, iterations: 0 }
}

/// Turns in place towards the goal, drives straight there, turns in place to its heading, each by the smaller angle.
///
/// At most three segments, none of them of nothing; empty for the start's own pose. Curvatures play no part: the wheels
/// stand as turning and driving ask.
pub fn turn_drive_turn(goal: &Goal) -> SegmentList {
    let mut segments = SegmentList::EMPTY;
    let distance = libm::hypot(goal.x, goal.y);
    let towards = if distance > 0.0 { libm::atan2(goal.y, goal.x) } else { 0.0 };
    let last = libm::remainder(goal.yaw - towards, std::f64::consts::TAU);
    let turn = |angle_rad| Segment { motion: Motion::Turn { angle_rad }, gear: Gear::Forward };
    let towards = (towards != 0.0).then(|| turn(towards));
    let straight = (distance > 0.0).then(|| Segment::straight(distance, Gear::Forward));
    let last = (last != 0.0).then(|| turn(last));
    [towards, straight, last].into_iter().flatten().for_each(|segment| segments.add(segment));
    segments
}

/// The query of a vehicle that travels at `direction` (rad, left positive) to its body: the path to be driven along
/// that direction.
///
/// The path's heading is the body's plus the direction all along, so only the goal's position turns, by −direction.
///
/// `direction` in the body; heading and curvatures stay as they are, for both turn with the body.
pub fn crab(query: &Query, direction: f64) -> Query {
    let (sin, cos) = (libm::sin(direction), libm::cos(direction));
    let goal = &query.goal;
    let (x, y) = (cos * goal.x + sin * goal.y, cos * goal.y - sin * goal.x);
    Query { goal: Goal { x, y, ..*goal }, ..*query }
}
