//! One graph, from its number to its plans: the reach set asked for, the search asked for, and never another.

use nalgebra::Point3;

use super::certificates::Certifier;
use super::stepwise::Stepwise;
use super::witness::Witness;
use super::{FlightSetup, graph, surround};
use crate::campaign::Stop;
use crate::campaign::graph::{Executions, Looped, Outcome, Plan, Surroundings, Wanted, between};
use crate::campaign::kind::Solver;
use crate::campaign::scenario::ReachName;
use crate::feasibility::certify::Certificate;
use crate::math::random::Stream;

/// The part of a search that is the same for every graph.
///
/// One for all graphs: a hull is sampled once, legs of witnesses are judged by one judge. Shared by threads.
pub(super) struct FlightSolver<'a> {
    setup: &'a FlightSetup,
    set: Set<'a>,
    certifier: Option<Certifier>,
}

enum Set<'a> {
    Stepwise(Stepwise<'a>),
    Witness(Box<Witness<'a>>),
}

impl<'a> FlightSolver<'a> {
    /// Builds the reach set that the scenario asks for.
    ///
    /// # Errors
    /// Why there is none, in a sentence's part; also where the planned duration alone is beyond its limit.
    ///
    /// A lower bound of any plan: (length − 1) · shortest leg time, so that a search that cannot find anything is not
    /// begun.
    pub(super) fn new(setup: &'a FlightSetup) -> Result<Self, String> {
        let generate = &setup.scenario.generate;
        let set = match generate.reach {
            ReachName::Witness => Set::Witness(Box::new(Witness::new(setup)?)),
            _ => Set::Stepwise(Stepwise::new(setup)?),
        };
        let shortest = match &set {
            Set::Stepwise(set) => set.step(),
            Set::Witness(set) => set.shortest_leg(),
        };
        let legs = setup.scenario.task.length - 1;
        if let Some(limit) = generate.limits.max_flight_time_s.filter(|limit| legs as f64 * shortest > *limit) {
            return Err(format!("{legs} legs of at least {shortest} s take longer than max_flight_time_s = {limit}"));
        }
        let wanted = generate.certify && generate.reach != ReachName::Witness;
        let certifier = if wanted { Some(Certifier::new(setup)?) } else { None };
        Ok(Self { setup, set, certifier })
    }

    /// `plan` with a certificate, if one is asked for and it has none yet.
    ///
    /// A yes raises the evidence to witnessed; no and unknown leave it.
    fn certified(&self, mut plan: Plan) -> Plan {
        if let Some(certifier) = self.certifier.as_ref().filter(|_| plan.certified.is_none()) {
            certifier.certify(&mut plan);
        }
        plan
    }

    /// `plan` over `points`, as many as its own, by the same reach set; `None` where they are not feasible. Of a
    /// witness `rewitnessed` makes the new one.
    ///
    /// Start and end stay where they are; what is in between keeps the margin from the walls and the robot's radius
    /// from obstacles. A bound that was proven is dropped, and so is a certificate.
    fn moved(
        &self,
        plan: &Plan,
        points: &[Point3<f64>],
        rewitnessed: impl Fn(&Witness) -> Option<Plan>,
    ) -> Option<Plan> {
        let FlightSetup { world, robot, .. } = self.setup;
        let inner = &points[1..points.len() - 1];
        let stands = |p: &Point3<f64>| {
            world.wall_distance(p) >= world.keep_in_margin() && world.is_free(p, robot.clearance_radius)
        };
        if !inner.iter().all(stands) {
            return None;
        }
        match &self.set {
            Set::Stepwise(set) => {
                let clear =
                    points.windows(2).all(|leg| world.segment_distance(&leg[0], &leg[1]) >= robot.clearance_radius);
                let seen = set.follows(points).filter(|_| clear)?;
                let (waypoints, certified, witness) = (points.to_vec(), None, None);
                Some(Plan { waypoints, seen, bound: None, certified, witness, ..plan.clone() })
            }
            Set::Witness(set) => rewitnessed(set),
        }
    }

    /// The same, with all velocities chosen anew for the whole sequence.
    ///
    /// What the loop's shift asks: waypoints and all velocities with them. Dearer than [`Solver::over`], which mends.
    ///
    /// Of a witness a certificate is asked, and a yes alone is a plan.
    fn moved_whole(&self, plan: &Plan, points: &[Point3<f64>]) -> Option<Plan> {
        self.moved(plan, points, |set| {
            let Certificate::Yes(profile) = set.through(points) else { return None };
            Some(Plan::witnessed(points.to_vec(), profile))
        })
    }
}

impl Solver for FlightSolver<'_> {
    fn solve(&self, graph: u64, executions: Executions, wanted: Wanted, stop: &Stop) -> Outcome {
        let points = match graph::sample(self.setup, graph) {
            Ok(points) => points,
            Err(error) => return Outcome { graphs: 1, reason: Some(error.to_string()), ..Outcome::default() },
        };
        let asked = self.setup.scenario.generate.environment;
        let bound = |place: &mut [f64]| asked.iter().for_each(|asked| surround::bound(asked, place));
        let put = |plan: &Plan, place: &[f64], duration: f64| match &asked {
            Some(asked) => surround::put(asked, plan, place, duration),
            None => plan.clone(),
        };
        let surroundings = asked.map(|asked| Surroundings {
            coordinates: surround::coordinates(&asked),
            bound: &bound,
            put: &put,
            obstacles: asked.obstacles.is_some(),
        });
        // A witness leaves its straight legs: obstacles are placed beside what the case will claim.
        let furnish = |plan: &Plan| (executions.furnish)(&self.certified(plan.clone()));
        let executions = Executions { furnish: &furnish, ..executions };
        let moved = |plan: &Plan, points: &[Point3<f64>]| self.moved_whole(plan, points);
        let looped = Looped { executions, surroundings, moved: &moved, wanted, over: stop.cancelled };
        let mut outcome = match &self.set {
            Set::Stepwise(set) => set.solve(graph, &points, looped),
            Set::Witness(set) => set.solve(graph, &points, looped),
        };
        outcome.plans = outcome.plans.into_iter().map(|(graph, plan)| (graph, self.certified(plan))).collect();
        outcome
    }

    fn takes_scores(&self) -> bool {
        true
    }

    /// Step-wise sets draw uniformly over trajectories, by counting; witnesses leg by leg, as every leg must be judged.
    fn draw(&self, graph: u64, stop: &Stop) -> Result<Plan, String> {
        let points = graph::sample(self.setup, graph).map_err(|error| error.to_string())?;
        match &self.set {
            Set::Stepwise(set) => set.draw(graph, &points, stop),
            Set::Witness(set) => set.draw(graph, &points),
        }
    }

    fn drawn_how(&self) -> &'static str {
        match &self.set {
            Set::Stepwise(_) => "each feasible trajectory of a sampled graph equally likely",
            Set::Witness(_) => "leg by leg, each witnessed leg equally likely",
        }
    }

    fn over(&self, _: u64, plan: &Plan, points: &[Point3<f64>]) -> Option<Plan> {
        self.moved(plan, points, |set| set.over(plan, points))
    }

    fn elsewhere(&self, graph: u64, random: &mut Stream) -> Option<Point3<f64>> {
        Some(between(&graph::sample(self.setup, graph).ok()?, random))
    }

    /// Of step-wise sets the joined sequence is asked as a whole.
    fn crossed(&self, graph: u64, plan: &Plan, other: &Plan, leg: usize, _: &mut Stream) -> Option<Plan> {
        match &self.set {
            Set::Stepwise(_) => self.over(graph, plan, &plan.spliced(other, leg)?),
            Set::Witness(set) => set.crossed(plan, other, leg),
        }
    }

    /// Nothing where nobody reads velocities and times of a plan: it would be the same mission again.
    fn altered(&self, plan: &Plan, leg: usize, random: &mut Stream) -> Option<Plan> {
        match &self.set {
            Set::Witness(set) if self.setup.reads_the_plan() => set.altered(plan, leg, random),
            _ => None,
        }
    }

    fn finished(&self, plan: Plan) -> Plan {
        self.certified(plan)
    }
}
