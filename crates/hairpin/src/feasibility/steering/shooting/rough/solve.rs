//! Finds the commands whose motion on the ground ends at the goal.
//!
//! Let S(g) be the flat solver's controls for the goal g and E(c) the predicted end of controls c. Sought is g with E(S(g)) = goal: four
//! equations in (x, y, ψ, κ). On level ground g is the goal; slopes, slip and lag move the end by a fraction of the way, so the
//! Jacobian starts as the identity and learns by Broyden's update (Broyden 1965), one prediction an iteration and none for
//! derivatives. Bounds, reversals and turns in place are kept by the flat solver at every iteration.

use nalgebra::{Matrix4, Vector4};

use super::predict::{Blocked, Course, Planar, Prediction, predict};
use crate::feasibility::steering::shooting::{Goal, Precision, Query};
use crate::trajectory::drive::{Gear, Segment, SegmentList};
use crate::world::terrain::Terrain;

/// How long and how exactly to look.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// Predictions, at most.
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
/// Halvings of a step that the flat solver or the ground refuses.
const MOST_HALVINGS: u32 = 4;

/// Commands from `start` whose motion on the ground ends at `goal`, shaped by `steer`, the flat solver.
///
/// `steer` answers questions in the frame of the start, and should do so far better than the precision asked for here.
pub fn solve<T: Terrain>(
    course: &Course<'_, T>,
    start: &Planar,
    goal: &Planar,
    settings: &Settings,
    steer: &mut dyn FnMut(&Query) -> Option<SegmentList>,
) -> Answer {
    let mut answer =
        Answer { status: Status::Unreachable, segments: SegmentList::default(), prediction: None, iterations: 0 };
    // Until the first command acts, the vehicle goes on as it was.
    let wait = course.rover.response.latency * course.speed;
    let mut from = *start;
    if wait > 0.0 {
        match predict(course, start, &[hold(start.curvature, wait)], |_| {}) {
            Ok(waited) => from = waited.end,
            Err(blocked) => {
                answer.status = Status::Blocked(blocked);
                return answer;
            }
        }
    }
    let frame = Frame { origin: from, direction: course.direction };
    let target = frame.seen(goal);
    let scale = scale(&settings.precision);
    let mut inverse = Matrix4::identity();
    let mut virtual_goal = target;
    let mut best: Option<Tried> = None;
    let mut halvings = 0;
    let mut damping = 1.0;
    while answer.iterations < settings.iterations {
        answer.iterations += 1;
        let question = Query {
            start_curvature: start.curvature,
            goal: Goal { x: virtual_goal[0], y: virtual_goal[1], yaw: virtual_goal[2], curvature: virtual_goal[3] },
        };
        let outcome = steer(&question).map(|segments| (predict(course, &from, &segments, |_| {}), segments));
        let (prediction, segments) = match outcome {
            Some((Ok(prediction), segments)) => (prediction, segments),
            refused => {
                if best.is_none() {
                    if let Some((Err(blocked), segments)) = refused {
                        (answer.status, answer.segments) = (Status::Blocked(blocked), segments);
                    }
                    return answer;
                }
                halvings += 1;
                if halvings > MOST_HALVINGS {
                    break;
                }
                if let Some(good) = &best {
                    virtual_goal = 0.5 * (virtual_goal + good.goal);
                }
                continue;
            }
        };
        let error = difference(&target, &frame.seen(&prediction.end));
        let residual = error.component_mul(&scale).amax();
        let tried = Tried { goal: virtual_goal, error, residual };
        let better = best.as_ref().is_none_or(|good| residual < good.residual);
        if let Some(good) = &best {
            learn(&mut inverse, &(tried.goal - good.goal), &(good.error - tried.error));
        }
        if better {
            (answer.segments, answer.prediction) = (segments, Some(prediction));
            if residual <= AIM {
                answer.status = Status::Ok;
                break;
            }
            best = Some(tried);
            (halvings, damping) = (0, 1.0);
        } else {
            // What was learned from a step that did not help is applied to the best place once, then in halves.
            damping = if halvings == 0 { 1.0 } else { 0.5 * damping };
            halvings += 1;
            if halvings > MOST_HALVINGS {
                break;
            }
        }
        let Some(good) = &best else { break };
        virtual_goal = good.goal + damping * (inverse * good.error);
    }
    if let Some(good) = best.filter(|_| answer.status != Status::Ok) {
        answer.status = Status::NotConverged { residual: good.residual };
    }
    // Commands go on for as long as they take to act.
    if wait > 0.0 && !answer.segments.is_empty() && answer.segments.push(hold(virtual_goal[3], wait)).is_err() {
        answer.status = Status::Unreachable;
    }
    answer
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

fn scale(precision: &Precision) -> Vector4<f64> {
    Vector4::new(1.0 / precision.position, 1.0 / precision.position, 1.0 / precision.yaw, 1.0 / precision.curvature)
}

fn difference(a: &Vector4<f64>, b: &Vector4<f64>) -> Vector4<f64> {
    let mut error = a - b;
    error[2] = wrapped(error[2]);
    error
}

/// `angle` brought to (−π, π].
fn wrapped(angle: f64) -> f64 {
    let turns = (angle / std::f64::consts::TAU).round();
    angle - turns * std::f64::consts::TAU
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
}
