//! What scenarios of arms have in common with all others.

use std::any::Any;
use std::collections::BTreeMap;

use super::{ArmControllerKind, ArmScenario, CostSection, PointsFrame, PointsSource, ProgramMethod};
use crate::campaign::bounds;
use crate::campaign::scenario::{
    ARM_MOVES, BASELINE, DeviationFrom, Distribution, Environment, Executor, Head, KeyPath, Keys, Named, NamedMesh,
    Patience, Steering, Subject, TIMEOUT_S, Terms, UserSteering, runs, sections,
};
use crate::judgement::Limits;
use crate::trajectory::program::{Tool, WorkObject};

/// A point counts as reached within this distance of an arm's tool, m.
const ARRIVED: f64 = 1e-3;

/// Keys of limits.
const LIMITS: &[&str] = &["spec.path.max_mm", "spec.arrival.max_late_ms", "spec.regression.baseline"];

impl Keys for ArmScenario {
    fn head(&self) -> Head<'_> {
        let (execute, spec) = (&self.execute, &self.spec);
        let judged_by = Limits {
            deviation: spec.path.map(|limit| limit.max_mm * 1e-3),
            late: spec.arrival.map(|limit| limit.max_late_ms * 1e-3),
            ..Limits::default()
        };
        Head {
            seed: self.seed,
            length: None,
            // How many points a file has is not for keys to say.
            search: self.generate.search.section(self.task.count(0)),
            score: self.generate.cost.word(),
            score_key: "generate.cost",
            usual_score: None,
            cases_key: "generate.search.programs",
            reach: self.generate.mode.word(),
            executor: Executor {
                command: None,
                repeat: runs(execute.repeat, &self.vary, execute.logs.is_some()),
                timeout: execute.timeout_s.unwrap_or(TIMEOUT_S),
                control_rate: execute.control_rate_hz,
                processes: None,
                accept: ARRIVED,
                baseline: execute.baseline.unwrap_or(BASELINE),
                reruns: execute.flaky.map_or(0, |flaky| flaky.reruns),
                record: execute.record,
                // The virtual controller's runs end with their program.
                patience: Patience { given: None, per_waypoint: f64::INFINITY, of_plan: 0.0, spare: 0.0 },
            },
            controller: match (&execute.logs, Steering::users(execute.controller.as_ref())) {
                (Some(_), _) => None,
                (None, Some(users)) => Some(users.word()),
                (None, None) => Some("virtual controller"),
            },
            origin: None,
            vary: &self.vary,
            violation_share: spec.violation_share,
            confidence: spec.confidence,
            // Arms are held to the path that was programmed, and to their times at its points.
            terms: Terms { from: DeviationFrom::Path, corner: 0.0, limits: judged_by },
            asked: spec.asked(judged_by.are_given() || spec.regression.is_some()),
            limits: LIMITS,
            longest_leg: bounds::LONGEST_MOVE_S,
            surroundings: &[],
            one_search: true,
        }
    }

    fn subject(&self) -> Subject {
        let users = Steering::users(self.execute.controller.as_ref()).map(UserSteering::word);
        let ours = if self.execute.logs.is_some() { "recorded" } else { "virtual" };
        let subject = Subject::of(&self.robot, |robot| &robot.name, true, Some(users.unwrap_or(ours)));
        Subject { speeds: ARM_MOVES.into(), ..subject }
    }

    fn vary_mut(&mut self) -> &mut BTreeMap<String, Distribution> {
        &mut self.vary
    }

    fn adopt(&mut self, now: &dyn Keys) -> Option<()> {
        let now: &Self = (now as &dyn Any).downcast_ref()?;
        (self.robot, self.execute, self.spec) = (now.robot.clone(), now.execute.clone(), now.spec.clone());
        Some(())
    }

    fn set_noisy(&mut self) {}

    /// Arms have no environments.
    fn surround(&mut self, _: &Environment) {}

    fn write_defaults(&mut self) {
        if self.execute.logs.is_none() {
            self.execute.controller.get_or_insert(Steering::Ours(ArmControllerKind::Virtual));
        }
        let search = self.search();
        let own = &mut self.generate.search;
        if own.method == ProgramMethod::Worst {
            own.executions.get_or_insert(search.executions);
            own.confirm.get_or_insert(search.confirm);
        }
    }

    fn named(&mut self) -> Named<'_> {
        let meshes = self.world.obstacles.iter_mut().enumerate().filter_map(|(index, obstacle)| {
            let mesh = obstacle.mesh.as_mut()?;
            Some(NamedMesh {
                key: format!("world.obstacles[{index}].mesh.file"),
                file: &mut mesh.file,
                scale: &mut mesh.scale_mm,
                scale_key: "scale_mm",
                per_metre: 1000.0,
                vertices_key: "vertices_mm",
                vertices: &mut mesh.vertices_mm,
                triangles: &mut mesh.triangles,
            })
        });
        let (costs, score) = match &mut self.generate.cost {
            CostSection::Table(table) => (Some(table), None),
            CostSection::Learned(cost) => (None, Some(("generate.cost", &mut cost.score))),
            CostSection::Named(_) | CostSection::Weighted(_) => (None, None),
        };
        let cloud = match &mut self.task.points {
            PointsSource::File(file) => Some((file, &mut self.task.checksum)),
            PointsSource::List(_) | PointsSource::Drawn(_) => None,
        };
        let controller = Steering::users_mut(self.execute.controller.as_mut());
        let (target, baseline) = (self.generate.search.target.as_mut(), self.spec.regression.as_mut());
        let (meshes, in_object) = (meshes.collect(), self.task.points_in.frame == PointsFrame::Wobj);
        Named { map: None, cloud, in_object, costs, meshes, score, target, controller, baseline }
    }

    fn frames(&self) -> Option<(Tool, WorkObject)> {
        Some(self.in_programs(&self.tool().ok()?, &self.work_object().ok()?))
    }

    /// Moves are proven clear with what the spec allows beside them, and without a limit as they are planned.
    fn clear_within_mm(&self) -> Option<f64> {
        Some(self.widest_mm().unwrap_or(0.0))
    }

    sections!(hairpin, robot, seed, world, task, generate, execute, vary, spec);
}

impl ArmScenario {
    /// How far off its path (mm) the limit lets a run be at most, as it is given or drawn; `None` without a limit.
    ///
    /// Moves are searched once, and proven for the widest of the limits that runs are held to.
    pub(in crate::campaign) fn widest_mm(&self) -> Option<f64> {
        let drawn = self.vary.iter().filter_map(|(key, drawn)| {
            let is_of_path = matches!(&KeyPath::parse(key)?.to_string()[..], "spec.path" | "spec.path.max_mm");
            is_of_path.then(|| drawn.largest("max_mm")).flatten()
        });
        self.spec.path.map(|limit| limit.max_mm).into_iter().chain(drawn).reduce(f64::max)
    }
}
