//! What scenarios of boats have in common with all others.

use std::any::Any;
use std::collections::BTreeMap;

use super::{BoatExecute, BoatGenerate, BoatScenario};
use crate::campaign::bounds;
use crate::campaign::scenario::{
    BASELINE, Distribution, Environment, Executor, Head, Keys, Named, Patience, Steering, Subject, Terms, runs,
    sections,
};

/// A trip is given up after this multiple of its planned duration …
///
/// The limit of a run without one given is 2 · planned + 60 s, or what its kind calls the slowest if that is more.
const SLOWNESS: f64 = 2.0;
/// … and this time, s.
const SPARE_SECONDS: f64 = 60.0;

impl Keys for BoatScenario {
    fn head(&self) -> Head<'_> {
        let BoatExecute { command, repeat, timeout_s, accept_m, baseline, flaky, time_limit_s, .. } = &self.execute;
        Head {
            seed: self.seed,
            length: Some(self.task.length),
            search: self.generate.search.clone(),
            score: &self.generate.score,
            score_key: "generate.score",
            usual_score: Some(BoatGenerate::BY_HAND),
            cases_key: "generate.search.cases",
            reach: "witness",
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
            violation_share: self.spec.violation_share,
            confidence: self.spec.confidence,
            terms: Terms::of(&self.spec),
            asked: self.spec.asked(Terms::of(&self.spec).limits.are_given()),
            limits: Terms::KEYS,
            longest_leg: bounds::LONGEST_PASSAGE_S,
            surroundings: &[],
            one_search: false,
        }
    }

    fn subject(&self) -> Subject {
        let controller = self.execute.controller_word();
        Subject::of(&self.robot, |robot| &robot.name, true, controller)
    }

    fn vary_mut(&mut self) -> &mut BTreeMap<String, Distribution> {
        &mut self.vary
    }

    /// Noise and the steady force stay the scenario's own: they are what a case was found under. `None` for a scenario
    /// of another kind.
    fn adopt(&mut self, now: &dyn Keys) -> Option<()> {
        let now: &Self = (now as &dyn Any).downcast_ref()?;
        let (noise, force) = (self.execute.noise, self.execute.external_force_n);
        (self.robot, self.execute, self.spec) = (now.robot.clone(), now.execute.clone(), now.spec.clone());
        (self.execute.noise, self.execute.external_force_n) = (noise, force);
        Some(())
    }

    fn set_noisy(&mut self) {
        self.execute.noise = true;
    }

    /// Nothing is searched beside the waypoints of boats.
    fn surround(&mut self, _: &Environment) {}

    fn write_defaults(&mut self) {
        self.generate.search.move_waypoints = Some(self.generate.search.moves_waypoints());
        self.execute.controller = self.execute.steering_in_force();
    }

    fn named(&mut self) -> Named<'_> {
        let controller = Steering::users_mut(self.execute.controller.as_mut());
        let score = Some(("generate.score", &mut self.generate.score));
        Named { score, target: self.generate.search.target.as_mut(), controller, ..Named::default() }
    }

    sections!(hairpin, robot, seed, world, task, generate, execute, vary, spec);
}
