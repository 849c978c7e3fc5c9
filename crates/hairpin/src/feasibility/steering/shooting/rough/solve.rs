//! Finds the commands whose motion on the ground ends at the goal.
//!
//! Let S(g) be the flat solver's controls for the goal g and E(c) the predicted end of controls c. Sought is g with E(S(g)) = goal: four
//! equations in (x, y, ψ, κ). On level ground g is the goal; slopes, slip and lag move the end by a fraction of the way, so the
//! Jacobian starts as the identity and learns by Broyden's update (Broyden 1965), one prediction an iteration and none for
//! derivatives. Bounds, reversals and turns in place are kept by the flat solver at every iteration.
//!
//! S jumps: from an arc to a chain of clothoids, from a drive to one with a loop. A goal at a jump is met by no g; there the
//! best commands so far are bent on by themselves, with the bounds.

use nalgebra::{Matrix4, Vector4};

use super::miss::{Miss, miss};
use super::predict::{Blocked, Course, Prediction, predict};
use super::refine::{Task, refinable, refine};
use crate::feasibility::steering::shooting::{Curvatures, Goal, Precision, Query};
use crate::trajectory::drive::{Gear, Motion, Planar, Segment, SegmentList};
use crate::world::terrain::Terrain;

/// How long and how exactly to look.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// Predictions for flat goals, at most; commands that are bent on from there take more, up to 16 for each of five starts.
    pub iterations: u32,
    /// When a goal counts as met; the search aims at a fifth of it, so that a finer integration agrees.
    pub precision: Precision,
}

impl Default for Settings {
    fn default() -> Self {
        Self { iterations: 30, precision: Precision::default() }
    }
}

/// How an answer ended.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Status {
    /// The predicted end meets the goal.
    Ok,
    /// The flat solver found no controls for the goal.
    Unreachable,
    /// The ground does not let the motion pass.
    Blocked(Blocked),
    /// The predictions did not come to the goal.
    NotConverged {
        /// What is left of (x, y) in m, ψ in rad, κ in 1/m, the largest in units of its precision.
        residual: f64,
    },
}

/// What was found.
#[derive(Debug, Clone, PartialEq)]
pub struct Answer {
    /// How it ended.
    pub status: Status,
    /// The best commands, whatever the status; empty if there are none.
    pub segments: SegmentList,
    /// Their predicted motion.
    pub prediction: Option<Prediction>,
    /// Predictions that were made.
    pub iterations: u32,
}

/// Share of the precision that is aimed at; the rest is left to the prediction's own error.
const AIM: f64 = 0.2;
/// Share of the precision that will do where the aim is out of reach.
const ENOUGH: f64 = 0.8;
/// Steps in a row that may fail before drives are refined instead, and where they cannot be.
const MOST_FAILURES: [u32; 2] = [1, 4];
/// Factors by which flat drives are made to bend less than the bounds allow before they are refined, in turn. The first bends
/// more: it goes straight to goals for which the bounds leave but a loop, and is bent back into them.
const GENTLER: [f64; 4] = [0.85, 1.04, 1.12, 1.25];

/// Commands from `start` whose motion on the ground ends at `goal`, shaped by `steer`, the flat solver.
///
/// `steer` answers questions in the frame of the start within `bounds`, and should do so far better than the precision
/// asked for here.
pub fn solve<T: Terrain>(
    course: &Course<'_, T>,
    start: &Planar,
    goal: &Planar,
    bounds: &Curvatures,
    settings: &Settings,
    steer: &mut dyn FnMut(&Query) -> Option<SegmentList>,
) -> Answer {
    let mut answer =
        Answer { status: Status::Unreachable, segments: SegmentList::default(), prediction: None, iterations: 0 };
    // Until the first command acts, the vehicle goes on as it was.
    let wait = course.rover.response.latency * course.speed.start();
    let mut from = *start;
    if wait > 0.0 {
        let waiting =
            Course { speed: course.speed.start().into(), direction: course.direction.start.into(), ..*course };
        match predict(&waiting, start, &[hold(start.curvature, wait)], |_| {}) {
            Ok(waited) => from = waited.end,
            Err(blocked) => {
                answer.status = Status::Blocked(blocked);
                return answer;
            }
        }
    }
    // Held as long, the steering stands where it stood.
    let from = Planar { curvature: start.curvature, ..from };
    let task = Task { course, from: &from, goal, precision: &settings.precision, bounds, aim: AIM };
    learn_goal(&task, settings.iterations, steer, &mut answer);
    if matches!(answer.status, Status::NotConverged { .. } | Status::Blocked(_)) {
        bend_commands(&task, steer, &mut answer);
    }
    // Commands go on for as long as they take to act.
    let wait = course.rover.response.latency * course.speed.end();
    if let Some(last) = answer.segments.last().filter(|_| wait > 0.0) {
        let settled = hold(last.curvature_at(last.length_m()), wait);
        if answer.segments.push(settled).is_err() {
            answer.status = Status::Unreachable;
        }
    }
    answer
}

