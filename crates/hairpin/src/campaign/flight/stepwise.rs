//! Reach sets with one fixed step per leg: `none`, `sphere`, `hull`, `published`, and `hull` with a state carried over
//! the waypoint.
//!
//! Legs are straight and take one step each; the state at a waypoint is what the scenario's estimate says. Obstacles
//! are tested against the straight leg, grown by the robot's radius.
//!
//! ```text
//! none        every waypoint
//! sphere      ‖b − a‖ ≤ v_max T
//! hull        b − a − v φ(T) within the hull of the ends of runs of T at constant rotor speeds, from level rest
//! published   the same with ends by one Euler step
//! carried     the same from attitudes and rates that an earlier leg may have left
//! ```
//!
//! v is the velocity that is assumed where the leg begins: the one before over T, or none (`estimate.velocity`); φ(T)
//! is how far a unit of it carries against the linear drag, s. With a speed limit a leg is no longer than limit · T.

use std::cell::RefCell;
use std::collections::HashSet;
use std::hash::Hash;

use nalgebra::Point3;

use super::FlightSetup;
use super::blocking::blocking;
use super::legs::scores;
use crate::campaign::graph::{
    Counter, Executions, Explored, Looped, Outcome, Plan, Question, Round, Stage, Wanted, in_order, search,
};
use crate::campaign::scenario::{EstimatedAttitude, EstimatedRates, EstimatedVelocity, ReachName};
use crate::campaign::{Evidence, SeenLeg, Stop};
use crate::feasibility::reach::{
    BruteForce, BruteForceSettings, CarriedNode, Everywhere, Filtered, Hull, HullSettings, Leg, PairMask, Reach,
    Sphere, StepNode, StepReach, StepSet, StepSettings,
};
use crate::math::random::named_seed;
use crate::search::Found;

/// Steps from the end within which the beam knows exactly whether the end can be reached: cheap where legs are.
/// Hulls are translated, so that a leg costs half-space tests only.
///
/// Beyond it the beam has only the necessary test of distances.
const LOOKAHEAD: usize = 3;

/// One graph, and what a search in the loop asks.
#[derive(Clone, Copy)]
struct Asked<'a> {
    graph: u64,
    points: &'a [Point3<f64>],
    looped: Looped<'a>,
}

/// The number of `Carried` is the farthest end of the plain hull, m, which scores are scaled by.
enum Set {
    Everywhere(Everywhere),
    Sphere(Sphere),
    Hull(Box<Hull>),
    /// The hull from every state that a leg before may have left, and how far its samples reach.
    Carried(Box<BruteForce>, f64),
}

/// Whether the end lies within so many steps of the sphere.
///
/// |end − p| ≤ steps · radius, 10⁻⁹ m for rounding: necessary for the end to be reached.
///
/// O(1). The velocity that a leg before leaves is not looked at.
fn set_near(set: &Sphere, points: &[Point3<f64>], node: &StepNode, steps: usize) -> bool {
    (points[points.len() - 1] - points[node.current as usize]).norm() <= set.radius * steps as f64 + 1e-9
}

/// A step-wise reach set and what it assumes.
///
/// `settings` carry step, estimate and speed limit into the reach set.
pub(super) struct Stepwise<'a> {
    setup: &'a FlightSetup,
    set: Set,
    settings: StepSettings,
}

impl<'a> Stepwise<'a> {
    /// # Errors
    /// Why there is no such set, in a sentence's part.
    ///
    /// A hull is sampled here: resolution⁴ runs.
    ///
    /// Cost: resolution⁴ simulated runs of four rotors, 20 736 at the largest resolution of 12; `carried` samples a
    /// second time, and later from every state that comes up.
    pub(super) fn new(setup: &'a FlightSetup) -> Result<Self, String> {
        let generate = &setup.scenario.generate;
        let step = generate.timing_in_force().step_s.ok_or("`timing.step_s` is missing")?;
        let robot = &setup.robot;
        let hull = HullSettings { resolution: generate.resolution as usize, step, simd: setup.simd };
        let settings = StepSettings {
            step,
            average_velocity: generate.estimate.velocity == EstimatedVelocity::Average,
            max_speed: generate.limits.max_speed_m_s.unwrap_or(f64::INFINITY),
            simd: setup.simd,
        };
        let keep_attitude = generate.estimate.attitude == EstimatedAttitude::Keep;
        let keep_rates = generate.estimate.rates == EstimatedRates::Keep;
        let set = match generate.reach {
            ReachName::None => Set::Everywhere(Everywhere),
            ReachName::Sphere => Set::Sphere(Sphere { radius: robot.max_speed * step }),
            ReachName::Hull if keep_attitude || keep_rates => {
                let farthest = Hull::new(robot, &hull).map_err(|error| error.to_string())?.farthest();
                let settings = BruteForceSettings {
                    hull,
                    step: settings,
                    keep_attitude,
                    keep_rates,
                    ..BruteForceSettings::default()
                };
                let reach = BruteForce::new(robot, settings).map_err(|error| error.to_string())?;
                Set::Carried(Box::new(reach), farthest)
            }
            ReachName::Published => Set::Hull(Box::new(Hull::published(robot, &hull).map_err(|e| e.to_string())?)),
            _ => Set::Hull(Box::new(Hull::new(robot, &hull).map_err(|error| error.to_string())?)),
        };
        Ok(Self { setup, set, settings })
    }

