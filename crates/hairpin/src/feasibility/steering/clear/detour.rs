//! Detours: drives in several legs, over poses beside what is in the way.
//!
//! A best-first search over poses: key = metres driven + straight rest to the goal, which no way around can beat. Poses
//! are added as places turn out to be in the way, at most [`PLACES`] of them, each left and right and in both headings.
//!
//! The bound is admissible, for metres driven are never fewer than the straight way: a pose from which no detour can be
//! shorter than the best one so far is not looked from. What is found is not the shortest of all detours. Curvature is
//! 0 at every pose on the way. Everything is in the frame of the question's start, x along the first direction of
//! travel, m and rad.

use super::hazards::Hazards;
use super::ways::{Way, every, shortest};
use crate::feasibility::steering::shooting::query::{Curvatures, Goal, Query};
use crate::feasibility::steering::shooting::solve::Choices;
use crate::trajectory::drive::{Segment, SegmentList};
use crate::world::terrain::KeepOutShape;

/// Legs that are looked for, at most.
/// Each is one question to the closed forms, so that a detour ends within milliseconds.
const LEGS: u32 = 1500;
/// Places whose sides are tried, at most.
const PLACES: usize = 24;
/// Poses around a circle, each in both directions.
const AROUND: u32 = 8;
/// How far from what must be kept the poses are: as little as is sure, and enough to bend in; m, and shares of the
/// tightest radius.
const RINGS: [(f64, f64); 2] = [(0.02, 0.0), (0.02, 0.6)];

/// A state under way, and the drive to it.
///
/// Goals are in the frame of the question's start; `driven` in m.
///
/// One for each pose at most, the shortest way there; a later and shorter one takes its place and is open again.
#[derive(Debug, Clone, Copy)]
struct Reached {
    /// Pose and curvature in the frame of the start.
    at: Goal,
    /// Clear all along, from the start to here.
    segments: SegmentList,
    driven: f64,
    /// Which pose it is, to come there once by the shortest way; the start is none.
    via: Option<usize>,
    /// Whether what follows from it is still to be looked for.
    open: bool,
}

/// Poses beside what was found in the way.
///
/// Poses are (x, y, heading) in the frame of the start; each place gives poses once.
struct Beside {
    /// Indices into the list of places, in the order that they were met.
    places: Vec<usize>,
    poses: Vec<[f64; 3]>,
}

/// A clear drive over poses beside what is in the way, `first` of all, and the legs that were looked for: best first by
/// what is driven and the straight rest.
///
/// `None` where no detour is clear within [`LEGS`] legs.
///
/// `first` is an index into the list of places, that of the deepest intrusion so far. `stop` is asked before each
/// leg.
///
/// Cost: at most 1500 legs, each by the shortest closed form and looked along from the very start; places whose own
/// poses are all too near others add nothing. A detour of more segments than a list holds is passed over.
pub(super) fn detour(
    query: &Query,
    bounds: &Curvatures,
    choices: &Choices,
    hazards: &Hazards<'_>,
    first: usize,
    stop: &mut dyn FnMut() -> bool,
) -> (Option<Way>, u32) {
    let goal = query.goal;
    let mut beside = Beside { places: Vec::new(), poses: Vec::new() };
    beside.add(first, hazards, bounds);
    let start = Goal { x: 0.0, y: 0.0, yaw: 0.0, curvature: query.start_curvature };
    let mut reached = vec![Reached { at: start, segments: SegmentList::EMPTY, driven: 0.0, via: None, open: true }];
    let rest = |at: &Goal| libm::hypot(goal.x - at.x, goal.y - at.y);
    let mut legs = 0;
    let mut best: Option<Way> = None;
    loop {
        let open = (0..reached.len()).filter(|&i| reached[i].open);
        let bound = |i: &usize| reached[*i].driven + rest(&reached[*i].at);
        let next = open.min_by(|a, b| bound(a).total_cmp(&bound(b)));
        let Some(here) = next.filter(|i| best.is_none_or(|best| bound(i) < best.length) && legs < LEGS && !stop())
        else {
            return (best, legs);
        };
        reached[here].open = false;
        let from = reached[here];
        // To the goal by any way.
        legs += 1;
        if from.via.is_some() {
            for way in every(&seen(&from.at, &goal), bounds, choices) {
                let Some(segments) = joined(&from.segments, &way.segments) else { continue };
                let length = from.driven + way.length;
                if best.is_some_and(|best| best.length <= length) {
                    break;
                }
                match hazards.worst(&segments, 0.0) {
                    None => {
                        best = Some(Way { segments, length, method: way.method });
                        break;
                    }
                    Some(intrusion) => beside.add(intrusion.place, hazards, bounds),
                }
            }
        }
        for via in 0..beside.poses.len() {
            if legs >= LEGS || stop() {
                break;
            }
            let [x, y, yaw] = beside.poses[via];
            let to = Goal { x, y, yaw, curvature: 0.0 };
            let so_far = reached.iter().find(|reached| reached.via == Some(via)).map(|reached| reached.driven);
            let least = from.driven + libm::hypot(x - from.at.x, y - from.at.y);
            if so_far.is_some_and(|driven| driven <= least) || best.is_some_and(|best| best.length <= least + rest(&to))
            {
                continue;
            }
            legs += 1;
            let Some(way) = shortest(&seen(&from.at, &to), bounds, choices) else { continue };
            let driven = from.driven + way.length;
            let Some(segments) = joined(&from.segments, &way.segments) else { continue };
            if so_far.is_some_and(|so_far| so_far <= driven) {
                continue;
            }
            if let Some(intrusion) = hazards.worst(&segments, 0.0) {
                beside.add(intrusion.place, hazards, bounds);
                continue;
            }
            reached.retain(|reached| reached.via != Some(via));
            reached.push(Reached { at: to, segments, driven, via: Some(via), open: true });
        }
    }
}

