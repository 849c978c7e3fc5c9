//! What drives: limits and choices, and how a question becomes an answer that its replay holds to.

use std::time::{Duration, Instant};

use hairpin::campaign::states::States;
use hairpin::feasibility::steering::shooting::families::{Iteration, Problem as Boundary};
use hairpin::feasibility::steering::shooting::query::{Curvatures, Goal, Precision, Query, Refusal};
use hairpin::feasibility::steering::shooting::solve::{Choices, Method, Outcome, Solution};
use hairpin::feasibility::steering::shooting::{Control, Generated, cc, flat, generate};
use hairpin::robot::rover::{Rover, Twist};
use hairpin::trajectory::SpeedProfile;
use hairpin::verification::{DriveReplay, replay_drive};
use hairpin::world::terrain::ElevationMap;
use hairpin_formats::scenario::rover_for;
use hairpin_formats::steering::{Asked, Status};

use super::answered::{Answered, broken, claim, named, pieces};
use super::ground::{self, Ground};
use super::pace::{Pace, Rows, direction, start, wheels_broken};
use crate::args::Steer;
use crate::problem::Problem;

/// What every question of a run has in common.
pub(in crate::commands) struct Vehicle {
    pub(super) rover: Rover,
    /// What it drives on; the plane without one.
    map: Option<ElevationMap>,
    choices: Choices,
    pub(super) pace: Pace,
    time_limit: Option<Duration>,
}

/// Share of a drive's length below which one with reversals is worth telling of.
const WORTH_IT: f64 = 0.7;

impl Vehicle {
    pub(super) fn new(steer: &Steer) -> Result<Self, Problem> {
        let rover = rover_for(&steer.rover)?;
        if steer.turns && !rover.limits.turns_in_place {
            return Err(Problem::input(format!(
                "--turns: `{}` cannot turn in place (limits.turns_in_place)",
                rover.name
            )));
        }
        let map = ground::map(steer, &rover)?;
        let choices = Choices { reversals: steer.reversals, turns: steer.turns, ..Choices::default() };
        let time_limit = steer.time_limit_ms.map(|ms| Duration::from_secs_f64(ms * 1e-3));
        Ok(Self { rover, map, choices, pace: Pace::new(steer), time_limit })
    }

    /// `rover` on `map`, forward arcs, with `time_limit` for each question: what requirements are checked with.
    pub(in crate::commands) fn on(rover: Rover, map: Option<ElevationMap>, time_limit: Option<Duration>) -> Self {
        Self { rover, map, choices: Choices::default(), pace: Pace::default(), time_limit }
    }

    /// Answers a question: solved under the clock, then replayed without it.
    pub(in crate::commands) fn answer(&self, asked: &Asked) -> Answered {
        let limits = &self.rover.limits;
        let most = asked.max_curvature.map_or(limits.curvature, |most| most.min(limits.curvature));
        let bounds = Curvatures { most, most_rate: limits.curvature_rate };
        let refused = |status, limit, excess| {
            let nearest =
                (limit == "curvature_1_m").then(|| [asked.k0.clamp(-most, most), asked.kf.clamp(-most, most)]);
            let limit = Some((limit, excess));
            Answered {
                status,
                drive: None,
                solving: Duration::ZERO,
                limit,
                bounds,
                nearest,
                profile: None,
                parameters: None,
            }
        };
        let profile = match self.pace.profile(asked, &self.rover) {
            Ok(profile) => profile,
            Err(wrong) => return refused(Status::Invalid, wrong.field, None),
        };
        if profile.top() > limits.speed {
            return refused(Status::Infeasible, "speed_m_s", Some(profile.top() - limits.speed));
        }
        let sharpest = asked.k0.abs().max(asked.kf.abs());
        if sharpest > most {
            return refused(Status::Infeasible, "curvature_1_m", Some(sharpest - most));
        }
        let query = match query(asked, &bounds) {
            Ok(query) => query,
            Err(refusal) => return refused(Status::Invalid, refusal.field, None),
        };
        if self.pace.control == Control::TurnDriveTurn
            && let Some(excess) = self.cannot_turn()
        {
            return refused(Status::Infeasible, "steer_angle", excess);
        }
        let precision = Precision::default();
        let precision = Precision { position: asked.tolerance_m.unwrap_or(precision.position), ..precision };
        let free_end = asked.free_end && self.pace.control == Control::VelocityPolynomial;
        let boundary = Boundary { query, speed: profile, swing: direction(asked).swing(), free_end };
        let shaping = self.pace.tightened(&bounds, &self.rover, &profile);
        let mut answered = self.found(asked, &boundary, &bounds, &shaping, &precision);
        if answered.status == Status::NotConverged && shaping != bounds && shaping.most >= sharpest {
            // What steering can follow at every curvature is more than enough: without it the limits themselves decide.
            answered = self.found(asked, &boundary, &bounds, &bounds, &precision);
        }
        self.hold_to_pace(asked, answered, &profile)
    }

