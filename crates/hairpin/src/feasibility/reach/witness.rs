//! `witness`: a roadmap of waypoint states, whose legs each have a control witness.
//!
//! Nodes are (waypoint, velocity): rest at start and end, M velocities elsewhere. n waypoints make up to (n M)² legs,
//! judged lazily, once each. Sound for the model, complete for nothing: a leg that no rung of times allows may be
//! flyable by another curve.

#[cfg(feature = "unit-tests")]
mod tests;

use std::cell::OnceCell;

use nalgebra::{Point3, Vector3};
use rand::RngExt;

use super::proven_legs::{ProveLegs, WitnessLegs, WitnessNode};
use super::states::{States, Velocities};
use super::wander::another;
use super::{Entry, Leg, Reach};
use crate::feasibility::limits::Infeasible;
use crate::feasibility::steering::eight_ends::Ends;
use crate::feasibility::steering::firsts::{Asked, in_lanes};
use crate::feasibility::steering::{LegEnd, LegJudge, LegTiming};
use crate::math::random::Stream;
use crate::trajectory::{Profile, ProfileLeg};

/// How a roadmap is drawn.
///
/// More velocities find more, at the square of their number.
///
/// The default: 8 velocities, leg times from 0.8 s to 4 s.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RoadmapSettings {
    /// Velocities per waypoint, M; 0 is taken as 1.
    pub velocities: usize,
    /// Leg times.
    pub timing: LegTiming,
    /// Seed of the velocities.
    pub seed: u64,
}

impl Default for RoadmapSettings {
    fn default() -> Self {
        Self { velocities: 8, timing: LegTiming::ladder(0.8, 4.0), seed: 0 }
    }
}

/// A leg of the roadmap between two states, without what scores see.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RoadmapLeg {
    /// Waypoint and velocity left.
    pub from: (u32, u32),
    /// Waypoint and velocity reached.
    pub to: (u32, u32),
    /// Planned duration, s.
    pub duration: f64,
}

/// The waypoint states of one graph and the legs between them, judged when first asked for and kept. One graph is one
/// task on one thread.
///
/// State (waypoint, velocity): level, without rates, with the acceleration and jerk that this velocity asks for there.
/// A leg is the polynomial of degree 7 between two states at the shortest rung of times for which [`LegJudge::judge`]
/// proves it.
#[derive(Debug)]
pub struct Roadmap<'a> {
    states: States<'a, LegJudge>,
    /// Distance of every waypoint to the nearest from which the end is one leg away, m.
    approach: OnceCell<Vec<f64>>,
}

impl ProveLegs for LegJudge {
    type End = LegEnd;
    type Lanes = Vec<Ends>;
    type Why = Infeasible;

    fn leg(&self, from: &LegEnd, to: &LegEnd, duration: f64) -> Result<ProfileLeg, Infeasible> {
        self.judge(from, to, duration)
    }

    fn lanes(states: &[LegEnd]) -> Vec<Ends> {
        in_lanes(states)
    }

    fn firsts(
        &self,
        from: &LegEnd,
        to: (&[LegEnd], &[Vec<Ends>]),
        asked: &[Asked],
        durations: &[f64],
        found: impl FnMut(usize, usize),
    ) {
        self.firsts(from, to, asked, durations, found);
    }

    fn possible(
        &self,
        from: &LegEnd,
        to: (&[LegEnd], &[Vec<Ends>]),
        asked: &[Asked],
        durations: &[f64],
        found: impl FnMut(usize, usize),
    ) {
        self.possible(from, to, asked, durations, found);
    }

    fn fastest(&self) -> f64 {
        self.limits().max_speed
    }

    fn top_speed(&self) -> f64 {
        self.top_speed()
    }

    fn speed(end: &LegEnd) -> f64 {
        end.velocity.norm()
    }

    fn state(&self, place: &Point3<f64>, velocity: &Vector3<f64>) -> LegEnd {
        self.end(*place, *velocity)
    }

