//! What drives: limits and choices, and how a question becomes an answer that its replay holds to.

use std::time::{Duration, Instant};

use hairpin::feasibility::steering::shooting::query::{Curvatures, Goal, Precision, Query, Refusal};
use hairpin::feasibility::steering::shooting::solve::{Choices, Method, Outcome, Solution, solve};
use hairpin::feasibility::steering::shooting::{cc, flat};
use hairpin::robot::rover::Rover;
use hairpin::verification::{DriveReplay, replay_drive};
use hairpin::world::terrain::ElevationMap;
use hairpin_formats::scenario::rover_for;
use hairpin_formats::steering::{Asked, Status};

use super::answered::{Answered, broken, claim, pieces};
use super::ground::{self, Ground};
use crate::args::Steer;
use crate::problem::Problem;

/// What every question of a run has in common.
pub(super) struct Vehicle {
    pub(super) rover: Rover,
    /// What it drives on; the plane without one.
    map: Option<ElevationMap>,
    choices: Choices,
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
        Ok(Self { rover, map, choices, time_limit })
    }

    /// Answers a question: solved under the clock, then replayed without it.
    pub(super) fn answer(&self, asked: &Asked) -> Answered {
        let limits = &self.rover.limits;
        let most = asked.max_curvature.map_or(limits.curvature, |most| most.min(limits.curvature));
        let bounds = Curvatures { most, most_rate: limits.curvature_rate };
        let refused = |status, limit, excess| {
            let nearest =
                (limit == "curvature_1_m").then(|| [asked.k0.clamp(-most, most), asked.kf.clamp(-most, most)]);
            let limit = Some((limit, excess));
            Answered { status, drive: None, solving: Duration::ZERO, limit, bounds, nearest }
        };
        let fastest = asked.v0.unwrap_or(0.0).max(asked.vf.unwrap_or(0.0));
        if fastest > limits.speed {
            return refused(Status::Infeasible, "speed_m_s", Some(fastest - limits.speed));
        }
        let sharpest = asked.k0.abs().max(asked.kf.abs());
        if sharpest > most {
            return refused(Status::Infeasible, "curvature_1_m", Some(sharpest - most));
        }
        let query = match query(asked, &bounds) {
            Ok(query) => query,
            Err(refusal) => return refused(Status::Invalid, refusal.field, None),
        };
        let precision = Precision::default();
        let precision = Precision { position: asked.tolerance_m.unwrap_or(precision.position), ..precision };
        if let Some(map) = &self.map {
            let (rover, choices, time_limit) = (&self.rover, self.choices, self.time_limit);
            return Ground { rover, map, choices, bounds, precision, time_limit }.answer(asked, &query);
        }
        let flat = flat::Settings { precision, ..self.choices.flat };
        let mut choices = Choices { flat, ..self.choices };
        let begun = Instant::now();
        let stop = || self.time_limit.is_some_and(|limit| begun.elapsed() >= limit);
        let mut solution = solve(&query, &bounds, &choices, stop);
        let mut solving = begun.elapsed();
        let mut replay = self.replay(asked, &solution);
        let mut broken = broken(&replay, &bounds, &precision);
        if solution.outcome == Outcome::Solved && broken.is_some() && solution.method == Method::SingleArc {
            // The solver believes what the replay does not: closed forms remain.
            choices.arcs = false;
            let again = Instant::now();
            solution = Solution { iterations: solution.iterations, ..solve(&query, &bounds, &choices, || false) };
            solving += again.elapsed();
            replay = self.replay(asked, &solution);
            broken = super::answered::broken(&replay, &bounds, &precision);
        }
        let status = match (solution.outcome, broken) {
            (Outcome::Solved, None) => Status::Ok,
            (Outcome::Solved | Outcome::NotConverged, _) => Status::NotConverged,
            (Outcome::Stopped, _) => Status::TimeLimit,
        };
        let limit = if status == Status::Ok { None } else { broken };
        Answered { status, drive: Some((solution, replay)), solving, limit, bounds, nearest: None }
    }

    /// Metres with reversals where they would spare a long way round and are not allowed.
    pub(super) fn with_reversals(&self, asked: &Asked, answered: &Answered) -> Option<f64> {
        let (solution, replay) = answered.drive.as_ref()?;
        if self.map.is_some() || self.choices.reversals || solution.outcome != Outcome::Solved {
            return None;
        }
        let query = query(asked, &answered.bounds).ok()?;
        let metres = cc::steer(&query, &answered.bounds, cc::Gears::Both)?.length_m();
        (metres < WORTH_IT * replay.length).then_some(metres)
    }

    fn replay(&self, asked: &Asked, solution: &Solution) -> DriveReplay {
        replay_drive(&pieces(solution), &claim(asked))
    }
}

/// The question in the frame of travel: with a crab direction the path is that of a vehicle which looks along it.
fn query(asked: &Asked, bounds: &Curvatures) -> Result<Query, Refusal> {
    let [x, y, yaw] = asked.goal;
    let query = Query::new(asked.k0, Goal { x, y, yaw, curvature: asked.kf }, bounds)?;
    Ok(flat::crab(&query, asked.direction))
}
