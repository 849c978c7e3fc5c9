//! One graph, from its number to its plans: the reach set asked for, the search asked for, and never another.

use std::cell::RefCell;
use std::hash::Hash;

use nalgebra::Point3;

use super::graph;
use super::search::{Answer, Question, search};
use crate::campaign::scenario::{EstimatedVelocity, ReachName, Timing};
use crate::campaign::{Evidence, Setup};
use crate::feasibility::reach::{
    Everywhere, Filtered, Hull, HullSettings, Leg, PairMask, Reach, Sphere, StepNode, StepReach, StepSet, StepSettings,
};
use crate::math::random::named_seed;
use crate::search::{Found, Score};
use crate::trajectory::Profile;

/// Step of the reach sets that have one, where the scenario names none, s: the paper's.
const STEP: f64 = 1.0;

/// A trajectory that a graph gave.
#[derive(Debug, Clone)]
pub(super) struct Plan {
    pub(super) waypoints: Vec<Point3<f64>>,
    pub(super) leg_times: Vec<f64>,
    pub(super) score: f64,
    pub(super) bound: Option<f64>,
    pub(super) evidence: Evidence,
    pub(super) certified: Option<&'static str>,
    pub(super) profile: Option<Profile>,
}

/// What one unit of work gave.
#[derive(Debug, Clone, Default)]
pub(super) struct Outcome {
    /// Number of the graph, plan.
    pub(super) plans: Vec<(u64, Plan)>,
    pub(super) graphs: u64,
    pub(super) proven_empty: u64,
    pub(super) expansions: u64,
    pub(super) dropped: u64,
    pub(super) duplicates: u64,
    /// Why there is no plan.
    pub(super) reason: Option<String>,
}

impl Outcome {
    pub(super) fn add(&mut self, other: Outcome) {
        self.plans.extend(other.plans);
        self.graphs += other.graphs;
        self.proven_empty += other.proven_empty;
        self.expansions += other.expansions;
        self.dropped += other.dropped;
        self.duplicates += other.duplicates;
        self.reason = other.reason;
    }
}

/// The part of a search that is the same for every graph.
pub(super) struct Solver<'a> {
    setup: &'a Setup,
    set: Set,
    step: f64,
}

enum Set {
    Everywhere(Everywhere),
    Sphere(Sphere),
    Hull(Box<Hull>),
}

impl<'a> Solver<'a> {
    /// Builds the reach set that the scenario asks for.
    ///
    /// # Errors
    /// Why there is none, in a sentence's part; also where the planned duration alone is beyond its limit.
    pub(super) fn new(setup: &'a Setup) -> Result<Self, String> {
        let generate = &setup.scenario.generate;
        let step = match generate.timing {
            Some(Timing { step_s: Some(step), .. }) => step,
            _ => STEP,
        };
        let robot = &setup.robot;
        let settings = HullSettings { resolution: generate.resolution as usize, step };
        let set = match generate.reach {
            ReachName::None => Set::Everywhere(Everywhere),
            ReachName::Sphere => Set::Sphere(Sphere { radius: robot.max_speed * step }),
            ReachName::Hull => Set::Hull(Box::new(Hull::new(robot, &settings).map_err(|error| error.to_string())?)),
            ReachName::Published => {
                Set::Hull(Box::new(Hull::published(robot, &settings).map_err(|error| error.to_string())?))
            }
            ReachName::Witness => return Err("not yet".into()),
        };
        if let Some(limit) = generate.limits.max_flight_time_s {
            let planned = (setup.scenario.task.length - 1) as f64 * step;
            if planned > limit {
                return Err(format!(
                    "{} legs of {step} s take {planned} s > {limit} s",
                    setup.scenario.task.length - 1
                ));
            }
        }
        Ok(Self { setup, set, step })
    }

    /// Searches graph number `graph`.
    pub(super) fn solve(&self, graph: u64) -> Outcome {
        let points = match graph::sample(self.setup, graph) {
            Ok(points) => points,
            Err(error) => return Outcome { graphs: 1, reason: Some(error.to_string()), ..Outcome::default() },
        };
        match &self.set {
            Set::Everywhere(set) => self.stepwise(set, graph, &points, |_, _| true),
            Set::Sphere(set) => {
                let (radius, end) = (set.radius, points[points.len() - 1]);
                let near = |node: &StepNode, steps: usize| {
                    (end - points[node.current as usize]).norm() <= radius * steps as f64 + 1e-9
                };
                self.stepwise(set, graph, &points, near)
            }
            Set::Hull(hull) => {
                let end = points[points.len() - 1].coords;
                let average = self.average_velocity();
                let may_arrive = |node: &StepNode, steps: usize| {
                    let here = points[node.current as usize].coords;
                    !average
                        || hull.may_reach(&here, &(here - points[node.previous as usize].coords), &end, steps as u32)
                };
                self.stepwise(hull.as_ref(), graph, &points, may_arrive)
            }
        }
    }

