//! What scenarios of flights have in common with all others.

use std::any::Any;
use std::collections::BTreeMap;

use super::{ExecuteSection, FlightScenario, GenerateSection, ReachName};
use crate::campaign::bounds;
use crate::campaign::scenario::{
    BASELINE, Distribution, Environment, Executor, Head, Keys, Named, NamedMesh, Patience, Steering, Subject, Terms,
    runs, sections,
};

/// Time per waypoint after which a flight is given up, s: what the paper's authors charged.
///
/// The limit of a run without one given is this times the waypoints, or what its kind calls the slowest if that is
/// more.
const SECONDS_PER_WAYPOINT: f64 = 9.0;

impl Keys for FlightScenario {
    fn head(&self) -> Head<'_> {
        let ExecuteSection { command, repeat, timeout_s, accept_m, baseline, flaky, time_limit_s, .. } = &self.execute;
        Head {
            seed: self.seed,
            length: Some(self.task.length),
            search: self.generate.search.clone(),
            score: &self.generate.score,
            score_key: "generate.score",
            usual_score: Some(GenerateSection::BY_HAND),
            cases_key: "generate.search.cases",
            reach: self.generate.reach.word(),
            executor: Executor {
                command: command.as_deref(),
                repeat: runs(*repeat, &self.vary, self.execute.logs.is_some()),
                timeout: *timeout_s,
                control_rate: self.execute.control_rate_hz,
                processes: self.execute.processes.or(self.execute.workers),
                accept: *accept_m,
                baseline: baseline.unwrap_or(BASELINE),
                reruns: flaky.map_or(0, |flaky| flaky.reruns),
                record: self.execute.record,
                patience: Patience {
                    given: *time_limit_s,
                    per_waypoint: SECONDS_PER_WAYPOINT,
                    of_plan: 0.0,
                    spare: 0.0,
                },
            },
            controller: self.execute.controller_word(),
            origin: self.world.origin,
            vary: &self.vary,
            violation_share: self.spec.violation_share,
            confidence: self.spec.confidence,
            terms: Terms::of(&self.spec),
            asked: self.spec.asked(Terms::of(&self.spec).limits.are_given()),
            limits: Terms::KEYS,
            longest_leg: bounds::LONGEST_LEG_S,
            surroundings: &["wind_m_s", "discrete_gust", "obstacles"],
            one_search: false,
        }
    }

    fn subject(&self) -> Subject {
        let at_ends = self.generate.reach == ReachName::Witness;
        let controller = self.execute.controller_word();
        Subject::of(&self.robot, |robot| &robot.name, at_ends, controller)
    }

    fn vary_mut(&mut self) -> &mut BTreeMap<String, Distribution> {
        &mut self.vary
    }

    /// Noise stays the scenario's own. `None` for a scenario of another kind.
    fn adopt(&mut self, now: &dyn Keys) -> Option<()> {
        let now: &Self = (now as &dyn Any).downcast_ref()?;
        let noise = self.execute.noise;
        (self.robot, self.execute, self.spec) = (now.robot.clone(), now.execute.clone(), now.spec.clone());
        self.execute.noise = noise;
        Some(())
    }

    fn set_noisy(&mut self) {
        self.execute.noise = true;
    }

    /// Wind and gust of the environment take the place of the world's; obstacles come beside those that there are.
    /// Nothing is left to be searched.
    fn surround(&mut self, environment: &Environment) {
        let world = &mut self.world;
        world.wind_m_s = environment.wind_m_s.or(world.wind_m_s);
        world.discrete_gust = environment.discrete_gust.or(world.discrete_gust);
        world.obstacles.extend(environment.obstacles.iter().cloned());
        self.generate.environment = None;
    }

    /// Timing, whether waypoints move, and who flies; nobody where logs are named.
    fn write_defaults(&mut self) {
        self.generate.search.move_waypoints = Some(self.generate.search.moves_waypoints());
        self.generate.timing = Some(self.generate.timing_in_force());
        if self.execute.logs.is_none() {
            self.execute.controller = self.execute.steering_in_force();
        }
    }

    fn named(&mut self) -> Named<'_> {
        let controller = Steering::users_mut(self.execute.controller.as_mut());
        let meshes = self.world.obstacles.iter_mut().enumerate().filter_map(|(index, obstacle)| {
            let mesh = obstacle.mesh.as_mut()?;
            Some(NamedMesh {
                key: format!("world.obstacles[{index}].mesh.file"),
                file: &mut mesh.file,
                scale: &mut mesh.scale,
                scale_key: "scale",
                per_metre: 1.0,
                vertices_key: "vertices_m",
                vertices: &mut mesh.vertices_m,
                triangles: &mut mesh.triangles,
            })
        });
        let score = Some(("generate.score", &mut self.generate.score));
        Named {
            meshes: meshes.collect(),
            score,
            target: self.generate.search.target.as_mut(),
            controller,
            ..Named::default()
        }
    }

    sections!(hairpin, robot, seed, world, task, generate, execute, vary, spec);
}
