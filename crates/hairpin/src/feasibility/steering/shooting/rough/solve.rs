//! Finds the commands whose motion on the ground ends at the goal.
//!
//! Let S(g) be the flat solver's controls for the goal g and E(c) the predicted end of controls c. Sought is g with
//! E(S(g)) = goal: four equations in (x, y, ψ, κ). On level ground g is the goal; slopes, slip and lag move the end by
//! a fraction of the way, so the Jacobian starts as the identity and learns by Broyden's update (Broyden 1965), one
//! prediction an iteration and none for derivatives. Bounds, reversals and turns in place are kept by the flat solver
//! at every iteration.
//!
//! S jumps: from an arc to a chain of clothoids, from a drive to one with a loop. A goal at a jump is met by no g;
//! there the best commands so far are bent on by themselves, with the bounds.
//!
//! Order of attempts: the goal is learned (`learn_goal`); where that ends short of it, commands are bent on by
//! themselves (`bend_on`); once it is met, they are made cheaper (`cheaper`) where a cost is asked for; where the
//! body's rest jumped on the way, all of it is checked, and if need be done again, in finer steps.

use super::answer::{Answer, ENOUGH, Settings, Status};
use super::bend_on::bend_commands;
use super::cheaper::cheaper;
use super::cost::GroundCost;
use super::course::{Course, Steps};
use super::frame::{Frame, question};
use super::learn_goal::learn_goal;
use super::miss::miss;
use super::predict::predict;
use super::refine::Task;
use super::wait::Waiting;
use crate::feasibility::steering::shooting::{Curvatures, Query};
use crate::trajectory::drive::{Planar, SegmentList};
use crate::world::terrain::Terrain;

/// Share of the precision that is aimed at; the rest is left to the prediction's own error.
const AIM: f64 = 0.2;
/// Steps in which commands are looked along again, as shares of the first ones', in turn.
const FINER: [f64; 2] = [0.3, 0.1];
/// What a prediction may be surprised by, rad, without being looked along again: a fifth of that is common on ground
/// that is rough but not broken.
const SMOOTH: f64 = 0.03;

/// Commands from `start` whose motion on the ground ends at `goal`, shaped by `steer`, the flat solver.
///
/// `steer` answers questions in the frame of the start within `bounds`, and should do so far better than the precision
/// asked for here. Until the first command acts, the vehicle does as [`Waiting`] says.
///
/// With a latency both ways of waiting are tried, the one first that the flat drive begins with, and the commands go on
/// by as much at the end. `iterations` sums all predictions of both. Status `Unreachable`: no flat drive, or no room in
/// the list for what is commanded last.
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

/// Finds commands, and where the body's way was not as smooth as foreseen looks along them again in finer steps: where
/// a body falls from one rest to another, coarse ones may find another rest than the vehicle. Then the finer ones are
/// believed.
///
/// At most two rounds, at 0.3 and 0.1 of the steps; an answer that a finer look confirms within 0.8 of the precision is
/// kept.
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

/// Fewest steps a segment stay as they are.
fn finer_course<'c, T>(course: &Course<'c, T>, share: f64) -> Course<'c, T> {
    let Steps { length, angle, least } = course.steps;
    Course { steps: Steps { length: share * length, angle: share * angle, least }, ..*course }
}

/// Whether `segments` meet the goal on `course` as well.
fn confirmed<T: Terrain>(task: &Task<'_, '_, T>, course: &Course<'_, T>, segments: &SegmentList) -> bool {
    let again = predict(course, task.from, segments, |_| {});
    again.is_ok_and(|again| miss(task.goal, &again.end, task.precision).residual <= ENOUGH)
}

/// Learned goal, then bent commands where no goal met it, then cheaper commands where a cost is asked for. Cheaper ones
/// are taken only if a finer prediction confirms them.
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
