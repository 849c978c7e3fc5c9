//! What drives: limits and choices, and how a question becomes an answer that its replay holds to.

use std::time::Duration;

use hairpin::campaign::drive::steerable;
use hairpin::campaign::states::States;
use hairpin::feasibility::steering::shooting::Control;
use hairpin::feasibility::steering::shooting::families::Problem as Boundary;
use hairpin::feasibility::steering::shooting::flat;
use hairpin::feasibility::steering::shooting::query::{Curvatures, Goal, Precision, Query, Refusal};
use hairpin::robot::rover::{Rover, Suspension, Twist};
use hairpin::trajectory::SpeedProfile;
use hairpin::trajectory::drive::Planar;
use hairpin::trajectory::start_table::StartTable;
use hairpin::world::terrain::{ElevationMap, KeepOuts, Terrain};
use hairpin_formats::scenario::{means_scenario, rover_for, shadowed};
use hairpin_formats::steering::{Asked, Status};
use hairpin_formats::terrain::MapFile;

use super::answered::Answered;
use super::pace::{Pace, Rows, direction, start, wheels_broken};
use super::plane::Task;
use super::solver::{Solver, places};
use super::{SteerSettings, ground, holes, plane, start_table};
use crate::{Problem, Watch};

/// A vehicle that is asked for drives, where it drives, and how they are looked for.
pub struct Vehicle {
    /// What drives.
    pub rover: Rover,
    /// What it drives on; the plane without one.
    pub(super) map: Option<ElevationMap>,
    /// What the map's coordinates are relative to, m: easting and northing of its x = y = 0.
    pub(super) offset: [f64; 2],
    /// What it keeps out of.
    pub(super) keep_outs: KeepOuts,
    solver: Solver<'static>,
    /// Where start values are looked up.
    table: Option<StartTable>,
    /// Whether what has no suspension may drive over the map as over a plane.
    glides: bool,
    /// How fast, and by which controls.
    pub pace: Pace,
}

impl Vehicle {
    /// The vehicle of `settings`; what is worth knowing of its map is told to `watch`.
    ///
    /// # Errors
    /// What cannot be read, does not fit the vehicle, or asks for what nothing can be done with.
    pub fn new(settings: &SteerSettings, watch: &dyn Watch) -> Result<Self, Problem> {
        shadowed(&settings.rover).iter().for_each(|note| watch.warn(note));
        let mut rover = rover_for(&settings.rover)?;
        rover.kinematics = settings.kinematics;
        if means_scenario(&settings.rover) {
            let ground = match settings.terrain {
                Some(_) => "--terrain is its ground",
                None => "on level ground, where --terrain gives no other",
            };
            watch.warn(&format!(
                "{}: of a scenario the robot alone is taken, `{}`: {ground}",
                settings.rover, rover.name
            ));
        }
        if settings.turns && !rover.limits.turns_in_place {
            return Err(Problem::input(format!(
                "--turns: `{}` cannot turn in place (limits.turns_in_place)",
                rover.name
            )));
        }
        let solver = Solver::new(settings)?;
        let table = settings.effort.start_table.as_deref().map(|path| start_table::load(path, &rover)).transpose()?;
        let map = settings.terrain.as_ref().map(|(path, georeference)| ground::map(path, georeference, &rover, watch));
        let (map, offset) = match map.transpose()? {
            Some(MapFile { map, told }) => (Some(map), told.offset_m),
            None => (None, [0.0, 0.0]),
        };
        let keep_outs = places(settings, offset)?;
        Ok(Self { map, offset, rover, keep_outs, solver, table, glides: false, pace: settings.pace })
    }

    /// `rover` on `map`, forward arcs, with `time_limit` for each question: what requirements are checked with.
    ///
    /// Without a suspension it is a point to which the map is a plane, whatever its slopes.
    pub fn on(rover: Rover, map: Option<ElevationMap>, time_limit: Option<Duration>) -> Self {
        let (keep_outs, solver) = (KeepOuts::default(), Solver::plain(time_limit));
        Self { rover, map, offset: [0.0, 0.0], keep_outs, solver, table: None, glides: true, pace: Pace::default() }
    }

