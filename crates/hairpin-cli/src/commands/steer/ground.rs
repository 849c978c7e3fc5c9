//! Questions on an elevation map: the same answer, found and replayed with the body on its wheels.

use std::time::{Duration, Instant};

use hairpin::campaign::drive::Site;
use hairpin::feasibility::steering::shooting::families::Problem as Boundary;
use hairpin::feasibility::steering::shooting::flat;
use hairpin::feasibility::steering::shooting::query::{Curvatures, Goal, Precision, Query};
use hairpin::feasibility::steering::shooting::rough::{Blocked, Cause, Settings, Status as Found};
use hairpin::feasibility::steering::shooting::solve::{Choices, Outcome, Solution};
use hairpin::feasibility::steering::shooting::{Control, generate};
use hairpin::robot::rover::{Rover, Unsettled};
use hairpin::trajectory::drive::{Planar, SegmentList};
use hairpin::verification::{DriveReplay, GroundReplay, Stopped, replay_drive};
use hairpin::world::terrain::{ElevationMap, HoleRule, NoGround};
use hairpin_formats::steering::{Asked, Status};

use super::answered::{Answered, broken, claim, pieces};
use super::pace::{direction, start};
use super::vehicle::told;
use crate::args::{NoData, Steer};
use crate::commands::terrain;
use crate::console;
use crate::problem::Problem;

/// The flat answers that a search on the ground is made of are exact to this, m, rad, 1/m.
const FLAT: f64 = 1e-5;

/// The map of `--terrain`, if one is given, with a warning where its cells say little of what the wheels meet.
pub(super) fn map(steer: &Steer, rover: &Rover) -> Result<Option<ElevationMap>, Problem> {
    let Some(path) = &steer.terrain else { return Ok(None) };
    let holes = match steer.no_data {
        NoData::Error => HoleRule::Error,
        NoData::KeepOut => HoleRule::KeepOut,
        NoData::Fill => HoleRule::Fill,
    };
    let map = terrain::read(path, &steer.map, holes)?;
    let cell = map.grid().cell[0].max(map.grid().cell[1]);
    if rover.suspension.wheelbase().is_some_and(|base| cell > 0.5 * base) {
        console::warn(&format!(
            "Warning: {}: cells of {cell} m are coarser than half the wheel base: attitudes are optimistic",
            path.display()
        ));
    }
    Ok(Some(map))
}

/// What one question on the ground is asked with.
pub(super) struct Ground<'a> {
    pub(super) rover: &'a Rover,
    pub(super) map: &'a ElevationMap,
    pub(super) choices: Choices,
    pub(super) control: Control,
    /// The question in the plane.
    pub(super) boundary: &'a Boundary,
    pub(super) bounds: Curvatures,
    /// The bounds that drives are shaped with.
    pub(super) shaping: Curvatures,
    pub(super) precision: Precision,
    pub(super) time_limit: Option<Duration>,
}

