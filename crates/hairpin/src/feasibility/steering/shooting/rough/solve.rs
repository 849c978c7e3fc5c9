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

use super::cheaper::cheaper;
use super::cost::GroundCost;
use super::miss::{Miss, miss};
use super::predict::{Blocked, Course, Prediction, Steps, predict};
use super::refine::{Task, refinable, refine};
use super::wait::Waiting;
use crate::feasibility::steering::shooting::{Curvatures, Goal, Precision, Query};
use crate::trajectory::drive::{Motion, Planar, SegmentList};
use crate::world::terrain::Terrain;

/// How long and how exactly to look.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// Predictions for flat goals, at most; commands that are bent on from there take more, up to 16 for each of five starts.
    pub iterations: u32,
    /// When a goal counts as met; the search aims at a fifth of it, so that a finer integration agrees.
    pub precision: Precision,
    /// What to make small along the motion once it meets its goal.
    pub cost: GroundCost,
    /// Share of each step of the flat goal that is taken, in (0, 1].
    pub step_scale: f64,
}

impl Default for Settings {
    fn default() -> Self {
        Self { iterations: 30, precision: Precision::default(), cost: GroundCost::Any, step_scale: 1.0 }
    }
}

impl Settings {
    /// Whether `end` is as near to `goal` as answers are, with room for a finer integration's difference.
    pub fn met(&self, goal: &Planar, end: &Planar) -> bool {
        miss(goal, end, &self.precision).residual <= ENOUGH
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
const GENTLER: [f64; 6] = [0.85, 1.04, 1.12, 1.25, 1.5, 2.0];
/// How far to the left the middles of drives are moved before they are refined where nothing else helped, in turn, m: around
/// what the body finds no rest on.
const ASIDE: [f64; 6] = [0.12, -0.12, 0.25, -0.25, 0.45, -0.45];
/// Steps in which commands are looked along again, as shares of the first ones', in turn.
const FINER: [f64; 2] = [0.3, 0.1];
/// What a prediction may be surprised by, rad, without being looked along again: a fifth of that is common on ground that is
/// rough but not broken.
const SMOOTH: f64 = 0.03;

/// Commands from `start` whose motion on the ground ends at `goal`, shaped by `steer`, the flat solver.
///
/// `steer` answers questions in the frame of the start within `bounds`, and should do so far better than the precision
/// asked for here. Until the first command acts, the vehicle does as [`Waiting`] says.
pub fn solve<T: Terrain>(
    course: &Course<'_, T>,
    start: &Planar,
    goal: &Planar,
    bounds: &Curvatures,
    settings: &Settings,
    steer: &mut dyn FnMut(&Query) -> Option<SegmentList>,
) -> Answer {
    solve_until(course, start, goal, bounds, settings, steer, &|| false)
}

/// The same, ended early where `over` says so: it is asked before every prediction, and the best so far is the answer.
pub fn solve_until<T: Terrain>(
    course: &Course<'_, T>,
    start: &Planar,
    goal: &Planar,
    bounds: &Curvatures,
    settings: &Settings,
    steer: &mut dyn FnMut(&Query) -> Option<SegmentList>,
    over: &dyn Fn() -> bool,
) -> Answer {
    let precision = &settings.precision;
    let task = Task { course, from: start, goal, precision, bounds, aim: AIM, over };
    if course.rover.response.latency == 0.0 {
        return search(&task, settings, steer);
    }
    // Drives that begin otherwise than the flat one would are tried where those fail.
    let seen = Frame { origin: *start, direction: course.direction.start }.seen(goal);
    let first = steer(&question(start, &seen)).map_or(Waiting::GoesOn, |segments| Waiting::before(&segments));
    let other = if first == Waiting::GoesOn { Waiting::Stands } else { Waiting::GoesOn };
    let mut best: Option<Answer> = None;
    let mut predictions = 0;
    for waiting in [first, other] {
        let mut answer = match waiting.over(course, start) {
            Err(blocked) => Answer { status: Status::Blocked(blocked), ..Answer::NONE },
            Ok(from) => {
                let mut fitting = |query: &Query| steer(query).filter(|segments| Waiting::before(segments) == waiting);
                search(&Task { from: &from, ..task }, settings, &mut fitting)
            }
        };
        if !waiting.outlast(course, &mut answer.segments) {
            answer.status = Status::Unreachable;
        }
        predictions += answer.iterations;
        if best.as_ref().is_none_or(|best| answer.rank() < best.rank()) {
            best = Some(answer);
        }
        if best.as_ref().is_some_and(|best| best.status == Status::Ok) || over() {
            break;
        }
    }
    best.map_or(Answer::NONE, |best| Answer { iterations: predictions, ..best })
}

impl Answer {
    const NONE: Self =
        Self { status: Status::Unreachable, segments: SegmentList::EMPTY, prediction: None, iterations: 0 };

    /// Less is better.
    fn rank(&self) -> f64 {
        match self.status {
            Status::Ok => -1.0,
            Status::NotConverged { residual } => residual,
            Status::Blocked(_) => f64::MAX,
            Status::Unreachable => f64::INFINITY,
        }
    }
}

/// Finds commands, and where the body's way was not as smooth as foreseen looks along them again in finer steps: where a body falls
/// from one rest to another, coarse ones may find another rest than the vehicle. Then the finer ones are believed.
fn search<T: Terrain>(
    task: &Task<'_, '_, T>,
    settings: &Settings,
    steer: &mut dyn FnMut(&Query) -> Option<SegmentList>,
) -> Answer {
    let mut answer = sought(task, settings, steer);
    if answer.prediction.is_some_and(|prediction| prediction.surprise < SMOOTH) {
        return answer;
    }
    for finer in FINER {
        if answer.status != Status::Ok || (task.over)() {
            break;
        }
        answer.iterations += 1;
        let course = finer_course(task.course, finer);
        if confirmed(task, &course, &answer.segments) {
            break;
        }
        let found = sought(&Task { course: &course, ..*task }, settings, steer);
        let iterations = answer.iterations + found.iterations;
        answer = Answer { iterations, ..found };
    }
    answer
}

fn finer_course<'c, T>(course: &Course<'c, T>, share: f64) -> Course<'c, T> {
    let Steps { length, angle, least } = course.steps;
    Course { steps: Steps { length: share * length, angle: share * angle, least }, ..*course }
}

