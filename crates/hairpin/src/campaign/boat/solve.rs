//! One graph, from its number to its plans: waypoints drawn in free water, their roadmap, the search asked for.

use nalgebra::Point3;

use super::BoatSetup;
use super::legs::scores;
use super::through::{is_free, through};
use crate::campaign::Stop;
use crate::campaign::graph::{Executions, Looped, Outcome, Plan, Remembered, Roads, Wanted, Witnessed, between};
use crate::campaign::kind::Solver;
use crate::feasibility::boat::{BoatJudge, BoatRoadmap, BoatRoadmapSettings};
use crate::feasibility::reach::WitnessLegs;
use crate::feasibility::reach::mend::mend_over;
use crate::feasibility::reach::wander::{Wandered, wander};
use crate::feasibility::steering::LegTiming;
use crate::math::random::{Stream, named_seed, stream, unit};
use crate::trajectory::Profile;

/// Draws for each waypoint, at most.
///
/// They are of all waypoints together: waypoints · 1000 draws.
const TRIES: u64 = 1000;

/// The part of a search that is the same for every graph.
///
/// Graph k depends on the scenario's seed and k alone: waypoints from the stream `graph`, velocities from `roadmap`.
pub(super) struct BoatSolver<'a> {
    setup: &'a BoatSetup,
    judge: BoatJudge,
    timing: LegTiming,
    /// Of the graphs that rounds come back to.
    remembered: Remembered<WitnessLegs>,
}

impl<'a> BoatSolver<'a> {
    /// # Errors
    /// A planned duration that alone is beyond its limit, in a sentence's part.
    pub(super) fn new(setup: &'a BoatSetup) -> Result<Self, String> {
        let (timing, legs) = (setup.timing(), setup.scenario.task.length - 1);
        let shortest = timing.range().0;
        let longest = setup.longest();
        if legs as f64 * shortest > longest {
            return Err(format!("{legs} legs of at least {shortest} s take longer than max_time_s = {longest}"));
        }
        Ok(Self { setup, judge: setup.judge(), timing, remembered: Remembered::default() })
    }

    /// The waypoints of graph number `graph`: index 0 the start, the last the end, free ones between.
    ///
    /// # Errors
    /// Too little free water.
    ///
    /// Uniform over the waters, those taken where the hull's disc is free; [`TRIES`] draws per waypoint on the whole.
    pub(super) fn sample(&self, graph: u64) -> Result<Vec<Point3<f64>>, String> {
        let (task, world) = (&self.setup.scenario.task, &self.setup.scenario.world);
        let wanted = self.setup.scenario.generate.search.waypoints;
        let mut random = stream(named_seed(self.setup.scenario.seed, "graph", graph));
        let [[x0, y0], [x1, y1]] = [task.start_m, task.end_m];
        let mut points = vec![Point3::new(x0, y0, 0.0)];
        let drawn = |random: &mut _| {
            let [x, y] = [0, 1].map(|axis| unit(random) * world.size_m[axis]);
            Point3::new(x, y, 0.0)
        };
        let tries = (0..wanted * TRIES).map(|_| drawn(&mut random));
        points.extend(tries.filter(|point| is_free(self.setup, point)).take(wanted as usize));
        if points.len() as u64 <= wanted {
            let found = points.len() - 1;
            return Err(format!("only {found} of {wanted} waypoints found room in {TRIES} draws each"));
        }
        points.push(Point3::new(x1, y1, 0.0));
        Ok(points)
    }

