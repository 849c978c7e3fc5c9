//! A drive between two states: the source's `SolveTrajectory`. Once the handle is there nothing is taken from the heap.

use std::f64::consts::TAU;
use std::sync::Arc;

use hairpin::campaign::drive::{Site, broken, flat_claim, replay_pieces, steerable};
use hairpin::feasibility::steering::shooting::query::FARTHEST;
use hairpin::feasibility::steering::shooting::rough::{Answer, Cause, Status};
use hairpin::feasibility::steering::shooting::solve::{Choices, Method, Outcome, Solution, solve};
use hairpin::feasibility::steering::shooting::{Curvatures, Goal, Precision, Query, rough};
use hairpin::robot::rover::{Rover, Unsettled};
use hairpin::trajectory::drive::{Planar, SegmentList};
use hairpin::world::terrain::{ElevationMap, NoGround};

use crate::drive::{
    Drive, HAIRPIN_BLOCKED, HAIRPIN_BUDGET_SPENT, HAIRPIN_INFEASIBLE, HAIRPIN_NOT_CONVERGED, HAIRPIN_SOLVED, State,
};
use crate::map::MapHandle;
use crate::memory::{free, given, handle, put, result};
use crate::refusal::{Code, Error, HAIRPIN_INVALID, Refused, enter};
use crate::rover::RoverHandle;
use crate::settings::SteerSettings;

/// The flat answers that a search on a map is made of are exact to this, m, rad, 1/m.
const FLAT: Precision = Precision { position: 1e-5, yaw: 1e-5, curvature: 1e-5 };

/// A vehicle, what it drives on, and how its drives are looked for. Nothing changes it, so that any number of threads
/// may ask it at once.
pub struct SteerHandle {
    pub(crate) rover: Arc<Rover>,
    pub(crate) map: Option<Arc<ElevationMap>>,
    pub(crate) settings: SteerSettings,
    /// The vehicle's own bounds.
    bounds: Curvatures,
    /// With what steering leaves of them at the speed.
    shaping: Curvatures,
    /// Speed, m/s.
    pub(crate) speed: f64,
}

/// Makes what hairpin_steer is asked with. Vehicle and map may be given back before it.
///
/// @param rover the vehicle
/// @param map what it drives on; NULL: the plane
/// @param settings how drives are looked for; NULL: hairpin_steer_defaults
/// @param steer what was made, to be given back to hairpin_steer_free
/// @param error NULL, or where the call says why it did nothing
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hairpin_steer_new(
    rover: *const RoverHandle,
    map: *const MapHandle,
    settings: *const SteerSettings,
    steer: *mut *mut SteerHandle,
    error: *mut Error,
) -> Code {
    // SAFETY: all are NULL or what their types say, as the header has it.
    unsafe {
        enter(error, || {
            let (rover, place) = (Arc::clone(&given(rover, "rover")?.rover), result(steer, "steer")?);
            let map = if map.is_null() { None } else { Some(Arc::clone(&given(map, "map")?.map)) };
            let usual = crate::settings::hairpin_steer_defaults();
            let settings = if settings.is_null() { usual } else { *given(settings, "settings")? };
            handle(place, SteerHandle::new(rover, map, settings)?)
        })
    }
}

/// Gives it back. NULL is nothing.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hairpin_steer_free(steer: *mut SteerHandle) {
    // SAFETY: it came from hairpin_steer_new and is used no more, as the header has it.
    unsafe { free(steer) }
}

/// Looks for a drive from one state to another. Takes no memory, starts no thread, reads no clock.
///
/// What a drive lacks is an answer, in `drive`; a code other than HAIRPIN_OK is about the question. In the plane what
/// is called solved was integrated again by other equations; on a map it rests on the prediction, and hairpin_confirm
/// does so.
///
/// @param steer what is asked
/// @param start where the vehicle is, on the map or anywhere in the plane
/// @param goal where it is to be, in the same frame
/// @param drive the answer
/// @param error NULL, or where the call says why it did nothing
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hairpin_steer(
    steer: *const SteerHandle,
    start: *const State,
    goal: *const State,
    drive: *mut Drive,
    error: *mut Error,
) -> Code {
    // SAFETY: all are NULL or what their types say, as the header has it.
    unsafe {
        enter(error, || {
            let (steer, start, goal) = (given(steer, "steer")?, given(start, "start")?, given(goal, "goal")?);
            let place = result(drive, "drive")?;
            put(place, steer.answer(&start.planar(), &goal.planar())?)
        })
    }
}