    fn average_velocity(&self) -> bool {
        self.setup.scenario.generate.estimate.velocity == EstimatedVelocity::Average
    }

    /// Speed that scores 1, m/s: the farthest sampled end ÷ step where ends are sampled, else the robot's top speed.
    fn top_speed(&self) -> f64 {
        match &self.set {
            Set::Hull(hull) => hull.farthest() / self.step,
            _ => self.setup.robot.max_speed,
        }
    }

    fn stepwise<S: StepSet>(
        &self,
        set: &S,
        graph: u64,
        points: &[Point3<f64>],
        may_arrive: impl Fn(&StepNode, usize) -> bool,
    ) -> Outcome {
        let limits = &self.setup.scenario.generate.limits;
        let settings = StepSettings {
            step: self.step,
            average_velocity: self.average_velocity(),
            max_speed: limits.max_speed_m_s.unwrap_or(f64::INFINITY),
        };
        let reach = StepReach::new(set, points, settings);
        let start = StepNode { previous: 0, current: 0 };
        let answer = if self.setup.world.obstacles().is_empty() {
            self.ask(graph, points, &reach, start, may_arrive)
        } else {
            let clear = RefCell::new(PairMask::new(points.len()));
            let radius = self.setup.robot.clearance_radius;
            let keep = |from: &StepNode, leg: &Leg<StepNode>| {
                clear.borrow_mut().allows(from.current, leg.waypoint, || {
                    let (a, b) = (&points[from.current as usize], &points[leg.waypoint as usize]);
                    self.setup.world.segment_distance(a, b) >= radius
                })
            };
            self.ask(graph, points, &Filtered { inner: reach, keep }, start, may_arrive)
        };
        let evidence = match self.set {
            Set::Hull(_) => Evidence::HullFeasible,
            _ => Evidence::Unchecked,
        };
        self.outcome(graph, answer, |found| {
            let waypoints = found.waypoints.iter().map(|&index| points[index as usize]).collect();
            Some(Plan {
                waypoints,
                leg_times: found.leg_times,
                score: found.score,
                bound: None,
                evidence,
                certified: None,
                profile: None,
            })
        })
    }

    fn ask<N: Copy + Eq + Ord + Hash, R: Reach<N>>(
        &self,
        graph: u64,
        points: &[Point3<f64>],
        reach: &R,
        start: N,
        may_arrive: impl Fn(&N, usize) -> bool,
    ) -> Answer<N> {
        let seed = named_seed(self.setup.scenario.seed, "score", graph);
        // The name was checked with the scenario, and top speeds are > 0 with the robot.
        let score =
            Score::named(&self.setup.scenario.generate.score, seed, self.top_speed()).unwrap_or(Score::Random { seed });
        let draws = named_seed(self.setup.scenario.seed, "uniform", graph);
        let question = Question { scenario: &self.setup.scenario, points, reach, start, score, seed: draws };
        search(&question, may_arrive)
    }
}

impl Solver<'_> {
    /// Turns what a search found into plans; `plan` gives `None` for what breaks a limit of whole trajectories.
    fn outcome<N>(&self, graph: u64, answer: Answer<N>, plan: impl Fn(Found<N>) -> Option<Plan>) -> Outcome {
        let found = answer.found.len();
        let plans: Vec<(u64, Plan)> = answer
            .found
            .into_iter()
            .filter_map(plan)
            .map(|plan| (graph, Plan { bound: answer.bound, ..plan }))
            .collect();
        let too_long = (plans.is_empty() && found > 0).then(|| "the flight time limit is exceeded".to_string());
        Outcome {
            plans,
            graphs: 1,
            proven_empty: answer.proven_empty.into(),
            expansions: answer.expansions,
            dropped: answer.dropped,
            duplicates: answer.duplicates,
            reason: answer.reason.or(too_long),
        }
    }
}
