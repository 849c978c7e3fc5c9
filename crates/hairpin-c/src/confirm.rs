//! What was found, driven again by other equations.

use hairpin::campaign::drive::broken;
use hairpin::feasibility::steering::shooting::{Goal, Query};
use hairpin::trajectory::drive::Planar;

use crate::asked::{seen, wrapped};
use crate::drive::{Drive, HAIRPIN_BLOCKED, HAIRPIN_INFEASIBLE, HAIRPIN_NOT_CONVERGED};
use crate::ground::no_ground;
use crate::refusal::Refused;
use crate::steer::SteerHandle;

impl SteerHandle {
    pub(crate) fn confirm(&self, start: &Planar, goal: &Planar, found: Drive) -> Result<Drive, Refused> {
        let segments = found.list()?;
        let precision = self.settings.precision();
        let query = Query { start_curvature: start.curvature, goal: seen(start, goal) };
        let flat = self.replay(&query, &segments);
        let Some(map) = &self.map else {
            return Ok(found.held_to(flat.error, flat.error_curvature, broken(&flat, &self.bounds, &precision)));
        };
        let ground = match self.site(map).replay(start, goal, &segments) {
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
        let at_rest = self.rover.limits.broken_at_rest(ground.max_tilt, ground.max_joint);
        let limit =
            broken(&told, &self.bounds, &precision).or_else(|| at_rest.map(|(limit, over)| (limit, Some(over))));
        Ok(Drive { tilt_rad: ground.max_tilt, ..found }.held_to(told.error, told.error_curvature, limit))
    }
}

impl Drive {
    /// With what is missing to `goal`, as the end sees it, where the curvature is `curvature`.
    pub(crate) fn missing(self, goal: &Goal, curvature: f64) -> Self {
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
            Some((limit @ ("tilt_rad" | "joint_rad"), excess)) => {
                Self { status: HAIRPIN_INFEASIBLE, ..told }.over(limit, excess)
            }
            Some((limit, excess)) => Self { status: HAIRPIN_NOT_CONVERGED, ..told }.over(limit, excess),
        }
    }
}