/// Drives what hairpin_steer found again, by an integration of its own in finer steps, and writes what that comes to
/// into `drive`: misses, largest tilt, and the status where it is not what it was said to be. Takes memory.
///
/// @param steer what was asked
/// @param start as it was asked
/// @param goal as it was asked
/// @param drive the answer of hairpin_steer, held to what its replay comes to
/// @param error NULL, or where the call says why it did nothing
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hairpin_confirm(
    steer: *const SteerHandle,
    start: *const State,
    goal: *const State,
    drive: *mut Drive,
    error: *mut Error,
) -> Code {
    // SAFETY: all are NULL or what their types say, and `drive` holds an answer, as the header has it.
    unsafe {
        enter(error, || {
            let (steer, start, goal) = (given(steer, "steer")?, given(start, "start")?, given(goal, "goal")?);
            let found = *given(drive, "drive")?;
            let held = steer.confirm(&start.planar(), &goal.planar(), found)?;
            put(result(drive, "drive")?, held)
        })
    }
}

/// What a search on a map came to.
struct Found {
    answer: Answer,
    method: Method,
    /// Looks that were taken, where they are counted.
    looks: u64,
    /// Whether it ended because there were no more.
    spent: bool,
}

impl SteerHandle {
    fn new(rover: Arc<Rover>, map: Option<Arc<ElevationMap>>, settings: SteerSettings) -> Result<Self, Refused> {
        settings.check()?;
        let limits = &rover.limits;
        if settings.turns != 0 && !limits.turns_in_place {
            return Err(Refused::new(HAIRPIN_INVALID, format_args!("`turns`: `{}` cannot turn in place", rover.name)));
        }
        let speed = if settings.speed_m_s > 0.0 { settings.speed_m_s } else { rover.default_speed };
        if speed > limits.speed {
            let sentence = format_args!("`speed_m_s` = {speed}: must be at most {} of `{}`", limits.speed, rover.name);
            return Err(Refused::new(HAIRPIN_INVALID, sentence));
        }
        let bounds = Curvatures { most: limits.curvature, most_rate: limits.curvature_rate };
        let shaping = steerable(&bounds, &rover, speed);
        Ok(Self { rover, map, settings, bounds, shaping, speed })
    }

    fn answer(&self, start: &Planar, goal: &Planar) -> Result<Drive, Refused> {
        let query = Query { start_curvature: start.curvature, goal: seen(start, goal) };
        // A curvature beyond the bounds is a question with an answer: no.
        let sharpest = start.curvature.abs().max(goal.curvature.abs());
        let straight = Goal { curvature: 0.0, ..query.goal };
        Query::new(0.0, straight, &self.bounds).map_err(Refused::invalid)?;
        for (field, value) in [("start.x_m", start.x), ("start.y_m", start.y), ("start.yaw_rad", start.yaw)] {
            if !(value.is_finite() && value.abs() <= FARTHEST) {
                let sentence = format_args!("`{field}` = {value}: must be finite and within 1e6");
                return Err(Refused::new(HAIRPIN_INVALID, sentence));
            }
        }
        for (field, value) in [("start.curvature_1_m", start.curvature), ("goal.curvature_1_m", goal.curvature)] {
            if !value.is_finite() {
                return Err(Refused::new(HAIRPIN_INVALID, format_args!("`{field}` = {value}: must be finite")));
            }
        }
        if sharpest > self.bounds.most {
            let none = Drive::none(HAIRPIN_INFEASIBLE);
            return Ok(none.over("curvature_1_m", Some(sharpest - self.bounds.most)));
        }
        let shaping = self.shaping(start);
        Ok(match &self.map {
            _ if self.is_there(&query) => Drive::none(HAIRPIN_SOLVED).missing(&query.goal, start.curvature),
            None => self.in_the_plane(&query, &shaping),
            Some(map) => self.on_the_map(map, start, goal, &shaping),
        })
    }

    /// What drives from `start` are shaped with.
    fn shaping(&self, start: &Planar) -> Curvatures {
        Curvatures { most: self.shaping.most.max(start.curvature.abs()), ..self.shaping }
    }

    /// Whether the start lies within all tolerances of the goal: nothing is driven then.
    fn is_there(&self, query: &Query) -> bool {
        let (precision, Goal { x, y, yaw, curvature }) = (self.settings.precision(), query.goal);
        libm::hypot(x, y) <= precision.position
            && wrapped(yaw).abs() <= precision.yaw
            && (query.start_curvature - curvature).abs() <= precision.curvature
    }