    /// Duration of every leg, s.
    pub(super) fn step(&self) -> f64 {
        self.settings.step
    }

    /// Searches graph number `graph` over `points`.
    ///
    /// `points`: start first, end last, m.
    pub(super) fn solve(&self, graph: u64, points: &[Point3<f64>], looped: Looped) -> Outcome {
        let asked = Asked { graph, points, looped };
        match &self.set {
            Set::Everywhere(set) => self.bound(set, asked, |_, _| true),
            Set::Sphere(set) => self.bound(set, asked, |node, steps| set_near(set, points, node, steps)),
            Set::Hull(hull) => {
                self.bound(hull.as_ref(), asked, |node, steps| self.hull_near(hull, points, node, steps))
            }
            Set::Carried(reach, _) => {
                let start = CarriedNode { previous: 0, current: 0, carried: [0; 6] };
                self.clear_of_obstacles(asked, reach.as_ref(), start, |node| node.current, |_, _| true)
            }
        }
    }

    /// A plan of graph number `graph` over `points`, each of them equally likely.
    ///
    /// # Errors
    /// Why there is none, in a sentence's part.
    ///
    /// Exactly uniform: by counting walks, as the method `uniform` does.
    ///
    /// A round of one draw and no optima. The reason where nothing is drawn is the search's own.
    pub(super) fn draw(&self, graph: u64, points: &[Point3<f64>], stop: &Stop) -> Result<Plan, String> {
        let known = HashSet::new();
        let round = Round { number: 0, place: 0, optima: 0, by_hand: 0, draws: 1, models: &[], known: &known };
        let wanted = Wanted::Round(&round);
        let (executions, over) = (Executions::none(), stop.cancelled);
        let looped = Looped { executions, surroundings: None, moved: &|_, _| None, wanted, over };
        let Outcome { plans, reason, .. } = self.solve(graph, points, looped);
        let drawn = plans.into_iter().next().map(|(_, plan)| plan);
        drawn.ok_or_else(|| reason.unwrap_or_else(|| "no feasible trajectory was drawn".into()))
    }

    /// The legs from each of `points` to the one after it, the first from rest; `None` where one is not feasible.
    ///
    /// World and obstacles are not asked here.
    pub(super) fn follows(&self, points: &[Point3<f64>]) -> Option<Vec<SeenLeg>> {
        let start = StepNode { previous: 0, current: 0 };
        match &self.set {
            Set::Everywhere(set) => in_order(StepReach::new(set, points, self.settings), start, points),
            Set::Sphere(set) => in_order(StepReach::new(set, points, self.settings), start, points),
            Set::Hull(hull) => in_order(StepReach::new(hull.as_ref(), points, self.settings), start, points),
            Set::Carried(reach, _) => {
                in_order(reach.as_ref(), CarriedNode { previous: 0, current: 0, carried: [0; 6] }, points)
            }
        }
    }

    /// Whether the hull, so many steps long, still holds the end.
    ///
    /// Necessary as well; always true where waypoints are left at rest, as then nothing is carried over.
    fn hull_near(&self, hull: &Hull, points: &[Point3<f64>], node: &StepNode, steps: usize) -> bool {
        let (here, before) = (points[node.current as usize], points[node.previous as usize]);
        let end = points[points.len() - 1];
        !self.settings.average_velocity || hull.may_reach(&here.coords, &(here - before), &end.coords, steps as u32)
    }

    /// Counts what becomes of the candidates for legs near the start of a graph.
    pub(super) fn count(&self, points: &[Point3<f64>], counter: &mut Counter) {
        let start = StepNode { previous: 0, current: 0 };
        let place = |node: &StepNode| node.current;
        match &self.set {
            Set::Everywhere(set) => {
                self.count_by(StepReach::new(set, points, self.settings), start, place, points, |_, _| true, counter);
            }
            Set::Sphere(set) => {
                let near = |node: &StepNode, steps: usize| set_near(set, points, node, steps);
                self.count_by(StepReach::new(set, points, self.settings), start, place, points, near, counter);
            }
            Set::Hull(hull) => {
                let near = |node: &StepNode, steps: usize| self.hull_near(hull, points, node, steps);
                let reach = StepReach::new(hull.as_ref(), points, self.settings);
                self.count_by(reach, start, place, points, near, counter);
            }
            Set::Carried(reach, _) => {
                let start = CarriedNode { previous: 0, current: 0, carried: [0; 6] };
                self.count_by(reach.as_ref(), start, |node| node.current, points, |_, _| true, counter);
            }
        }
    }