/// The question from one state to another.
///
/// Curvatures do not depend on the frame; the yaw is not wrapped.
fn seen(from: &Goal, to: &Goal) -> Query {
    let (sin, cos) = libm::sincos(from.yaw);
    let (dx, dy) = (to.x - from.x, to.y - from.y);
    let goal = Goal { x: cos * dx + sin * dy, y: cos * dy - sin * dx, yaw: to.yaw - from.yaw, curvature: to.curvature };
    Query { start_curvature: from.curvature, goal }
}

/// `None` where a list has no room for both.
///
/// At most [`MOST_SEGMENTS`](crate::trajectory::drive::MOST_SEGMENTS) segments.
fn joined(first: &SegmentList, second: &[Segment]) -> Option<SegmentList> {
    let mut all = *first;
    all.append(second).is_ok().then_some(all)
}

impl Beside {
    /// Adds the poses beside the place `index` that are clear themselves.
    ///
    /// Circles get eight tangent poses in both directions at each of two distances, polygons two beside every corner,
    /// along the line between its neighbours. A corner that points inwards gets them as well: what is not clear is left
    /// out by [`Hazards::room`].
    fn add(&mut self, index: usize, hazards: &Hazards<'_>, bounds: &Curvatures) {
        if self.places.contains(&index) || self.places.len() == PLACES {
            return;
        }
        self.places.push(index);
        let mut add = |at: [f64; 2], along: f64| {
            let [x, y] = hazards.seen_from_start(at);
            let yaw = along - hazards.start.yaw - hazards.direction;
            if hazards.room(x, y) >= 0.0 {
                self.poses.extend([[x, y, yaw], [x, y, yaw + std::f64::consts::PI]]);
            }
        };
        for (metres, radii) in RINGS {
            let away = hazards.radius + metres + radii / bounds.most;
            match &hazards.keep_outs.list()[index].shape {
                KeepOutShape::Circle { center_m: [x, y], radius_m } => {
                    for i in 0..AROUND {
                        let angle = std::f64::consts::TAU * f64::from(i) / f64::from(AROUND);
                        let (sin, cos) = libm::sincos(angle);
                        let r = radius_m + away;
                        add([x + r * cos, y + r * sin], angle + std::f64::consts::FRAC_PI_2);
                    }
                }
                KeepOutShape::Polygon { points_m } => {
                    let n = points_m.len();
                    for (i, at) in points_m.iter().enumerate() {
                        // Beside a corner: along the line that joins its neighbours, to either side.
                        let (before, after) = (points_m[(i + n - 1) % n], points_m[(i + 1) % n]);
                        let along = libm::atan2(after[1] - before[1], after[0] - before[0]);
                        let (sin, cos) = libm::sincos(along);
                        for side in [away, -away] {
                            add([at[0] + side * sin, at[1] - side * cos], along);
                        }
                    }
                }
            }
        }
    }
}