/// Whether `segments` meet the goal on `course` as well.
fn confirmed<T: Terrain>(task: &Task<'_, '_, T>, course: &Course<'_, T>, segments: &SegmentList) -> bool {
    let again = predict(course, task.from, segments, |_| {});
    again.is_ok_and(|again| miss(task.goal, &again.end, task.precision).residual <= ENOUGH)
}

fn sought<T: Terrain>(
    task: &Task<'_, '_, T>,
    settings: &Settings,
    steer: &mut dyn FnMut(&Query) -> Option<SegmentList>,
) -> Answer {
    let mut answer = Answer::NONE;
    learn_goal(task, settings, steer, &mut answer);
    if matches!(answer.status, Status::NotConverged { .. } | Status::Blocked(_)) {
        bend_commands(task, steer, &mut answer);
    }
    if answer.status == Status::Ok && settings.cost != GroundCost::Any {
        let (found, predictions) = cheaper(task, &answer.segments, settings.cost);
        answer.iterations += predictions;
        // What saves only in coarse steps is not worth its risk.
        if let Some(found) =
            found.filter(|found| confirmed(task, &finer_course(task.course, FINER[0]), &found.segments))
        {
            (answer.segments, answer.prediction) = (found.segments, Some(found.prediction));
        }
    }
    answer
}

/// Looks for the flat goal whose controls reach the true one.
fn learn_goal<T: Terrain>(
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

fn most_failures(segments: &SegmentList) -> u32 {
    MOST_FAILURES[usize::from(!refinable(segments))]
}

/// Refines the best commands so far, then gentler ones, which leave room within the bounds, then some that pass to the side, until
/// one meets the goal.
fn bend_commands<T: Terrain>(
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