    /// The solver, with its table.
    pub(super) fn solver(&self) -> Solver<'_> {
        let mut solver = self.solver;
        solver.choices.flat.table = self.table.as_ref();
        solver
    }

    /// The bounds of a question.
    pub(super) fn bounds(&self, asked: &Asked) -> Curvatures {
        self.bounds_by(asked, &self.solver)
    }

    fn bounds_by(&self, asked: &Asked, solver: &Solver<'_>) -> Curvatures {
        let own = self.pace.bounds(asked, &self.rover, self.may_stop(solver));
        let most = asked.max_curvature.map_or(own.most, |most| most.min(own.most));
        Curvatures { most, ..own }
    }

    /// Whether a drive may stop on its way.
    fn may_stop(&self, solver: &Solver<'_>) -> bool {
        solver.choices.reversals || solver.choices.turns || self.pace.control == Control::TurnDriveTurn
    }

    /// A question in the map's own coordinates as it is asked of the map, which lies near its zero.
    pub(super) fn near(&self, asked: &Asked) -> Asked {
        if self.offset == [0.0, 0.0] {
            return *asked;
        }
        let ([x, y, yaw], [east, north]) = (asked.start.unwrap_or([0.0; 3]), self.offset);
        Asked { start: Some([x - east, y - north, yaw]), ..*asked }
    }

    /// Answers a question that is asked of the map ([`Self::near`]) exactly, by `solver`; where what may reverse or
    /// turn is no answer, by what does less of that.
    pub(super) fn answer_by(&self, asked: &Asked, solver: &Solver<'_>) -> Answered {
        let mut first = self.answer_towards(asked, asked, solver.precision(asked), solver);
        for choices in solver.plainer() {
            let open = matches!(first.status, Status::Infeasible | Status::NotConverged);
            if !open || solver.time_limit.is_some_and(|limit| first.solving >= limit) {
                break;
            }
            let plainer = Solver { choices, ..*solver };
            let second = self.answer_towards(asked, asked, plainer.precision(asked), &plainer);
            first.solving += second.solving;
            if second.status == Status::Ok {
                return Answered { solving: first.solving, ..second };
            }
        }
        first
    }

    /// Answers a question by a drive to the goal of `towards`, as exact as `aim` has it.
    pub(super) fn answer_towards(
        &self,
        asked: &Asked,
        towards: &Asked,
        aim: Precision,
        solver: &Solver<'_>,
    ) -> Answered {
        let (limits, bounds) = (&self.rover.limits, self.bounds_by(asked, solver));
        let most = bounds.most;
        let refused = |status, limit, excess| {
            let nearest =
                (limit == "curvature_1_m").then(|| [asked.k0.clamp(-most, most), asked.kf.clamp(-most, most)]);
            Answered { nearest, ..Answered::new(status, Some((limit, excess)), bounds, Duration::ZERO) }
        };
        let profile = match self.pace.profile(asked, &self.rover, self.may_stop(solver)) {
            Ok(profile) => profile,
            Err(wrong) => return refused(Status::Invalid, wrong.field, None),
        };
        let travel = direction(asked);
        if (travel.start != 0.0 || travel.end != 0.0) && !self.rover.may_crab() {
            return refused(Status::Infeasible, "direction_rad", None);
        }
        if profile.top() > limits.speed {
            return refused(Status::Infeasible, "speed_m_s", Some(profile.top() - limits.speed));
        }
        let sharpest = asked.k0.abs().max(asked.kf.abs());
        if sharpest > most {
            return refused(Status::Infeasible, "curvature_1_m", Some(sharpest - most));
        }
        let query = match query(towards, &bounds) {
            Ok(query) => query,
            Err(refusal) => return refused(Status::Invalid, refusal.field, None),
        };
        let precision = solver.precision(asked);
        let there = self.is_there(asked, &profile, &precision);
        let swing = travel.swing();
        if !there
            && self.pace.control == Control::TurnDriveTurn
            && let Some(excess) = self.cannot_turn()
        {
            return refused(Status::Infeasible, "steer_angle", excess);
        }
        let free_end = asked.free_end && self.pace.control == Control::VelocityPolynomial;
        let boundary = Boundary { query, speed: profile, swing, free_end };
        let shaping = steerable(&bounds, &self.rover, profile.top());
        let task = Task {
            rover: &self.rover,
            keep_outs: &self.keep_outs,
            solver,
            control: self.pace.control,
            boundary: &boundary,
            bounds,
            shaping,
            precision,
            towards,
            aim,
            there,
            glides: self.glides,
        };
        let mut answered = self.found(asked, &task, &shaping);
        if answered.status == Status::NotConverged && shaping != bounds && shaping.most >= sharpest {
            // What steering can follow at every curvature is more than enough: without it the limits themselves decide.
            answered = self.found(asked, &task, &bounds);
        }
        if there {
            return Answered { profile: Some(self.pace.settled(asked, profile, &[])), ..answered };
        }
        let segments = answered.drive.as_ref().map(|(solution, _)| solution.segments).unwrap_or_default();
        let profile = self.pace.settled(asked, profile, &segments);
        self.hold_to_pace(asked, answered, &profile)
    }

    /// Solves and replays, on the map or in the plane.
    fn found(&self, asked: &Asked, task: &Task<'_>, shaping: &Curvatures) -> Answered {
        let most = shaping.most.max(task.boundary.query.start_curvature.abs());
        let task = Task { shaping: Curvatures { most, ..*shaping }, ..*task };
        match &self.map {
            Some(map) => holes::answer(&task, map, asked),
            None => plane::answer(&task, asked),
        }
    }

    /// By how much the joints stand in the way of a turn in place, rad; `None` where it can be turned, and no number
    /// where the vehicle just does not.
    fn cannot_turn(&self) -> Option<Option<f64>> {
        let (motions, count) = self.rover.wheel_motions(&Twist::IN_PLACE, &[0.0; 3], None);
        let most = motions[..count].iter().map(|motion| motion.steer.abs()).fold(0.0, f64::max);
        let excess = (most > self.rover.wheels.steer).then_some(most - self.rover.wheels.steer);
        (excess.is_some() || !self.rover.limits.turns_in_place).then_some(excess)
    }

    /// Holds a good answer to what its speeds ask of the vehicle and its wheels.
    fn hold_to_pace(&self, asked: &Asked, mut answered: Answered, profile: &SpeedProfile) -> Answered {
        answered.profile = Some(*profile);
        if answered.status != Status::Ok {
            return answered;
        }
        let Some((solution, _)) = &answered.drive else { return answered };
        let segments = &solution.segments;
        let pace = &self.pace;
        let mut limit = pace.broken(&self.rover, profile, segments);
        if limit.is_none() && self.map.is_none() {
            // On the ground the steering follows its command as fast as it can, and the replay knows.
            limit = pace.steering_excess(&self.rover, profile, segments).map(|excess| ("steering_rate", Some(excess)));
        }
        limit = limit.or_else(|| pace.rims_broken(&self.rover, profile, segments));
        if limit.is_none() && self.rover.wheels.bounded() {
            let states = self.states(asked, &answered, Rows::Few);
            limit = states.and_then(|states| wheels_broken(&self.rover, &states));
        }
        if limit.is_some() {
            answered.status = Status::Infeasible;
            answered.limit = limit;
        }
        answered
    }

    /// The states of an answer's drive, on the ground or in the plane; `None` without a drive, and where the ground
    /// ends.
    pub fn follow(&self, asked: &Asked, answered: &Answered, rows: Rows) -> Option<States> {
        let mut states = self.states(&self.near(asked), answered, rows)?;
        if let Some(map) = self.map.as_ref().filter(|_| self.rover.suspension == Suspension::Level) {
            // A point that is level wherever it is has no height of its own.
            let height = |at: &Planar| map.height(at.x, at.y).unwrap_or(f64::NAN);
            states.states.iter_mut().for_each(|state| state.settled.z = height(&state.at));
        }
        states.states.iter_mut().for_each(|state| self.move_back(&mut state.at));
        Some(states)
    }

    /// Gives a place of the map the coordinates of the map's own file.
    pub(super) fn move_back(&self, at: &mut Planar) {
        (at.x, at.y) = (at.x + self.offset[0], at.y + self.offset[1]);
    }

    fn states(&self, asked: &Asked, answered: &Answered, rows: Rows) -> Option<States> {
        let (solution, _) = answered.drive.as_ref()?;
        let (profile, start) = (answered.profile?, start(asked));
        let followed = self.pace.followed(&self.rover, profile, direction(asked), &solution.segments, rows);
        match &self.map {
            Some(map) => followed.on(map, &start, &solution.segments).ok(),
            None => followed.in_the_plane(&start, &solution.segments).ok(),
        }
    }
}

/// The question in the frame of travel: with a crab direction the path is that of a vehicle which looks along it.
pub(super) fn query(asked: &Asked, bounds: &Curvatures) -> Result<Query, Refusal> {
    let [x, y, yaw] = asked.goal;
    let query = Query::new(asked.k0, Goal { x, y, yaw, curvature: asked.kf }, bounds)?;
    Ok(flat::crab(&query, asked.direction))
}