    /// Solves under the clock and replays without it.
    fn found(
        &self,
        asked: &Asked,
        boundary: &Boundary,
        bounds: &Curvatures,
        shaping: &Curvatures,
        precision: &Precision,
    ) -> Answered {
        let (bounds, precision, free_end) = (*bounds, *precision, boundary.free_end);
        let shaping = Curvatures { most: shaping.most.max(boundary.query.start_curvature.abs()), ..*shaping };
        if let Some(map) = &self.map {
            let (rover, choices, time_limit) = (&self.rover, self.choices, self.time_limit);
            let control = self.pace.control;
            let ground = Ground { rover, map, choices, control, boundary, bounds, shaping, precision, time_limit };
            return ground.answer(asked);
        }
        let flat = flat::Settings { precision, ..self.choices.flat };
        let mut choices = Choices { flat, ..self.choices };
        let begun = Instant::now();
        let stop = || self.time_limit.is_some_and(|limit| begun.elapsed() >= limit);
        let Generated { mut solution, mut parameters, fit_error } =
            generate(boundary, self.pace.control, &shaping, &choices, stop, told);
        let mut solving = begun.elapsed();
        if tracing::enabled!(tracing::Level::DEBUG) && parameters.is_none() {
            retrace(boundary, self.pace.control, &shaping, &choices, &solution);
        }
        let mut replay = self.replay(asked, &solution, free_end);
        let mut broken = broken(&replay, &bounds, &precision);
        let default = self.pace.control == Control::Quintic && boundary.swing == 0.0;
        if solution.outcome == Outcome::Solved && broken.is_some() && default && solution.method == Method::SingleArc {
            // The solver believes what the replay does not: closed forms remain.
            choices.arcs = false;
            let again = Instant::now();
            let second = generate(boundary, self.pace.control, &shaping, &choices, || false, told);
            solution = Solution { iterations: solution.iterations, ..second.solution };
            parameters = second.parameters;
            solving += again.elapsed();
            replay = self.replay(asked, &solution, free_end);
            broken = super::answered::broken(&replay, &bounds, &precision);
        }
        let lacks = match solution.arc {
            Some(flat::Status::Infeasible { limit, excess }) if !default => Some((named(limit), Some(excess))),
            _ => None,
        };
        let status = match (solution.outcome, broken) {
            (Outcome::Solved, None) => Status::Ok,
            (Outcome::NotConverged, _) if lacks.is_some() => Status::Infeasible,
            (Outcome::Solved | Outcome::NotConverged, _) => Status::NotConverged,
            (Outcome::Stopped, _) => Status::TimeLimit,
        };
        let limit = if status == Status::Ok { None } else { lacks.or(broken) };
        let parameters = parameters.map(|parameters| (parameters, fit_error));
        let drive = Some((solution, replay));
        Answered { status, drive, solving, limit, bounds, nearest: None, profile: None, parameters }
    }

    /// By how much the joints stand in the way of a turn in place, rad; `None` where it can be turned, and no number where
    /// the vehicle just does not.
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
        if limit.is_none() && self.rover.wheels.bounded() {
            let states = self.follow(asked, &answered, Rows::Few);
            limit = states.and_then(|states| wheels_broken(&self.rover, &states));
        }
        if limit.is_some() {
            answered.status = Status::Infeasible;
            answered.limit = limit;
        }
        answered
    }

    /// The states of an answer's drive, on the ground or in the plane; `None` without a drive, and where the ground ends.
    pub(super) fn follow(&self, asked: &Asked, answered: &Answered, rows: Rows) -> Option<States> {
        let (solution, _) = answered.drive.as_ref()?;
        let (profile, start) = (answered.profile?, start(asked));
        let followed = self.pace.followed(&self.rover, profile, direction(asked), &solution.segments, rows);
        match &self.map {
            Some(map) => followed.on(map, &start, &solution.segments).ok(),
            None => followed.in_the_plane(&start, &solution.segments).ok(),
        }
    }

    /// Metres with reversals where they would spare a long way round and are not allowed.
    pub(super) fn with_reversals(&self, asked: &Asked, answered: &Answered) -> Option<f64> {
        let (solution, replay) = answered.drive.as_ref()?;
        if self.map.is_some()
            || self.pace.control != Control::Quintic
            || self.choices.reversals
            || solution.outcome != Outcome::Solved
        {
            return None;
        }
        let query = query(asked, &answered.bounds).ok()?;
        let metres = cc::steer(&query, &answered.bounds, cc::Gears::Both)?.length_m();
        (metres < WORTH_IT * replay.length).then_some(metres)
    }

    fn replay(&self, asked: &Asked, solution: &Solution, free_end: bool) -> DriveReplay {
        replay_drive(&pieces(solution), &claim(asked, &solution.segments, free_end))
    }
}

/// A step of a descent, for those who want to see it.
pub(super) fn told(step: &Iteration) {
    let Iteration { start, step, length, miss, bends } = step;
    tracing::debug!("start {start}, step {step}: {length:.4} m, misses by {miss:.2e}, {bends:.4} of the bounds");
}

/// The flat solver's steps: it takes no observer along, so its answers after one, two and more steps are asked for again.
fn retrace(boundary: &Boundary, control: Control, bounds: &Curvatures, choices: &Choices, solution: &Solution) {
    for iterations in 0..=solution.iterations.min(choices.flat.iterations) {
        let flat = flat::Settings { iterations, ..choices.flat };
        let stopped = generate(boundary, control, bounds, &Choices { flat, ..*choices }, || false, |_| {});
        let length: f64 = stopped.solution.segments.iter().map(|segment| segment.length_m()).sum();
        tracing::debug!("{iterations} steps at most: {length:.4} m, {:?}", stopped.solution.arc);
    }
}

/// The question in the frame of travel: with a crab direction the path is that of a vehicle which looks along it.
fn query(asked: &Asked, bounds: &Curvatures) -> Result<Query, Refusal> {
    let [x, y, yaw] = asked.goal;
    let query = Query::new(asked.k0, Goal { x, y, yaw, curvature: asked.kf }, bounds)?;
    Ok(flat::crab(&query, asked.direction))
}
