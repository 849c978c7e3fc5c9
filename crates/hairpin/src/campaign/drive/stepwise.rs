//! Reach sets of ground vehicles with one fixed step per leg: `none`, `sphere`, `hull`. They are for comparison: what
//! they find has no commands, and their scores see straight legs between turns in place.
//!
//! ```text
//! none     every waypoint
//! sphere   |b − a| ≤ v T                          v commanded speed, T the step
//! hull     b within the hull of the ends of constant-input runs of T, in the body's frame
//! ```
//!
//! To each of them a leg has besides a length within `task.leg_m` and keeps the vehicle's radius from all keep-outs, as
//! a straight segment in the plan. Neither slope nor rest on the ground is asked.

use nalgebra::Point3;

use super::DriveSetup;
use super::ask::{Asked, Graph, ask, beside};
use super::plan::track;
use super::walking::Walking;
use crate::campaign::graph::{Counter, Explored, Outcome, Plan, Stage, in_order, learned};
use crate::campaign::learn::AnyScore;
use crate::campaign::scenario::{GroundReach, Manoeuvre};
use crate::campaign::{Evidence, SeenLeg};
use crate::feasibility::reach::drive::{DriveSettings, DriveSite, StraightLegs};
use crate::feasibility::reach::{
    BodyHull, BodyNode, Everywhere, Filtered, Leg, PlanarVehicle, Reach, Sphere, StepNode, StepReach, StepSettings,
};
use crate::math::random::{Stream, named_seed};
use crate::search::{Found, LegView, NoWalk, stroll};

/// A step-wise reach set.
///
/// Without a map: heights of waypoints are the ground's, but a leg over a hole or a cliff is a leg.
pub(super) struct Stepwise<'a> {
    setup: &'a DriveSetup,
    set: Set,
}