    /// By walls, speed, obstacle, reach and whether the end can still be reached.
    ///
    /// A candidate counts once. A leg is too fast where it is longer than the speed limit times the step.
    fn count_by<N: Copy + Eq + Hash, R: Reach<N>>(
        &self,
        reach: R,
        start: N,
        place: impl Fn(&N) -> u32,
        points: &[Point3<f64>],
        may_arrive: impl Fn(&N, usize) -> bool,
        counter: &mut Counter,
    ) {
        let length = self.setup.scenario.task.length as usize;
        let name = self.setup.scenario.generate.reach.word();
        let longest = self.settings.max_speed * self.settings.step;
        let fast = |a: usize, b: usize| {
            let limit = || (Stage::Limits, "generate.limits.max_speed_m_s".to_owned());
            ((points[b] - points[a]).norm() > longest).then(limit)
        };
        let (world, radius) = (&self.setup.world, self.setup.robot.clearance_radius);
        let blocked = |a: usize, b: usize| blocking(world, radius, &points[a], &points[b]);
        Explored { points, reach, start, length, ends: true, name }.count(place, fast, blocked, may_arrive, counter);
    }

    /// Speed that scores 1, m/s: the farthest sampled end ÷ step where ends are sampled, else the robot's top speed.
    fn top_speed(&self) -> f64 {
        match &self.set {
            Set::Hull(hull) => hull.farthest() / self.settings.step,
            Set::Carried(_, farthest) => farthest / self.settings.step,
            _ => self.setup.robot.max_speed,
        }
    }

    /// Binds a set to the graph's waypoints; the start's node has no waypoint before it.
    fn bound<S: StepSet>(&self, set: &S, asked: Asked, may_arrive: impl Fn(&StepNode, usize) -> bool) -> Outcome {
        let start = StepNode { previous: 0, current: 0 };
        let reach = StepReach::new(set, asked.points, self.settings);
        self.clear_of_obstacles(asked, reach, start, |node| node.current, may_arrive)
    }

    /// Keeps the legs whose segment is clear of obstacles by the robot's radius, and searches.
    ///
    /// Each pair of waypoints is tested against the obstacles once, when a search first asks for it.
    fn clear_of_obstacles<N: Copy + Eq + Ord + Hash, R: Reach<N>>(
        &self,
        asked: Asked,
        reach: R,
        start: N,
        place: impl Fn(&N) -> u32,
        may_arrive: impl Fn(&N, usize) -> bool,
    ) -> Outcome {
        let (world, points) = (&self.setup.world, asked.points);
        if world.obstacles().is_empty() {
            return self.ask(asked, &reach, start, may_arrive);
        }
        let clear = RefCell::new(PairMask::new(points.len()));
        let radius = self.setup.robot.clearance_radius;
        let keep = |from: &N, leg: &Leg<N>| {
            let here = place(from);
            clear.borrow_mut().allows(here, leg.waypoint, || {
                let (a, b) = (&points[here as usize], &points[leg.waypoint as usize]);
                world.segment_distance(a, b) >= radius
            })
        };
        self.ask(asked, &Filtered { inner: reach, keep }, start, may_arrive)
    }

    /// Evidence is `hull-feasible` with a hull, and none with `none` and `sphere`.
    fn ask<N: Copy + Eq + Ord + Hash, R: Reach<N>>(
        &self,
        Asked { graph, points, looped }: Asked,
        reach: &R,
        start: N,
        may_arrive: impl Fn(&N, usize) -> bool,
    ) -> Outcome {
        let evidence = match self.set {
            Set::Hull(_) | Set::Carried(..) => Evidence::HullFeasible,
            _ => Evidence::Unchecked,
        };
        let (score, also) = scores(self.setup, graph, self.top_speed(), &looped);
        let question = Question {
            search: &self.setup.scenario.generate.search,
            length: self.setup.scenario.task.length as usize,
            points,
            reach,
            start,
            score,
            seed: named_seed(self.setup.scenario.seed, "uniform", graph),
            lookahead: LOOKAHEAD,
            plan: &|found: Found<N>| Some(Plan::new(&found, points, evidence)),
            free_end: false,
            also,
            looped,
        };
        Outcome::of(graph, search(question, &may_arrive))
    }
}
