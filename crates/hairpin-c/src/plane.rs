//! Drives in the plane, replayed by other equations.

use hairpin::campaign::drive::{broken, flat_claim, replay_pieces};
use hairpin::feasibility::steering::clear::{Hazards, generate};
use hairpin::feasibility::steering::shooting::families::Problem;
use hairpin::feasibility::steering::shooting::flat::{Status, crab};
use hairpin::feasibility::steering::shooting::solve::{Choices, Method, Outcome, Solution};
use hairpin::feasibility::steering::shooting::{Control, Curvatures, Query};
use hairpin::trajectory::drive::{Segment, SegmentList};
use hairpin::verification::{DriveClaim, DriveReplay};

use crate::drive::{Drive, HAIRPIN_BUDGET_SPENT, HAIRPIN_INFEASIBLE, HAIRPIN_NOT_CONVERGED, HAIRPIN_SOLVED};
use crate::steer::SteerHandle;

/// What stands in the way, and by how much.
type Broken = Option<(&'static str, Option<f64>)>;

impl SteerHandle {
    /// A drive that stays clear of `hazards`, if there are any.
    pub(crate) fn in_the_plane(&self, query: &Query, shaping: &Curvatures, hazards: &Hazards<'_>) -> Drive {
        let precision = self.settings.precision();
        let problem = self.problem(query);
        let mut choices = self.settings.choices(precision);
        let look = |choices: &Choices<'_>| {
            let (found, near) = generate(&problem, self.control, shaping, choices, hazards, || false, |_| {});
            let replay = self.replay(query, &found.solution.segments);
            (found.solution, near, replay, broken(&replay, &self.bounds, &precision))
        };
        let (mut solution, mut near, mut replay, mut limit) = look(&choices);
        let arc = solution.method == Method::SingleArc && self.is_usual();
        if solution.outcome == Outcome::Solved && limit.is_some() && arc {
            // The solver believes what the replay does not: closed forms remain.
            choices.arcs = false;
            let iterations = solution.iterations;
            (solution, near, replay, limit) = look(&choices);
            solution.iterations = iterations;
        }
        self.told_flat(&solution, &replay, limit).near(near)
    }

    /// Whether curvature is the usual function of the way, in a direction that stays.
    pub(crate) fn is_usual(&self) -> bool {
        self.control == Control::Quintic && self.settings.swing_rad == 0.0
    }

    /// `query`, of the body, as its path is asked for.
    fn problem(&self, query: &Query) -> Problem {
        let query = crab(query, self.settings.direction_rad);
        Problem { query, speed: self.speed.into(), swing: self.settings.swing_rad, free_end: false }
    }

    /// `segments` driven again, against what `query` asked for.
    pub(crate) fn replay(&self, query: &Query, segments: &SegmentList) -> DriveReplay {
        let direction = self.settings.direction();
        let length: f64 = segments.iter().map(Segment::length_m).sum();
        let claim = flat_claim(query, direction.start);
        replay_pieces(segments, &DriveClaim { crab_rate: direction.rate(length), ..claim })
    }

    /// An answer, and what its replay holds it to.
    fn told_flat(&self, solution: &Solution, replay: &DriveReplay, limit: Broken) -> Drive {
        let lacks = match solution.arc {
            Some(Status::Infeasible { limit, excess }) if !self.is_usual() => Some((limit.name(), Some(excess))),
            _ => None,
        };
        let spent = self.settings.most_steps != 0 && solution.iterations >= self.settings.most_steps;
        let status = match (solution.outcome, limit) {
            (Outcome::Solved, None) => HAIRPIN_SOLVED,
            (Outcome::NotConverged, _) if lacks.is_some() => HAIRPIN_INFEASIBLE,
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
        let limit = if status == HAIRPIN_SOLVED { None } else { lacks.or(limit) };
        limit.map_or(drive, |(limit, excess)| drive.over(limit, excess))
    }
}
