//! Questions on an elevation map: the same answer, found and replayed with the body on its wheels.

use std::path::Path;
use std::time::Instant;

use hairpin::campaign::drive::{Site, broken};
use hairpin::feasibility::steering::clear::{Around, Intrusion, footprint};
use hairpin::feasibility::steering::shooting::families::Problem as Boundary;
use hairpin::feasibility::steering::shooting::flat;
use hairpin::feasibility::steering::shooting::query::{Goal, Precision, Query};
use hairpin::feasibility::steering::shooting::rough::{Answer, Cause, Settings, Status as Found};
use hairpin::feasibility::steering::shooting::solve::{Choices, Outcome, Solution};
use hairpin::feasibility::steering::shooting::{Control, generate};
use hairpin::robot::rover::{Rover, Unsettled};
use hairpin::trajectory::drive::{Planar, SegmentList};
use hairpin::verification::{DriveReplay, GroundReplay, replay_drive};
use hairpin::world::terrain::{ElevationMap, NoGround};
use hairpin_formats::steering::{Asked, Status};
use hairpin_formats::terrain::{Georeference, MapFile};

use super::answered::{Answered, Near, claim, pieces};
use super::level::{Uneven, uneven};
use super::pace::{direction, start};
use super::plane::{STANDING, Task};
use super::trace::trace_step;
use crate::terrain::read_map;
use crate::{Problem, Watch};

/// The flat answers that a search on the ground is made of are exact to this, m, rad, 1/m.
const FLAT: f64 = 1e-5;

/// The map in the file at `path`, with a warning where its cells say little of what the wheels meet.
pub(super) fn map(
    path: &Path,
    georeference: &Georeference,
    rover: &Rover,
    watch: &dyn Watch,
) -> Result<MapFile, Problem> {
    let file = read_map(path, georeference)?;
    let cell = file.map.grid().cell[0].max(file.map.grid().cell[1]);
    if rover.suspension.wheelbase().is_some_and(|base| cell > 0.5 * base) {
        watch.warn(&format!(
            "Warning: {}: cells of {cell} m are coarser than half the wheel base: attitudes are optimistic",
            path.display()
        ));
    }
    Ok(file)
}

/// Answers `asked` on `map`; what solving took, and may take, counts from `begun` on.
pub(super) fn answer(task: &Task<'_>, map: &ElevationMap, asked: &Asked, begun: Instant) -> Answered {
    let (solver, bounds) = (task.solver, task.bounds);
    let site = Site { rover: task.rover, map, speed: task.boundary.speed, direction: direction(asked) };
    let start = start(asked);
    let (goal, towards) = (goal(asked, &start), goal(task.towards, &start));
    let over = || solver.time_limit.is_some_and(|limit| begun.elapsed() >= limit);
    let mut found = match task.there {
        true => standing(task, asked),
        false => search(task, &site, &start, &towards, solver.choices, &over),
    };
    if matches!(found.status, Found::NotConverged { .. }) && task.control == Control::Quintic && !over() {
        // Closed forms change steadily with their goal where arcs do not.
        let choices = Choices { arcs: false, ..solver.choices };
        let second = search(task, &site, &start, &towards, choices, &over);
        if second.status == Found::Ok {
            let iterations = found.solution.iterations + second.solution.iterations;
            found = Searched { solution: Solution { iterations, ..second.solution }, ..second };
        }
    }
    let solving = begun.elapsed();
    let Searched { status, solution, intrusion } = found;
    let ran_out = over() && status != Found::Ok;
    let near = intrusion
        .filter(|_| !ran_out)
        .map(|intrusion| Near::new(&intrusion, task.keep_outs, task.control, task.boundary));
    let flat = replay_drive(&pieces(&solution), &claim(asked, &solution.segments, false));
    let replay = site.replay(&start, &goal, &solution.segments);
    let answered = |status, limit, drive: Option<(Solution, DriveReplay)>| Answered {
        drive: drive.filter(|_| task.there || !solution.segments.is_empty()),
        ..Answered::new(status, limit, bounds, solving)
    };
    let too_near = |near: Near, drive| Answered {
        near: Some(near.clone()),
        ..answered(Status::Infeasible, Some(near.limit()), drive)
    };
    let stopped = |limit, no_ground: Option<&NoGround>, after_m| Answered {
        stopped: (!solution.segments.is_empty()).then(|| Box::new((solution, after_m))),
        no_ground: no_ground.copied(),
        ..answered(Status::Infeasible, Some(limit), None)
    };
    let ground = match (&status, &replay) {
        (Found::Blocked(blocked), _) if !ran_out => {
            let after_m = replay.as_ref().map_or_else(|stop| stop.after_m, |_| blocked.after_m);
            let (limit, place) = stopped_by(map, &goal, &blocked.cause);
            return stopped(limit, place, after_m);
        }
        (_, Err(stop)) if !ran_out => {
            let place = stop.no_ground.as_ref();
            let limit = place.map_or(("rest", None), |place| no_ground(map, &goal, place));
            return near.map_or_else(|| stopped(limit, place, stop.after_m), |near| too_near(near, None));
        }
        (_, Err(_)) => return answered(Status::TimeLimit, None, None),
        (_, Ok(ground)) => ground,
    };
    let replay = on_the_ground(&flat, ground, &start);
    let along = if task.glides { None } else { uneven(&site, &start, &goal, &solution.segments) };
    if let (false, None, Some(Uneven::NoGround { place, after_m })) = (ran_out, &near, &along) {
        return stopped(no_ground(map, &goal, place), Some(place), *after_m);
    }
    let drive = Some((solution, replay));
    let over = task.rover.limits.broken_at_rest(ground.max_tilt, ground.max_joint);
    if let Some(near) = near {
        return too_near(near, drive);
    }
    match (status, broken(&replay, &bounds, &task.precision)) {
        _ if ran_out => answered(Status::TimeLimit, None, drive),
        (Found::Ok, None) if over.is_some() => {
            answered(Status::Infeasible, over.map(|(limit, over)| (limit, Some(over))), drive)
        }
        (Found::Ok, None) if along.is_some() => {
            let over = along.and_then(|along| along.steeper_by());
            answered(Status::Infeasible, Some(("slope_rad", over)), drive)
        }
        (Found::Ok, None) => Answered {
            cost: site.cost(&start, &solution.segments, solver.ground.cost),
            ..answered(Status::Ok, None, drive)
        },
        (_, limit) => answered(Status::NotConverged, limit, drive),
    }
}

