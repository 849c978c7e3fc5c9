//! Reach sets of ground vehicles with one fixed step per leg: `none`, `sphere`, `hull`. They are for comparison: what they find
//! has no commands, and their scores see straight legs.

use nalgebra::Point3;

use super::DriveSetup;
use crate::campaign::Evidence;
use crate::campaign::graph::{Outcome, Plan, Question, search};
use crate::campaign::scenario::{GroundReach, Manoeuvre, SearchSection};
use crate::feasibility::reach::{
    BodyHull, Everywhere, Filtered, Leg, PlanarVehicle, Reach, Sphere, StepNode, StepReach, StepSet, StepSettings,
};
use crate::math::random::{hashed_unit, named_seed};
use crate::search::{Found, LegView, OpenEnd};

/// A step-wise reach set.
pub(super) struct Stepwise<'a> {
    setup: DriveSetup<'a>,
    set: Set,
}

enum Set {
    Everywhere(Everywhere),
    Sphere(Sphere),
    Hull(Box<BodyHull>),
}

impl<'a> Stepwise<'a> {
    /// The set that the scenario asks for.
    ///
    /// # Errors
    /// Why there is none, in a sentence's part.
    pub(super) fn new(setup: DriveSetup<'a>) -> Result<Self, String> {
        let generate = &setup.scenario.generate;
        let (step, speed) = (generate.step_s, setup.speed());
        let set = match generate.reach {
            GroundReach::None | GroundReach::Witness => Set::Everywhere(Everywhere),
            GroundReach::Sphere => Set::Sphere(Sphere { radius: speed * step }),
            GroundReach::Hull => {
                let reverse = generate.manoeuvres.contains(&Manoeuvre::Reverse);
                let vehicle =
                    PlanarVehicle { bounds: setup.bounds(), ..PlanarVehicle::of(setup.planner, speed, reverse) };
                Set::Hull(Box::new(vehicle.hull(step).map_err(|error| error.to_string())?))
            }
        };
        Ok(Self { setup, set })
    }

    /// Searches graph number `graph` over `points`.
    pub(super) fn solve(&self, search: &SearchSection, graph: u64, points: &[Point3<f64>]) -> Outcome {
        let settings = StepSettings {
            step: self.setup.scenario.generate.step_s,
            simd: self.setup.simd,
            ..StepSettings::default()
        };
        let start = StepNode { previous: 0, current: 0 };
        match &self.set {
            Set::Everywhere(set) => self.steps(search, graph, points, set, settings, start),
            Set::Sphere(set) => self.steps(search, graph, points, set, settings, start),
            Set::Hull(hull) => {
                let task = &self.setup.scenario.task.start;
                let start = hull.start(task.yaw_deg.to_radians(), [0.0, task.curvature_1_m]);
                self.ask(search, graph, points, hull.as_ref(), start, |node| node.current)
            }
        }
    }

    fn steps<S: StepSet>(
        &self,
        search: &SearchSection,
        graph: u64,
        points: &[Point3<f64>],
        set: &S,
        settings: StepSettings,
        start: StepNode,
    ) -> Outcome {
        self.ask(search, graph, points, &StepReach::new(set, points, settings), start, |node| node.current)
    }

    /// Keeps the legs of the task's lengths that are clear of keep-outs, and searches.
    fn ask<N: Copy + Eq + Ord + std::hash::Hash, R: Reach<N>>(
        &self,
        section: &SearchSection,
        graph: u64,
        points: &[Point3<f64>],
        reach: &R,
        start: N,
        place: impl Fn(&N) -> u32,
    ) -> Outcome {
        let scenario = self.setup.scenario;
        let [low, high] = scenario.task.leg_m;
        let radius = self.setup.radius();
        let keep = |from: &N, leg: &Leg<N>| {
            let (a, b) = (&points[place(from) as usize], &points[leg.waypoint as usize]);
            let apart = libm::hypot(b.x - a.x, b.y - a.y);
            (low..=high).contains(&apart) && self.setup.keep_out.segment_distance([a.x, a.y], [b.x, b.y]) >= radius
        };
        let filtered = Filtered { inner: reach, keep };
        let seed = |name: &str| named_seed(scenario.seed, name, graph);
        let (random, score_seed) = (scenario.generate.search.score.contains("random"), seed("score"));
        // Of a straight leg no more is known than how steep it is.
        let score = |leg: &LegView| {
            let slope = libm::atan2(leg.features.climb.abs(), leg.features.length) / self.setup.tilt().min(1.57);
            if random { hashed_unit(score_seed, &[leg.from.into(), leg.to.into()]) } else { slope }
        };
        let evidence = match self.set {
            Set::Hull(_) => Evidence::HullFeasible,
            Set::Everywhere(_) | Set::Sphere(_) => Evidence::Unchecked,
        };
        let plan = |found: Found<N>| Some(Plan::new(&found, points, evidence));
        let length = scenario.task.length as usize;
        if scenario.task.end_m.is_some() {
            let question = Question {
                search: section,
                length,
                points,
                reach: &filtered,
                start,
                score,
                seed: seed("uniform"),
                lookahead: 1,
            };
            return Outcome::of(graph, search(&question, |_, _| true), plan);
        }
        let open = OpenEnd::new(&filtered, points);
        let question = Question {
            search: section,
            length: length + 1,
            points: open.candidates(),
            reach: &open,
            start: open.task(start).start,
            score: open.score(&score, section.aggregate),
            seed: seed("uniform"),
            lookahead: 0,
        };
        let answer = search(&question, |node, steps| OpenEnd::<&R>::may_arrive(node, steps));
        Outcome::of(graph, answer, |found| plan(open.closed(found)))
    }
}
