//! Drives on a map, with the body on its wheels.

use hairpin::campaign::drive::Site;
use hairpin::feasibility::steering::shooting::families::Problem;
use hairpin::feasibility::steering::shooting::rough::{Answer, Cause, Prediction, Status};
use hairpin::feasibility::steering::shooting::solve::{Choices, Method, Outcome};
use hairpin::feasibility::steering::shooting::{Control, Curvatures, Precision, Query, generate};
use hairpin::robot::rover::Unsettled;
use hairpin::trajectory::drive::{Planar, SegmentList};
use hairpin::world::terrain::{ElevationMap, NoGround};

use crate::asked::seen;
use crate::drive::{
    Drive, HAIRPIN_BLOCKED, HAIRPIN_BUDGET_SPENT, HAIRPIN_INFEASIBLE, HAIRPIN_NOT_CONVERGED, HAIRPIN_SOLVED,
};
use crate::steer::SteerHandle;

/// The flat answers that a search on a map is made of are exact to this, m, rad, 1/m.
pub(crate) const FLAT: Precision = Precision { position: 1e-5, yaw: 1e-5, curvature: 1e-5 };

/// What a search on a map came to.
pub(crate) struct Found {
    pub(crate) answer: Answer,
    pub(crate) method: Method,
    /// Looks that were taken, where they are counted.
    pub(crate) looks: u64,
    /// Whether it ended because there were no more.
    pub(crate) spent: bool,
}

impl SteerHandle {
    /// Where and how it drives.
    pub(crate) fn site<'a>(&'a self, map: &'a ElevationMap) -> Site<'a> {
        let (speed, direction) = (self.speed.into(), self.settings.direction());
        Site { speed, direction, ..Site::straight(&self.rover, map) }
    }

    pub(crate) fn on_the_map(&self, map: &ElevationMap, start: &Planar, goal: &Planar, shaping: &Curvatures) -> Drive {
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
        if self.control == Control::Quintic {
            again(&mut found, shaping, &closed);
        }
        let sharpest = start.curvature.abs().max(goal.curvature.abs());
        if self.shaping != self.bounds && self.shaping.most >= sharpest {
            // What steering can follow at every curvature is more than enough: without it the limits themselves decide.
            again(&mut found, &self.bounds, &choices);
            if self.control == Control::Quintic {
                again(&mut found, &self.bounds, &closed);
            }
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
        let site = self.site(map);
        let mut method = Method::SingleArc;
        let (speed, swing) = (self.speed.into(), self.settings.swing_rad);
        let mut steer = |query: &Query| -> Option<SegmentList> {
            let query = Query::new(query.start_curvature, query.goal, shaping).ok()?;
            let problem = Problem { query, speed, swing, free_end: false };
            let flat = generate(&problem, self.control, shaping, choices, || false, |_| {}).solution;
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

    pub(crate) fn told(&self, found: &Found, goal: &Planar) -> Drive {
        let Answer { status, segments, prediction, iterations } = &found.answer;
        let mut drive = Drive {
            iterations: *iterations,
            looks: found.looks,
            ..Drive::none(HAIRPIN_NOT_CONVERGED).along(segments, found.method)
        };
        let mut joint = 0.0;
        if let Some(Prediction { end, tilt: (tilt, _), joint: (most, _), .. }) = prediction {
            joint = *most;
            drive = Drive { tilt_rad: *tilt, ..drive.missing(&seen(end, goal), end.curvature) };
        }
        let over = self.rover.limits.broken_at_rest(drive.tilt_rad, joint);
        match status {
            _ if found.spent => Drive { status: HAIRPIN_BUDGET_SPENT, ..drive },
            Status::Ok => match over {
                Some((limit, over)) => Drive { status: HAIRPIN_INFEASIBLE, ..drive }.over(limit, Some(over)),
                None => Drive { status: HAIRPIN_SOLVED, ..drive },
            },
            Status::Blocked(blocked) => Drive { status: HAIRPIN_BLOCKED, stopped_after_m: blocked.after_m, ..drive }
                .over(why(&blocked.cause), None),
            Status::Unreachable | Status::NotConverged { .. } => drive,
        }
    }
}

/// What stops a drive.
fn why(cause: &Cause) -> &'static str {
    match cause {
        Cause::Unsettled(Unsettled::NoGround(place)) => no_ground(place),
        Cause::Unsettled(_) => "rest",
        Cause::Overturned => "tilt_rad",
    }
}

pub(crate) fn no_ground(place: &NoGround) -> &'static str {
    match place {
        NoGround::OffMap { .. } => "map_edge",
        NoGround::Hole { .. } => "no_data",
    }
}