/// What a search came to.
struct Searched {
    status: Found,
    solution: Solution,
    /// Where the motion comes too near to a place to keep out of.
    intrusion: Option<Intrusion>,
}

/// What a start that is there already needs no search for.
fn standing(task: &Task<'_>, asked: &Asked) -> Searched {
    let solution = STANDING.solution;
    Searched { status: Found::Ok, solution, intrusion: task.hazards(asked).intrusion(&solution.segments) }
}

fn search(
    task: &Task<'_>,
    site: &Site<'_>,
    start: &Planar,
    goal: &Planar,
    choices: Choices<'_>,
    over: &dyn Fn() -> bool,
) -> Searched {
    let Task { boundary, control, shaping, .. } = *task;
    let precision = Precision { position: FLAT, yaw: FLAT, curvature: FLAT };
    let choices = Choices { flat: flat::Settings { precision, ..choices.flat }, ..choices };
    let settings = Settings { precision: task.aim, ..task.solver.ground };
    let plainly = || generate(boundary, control, &shaping, &choices, over, trace_step).solution;
    if !task.keep_outs.is_empty() {
        let around = Around { keep_outs: task.keep_outs, radius: footprint(task.rover), control, choices };
        let cleared = site.solve_clear(start, goal, &shaping, &settings, &around, over);
        let (flat, Answer { status, segments, iterations, .. }) = (plainly(), cleared.answer);
        let method = cleared.method.unwrap_or(flat.method);
        let drive = if segments.is_empty() { flat } else { Solution { segments, iterations, method, ..flat } };
        return Searched { status, solution: drive, intrusion: cleared.intrusion };
    }
    let (mut first, mut method) = (None, None);
    let mut steer = |query: &Query| -> Option<SegmentList> {
        let query = Query::new(query.start_curvature, query.goal, &shaping).ok().filter(|_| !over())?;
        let boundary = Boundary { query, free_end: false, ..*boundary };
        let flat = generate(&boundary, control, &shaping, &choices, over, trace_step).solution;
        let Goal { x, y, yaw, curvature } = query.goal;
        tracing::debug!("flat goal {x:.4} {y:.4} {yaw:.4} {curvature:.4}: {:?}, {:?}", flat.outcome, flat.method);
        first.get_or_insert(flat);
        method = Some(flat.method);
        (flat.outcome == Outcome::Solved).then_some(flat.segments)
    };
    let answer = site.solve_until(start, goal, &shaping, &settings, &mut steer, over);
    // Without any time there is still the flat start value.
    let flat = first.unwrap_or_else(plainly);
    let Answer { status, segments, iterations, .. } = answer;
    let method = method.unwrap_or(flat.method);
    let solution = if segments.is_empty() { flat } else { Solution { segments, iterations, method, ..flat } };
    Searched { status, solution, intrusion: None }
}

fn goal(asked: &Asked, start: &Planar) -> Planar {
    let (sin, cos) = libm::sincos(start.yaw);
    let [x, y, yaw] = asked.goal;
    Planar { x: start.x + cos * x - sin * y, y: start.y + sin * x + cos * y, yaw: start.yaw + yaw, curvature: asked.kf }
}

/// Curvatures as they were commanded, errors as the ground has them, in the frame of the start.
fn on_the_ground(flat: &DriveReplay, ground: &GroundReplay, start: &Planar) -> DriveReplay {
    let (sin, cos) = libm::sincos(start.yaw);
    let [x, y, yaw] = ground.error;
    DriveReplay {
        error: [cos * x + sin * y, cos * y - sin * x, yaw],
        error_curvature: ground.error_curvature,
        steps: ground.steps,
        left_out: ground.left_out,
        ..*flat
    }
}

/// A limit, and by how much it is exceeded where that is a length.
type Limit = (&'static str, Option<f64>);

/// What stops a drive, and the place where that is for want of ground.
fn stopped_by<'a>(map: &ElevationMap, goal: &Planar, cause: &'a Cause) -> (Limit, Option<&'a NoGround>) {
    match cause {
        Cause::Unsettled(Unsettled::NoGround(place)) => (no_ground(map, goal, place), Some(place)),
        Cause::Unsettled(_) => (("rest", None), None),
        Cause::Overturned => (("tilt_rad", None), None),
    }
}

/// A place without ground; beyond the map's edge lies the goal by so many metres, or else that place.
fn no_ground(map: &ElevationMap, goal: &Planar, place: &NoGround) -> Limit {
    let (low, high) = map.extent();
    let beyond = |at: [f64; 2]| {
        let over = [0, 1].map(|i| (low[i] - at[i]).max(at[i] - high[i]).max(0.0));
        libm::hypot(over[0], over[1])
    };
    match place {
        NoGround::OffMap { x, y } => {
            let goal = beyond([goal.x, goal.y]);
            ("map_edge", Some(if goal > 0.0 { goal } else { beyond([*x, *y]) }))
        }
        NoGround::Hole { .. } => ("no_data", None),
    }
}