    /// Towards a waypoint that a leg at that speed can reach.
    fn aimed(&self, points: &[Point3<f64>], w: usize, speed: f64, longest: f64, random: &mut Stream) -> Vector3<f64> {
        let towards = points[another(points, w, speed * longest, random)] - points[w];
        towards.try_normalize(1e-9).unwrap_or_else(Vector3::zeros) * speed
    }
}

impl<'a> Roadmap<'a> {
    /// The roadmap over `points`: index 0 the start, the last the end, both at rest; every other waypoint gets M
    /// velocities.
    ///
    /// Velocity k of a waypoint has a speed drawn from the k-th of M equal parts of [0, top speed] and points towards a
    /// waypoint drawn from those that a leg at that speed can reach (the nearest one if there is none).
    ///
    /// `points` in m, two or more. Nothing is judged yet. Each waypoint draws from its own stream, so that adding
    /// waypoints behind changes no velocity's speed.
    pub fn new(judge: &'a LegJudge, points: &[Point3<f64>], settings: &RoadmapSettings) -> Self {
        let velocities = Velocities {
            many: settings.velocities,
            seed: (settings.seed, "waypoint velocities"),
            timing: settings.timing,
        };
        let longest = settings.timing.range().1;
        let at_rest = |point: &Point3<f64>| judge.end(*point, Vector3::zeros());
        let moving = |w: usize, speed: f64, random: &mut Stream| {
            let towards = target(points, w, speed * longest, random.random_range(0.0..1.0));
            let direction = (points[towards] - points[w]).try_normalize(1e-9).unwrap_or_else(Vector3::zeros);
            judge.end(points[w], direction * speed)
        };
        Self { states: States::new(judge, points, &velocities, at_rest, moving), approach: OnceCell::new() }
    }

    /// The same, with `legs` of one that was drawn alike.
    ///
    /// Drawn alike: the same judge, points and settings.
    ///
    /// # Panics
    /// If it has another number of states.
    pub fn knowing(self, legs: WitnessLegs) -> Self {
        Self { states: self.states.knowing(legs), ..self }
    }

    /// The legs that were judged.
    pub fn into_legs(self) -> WitnessLegs {
        self.states.into_legs()
    }

    /// The node at rest at the start.
    pub fn start(&self) -> WitnessNode {
        self.states.start()
    }

    /// Number of waypoint states.
    pub fn states(&self) -> usize {
        self.states.all().len()
    }

    /// Velocity of a node, m/s.
    pub fn velocity(&self, node: &WitnessNode) -> Vector3<f64> {
        self.states.all()[self.states.number(node)].velocity
    }

    /// Number of legs between all states; judges every leg that was not asked for yet.
    ///
    /// (n M)² judgements at worst.
    pub fn legs_count(&self) -> usize {
        (0..self.states()).map(|state| self.states.kept_legs(state).len()).sum()
    }

    /// All legs, ordered by the state they leave and the state they reach.
    pub fn all_legs(&self) -> Vec<RoadmapLeg> {
        let mut out = Vec::with_capacity(self.legs_count());
        for state in 0..self.states() {
            let from = self.states.place(state as u32);
            for leg in self.states.kept_legs(state).iter() {
                let (to, duration) = (self.states.place(leg.state), self.states.rungs()[leg.rung as usize]);
                out.push(RoadmapLeg { from, to, duration });
            }
        }
        out
    }

    /// A necessary test for searches: false only if no `steps` legs lead from `node` to the end.
    ///
    /// One step is judged exactly, so a search needs no lookahead of its own, which would judge the legs of every state
    /// near the end; more steps must bring the robot, at no more than the speed limit and the longest leg time each, to
    /// a waypoint from which the end is one leg away.
    pub fn may_arrive(&self, node: &WitnessNode, steps: usize) -> bool {
        self.states.may_arrive(node, steps, || {
            let approach = self.approach.get_or_init(|| self.find_approach());
            let fastest = self.states.judge().limits().max_speed;
            approach[node.waypoint as usize] <= (steps - 1) as f64 * self.states.longest() * fastest
        })
    }

