//! Left and right are solved alike, to the bit: queries that lean to the right are solved in the mirror.
//!
//! Rounding is not symmetric under a change of sign in every formula used, but a search that only ever sees one of both
//! cases cannot tell. Mirrored answers are then equal by construction, which tests and users rely on.

use super::settings::Answer;
use crate::feasibility::steering::shooting::query::{Goal, Query};
use crate::trajectory::drive::Motion;

/// Whether the first of y, yaw and the curvatures that is not zero is negative.
pub(super) fn leans_right(query: &Query) -> bool {
    let goal = &query.goal;
    [goal.y, goal.yaw, query.start_curvature, goal.curvature].iter().find(|v| **v != 0.0).is_some_and(|v| *v < 0.0)
}

/// The query with left and right exchanged.
///
/// y, yaw and curvatures change their signs.
pub(super) fn query(query: &Query) -> Query {
    let Goal { x, y, yaw, curvature } = query.goal;
    Query { start_curvature: -query.start_curvature, goal: Goal { x, y: -y, yaw: -yaw, curvature: -curvature } }
}

/// The answer with left and right exchanged.
pub(super) fn answer(mut answer: Answer) -> Answer {
    for segment in answer.segments.iter_mut() {
        match &mut segment.motion {
            Motion::Arc { curvature, .. } => curvature.iter_mut().for_each(|a| *a = -*a),
            Motion::Turn { angle_rad } => *angle_rad = -*angle_rad,
        }
    }
    answer
}