    fn in_the_plane(&self, query: &Query, shaping: &Curvatures) -> Drive {
        let precision = self.settings.precision();
        let mut choices = self.settings.choices(precision);
        let replayed = |solution: &Solution| replay_pieces(&solution.segments, &flat_claim(query, 0.0));
        let mut solution = solve(query, shaping, &choices, || false);
        let mut replay = replayed(&solution);
        let mut limit = broken(&replay, &self.bounds, &precision);
        if solution.outcome == Outcome::Solved && limit.is_some() && solution.method == Method::SingleArc {
            // The solver believes what the replay does not: closed forms remain.
            choices.arcs = false;
            solution = Solution { iterations: solution.iterations, ..solve(query, shaping, &choices, || false) };
            replay = replayed(&solution);
            limit = broken(&replay, &self.bounds, &precision);
        }
        let spent = self.settings.most_steps != 0 && solution.iterations >= self.settings.most_steps;
        let status = match (solution.outcome, limit) {
            (Outcome::Solved, None) => HAIRPIN_SOLVED,
            _ if spent => HAIRPIN_BUDGET_SPENT,
            _ => HAIRPIN_NOT_CONVERGED,
        };
        let [x, y, yaw] = replay.error;
        let drive = Drive {
            iterations: solution.iterations,
            miss_m: libm::hypot(x, y),
            miss_yaw_rad: yaw.abs(),
            miss_curvature_1_m: replay.error_curvature.abs(),
            ..Drive::none(status).along(&solution.segments, solution.method)
        };
        limit.map_or(drive, |(limit, excess)| drive.over(limit, excess))
    }

    fn on_the_map(&self, map: &ElevationMap, start: &Planar, goal: &Planar, shaping: &Curvatures) -> Drive {
        let choices = self.settings.choices(FLAT);
        let mut left = match self.settings.most_looks {
            0 => None,
            looks => Some(looks),
        };
        let mut found = self.search(map, [start, goal], shaping, &choices, &mut left);
        let mut again = |found: &mut Found, shaping: &Curvatures, choices: &Choices<'_>| {
            if matches!(found.answer.status, Status::NotConverged { .. }) && !found.spent {
                let second = self.search(map, [start, goal], shaping, choices, &mut left);
                let iterations = found.answer.iterations + second.answer.iterations;
                (found.answer.iterations, found.looks, found.spent) =
                    (iterations, found.looks + second.looks, second.spent);
                if second.answer.status == Status::Ok {
                    let answer = Answer { iterations, ..second.answer };
                    *found = Found { answer, method: second.method, ..*found };
                }
            }
        };
        // Closed forms change steadily with their goal where arcs do not.
        let closed = Choices { arcs: false, ..choices };
        again(&mut found, shaping, &closed);
        let sharpest = start.curvature.abs().max(goal.curvature.abs());
        if self.shaping != self.bounds && self.shaping.most >= sharpest {
            // What steering can follow at every curvature is more than enough: without it the limits themselves decide.
            again(&mut found, &self.bounds, &choices);
            again(&mut found, &self.bounds, &closed);
        }
        self.told(&found, goal)
    }

    /// Commands whose predicted motion ends at the goal, with the looks that are `left`, where they are counted.
    fn search(
        &self,
        map: &ElevationMap,
        [start, goal]: [&Planar; 2],
        shaping: &Curvatures,
        choices: &Choices<'_>,
        left: &mut Option<u64>,
    ) -> Found {
        let site = Site { speed: self.speed.into(), ..Site::straight(&self.rover, map) };
        let mut method = Method::SingleArc;
        let mut steer = |query: &Query| -> Option<SegmentList> {
            let query = Query::new(query.start_curvature, query.goal, shaping).ok()?;
            let flat = solve(&query, shaping, choices, || false);
            method = flat.method;
            (flat.outcome == Outcome::Solved).then_some(flat.segments)
        };
        let ground = self.settings.ground();
        let Some(looks) = *left else {
            let answer = site.solve(start, goal, shaping, &ground, &mut steer);
            return Found { answer, method, looks: 0, spent: false };
        };
        let (answer, still) = site.solve_within(start, goal, shaping, &ground, &mut steer, looks);
        *left = Some(still);
        Found { answer, method, looks: looks - still, spent: still == 0 }
    }

    fn told(&self, found: &Found, goal: &Planar) -> Drive {
        let Answer { status, segments, prediction, iterations } = &found.answer;
        let mut drive = Drive {
            iterations: *iterations,
            looks: found.looks,
            ..Drive::none(HAIRPIN_NOT_CONVERGED).along(segments, found.method)
        };
        if let Some(rough::Prediction { end, tilt: (tilt, _), .. }) = prediction {
            drive = Drive { tilt_rad: *tilt, ..drive.missing(&seen(end, goal), end.curvature) };
        }
        let over = drive.tilt_rad - self.rover.limits.tilt;
        match status {
            _ if found.spent => Drive { status: HAIRPIN_BUDGET_SPENT, ..drive },
            Status::Ok if over > 0.0 => Drive { status: HAIRPIN_INFEASIBLE, ..drive }.over("tilt_rad", Some(over)),
            Status::Ok => Drive { status: HAIRPIN_SOLVED, ..drive },
            Status::Blocked(blocked) => Drive { status: HAIRPIN_BLOCKED, stopped_after_m: blocked.after_m, ..drive }
                .over(why(&blocked.cause), None),
            Status::Unreachable | Status::NotConverged { .. } => drive,
        }
    }

    fn confirm(&self, start: &Planar, goal: &Planar, found: Drive) -> Result<Drive, Refused> {
        let segments = found.list()?;
        let precision = self.settings.precision();
        let query = Query { start_curvature: start.curvature, goal: seen(start, goal) };
        let flat = replay_pieces(&segments, &flat_claim(&query, 0.0));
        let Some(map) = &self.map else {
            return Ok(found.held_to(flat.error, flat.error_curvature, broken(&flat, &self.bounds, &precision)));
        };
        let site = Site { speed: self.speed.into(), ..Site::straight(&self.rover, map) };
        let ground = match site.replay(start, goal, &segments) {
            Ok(ground) => ground,
            Err(stop) => {
                let limit = stop.no_ground.as_ref().map_or("rest", no_ground);
                let stopped = Drive { status: HAIRPIN_BLOCKED, stopped_after_m: stop.after_m, ..found };
                return Ok(stopped.over(limit, None));
            }
        };
        // Curvatures as they were commanded, errors as the ground has them.
        let mut told = flat;
        (told.error, told.error_curvature) = (ground.error, ground.error_curvature);
        let tilt = ground.max_tilt - self.rover.limits.tilt;
        let limit = broken(&told, &self.bounds, &precision).or((tilt > 0.0).then_some(("tilt_rad", Some(tilt))));
        Ok(Drive { tilt_rad: ground.max_tilt, ..found }.held_to(told.error, told.error_curvature, limit))
    }
}