    /// What every candidate for a leg from `from` is, a state of another waypoint each: its node, or why it is none;
    /// `None` where the straight line alone takes longer at the speed limit than the longest leg may.
    ///
    /// The evidence is that of the leg time nearest to what the line takes at the mean of the speeds at both ends.
    ///
    /// For telling why nothing was found: every refused candidate is judged once more.
    pub fn candidates(&self, from: &WitnessNode) -> Vec<Result<WitnessNode, Option<Infeasible>>> {
        self.states.candidates(from, |here, there, least| {
            let speed = 0.5 * (here.velocity.norm() + there.velocity.norm());
            let usual = (there.position - here.position).norm() / speed.max(f64::MIN_POSITIVE);
            let nearest = |a: &&f64, b: &&f64| (**a - usual).abs().total_cmp(&(**b - usual).abs());
            let possible = self.states.rungs().iter().filter(|rung| **rung >= least);
            possible.min_by(nearest).copied().unwrap_or(self.states.longest())
        })
    }

    /// The trajectory over `nodes` as polynomials, built once for what is returned.
    ///
    /// Legs are judged again, since only their rungs are kept. Velocity and, for the model, acceleration and jerk agree
    /// where legs meet.
    ///
    /// # Errors
    /// Why two successive nodes are no leg: the evidence of the longest leg time.
    pub fn profile(&self, nodes: &[WitnessNode]) -> Result<Profile, Infeasible> {
        self.states.profile(nodes)
    }

    /// Infinite where no waypoint has a leg to the end.
    fn find_approach(&self) -> Vec<f64> {
        let (arrivals, points) = (self.states.arrivals(), self.states.points());
        let near: Vec<Point3<f64>> = (0..points.len())
            .filter(|w| self.states.of(*w).any(|state| arrivals[state as usize]))
            .map(|w| points[w])
            .collect();
        let nearest = |p: &Point3<f64>| near.iter().map(|q| (q - p).norm()).fold(f64::INFINITY, f64::min);
        points.iter().map(nearest).collect()
    }
}

/// The waypoint that a velocity at `own` points to: number ⌊`draw`·n⌋ of the n others within `radius`, or the nearest.
fn target(points: &[Point3<f64>], own: usize, radius: f64, draw: f64) -> usize {
    let distance = |w: usize| (points[w] - points[own]).norm();
    let near: Vec<usize> = (0..points.len()).filter(|w| *w != own && distance(*w) <= radius).collect();
    if near.is_empty() {
        let others = (0..points.len()).filter(|w| *w != own);
        return others.min_by(|a, b| distance(*a).total_cmp(&distance(*b))).unwrap_or(own);
    }
    near[((draw * near.len() as f64) as usize).min(near.len() - 1)]
}

impl Reach<WitnessNode> for Roadmap<'_> {
    fn legs(&self, from: &WitnessNode, candidates: &[Point3<f64>], out: &mut Vec<Leg<WitnessNode>>) {
        self.states.legs(from, candidates, |_, _| 0.0, out);
    }

    fn possible(&self, from: &WitnessNode, candidates: &[Point3<f64>], out: &mut Vec<Leg<WitnessNode>>) {
        self.states.possible(from, candidates, out);
    }

    fn proven(&self, from: &WitnessNode, to: &WitnessNode, _: f64) -> Option<f64> {
        self.states.proven(from, to)
    }

    fn leg(&self, from: &WitnessNode, to: &WitnessNode, candidates: &[Point3<f64>]) -> Option<Leg<WitnessNode>> {
        self.states.leg([from, to], candidates, |_, _| 0.0)
    }

    fn is_known_at_once(&self) -> bool {
        false
    }

    fn entry(&self, from: &WitnessNode) -> Option<Entry> {
        Some(Entry { state: self.states.number(from), previous: from.previous })
    }
}