    /// The states of graph number `graph` over `points`.
    ///
    /// Velocities are drawn from the graph's seed, `velocities` of them a waypoint; both ends are at rest.
    pub(super) fn roadmap(&self, graph: u64, points: &[Point3<f64>]) -> BoatRoadmap<'_> {
        let scenario = &self.setup.scenario;
        let settings = BoatRoadmapSettings {
            velocities: scenario.generate.velocities as usize,
            timing: self.timing,
            seed: named_seed(scenario.seed, "roadmap", graph),
            current: scenario.world.current(),
        };
        BoatRoadmap::new(&self.judge, points, &settings)
    }

    /// `plan` over what `points`, as many as its own, are in the plane, passed with the velocities that it has; `None`
    /// where they are not feasible, or take longer than `generate.limits.max_time_s`.
    ///
    /// Leg times are the shortest of the ladder; where a leg has none with these velocities nothing else is tried.
    fn moved(&self, plan: &Plan, points: &[Point3<f64>]) -> Option<Plan> {
        let (points, indices) = (in_the_plane(points), (0..points.len()).collect::<Vec<_>>());
        let profile = through(&self.judge, &self.timing.rungs(), plan.witness.as_ref()?.profile()?, &indices, &points)?;
        self.in_time(points, profile)
    }

    /// The same; where velocities are in the way, other ones are chosen at what changed, and then beside it.
    fn mended(&self, plan: &Plan, points: &[Point3<f64>]) -> Option<Plan> {
        let (points, profile) = (in_the_plane(points), plan.witness.as_ref()?.profile()?);
        let profile = mend_over(&self.judge, &self.timing, profile, &plan.waypoints, &points)?;
        self.in_time(points, profile)
    }

    fn in_time(&self, points: Vec<Point3<f64>>, profile: Profile) -> Option<Plan> {
        (profile.duration() <= self.setup.longest()).then(|| Plan::witnessed(points, profile))
    }

    /// Legs that were judged are kept for the next round of an adaptive campaign, within a bound of memory.
    fn search(&self, graph: u64, points: &[Point3<f64>], looped: Looped) -> Outcome {
        let scenario = &self.setup.scenario;
        let mut roadmap = self.roadmap(graph, points);
        if let Some(legs) = self.remembered.take(graph) {
            roadmap = roadmap.knowing(legs);
        }
        let (score, also) = scores(self.setup, graph, self.judge.top_speed(), &looped);
        let asked = Witnessed {
            search: &scenario.generate.search,
            length: scenario.task.length,
            longest: self.setup.longest(),
            seed: (scenario.seed, graph),
            points,
            score,
            also,
            looped,
        };
        let outcome = asked.solve(Roads {
            reach: &roadmap,
            start: roadmap.start(),
            may_arrive: &|node, steps| roadmap.may_arrive(node, steps),
            profile: &|nodes| roadmap.profile(nodes).ok(),
        });
        if matches!(looped.wanted, Wanted::Round(_)) {
            let legs = roadmap.into_legs();
            let bytes = legs.bytes();
            self.remembered.keep(graph, legs, bytes);
        }
        outcome
    }
}

/// Waypoints on the water: searches move them in space.
fn in_the_plane(points: &[Point3<f64>]) -> Vec<Point3<f64>> {
    points.iter().map(|point| Point3::new(point.x, point.y, 0.0)).collect()
}

impl Solver for BoatSolver<'_> {
    fn solve(&self, graph: u64, executions: Executions, wanted: Wanted, stop: &Stop) -> Outcome {
        match self.sample(graph) {
            Ok(points) => {
                let moved = |plan: &Plan, points: &[Point3<f64>]| self.moved(plan, points);
                let over = stop.cancelled;
                self.search(graph, &points, Looped { executions, surroundings: None, moved: &moved, wanted, over })
            }
            Err(reason) => Outcome { graphs: 1, reason: Some(reason), ..Outcome::default() },
        }
    }

    fn takes_scores(&self) -> bool {
        true
    }

    fn draw(&self, graph: u64, _: &Stop) -> Result<Plan, String> {
        let points = self.sample(graph)?;
        let mut random = stream(named_seed(self.setup.scenario.seed, "wander", graph));
        let length = self.setup.scenario.task.length as usize;
        let drawn = wander(&self.judge, &points, &self.timing, length, &mut random);
        let Wandered { waypoints, profile } = drawn.ok_or("none was met by drawing leg by leg")?;
        if profile.duration() > self.setup.longest() {
            return Err("`max_time_s` is exceeded".into());
        }
        Ok(Plan::witnessed(waypoints, profile))
    }

    fn drawn_how(&self) -> &'static str {
        "leg by leg, each witnessed leg equally likely"
    }

    fn over(&self, _: u64, plan: &Plan, points: &[Point3<f64>]) -> Option<Plan> {
        self.mended(plan, points)
    }

    fn elsewhere(&self, graph: u64, random: &mut Stream) -> Option<Point3<f64>> {
        Some(between(&self.sample(graph).ok()?, random))
    }
}
