//! The flat goal whose controls reach the true one, learned from where predictions end.
//!
//! A quasi-Newton method in four unknowns whose every evaluation is a flat solve and a prediction. Broyden's good
//! update, kept as an inverse, so that a step is a product.

use nalgebra::{Matrix4, Vector4};

use super::answer::{Answer, Settings, Status};
use super::frame::{Frame, question, within};
use super::miss::{Miss, miss};
use super::predict::predict;
use super::refine::{Task, refinable};
use crate::feasibility::steering::shooting::Query;
use crate::trajectory::drive::SegmentList;
use crate::world::terrain::Terrain;

/// Steps in a row that may fail before drives are refined instead, and where they cannot be.
const MOST_FAILURES: [u32; 2] = [1, 4];

/// Looks for the flat goal whose controls reach the true one.
///
/// Goes from the best goal so far, in full steps, in parts after failures; where the flat solver or the ground refuses
/// a goal, half way back. Ends with `answer` as the best that was found, `Ok` at a residual of `aim` or less.
pub(super) fn learn_goal<T: Terrain>(
    task: &Task<'_, '_, T>,
    settings: &Settings,
    steer: &mut dyn FnMut(&Query) -> Option<SegmentList>,
    answer: &mut Answer,
) {
    let Task { course, from, goal, precision, bounds, aim, over } = *task;
    let frame = Frame { origin: *from, direction: course.direction.start };
    let mut inverse = Matrix4::identity();
    let mut virtual_goal = frame.seen(goal);
    let mut best: Option<Tried> = None;
    let mut failures = 0;
    while answer.iterations < settings.iterations && !over() {
        answer.iterations += 1;
        virtual_goal[3] = within(virtual_goal[3], bounds.most);
        let question = question(from, &virtual_goal);
        let outcome = steer(&question).map(|segments| (predict(course, from, &segments, |_| {}), segments));
        let (prediction, segments) = match outcome {
            Some((Ok(prediction), segments)) => (prediction, segments),
            refused => {
                let Some(good) = &best else {
                    if let Some((Err(blocked), segments)) = refused {
                        (answer.status, answer.segments) = (Status::Blocked(blocked), segments);
                    }
                    return;
                };
                failures += 1;
                if failures > most_failures(&answer.segments) {
                    return;
                }
                virtual_goal = 0.5 * (virtual_goal + good.goal);
                continue;
            }
        };
        let Miss { error, residual } = miss(goal, &prediction.end, precision);
        let tried = Tried { goal: virtual_goal, error: frame.turned(&error), residual };
        let better = best.as_ref().is_none_or(|good| residual < good.residual);
        if let Some(good) = &best {
            learn(&mut inverse, &(tried.goal - good.goal), &(good.error - tried.error));
        }
        if better {
            (answer.segments, answer.prediction) = (segments, Some(prediction));
            answer.status = if residual <= aim { Status::Ok } else { Status::NotConverged { residual } };
            if answer.status == Status::Ok {
                return;
            }
            best = Some(tried);
            failures = 0;
        } else {
            failures += 1;
            if failures > most_failures(&answer.segments) {
                return;
            }
        }
        let Some(good) = &best else { return };
        // What was learned from a step that did not help is applied to the best place once, then in parts.
        virtual_goal = good.goal + settings.step_scale * (inverse * good.error) / f64::from(failures.max(1));
    }
}

/// 1 where commands can be refined, which is then quicker, else 4.
fn most_failures(segments: &SegmentList) -> u32 {
    MOST_FAILURES[usize::from(!refinable(segments))]
}

/// A goal that was tried, by what its controls missed the true one, and that in units of the precision.
struct Tried {
    goal: Vector4<f64>,
    error: Vector4<f64>,
    residual: f64,
}

/// Broyden's update of the inverse Jacobian (Sherman-Morrison): moving the goal by `moved` moved the end by `effect`.
///
/// B ← B + (m − B e)(mᵀB)/(mᵀB e) with m = `moved` and e = `effect`. Left as it is where the denominator is below 10⁻³
/// ‖m‖², where the update would blow up.
fn learn(inverse: &mut Matrix4<f64>, moved: &Vector4<f64>, effect: &Vector4<f64>) {
    let predicted = *inverse * effect;
    let denominator = moved.dot(&predicted);
    if denominator.abs() > 1e-3 * moved.norm_squared() {
        let update = (moved - predicted) * (moved.transpose() * *inverse) / denominator;
        *inverse += update;
    }
}
