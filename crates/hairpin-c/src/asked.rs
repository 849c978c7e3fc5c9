//! What is asked, before anything is looked for.

use std::f64::consts::TAU;

use hairpin::feasibility::steering::shooting::query::FARTHEST;
use hairpin::feasibility::steering::shooting::{Curvatures, Goal, Query};
use hairpin::trajectory::drive::Planar;

use crate::drive::{Drive, HAIRPIN_INFEASIBLE, HAIRPIN_SOLVED};
use crate::refusal::{HAIRPIN_INVALID, Refused};
use crate::steer::SteerHandle;

impl SteerHandle {
    pub(crate) fn answer(&self, start: &Planar, goal: &Planar) -> Result<Drive, Refused> {
        let query = match self.question(start, goal)? {
            Ok(query) => query,
            Err(answered) => return Ok(answered),
        };
        let shaping = self.shaping(start);
        Ok(match &self.map {
            None => self.in_the_plane(&query, &shaping, &self.hazards(start, &self.nothing)),
            Some(map) => self.on_the_map(map, start, goal, &shaping),
        })
    }

    /// The question in the frame of the start; `Err` of it is the answer already.
    pub(crate) fn question(&self, start: &Planar, goal: &Planar) -> Result<Result<Query, Drive>, Refused> {
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
            return Ok(Err(none.over("curvature_1_m", Some(sharpest - self.bounds.most))));
        }
        match self.is_there(&query) {
            true => Ok(Err(Drive::none(HAIRPIN_SOLVED).missing(&query.goal, start.curvature))),
            false => Ok(Ok(query)),
        }
    }

    /// What drives from `start` are shaped with.
    pub(crate) fn shaping(&self, start: &Planar) -> Curvatures {
        Curvatures { most: self.shaping.most.max(start.curvature.abs()), ..self.shaping }
    }

    /// Whether the start lies within all tolerances of the goal: nothing is driven then.
    pub(crate) fn is_there(&self, query: &Query) -> bool {
        let (precision, Goal { x, y, yaw, curvature }) = (self.settings.precision(), query.goal);
        libm::hypot(x, y) <= precision.position
            && wrapped(yaw).abs() <= precision.yaw
            && (query.start_curvature - curvature).abs() <= precision.curvature
            && self.settings.swing_rad == 0.0
    }
}

/// `goal` in the frame of `start`.
pub(crate) fn seen(start: &Planar, goal: &Planar) -> Goal {
    let (sin, cos) = libm::sincos(start.yaw);
    let (x, y) = (goal.x - start.x, goal.y - start.y);
    Goal { x: cos * x + sin * y, y: cos * y - sin * x, yaw: goal.yaw - start.yaw, curvature: goal.curvature }
}

/// `angle` in [−π, π].
pub(crate) fn wrapped(angle: f64) -> f64 {
    angle - TAU * (angle / TAU).round()
}
