//! Questions in the plane: solved under the clock, then replayed without it.

use std::time::Instant;

use hairpin::campaign::drive;
use hairpin::feasibility::steering::clear::{self, Hazards};
use hairpin::feasibility::steering::shooting::families::Problem as Boundary;
use hairpin::feasibility::steering::shooting::query::{Curvatures, Precision};
use hairpin::feasibility::steering::shooting::solve::{Choices, Method, Outcome, Solution};
use hairpin::feasibility::steering::shooting::{Control, Generated, flat};
use hairpin::robot::rover::Rover;
use hairpin::trajectory::drive::SegmentList;
use hairpin::verification::{DriveReplay, replay_drive};
use hairpin::world::terrain::KeepOuts;
use hairpin_formats::steering::{Asked, Status};

use super::answered::{Answered, Near, claim, pieces};
use super::pace::start;
use super::solver::Solver;
use super::trace::{retrace, trace_step};

/// One question, as plane and ground are asked it.
#[derive(Clone, Copy)]
pub(super) struct Task<'a> {
    pub(super) rover: &'a Rover,
    pub(super) keep_outs: &'a KeepOuts,
    pub(super) solver: &'a Solver<'a>,
    pub(super) control: Control,
    /// The question in the plane.
    pub(super) boundary: &'a Boundary,
    pub(super) bounds: Curvatures,
    /// The bounds that drives are shaped with.
    pub(super) shaping: Curvatures,
    /// How exactly the question is to be met.
    pub(super) precision: Precision,
    /// The goal that is steered for: the question's, or one within its tolerances.
    pub(super) towards: &'a Asked,
    /// How exactly that is to be met.
    pub(super) aim: Precision,
    /// Whether the start is there already.
    pub(super) there: bool,
    /// Whether what has no suspension may drive over a map as over a plane.
    pub(super) glides: bool,
}

impl<'a> Task<'a> {
    /// What is in the way, as the flat solver sees it from the start.
    pub(super) fn hazards(&self, asked: &Asked) -> Hazards<'a> {
        hazards(self.rover, self.keep_outs, asked)
    }
}

/// What is in the way of `asked`, as the flat solver sees it from the start.
pub(super) fn hazards<'a>(rover: &Rover, keep_outs: &'a KeepOuts, asked: &Asked) -> Hazards<'a> {
    Hazards { keep_outs, start: start(asked), direction: asked.direction, radius: clear::footprint(rover) }
}

/// Where the start is there already.
pub(super) const STANDING: Generated = Generated {
    solution: Solution {
        outcome: Outcome::Solved,
        segments: SegmentList::EMPTY,
        method: Method::SingleArc,
        iterations: 0,
        arc: None,
    },
    parameters: None,
    fit_error: 0.0,
};

/// Answers `asked` in the plane.
pub(super) fn answer(task: &Task<'_>, asked: &Asked) -> Answered {
    let Task { solver, control, boundary, bounds, shaping, precision, aim, .. } = *task;
    let flat = flat::Settings { precision: aim, ..solver.choices.flat };
    let mut choices = Choices { flat, ..solver.choices };
    let hazards = task.hazards(asked);
    let begun = Instant::now();
    let stop = || solver.time_limit.is_some_and(|limit| begun.elapsed() >= limit);
    let (found, mut intrusion) = match task.there {
        true => (STANDING, hazards.intrusion(&STANDING.solution.segments)),
        false => clear::generate(boundary, control, &shaping, &choices, &hazards, stop, trace_step),
    };
    let (mut solution, mut parameters) = (found.solution, found.parameters);
    let mut solving = begun.elapsed();
    if tracing::enabled!(tracing::Level::DEBUG) && parameters.is_none() && !task.there {
        retrace(boundary, control, &shaping, &choices, &solution);
    }
    let mut replay = replayed(asked, &solution, boundary.free_end);
    let mut broken = drive::broken(&replay, &bounds, &precision);
    let default = control == Control::Quintic && boundary.swing == 0.0;
    if solution.outcome == Outcome::Solved && broken.is_some() && default && solution.method == Method::SingleArc {
        // The solver believes what the replay does not: closed forms remain.
        choices.arcs = false;
        let again = Instant::now();
        let (second, near) = clear::generate(boundary, control, &shaping, &choices, &hazards, || false, trace_step);
        intrusion = near;
        solution = Solution { iterations: solution.iterations, ..second.solution };
        parameters = second.parameters;
        solving += again.elapsed();
        replay = replayed(asked, &solution, boundary.free_end);
        broken = drive::broken(&replay, &bounds, &precision);
    }
    let lacks = match solution.arc {
        Some(flat::Status::Infeasible { limit, excess }) if !default => Some((limit.name(), Some(excess))),
        _ => None,
    };
    let near = intrusion.map(|intrusion| Near::new(&intrusion, task.keep_outs, control, boundary));
    let status = match (solution.outcome, broken) {
        (Outcome::Solved, None) if near.is_some() => Status::Infeasible,
        (Outcome::Solved, None) => Status::Ok,
        (Outcome::NotConverged, _) if lacks.is_some() => Status::Infeasible,
        (Outcome::Solved | Outcome::NotConverged, _) => Status::NotConverged,
        (Outcome::Stopped, _) => Status::TimeLimit,
    };
    let limit = match status {
        Status::Ok => None,
        _ => lacks.or(broken).or(near.as_ref().map(Near::limit)),
    };
    Answered {
        near: near.filter(|near| limit == Some(near.limit())),
        parameters: parameters.map(|parameters| (parameters, found.fit_error)),
        cost: (status == Status::Ok).then(|| solver.ground.cost.of_commands(&solution.segments)),
        drive: Some((solution, replay)),
        ..Answered::new(status, limit, bounds, solving)
    }
}

fn replayed(asked: &Asked, solution: &Solution, free_end: bool) -> DriveReplay {
    replay_drive(&pieces(solution), &claim(asked, &solution.segments, free_end))
}