/// Looks for the flat goal whose controls reach the true one.
fn learn_goal<T: Terrain>(
    task: &Task<'_, '_, T>,
    most_iterations: u32,
    steer: &mut dyn FnMut(&Query) -> Option<SegmentList>,
    answer: &mut Answer,
) {
    let Task { course, from, goal, precision, bounds, aim } = *task;
    let frame = Frame { origin: *from, direction: course.direction.start };
    let mut inverse = Matrix4::identity();
    let mut virtual_goal = frame.seen(goal);
    let mut best: Option<Tried> = None;
    let mut failures = 0;
    while answer.iterations < most_iterations {
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
        virtual_goal = good.goal + inverse * good.error / f64::from(failures.max(1));
    }
}

fn most_failures(segments: &SegmentList) -> u32 {
    MOST_FAILURES[usize::from(!refinable(segments))]
}

/// Refines the best commands so far, then gentler ones, which leave room within the bounds, until some meet the goal.
fn bend_commands<T: Terrain>(
    task: &Task<'_, '_, T>,
    steer: &mut dyn FnMut(&Query) -> Option<SegmentList>,
    answer: &mut Answer,
) {
    let (begun, mut left) = match answer.status {
        Status::NotConverged { residual } => (Some(answer.segments), residual),
        _ => (None, f64::INFINITY),
    };
    let mut attempt = |commands: Option<SegmentList>| {
        let Some(commands) = commands else { return false };
        let (refined, predictions) = refine(task, &commands);
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
    if !attempt(begun) {
        GENTLER.into_iter().any(|factor| attempt(gentle(task, factor, steer)));
    }
}

/// Flat controls for the true goal that bend less than the bounds allow by `factor`: those of a world smaller by as much,
/// enlarged.
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

/// The flat solver's question for `goal` in its frame.
fn question(from: &Planar, goal: &Vector4<f64>) -> Query {
    Query { start_curvature: from.curvature, goal: Goal { x: goal[0], y: goal[1], yaw: goal[2], curvature: goal[3] } }
}

/// `curvature` brought to ±`most`.
fn within(curvature: f64, most: f64) -> f64 {
    curvature.min(most).max(-most)
}

/// A goal that was tried, by what its controls missed the true one, and that in units of the precision.
struct Tried {
    goal: Vector4<f64>,
    error: Vector4<f64>,
    residual: f64,
}

/// Broyden's update of the inverse Jacobian (Sherman-Morrison): moving the goal by `moved` moved the end by `effect`.
fn learn(inverse: &mut Matrix4<f64>, moved: &Vector4<f64>, effect: &Vector4<f64>) {
    let predicted = *inverse * effect;
    let denominator = moved.dot(&predicted);
    if denominator.abs() > 1e-3 * moved.norm_squared() {
        let update = (moved - predicted) * (moved.transpose() * *inverse) / denominator;
        *inverse += update;
    }
}

/// A stretch of constant curvature.
fn hold(curvature: f64, length_m: f64) -> Segment {
    Segment::clothoid(length_m, curvature, curvature, Gear::Forward)
}

/// The frame in which the flat solver works: the start's, turned into the direction of travel.
struct Frame {
    origin: Planar,
    direction: f64,
}

impl Frame {
    /// `place` as the flat solver sees it; ψ is measured from the start's heading.
    fn seen(&self, place: &Planar) -> Vector4<f64> {
        let (sin, cos) = libm::sincos(self.origin.yaw + self.direction);
        let (dx, dy) = (place.x - self.origin.x, place.y - self.origin.y);
        Vector4::new(cos * dx + sin * dy, cos * dy - sin * dx, place.yaw - self.origin.yaw, place.curvature)
    }

    /// An error of the ground's x and y in the axes of the frame.
    fn turned(&self, error: &Vector4<f64>) -> Vector4<f64> {
        let (sin, cos) = libm::sincos(self.origin.yaw + self.direction);
        Vector4::new(cos * error[0] + sin * error[1], cos * error[1] - sin * error[0], error[2], error[3])
    }
}
