//! Commands bent on by themselves where no flat goal leads to the true one.

use super::answer::{Answer, ENOUGH, Status};
use super::frame::{Frame, question, within};
use super::refine::{Task, refine};
use crate::feasibility::steering::shooting::Query;
use crate::trajectory::drive::{Motion, Planar, SegmentList};
use crate::world::terrain::Terrain;

/// Factors by which flat drives are made to bend less than the bounds allow before they are refined, in turn. The first
/// bends more: it goes straight to goals for which the bounds leave but a loop, and is bent back into them.
const GENTLER: [f64; 6] = [0.85, 1.04, 1.12, 1.25, 1.5, 2.0];
/// How far to the left the middles of drives are moved before they are refined where nothing else helped, in turn, m:
/// around what the body finds no rest on.
const ASIDE: [f64; 6] = [0.12, -0.12, 0.25, -0.25, 0.45, -0.45];

/// Refines the best commands so far, then gentler ones, which leave room within the bounds, then some that pass to the
/// side, until one meets the goal.
///
/// At most 1 + 6 + 6 refinements of 16 predictions each; the first that meets the goal ends it. `answer` is only ever
/// made better: a start that comes no nearer than the best is dropped.
pub(super) fn bend_commands<T: Terrain>(
    task: &Task<'_, '_, T>,
    steer: &mut dyn FnMut(&Query) -> Option<SegmentList>,
    answer: &mut Answer,
) {
    let (begun, mut left) = match answer.status {
        Status::NotConverged { residual } => (Some(answer.segments), residual),
        _ => (None, f64::INFINITY),
    };
    let mut attempt = |commands: Option<SegmentList>, aside: f64| {
        let Some(commands) = commands else { return false };
        let (refined, predictions) = refine(task, &commands, aside);
        answer.iterations += predictions;
        if let Some(refined) = refined.filter(|refined| refined.residual < left) {
            left = refined.residual;
            (answer.segments, answer.prediction) = (refined.segments, Some(refined.prediction));
            answer.status = Status::NotConverged { residual: left };
        }
        if left <= ENOUGH {
            answer.status = Status::Ok;
        }
        answer.status == Status::Ok
    };
    if attempt(begun, 0.0)
        || GENTLER.into_iter().any(|factor| (task.over)() || attempt(gentle(task, factor, steer), 0.0))
    {
        return;
    }
    let plain = begun.or_else(|| gentle(task, 1.0, steer));
    ASIDE.into_iter().any(|aside| (task.over)() || attempt(plain, aside));
}

/// Flat controls for the true goal that bend less than the bounds allow by `factor`: those of a world smaller by as
/// much, enlarged.
///
/// With factor f: solve for the goal at (x/f, y/f, ψ, f κ), then lengths times f and aᵢ over fⁱ⁺¹. Bounds hold in the
/// small world, so that in the large one |κ| ≤ κ_max/f and |κ′| ≤ κ′_max/f²; f < 1 may exceed both.
fn gentle<T>(
    task: &Task<'_, '_, T>,
    factor: f64,
    steer: &mut dyn FnMut(&Query) -> Option<SegmentList>,
) -> Option<SegmentList> {
    let frame = Frame { origin: *task.from, direction: task.course.direction.start };
    let mut goal = frame.seen(task.goal);
    // Where an end leaves less room, there is less of it.
    let factor = factor.min(task.bounds.most / task.from.curvature.abs());
    goal[3] = within(goal[3] * factor, task.bounds.most);
    (goal[0], goal[1]) = (goal[0] / factor, goal[1] / factor);
    let from = Planar { curvature: task.from.curvature * factor, ..*task.from };
    let mut segments = steer(&question(&from, &goal))?;
    for segment in segments.iter_mut() {
        if let Motion::Arc { length_m, curvature } = &mut segment.motion {
            *length_m *= factor;
            let mut power = factor;
            for a in curvature {
                *a /= power;
                power *= factor;
            }
        }
    }
    Some(segments)
}