impl Ground<'_> {
    /// Answers `asked`.
    pub(super) fn answer(&self, asked: &Asked) -> Answered {
        let speed = self.boundary.speed;
        let site = Site { rover: self.rover, map: self.map, speed, direction: direction(asked) };
        let start = start(asked);
        let goal = goal(asked, &start);
        let begun = Instant::now();
        let over = || self.time_limit.is_some_and(|limit| begun.elapsed() >= limit);
        let (mut found, mut solution) = self.search(&site, &start, &goal, self.choices, &over);
        if matches!(found, Found::NotConverged { .. }) && self.control == Control::Quintic && !over() {
            // Closed forms change steadily with their goal where arcs do not.
            let choices = Choices { arcs: false, ..self.choices };
            let (again, second) = self.search(&site, &start, &goal, choices, &over);
            if again == Found::Ok {
                (found, solution) = (again, Solution { iterations: solution.iterations + second.iterations, ..second });
            }
        }
        let solving = begun.elapsed();
        let ran_out = over() && found != Found::Ok;
        let flat = replay_drive(&pieces(&solution), &claim(asked, &solution.segments, false));
        let replay = site.replay(&start, &goal, &solution.segments);
        let answered = |status, limit, drive: Option<(Solution, DriveReplay)>| Answered {
            status,
            drive: drive.filter(|_| !solution.segments.is_empty()),
            solving,
            limit,
            bounds: self.bounds,
            nearest: None,
            profile: None,
            parameters: None,
        };
        let ground = match (&found, &replay) {
            (Found::Blocked(blocked), _) if !ran_out => {
                return answered(Status::Infeasible, Some((way(blocked), None)), None);
            }
            (_, Err(stopped)) if !ran_out => {
                return answered(Status::Infeasible, Some((stands_in_the_way(stopped), None)), None);
            }
            (_, Err(_)) => return answered(Status::TimeLimit, None, None),
            (_, Ok(ground)) => ground,
        };
        let replay = on_the_ground(&flat, ground, &start);
        let drive = Some((solution, replay));
        let over_tilt = ground.max_tilt - self.rover.limits.tilt;
        match (found, broken(&replay, &self.bounds, &self.precision)) {
            _ if ran_out => answered(Status::TimeLimit, None, drive),
            (Found::Ok, None) if over_tilt > 0.0 => {
                answered(Status::Infeasible, Some(("tilt_rad", Some(over_tilt))), drive)
            }
            (Found::Ok, None) => answered(Status::Ok, None, drive),
            (_, limit) => answered(Status::NotConverged, limit, drive),
        }
    }

    fn search(
        &self,
        site: &Site<'_>,
        start: &Planar,
        goal: &Planar,
        choices: Choices,
        over: &dyn Fn() -> bool,
    ) -> (Found, Solution) {
        let precision = Precision { position: FLAT, yaw: FLAT, curvature: FLAT };
        let choices = Choices { flat: flat::Settings { precision, ..choices.flat }, ..choices };
        let (mut first, mut method) = (None, None);
        let settings = Settings { precision: self.precision, ..Settings::default() };
        let mut steer = |query: &Query| -> Option<SegmentList> {
            let query = Query::new(query.start_curvature, query.goal, &self.shaping).ok().filter(|_| !over())?;
            let boundary = Boundary { query, free_end: false, ..*self.boundary };
            let flat = generate(&boundary, self.control, &self.shaping, &choices, over, told).solution;
            let Goal { x, y, yaw, curvature } = query.goal;
            tracing::debug!("flat goal {x:.4} {y:.4} {yaw:.4} {curvature:.4}: {:?}, {:?}", flat.outcome, flat.method);
            first.get_or_insert(flat);
            method = Some(flat.method);
            (flat.outcome == Outcome::Solved).then_some(flat.segments)
        };
        let answer = site.solve_until(start, goal, &self.shaping, &settings, &mut steer, over);
        // Without any time there is still the flat start value.
        let flat = first
            .unwrap_or_else(|| generate(self.boundary, self.control, &self.shaping, &choices, over, told).solution);
        if answer.segments.is_empty() {
            return (answer.status, flat);
        }
        let method = method.unwrap_or(flat.method);
        (answer.status, Solution { segments: answer.segments, iterations: answer.iterations, method, ..flat })
    }
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
        ..*flat
    }
}

fn way(blocked: &Blocked) -> &'static str {
    match blocked.cause {
        Cause::Unsettled(Unsettled::NoGround(place)) => no_ground(&place),
        Cause::Unsettled(_) => "rest",
        Cause::Overturned => "tilt_rad",
    }
}

fn stands_in_the_way(stopped: &Stopped) -> &'static str {
    stopped.no_ground.as_ref().map_or("rest", no_ground)
}

fn no_ground(place: &NoGround) -> &'static str {
    match place {
        NoGround::OffMap { .. } => "map_edge",
        NoGround::Hole { .. } => "no_data",
    }
}
