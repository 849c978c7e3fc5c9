//! What scenarios of drives have in common with all others.

use std::any::Any;
use std::collections::BTreeMap;

use super::{DriveExecute, DriveScenario, DriveSearch, GroundDescription, GroundReach};
use crate::campaign::bounds;
use crate::campaign::scenario::{
    BASELINE, DeviationFrom, Distribution, Environment, Executor, Head, Keys, Named, Patience, Projected, Steering,
    Subject, Terms, runs, sections,
};
use crate::judgement::Limits;

/// A drive is given up after this multiple of its planned duration …
///
/// The limit of a run without one given is 2 · planned + 60 s, or what its kind calls the slowest if that is more.
const SLOWNESS: f64 = 2.0;
/// … and this time, s.
const SPARE_SECONDS: f64 = 60.0;

/// Keys of limits.
const LIMITS: &[&str] = &[
    "spec.limits.path_deviation_m",
    "spec.limits.tip_over_margin_deg",
    "spec.limits.clearance_m",
    "spec.limits.total_time_s",
];

impl Keys for DriveScenario {
    /// Deviations are from the
    /// planned path, without corners.
    fn head(&self) -> Head<'_> {
        let DriveExecute { command, repeat, timeout_s, accept_m, baseline, flaky, time_limit_s, .. } = &self.execute;
        let limits = &self.spec.limits;
        let judged_by = Limits {
            deviation: limits.path_deviation_m,
            clearance: limits.clearance_m,
            tip_over_margin: limits.tip_over_margin_deg,
            total_time: limits.total_time_s,
            ..Limits::default()
        };
        Head {
            seed: self.seed,
            length: Some(self.task.length),
            search: self.generate.search.section(),
            score: &self.generate.search.score,
            score_key: "generate.search.score",
            usual_score: Some(DriveSearch::BY_HAND),
            cases_key: "generate.search.cases",
            reach: self.generate.reach.word(),
            executor: Executor {
                command: command.as_deref(),
                repeat: runs(*repeat, &self.vary, false),
                timeout: *timeout_s,
                control_rate: self.execute.control_rate_hz,
                processes: self.execute.processes.or(self.execute.workers),
                accept: *accept_m,
                baseline: baseline.unwrap_or(BASELINE),
                reruns: flaky.map_or(0, |flaky| flaky.reruns),
                record: self.execute.record,
                patience: Patience { given: *time_limit_s, per_waypoint: 0.0, of_plan: SLOWNESS, spare: SPARE_SECONDS },
            },
            controller: self.execute.controller_word(),
            origin: self.world.origin,
            vary: &self.vary,
            violation_share: limits.violation_share,
            confidence: limits.confidence,
            // Drives follow a planned path: the way between two waypoints is not the straight one.
            terms: Terms { from: DeviationFrom::Path, corner: 0.0, limits: judged_by },
            asked: self.spec.asked(judged_by.are_given()),
            limits: LIMITS,
            longest_leg: bounds::LONGEST_DRIVE_S,
            surroundings: &["keep_out", "external_force_n"],
            one_search: false,
        }
    }

    fn projected(&self) -> Option<Projected> {
        self.world.terrain.projected()
    }

    fn unknown_plane(&self) -> Option<&str> {
        self.world.terrain.unknown_plane.as_deref()
    }

    fn subject(&self) -> Subject {
        let at_ends = self.generate.reach == GroundReach::Witness;
        let controller = self.execute.controller_word();
        Subject::of(&self.robot, |robot| robot.name(), at_ends, controller)
    }

    fn vary_mut(&mut self) -> &mut BTreeMap<String, Distribution> {
        &mut self.vary
    }

    /// Noise and the steady force stay the scenario's own. `None` for a scenario of another kind: rovers, cars and
    /// differential drives share their keys, and none drives what was planned for another.
    fn adopt(&mut self, now: &dyn Keys) -> Option<()> {
        let now: &Self = (now as &dyn Any).downcast_ref()?;
        let [own, other] = [&self.robot, &now.robot].map(|robot| robot.resolved().ok().map(GroundDescription::kind));
        if own != other {
            return None;
        }
        let (noise, force) = (self.execute.noise, self.execute.external_force_n);
        (self.robot, self.execute, self.spec) = (now.robot.clone(), now.execute.clone(), now.spec.clone());
        (self.execute.noise, self.execute.external_force_n) = (noise, force);
        Some(())
    }

    fn set_noisy(&mut self) {
        self.execute.noise = true;
    }

    /// A force of the environment takes the place of the scenario's; keep-outs come beside those that there are.
    /// Nothing is left to be searched.
    fn surround(&mut self, environment: &Environment) {
        self.execute.external_force_n = environment.external_force_n.or(self.execute.external_force_n);
        self.world.keep_out.extend(environment.keep_out.iter().cloned());
        self.generate.environment = None;
    }

    fn write_defaults(&mut self) {
        self.generate.search.move_waypoints = Some(self.generate.search.section().moves_waypoints());
        self.execute.controller = self.execute.steering_in_force();
    }

    fn named(&mut self) -> Named<'_> {
        let controller = Steering::users_mut(self.execute.controller.as_mut());
        let terrain = &mut self.world.terrain;
        let map = (terrain.file.is_some() && terrain.generator.is_none()).then_some(terrain);
        let score = Some(("generate.search.score", &mut self.generate.search.score));
        Named { map, score, target: self.generate.search.target.as_mut(), controller, ..Named::default() }
    }

    sections!(hairpin, robot, seed, world, task, generate, execute, vary, spec);
}