/// `Hull` alone has a heading and a state (speed, steering) at its nodes; the others know where they are, and where
/// they came from.
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
    ///
    /// Cost: sampling of the hull's inputs, once for all graphs. Without `reverse` among the manoeuvres the hull's
    /// least speed is 0.
    pub(super) fn new(setup: &'a DriveSetup) -> Result<Self, String> {
        let generate = &setup.scenario.generate;
        let (step, speed) = (generate.step_s, setup.speed());
        let set = match generate.reach {
            GroundReach::None | GroundReach::Witness => Set::Everywhere(Everywhere),
            GroundReach::Sphere => Set::Sphere(Sphere { radius: speed * step }),
            GroundReach::Hull => {
                let reverse = generate.manoeuvres.contains(&Manoeuvre::Reverse);
                let vehicle =
                    PlanarVehicle { bounds: setup.bounds(), ..PlanarVehicle::of(&setup.planner, speed, reverse) };
                Set::Hull(Box::new(vehicle.hull(step).map_err(|error| error.to_string())?))
            }
        };
        Ok(Self { setup, set })
    }

    /// Searches a graph.
    ///
    /// What is found has the evidence `hull-feasible` with the hull, and none with the others.
    pub(super) fn solve(&self, scored: &DriveSettings, graph: Graph) -> Outcome {
        let (settings, points) = (self.settings(), graph.points);
        let start = StepNode { previous: 0, current: 0 };
        let at = |node: &StepNode| node.current;
        match &self.set {
            Set::Everywhere(set) => self.ask(scored, graph, &StepReach::new(set, points, settings), start, at),
            Set::Sphere(set) => self.ask(scored, graph, &StepReach::new(set, points, settings), start, at),
            Set::Hull(hull) => self.ask(scored, graph, hull.as_ref(), self.headed(hull), |node| node.current),
        }
    }

    /// The legs from each of `points` to the one after it, the first from the task's start; `None` where one is not
    /// feasible.
    ///
    /// The one test that moved, joined and replanned waypoints pass. Cost: one question to the set for each leg.
    pub(super) fn follows(&self, points: &[Point3<f64>]) -> Option<Vec<SeenLeg>> {
        let settings = self.settings();
        let start = StepNode { previous: 0, current: 0 };
        if !points.windows(2).all(|leg| self.allows(&leg[0], &leg[1])) {
            return None;
        }
        match &self.set {
            Set::Everywhere(set) => in_order(StepReach::new(set, points, settings), start, points),
            Set::Sphere(set) => in_order(StepReach::new(set, points, settings), start, points),
            Set::Hull(hull) => in_order(hull.as_ref(), self.headed(hull), points),
        }
    }

    /// `plan` over other waypoints, the first the task's start; `None` where a leg is not feasible.
    ///
    /// Leg times, score and evidence are those of `plan`.
    pub(super) fn planned(&self, plan: &Plan, waypoints: Vec<Point3<f64>>) -> Option<Plan> {
        Some(Plan { seen: self.follows(&waypoints)?, waypoints, bound: None, ..plan.clone() })
    }

    /// A random walk over `points`.
    ///
    /// # Errors
    /// There is none, in a sentence's part.
    ///
    /// Every leg lasts one step, so that `leg_times` are all the same; its score is 0, as no search ranked it.
    pub(super) fn drawn(&self, points: &[Point3<f64>], walking: &Walking, random: &mut Stream) -> Result<Plan, String> {
        let (settings, start) = (self.settings(), StepNode { previous: 0, current: 0 });
        let at = |node: &StepNode| node.current;
        let found = match &self.set {
            Set::Everywhere(set) => {
                self.walk(&StepReach::new(set, points, settings), start, at, points, walking, random)
            }
            Set::Sphere(set) => self.walk(&StepReach::new(set, points, settings), start, at, points, walking, random),
            Set::Hull(hull) => {
                self.walk(hull.as_ref(), self.headed(hull), |node| node.current, points, walking, random)
            }
        };
        let waypoints: Vec<Point3<f64>> = found?.into_iter().map(|waypoint| points[waypoint as usize]).collect();
        let seen = self.follows(&waypoints).ok_or("a walk that cannot be followed again")?;
        Ok(Plan {
            leg_times: vec![self.step(); waypoints.len() - 1],
            waypoints,
            seen,
            score: 0.0,
            bound: None,
            evidence: self.evidence(),
            certified: None,
            witness: None,
            environment: None,
        })
    }

    /// A leg that the set gives is a leg: no step is refused later, and questions are cheap. Numbers of waypoints, the
    /// start first.
    fn walk<N: Copy + Eq>(
        &self,
        reach: &impl Reach<N>,
        start: N,
        place: impl Fn(&N) -> u32,
        points: &[Point3<f64>],
        walking: &Walking,
        random: &mut Stream,
    ) -> Result<Vec<u32>, String> {
        let next = |walk: &[N]| {
            let Some(here) = walk.last() else { return Vec::new() };
            let mut legs = Vec::new();
            reach.legs(here, points, &mut legs);
            legs.retain(|leg| {
                self.allows(&points[place(here) as usize], &points[leg.waypoint as usize])
                    && walking.may_follow(walk.iter().map(&place), leg.waypoint)
            });
            legs.into_iter().map(|leg| leg.to).collect()
        };
        let walk = stroll(start, walking.length, next, |_, _| true, walking.most(), random);
        let nodes = walk.map_err(|none| match none {
            NoWalk::None => "every walk ends too early".to_owned(),
            NoWalk::Asked(most) => format!("none was found in {most} legs"),
        })?;
        Ok(nodes.iter().map(place).collect())
    }

    /// What stands behind its legs.
    ///
    /// The hull is a filter and proves nothing of a drive; of the other two nothing is claimed.
    fn evidence(&self) -> Evidence {
        match self.set {
            Set::Hull(_) => Evidence::HullFeasible,
            Set::Everywhere(_) | Set::Sphere(_) => Evidence::Unchecked,
        }
    }

    /// Counts what becomes of the candidates for legs near the start of a graph.
    pub(super) fn count(&self, points: &[Point3<f64>], counter: &mut Counter) {
        let (settings, start) = (self.settings(), StepNode { previous: 0, current: 0 });
        let place = |node: &StepNode| node.current;
        match &self.set {
            Set::Everywhere(set) => self.count_by(StepReach::new(set, points, settings), start, place, points, counter),
            Set::Sphere(set) => self.count_by(StepReach::new(set, points, settings), start, place, points, counter),
            Set::Hull(hull) => {
                self.count_by(hull.as_ref(), self.headed(hull), |node: &BodyNode| node.current, points, counter);
            }
        }
    }

    fn count_by<N: Copy + Eq + std::hash::Hash, R: Reach<N>>(
        &self,
        reach: R,
        start: N,
        place: impl Fn(&N) -> u32,
        points: &[Point3<f64>],
        counter: &mut Counter,
    ) {
        let task = &self.setup.scenario.task;
        let name = self.setup.scenario.generate.reach.word();
        let refused = |a: usize, b: usize| {
            let apart = libm::hypot(points[b].x - points[a].x, points[b].y - points[a].y);
            let length = !(task.leg_m[0]..=task.leg_m[1]).contains(&apart);
            length.then(|| (Stage::Limits, "task.leg_m".to_owned()))
        };
        let blocked = |a: usize, b: usize| {
            (!self.allows(&points[a], &points[b])).then(|| (Stage::Obstacle, "a keep-out".to_owned()))
        };
        let ends = task.end_m.is_some();
        Explored { points, reach, start, length: task.length as usize, ends, name }.count(
            place,
            refused,
            blocked,
            |_, _| true,
            counter,
        );
    }

    fn settings(&self) -> StepSettings {
        StepSettings { step: self.step(), simd: self.setup.simd, ..StepSettings::default() }
    }

    /// Duration of every leg, s.
    pub(super) fn step(&self) -> f64 {
        self.setup.scenario.generate.step_s
    }

    /// The hull's node at the task's start.
    fn headed(&self, hull: &BodyHull) -> BodyNode {
        let start = &self.setup.scenario.task.start;
        hull.start(start.yaw_deg.to_radians(), [0.0, start.curvature_1_m])
    }

    /// Whether a leg has one of the task's lengths and is clear of keep-outs.
    ///
    /// Horizontal distance within `task.leg_m`; the straight segment keeps the vehicle's radius from every keep-out.
    fn allows(&self, a: &Point3<f64>, b: &Point3<f64>) -> bool {
        let [low, high] = self.setup.scenario.task.leg_m;
        let apart = libm::hypot(b.x - a.x, b.y - a.y);
        let keep_out = &self.setup.keep_out;
        (low..=high).contains(&apart) && keep_out.segment_distance([a.x, a.y], [b.x, b.y]) >= self.setup.radius()
    }

    /// Keeps the legs of the task's lengths that are clear of keep-outs, and searches.
    ///
    /// Without a learned model a leg's score is that of [`StraightLegs`]: of the straight line between both ends after
    /// a turn in place, on the same map.
    fn ask<N: Copy + Eq + Ord + std::hash::Hash, R: Reach<N>>(
        &self,
        scored: &DriveSettings,
        graph: Graph,
        reach: &R,
        start: N,
        place: impl Fn(&N) -> u32,
    ) -> Outcome {
        let (scenario, points) = (&self.setup.scenario, graph.points);
        let keep = |from: &N, leg: &Leg<N>| self.allows(&points[place(from) as usize], &points[leg.waypoint as usize]);
        let filtered = Filtered { inner: reach, keep };
        let (evidence, number) = (self.evidence(), graph.graph);
        // Nothing is claimed of the ground, and without rest on it there is no motion to run or to judge by.
        let plan = |found: Found<N>| {
            let plan = Plan::new(&found, points, evidence);
            let case = plan.clone().case(scenario.seed, number, 0);
            track(self.setup, &case).is_ok().then_some(plan)
        };
        let (reach, lookahead) = (&filtered, 1);
        if let Some(score) = learned(&graph.looped, &self.setup.attachments, &self.setup.scenario.generate.search.score)
        {
            let also = beside(&graph.looped);
            return ask(Asked { scenario, graph, reach, start, score, also, lookahead }, &|_, _| true, plan);
        }
        let site = DriveSite::new(&self.setup.planner, &self.setup.map, &self.setup.keep_out);
        let seed = named_seed(scenario.seed, "score", graph.graph);
        let scored = DriveSettings { seed, ..scored.clone() };
        let straight = StraightLegs::new(site, &scored);
        let stress = |leg: &LegView<'_>| {
            let [from, to] = [leg.from, leg.to].map(|index| (index, &points[index as usize]));
            straight.stress(from, to, leg.features.turn)
        };
        let score = AnyScore::Own(&stress);
        ask(Asked { scenario, graph, reach, start, score, also: Vec::new(), lookahead }, &|_, _| true, plan)
    }
}