impl Drive {
    /// With what is missing to `goal`, as the end sees it, where the curvature is `curvature`.
    fn missing(self, goal: &Goal, curvature: f64) -> Self {
        Self {
            miss_m: libm::hypot(goal.x, goal.y),
            miss_yaw_rad: wrapped(goal.yaw).abs(),
            miss_curvature_1_m: (goal.curvature - curvature).abs(),
            ..self
        }
    }

    /// With what a replay comes to: solved no more where that breaks a limit.
    fn held_to(self, error: [f64; 3], bend: f64, limit: Option<(&'static str, Option<f64>)>) -> Self {
        let [x, y, yaw] = error;
        let told = Self { miss_m: libm::hypot(x, y), miss_yaw_rad: yaw.abs(), miss_curvature_1_m: bend.abs(), ..self };
        match limit {
            None => told,
            Some(("tilt_rad", excess)) => Self { status: HAIRPIN_INFEASIBLE, ..told }.over("tilt_rad", excess),
            Some((limit, excess)) => Self { status: HAIRPIN_NOT_CONVERGED, ..told }.over(limit, excess),
        }
    }
}

/// `goal` in the frame of `start`.
fn seen(start: &Planar, goal: &Planar) -> Goal {
    let (sin, cos) = libm::sincos(start.yaw);
    let (x, y) = (goal.x - start.x, goal.y - start.y);
    Goal { x: cos * x + sin * y, y: cos * y - sin * x, yaw: goal.yaw - start.yaw, curvature: goal.curvature }
}

/// What stops a drive.
fn why(cause: &Cause) -> &'static str {
    match cause {
        Cause::Unsettled(Unsettled::NoGround(place)) => no_ground(place),
        Cause::Unsettled(_) => "rest",
        Cause::Overturned => "tilt_rad",
    }
}

fn no_ground(place: &NoGround) -> &'static str {
    match place {
        NoGround::OffMap { .. } => "map_edge",
        NoGround::Hole { .. } => "no_data",
    }
}

/// `angle` in [−π, π].
fn wrapped(angle: f64) -> f64 {
    angle - TAU * (angle / TAU).round()
}
