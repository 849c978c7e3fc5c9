//! Clear drives on real ground: the flat ones keep farther away until the predicted motion stays clear.
//!
//! The ground moves a drive aside by slip, lean and lag. Instead of obstacles in the prediction's own search, the flat
//! drive keeps as much more as turns out to be needed, so that the plane's closed forms stay in use and the prediction
//! decides.

use super::generate::generate;
use super::hazards::{Hazards, Intrusion, MotionCheck};
use crate::feasibility::steering::shooting::Control;
use crate::feasibility::steering::shooting::families::Problem;
use crate::feasibility::steering::shooting::query::{Curvatures, Query};
use crate::feasibility::steering::shooting::rough::{self, Answer, Course, Settings, Status, Waiting};
use crate::feasibility::steering::shooting::solve::{Choices, Method, Outcome};
use crate::trajectory::drive::{Planar, SegmentList};
use crate::world::terrain::{KeepOuts, Terrain};

/// What a drive keeps away from, and how.
///
/// Frames: places in the map, drives from `start` of the question.
#[derive(Debug, Clone, Copy)]
pub struct Around<'a> {
    /// The places, in the map.
    pub keep_outs: &'a KeepOuts,
    /// What the vehicle's middle keeps from them, m: see [`super::footprint`].
    pub radius: f64,
    /// What the flat drives are shaped by.
    pub control: Control,
    /// What may be driven.
    pub choices: Choices<'a>,
}

/// An answer, and where its motion comes too near to a place to keep out of.
///
/// Clear and arrived only where `intrusion` is `None` and the answer's status is `Ok`.
#[derive(Debug, Clone, PartialEq)]
pub struct ClearedOnGround {
    /// The drive that stays clear; where none was found, the one that comes least near.
    pub answer: Answer,
    /// How its flat form was found; `None` where there was none.
    pub method: Option<Method>,
    /// `None` if the motion stays clear.
    pub intrusion: Option<Intrusion>,
}

/// What flat drives keep in addition, in turn, m: ground and slip push motions aside by so much.
/// The least that does is taken, so that drives are no wider than they have to be.
const ADDED: [f64; 4] = [0.0, 0.05, 0.15, 0.4];

/// Commands from `start` whose motion on the ground ends at `goal` and stays clear of all places; `over` as in
/// [`rough::solve_until`].
///
/// Four attempts at most, which keep 0, 5, 15 and 40 cm more than asked for in the plane; `iterations` counts the
/// predictions of all.
///
/// Each attempt shapes a flat drive clear of what it keeps, moves its goal on the ground, and looks along the
/// predicted motion.
pub fn solve_on_ground<T: Terrain>(
    course: &Course<'_, T>,
    start: &Planar,
    goal: &Planar,
    bounds: &Curvatures,
    settings: &Settings,
    around: &Around<'_>,
    over: &dyn Fn() -> bool,
) -> ClearedOnGround {
    let mut best: Option<ClearedOnGround> = None;
    let mut predictions = 0;
    for added in ADDED {
        if best.is_some() && over() {
            break;
        }
        let tried = attempt(course, start, goal, bounds, settings, around, added, over);
        predictions += tried.answer.iterations;
        let clear = tried.answer.status == Status::Ok && tried.intrusion.is_none();
        if best.as_ref().is_none_or(|best| tried.rank() < best.rank()) {
            best = Some(tried);
        }
        if clear {
            break;
        }
    }
    let mut best = best.unwrap_or_else(|| attempt(course, start, goal, bounds, settings, around, 0.0, over));
    best.answer.iterations = predictions;
    best
}

impl ClearedOnGround {
    /// First those that arrive and are clear, then those that arrive.
    ///
    /// Lexicographic, less is better: whether it fails to arrive, then how deep it comes into a place, m.
    fn rank(&self) -> (bool, f64) {
        (self.answer.status != Status::Ok, self.intrusion.map_or(0.0, |intrusion| intrusion.depth))
    }
}

/// One attempt that keeps `added` (m) more in the plane. With `added` 0 a flat drive that is too near is still taken,
/// since the ground may move it clear and something must be told; with more it counts as none. Without an answer the
/// intrusion told is that of the flat drive.
#[expect(clippy::too_many_arguments, reason = "one question, and how it is answered")]
fn attempt<T: Terrain>(
    course: &Course<'_, T>,
    start: &Planar,
    goal: &Planar,
    bounds: &Curvatures,
    settings: &Settings,
    around: &Around<'_>,
    added: f64,
    over: &dyn Fn() -> bool,
) -> ClearedOnGround {
    let Around { keep_outs, radius, control, choices } = *around;
    let (mut method, mut too_near) = (None, None);
    // Late commands find the vehicle farther on.
    let acting = Waiting::GoesOn.over(course, start).unwrap_or(*start);
    let hazards = Hazards { keep_outs, start: acting, direction: course.direction.start, radius: radius + added };
    let mut steer = |query: &Query| -> Option<SegmentList> {
        let query = Query::new(query.start_curvature, query.goal, bounds).ok().filter(|_| !over())?;
        let problem = Problem { query, speed: course.speed, swing: course.direction.swing(), free_end: false };
        let (flat, intrusion) = generate(&problem, control, bounds, &choices, &hazards, over, |_| {});
        method = Some(flat.solution.method);
        too_near = intrusion;
        let usable = flat.solution.outcome == Outcome::Solved && (intrusion.is_none() || added == 0.0);
        usable.then_some(flat.solution.segments)
    };
    let answer = rough::solve_until(course, start, goal, bounds, settings, &mut steer, over);
    let intrusion = motion(course, start, &answer.segments, keep_outs, radius).or(match answer.status {
        Status::Ok => None,
        // Where nothing arrives, what was in the way of the flat drives is why.
        _ => too_near,
    });
    ClearedOnGround { answer, method, intrusion }
}

/// Where the predicted motion of `segments` comes too near to `keep_outs`, at its worst; what cannot be predicted does
/// not.
///
/// The wait before late commands act is looked along as well. `radius` in m.
///
/// Cost: one prediction and a query of the places for each of its steps. An empty list of places finds nothing.
pub fn motion<T: Terrain>(
    course: &Course<'_, T>,
    start: &Planar,
    segments: &SegmentList,
    keep_outs: &KeepOuts,
    radius: f64,
) -> Option<Intrusion> {
    let waiting = Waiting::before(segments);
    let acting = waiting.over(course, start).ok()?;
    let mut check = MotionCheck::new(keep_outs, radius);
    check.see(start);
    check.see(&acting);
    // What is commanded at the last does not act before the drive is over.
    let driven = waiting.acting(course, segments);
    let predicted = rough::predict(course, &acting, &driven, |step| check.see(&step.at));
    if let Ok(predicted) = predicted {
        check.see(&predicted.end);
    }
    check.worst()
}
