//! `witness`: a roadmap of waypoint states, whose legs each have a control witness.
//!
//! Nodes are (waypoint, velocity): rest at start and end, M velocities elsewhere. n waypoints make up to (n M)² legs,
//! judged lazily, once each. Sound for the model, complete for nothing: a leg that no rung of times allows may be
//! flyable by another curve.

#[cfg(test)]
mod tests;

use std::cell::{OnceCell, RefCell};
use std::sync::Arc;

use nalgebra::{Point3, Vector3};
use rand::RngExt;

use super::{Leg, LegFeatures, Reach};
use crate::feasibility::limits::Infeasible;
use crate::feasibility::steering::{LegEnd, LegJudge, LegTiming};
use crate::math::random::{named_seed, stream};
use crate::math::rotation::angle_between;
use crate::trajectory::Profile;

/// A node: a state of a waypoint and the waypoint before it, which the turn angle is seen from. Legs do not depend on
/// `previous`, and are kept without it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct WitnessNode {
    /// The waypoint before; equal to `waypoint` at the start.
    pub previous: u32,
    /// The current waypoint.
    pub waypoint: u32,
    /// Which of the waypoint's velocities; 0 at start and end, which have only rest.
    pub velocity: u32,
}

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

/// A judged leg: the state it leads to, and its rung.
#[derive(Debug, Clone, Copy)]
struct Judged {
    state: u32,
    rung: u32,
}

/// The legs of a [`Roadmap`] that were judged so far; they serve every roadmap that is drawn alike.
#[derive(Debug)]
pub struct WitnessLegs(Vec<Option<Arc<[Judged]>>>);

impl WitnessLegs {
    /// Memory that they take, about.
    pub fn bytes(&self) -> usize {
        let legs: usize = self.0.iter().flatten().map(|legs| legs.len()).sum();
        self.0.len() * size_of::<Option<Arc<[Judged]>>>() + legs * size_of::<Judged>()
    }
}

/// The waypoint states of one graph and the legs between them, judged when first asked for and kept. One graph is one
/// task on one thread.
///
/// State (waypoint, velocity): level, without rates, with the acceleration and jerk that this velocity asks for there.
/// A leg is the polynomial of degree 7 between two states at the shortest rung of times for which [`LegJudge::judge`]
/// proves it.
#[derive(Debug)]
pub struct Roadmap<'a> {
    judge: &'a LegJudge,
    points: Vec<Point3<f64>>,
    /// States of all waypoints, waypoint by waypoint.
    states: Vec<LegEnd>,
    /// First state of every waypoint, and the number of states.
    first: Vec<u32>,
    rungs: Vec<f64>,
    kept: RefCell<Vec<Option<Arc<[Judged]>>>>,
    /// Which states have a leg to the end.
    arrivals: OnceCell<Vec<bool>>,
    /// Distance of every waypoint to the nearest from which the end is one leg away, m.
    approach: OnceCell<Vec<f64>>,
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
        let rungs = settings.timing.rungs();
        let longest = settings.timing.range().1;
        let many = settings.velocities.max(1);
        let (mut states, mut first) = (Vec::with_capacity(points.len() * many), Vec::with_capacity(points.len() + 1));
        for (w, point) in points.iter().enumerate() {
            first.push(states.len() as u32);
            if w == 0 || w + 1 == points.len() {
                states.push(judge.end(*point, Vector3::zeros()));
                continue;
            }
            let mut random = stream(named_seed(settings.seed, "waypoint velocities", w as u64));
            for k in 0..many {
                let speed = judge.top_speed() * (k as f64 + random.random_range(0.0..1.0)) / many as f64;
                let towards = target(points, w, speed * longest, random.random_range(0.0..1.0));
                let direction = (points[towards] - point).try_normalize(1e-9).unwrap_or_else(Vector3::zeros);
                states.push(judge.end(*point, direction * speed));
            }
        }
        first.push(states.len() as u32);
        let kept = RefCell::new(vec![None; states.len()]);
        let (arrivals, approach) = (OnceCell::new(), OnceCell::new());
        Self { judge, points: points.to_vec(), states, first, rungs, kept, arrivals, approach }
    }

    /// The same, with `legs` of one that was drawn alike.
    ///
    /// Drawn alike: the same judge, points and settings.
    ///
    /// # Panics
    /// If it has another number of states.
    pub fn knowing(self, legs: WitnessLegs) -> Self {
        assert_eq!(legs.0.len(), self.states.len(), "legs of another roadmap");
        Self { kept: RefCell::new(legs.0), ..self }
    }

    /// The legs that were judged.
    pub fn into_legs(self) -> WitnessLegs {
        WitnessLegs(self.kept.into_inner())
    }

    /// The node at rest at the start.
    pub fn start(&self) -> WitnessNode {
        WitnessNode { previous: 0, waypoint: 0, velocity: 0 }
    }

    /// Number of waypoint states.
    pub fn states(&self) -> usize {
        self.states.len()
    }

    /// Velocity of a node, m/s.
    pub fn velocity(&self, node: &WitnessNode) -> Vector3<f64> {
        self.states[self.state(node)].velocity
    }

    /// Number of legs between all states; judges every leg that was not asked for yet.
    ///
    /// (n M)² judgements at worst.
    pub fn legs_count(&self) -> usize {
        (0..self.states.len()).map(|state| self.kept_legs(state).len()).sum()
    }

    /// All legs, ordered by the state they leave and the state they reach.
    pub fn all_legs(&self) -> Vec<RoadmapLeg> {
        let mut out = Vec::with_capacity(self.legs_count());
        for state in 0..self.states.len() {
            let from = self.place(state as u32);
            for leg in self.kept_legs(state).iter() {
                out.push(RoadmapLeg { from, to: self.place(leg.state), duration: self.rungs[leg.rung as usize] });
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
        match steps {
            0 => node.waypoint as usize + 1 == self.points.len(),
            1 => self.arrivals.get_or_init(|| self.find_arrivals())[self.state(node)],
            _ => {
                let approach = self.approach.get_or_init(|| self.find_approach());
                let longest = self.rungs.last().copied().unwrap_or(0.0);
                approach[node.waypoint as usize] <= (steps - 1) as f64 * longest * self.judge.limits().max_speed
            }
        }
    }

    /// What every candidate for a leg from `from` is, a state of another waypoint each: its node, or why it is none;
    /// `None` where the straight line alone takes longer at the speed limit than the longest leg may.
    ///
    /// The evidence is that of the leg time nearest to what the line takes at the mean of the speeds at both ends.
    ///
    /// For telling why nothing was found: every refused candidate is judged once more.
    pub fn candidates(&self, from: &WitnessNode) -> Vec<Result<WitnessNode, Option<Infeasible>>> {
        let (left, own) = (self.state(from), from.waypoint as usize);
        let longest = self.rungs.last().copied().unwrap_or(0.0);
        let others = (0..self.points.len()).filter(|w| *w != own);
        let judged = others.flat_map(|w| (self.first[w]..self.first[w + 1]).map(move |state| (w, state)));
        let fate = |(w, state): (usize, u32)| {
            let (here, there) = (&self.states[left], &self.states[state as usize]);
            let fastest = self.fastest(&here.position, &there.position);
            if fastest > longest {
                return Err(None);
            }
            if self.shortest(left, state as usize, fastest).is_some() {
                let (waypoint, velocity) = (w as u32, state - self.first[w]);
                return Ok(WitnessNode { previous: from.waypoint, waypoint, velocity });
            }
            let speed = 0.5 * (here.velocity.norm() + there.velocity.norm());
            let usual = (there.position - here.position).norm() / speed.max(f64::MIN_POSITIVE);
            let nearest = |a: &&f64, b: &&f64| (**a - usual).abs().total_cmp(&(**b - usual).abs());
            let time = self.rungs.iter().filter(|rung| **rung >= fastest).min_by(nearest).copied().unwrap_or(longest);
            Err(self.judge.judge(here, there, time).err())
        };
        judged.map(fate).collect()
    }

    /// The trajectory over `nodes` as polynomials, built once for what is returned.
    ///
    /// Legs are judged again, since only their rungs are kept. Velocity and, for the model, acceleration and jerk agree
    /// where legs meet.
    ///
    /// # Errors
    /// Why two successive nodes are no leg: the evidence of the longest leg time.
    pub fn profile(&self, nodes: &[WitnessNode]) -> Result<Profile, Infeasible> {
        let leg = |pair: &[WitnessNode]| {
            let (from, to) = (self.state(&pair[0]), self.state(&pair[1]));
            let judged = |rung: &f64| self.judge.judge(&self.states[from], &self.states[to], *rung);
            let (last, shorter) = self.rungs.split_last().expect("a timing has at least one rung");
            shorter.iter().find_map(|rung| judged(rung).ok()).map_or_else(|| judged(last), Ok)
        };
        Ok(Profile { legs: nodes.windows(2).map(leg).collect::<Result<_, _>>()? })
    }

    /// Number of a node's state.
    fn state(&self, node: &WitnessNode) -> usize {
        let state = self.first[node.waypoint as usize] + node.velocity;
        assert!(state < self.first[node.waypoint as usize + 1], "a node of another roadmap: {node:?}");
        state as usize
    }

    /// Waypoint and velocity of a state.
    fn place(&self, state: u32) -> (u32, u32) {
        let waypoint = self.first.partition_point(|first| *first <= state) - 1;
        (waypoint as u32, state - self.first[waypoint])
    }

    /// The shortest feasible rung between two states. The times in which even the straight line is too long at the
    /// speed limit are skipped.
    fn shortest(&self, from: usize, to: usize, fastest: f64) -> Option<u32> {
        let begin = self.rungs.partition_point(|rung| *rung < fastest);
        (begin..self.rungs.len())
            .find(|rung| self.judge.judge(&self.states[from], &self.states[to], self.rungs[*rung]).is_ok())
            .map(|rung| rung as u32)
    }

    /// Time of the straight line at the speed limit, s.
    fn fastest(&self, from: &Point3<f64>, to: &Point3<f64>) -> f64 {
        (to - from).norm() / self.judge.limits().max_speed
    }

    /// All legs out of a state, judged at the first question and kept. Waypoints farther than the top speed goes in the
    /// longest rung are not looked at; each leg keeps the shortest rung that holds.
    fn kept_legs(&self, from: usize) -> Arc<[Judged]> {
        if let Some(legs) = &self.kept.borrow()[from] {
            return Arc::clone(legs);
        }
        let own = self.place(from as u32).0 as usize;
        let longest = self.rungs.last().copied().unwrap_or(0.0);
        let mut legs = Vec::new();
        for (w, point) in self.points.iter().enumerate() {
            let fastest = self.fastest(&self.points[own], point);
            if w == own || fastest > longest {
                continue;
            }
            for state in self.first[w]..self.first[w + 1] {
                legs.extend(self.shortest(from, state as usize, fastest).map(|rung| Judged { state, rung }));
            }
        }
        let legs: Arc<[Judged]> = legs.into();
        self.kept.borrow_mut()[from] = Some(Arc::clone(&legs));
        legs
    }

    /// One leg to the end judged for each state.
    fn find_arrivals(&self) -> Vec<bool> {
        let end = self.states.len() - 1;
        let goal = self.points[self.points.len() - 1];
        (0..self.states.len())
            .map(|state| {
                state != end && self.shortest(state, end, self.fastest(&self.states[state].position, &goal)).is_some()
            })
            .collect()
    }

    /// Infinite where no waypoint has a leg to the end.
    fn find_approach(&self) -> Vec<f64> {
        let arrivals = self.arrivals.get_or_init(|| self.find_arrivals());
        let near: Vec<Point3<f64>> = (0..self.points.len())
            .filter(|w| (self.first[*w]..self.first[w + 1]).any(|state| arrivals[state as usize]))
            .map(|w| self.points[w])
            .collect();
        let nearest = |p: &Point3<f64>| near.iter().map(|q| (q - p).norm()).fold(f64::INFINITY, f64::min);
        self.points.iter().map(nearest).collect()
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
        assert_eq!(candidates.len(), self.points.len(), "a roadmap serves the graph that it was drawn over");
        let here = self.points[from.waypoint as usize];
        let incoming = here - self.points[from.previous as usize];
        let left = self.state(from);
        let length_in = incoming.norm();
        let v_in = self.states[left].velocity.norm();
        for leg in self.kept_legs(left).iter() {
            let (waypoint, velocity) = self.place(leg.state);
            let outgoing = self.points[waypoint as usize] - here;
            out.push(Leg {
                to: WitnessNode { previous: from.waypoint, waypoint, velocity },
                waypoint,
                duration: self.rungs[leg.rung as usize],
                features: LegFeatures {
                    v_in,
                    v_out: self.states[leg.state as usize].velocity.norm(),
                    turn: if from.previous == from.waypoint { 0.0 } else { angle_between(&incoming, &outgoing) },
                    length: outgoing.norm(),
                    climb: outgoing.z,
                    slope_in: if length_in > 0.0 { incoming.z / length_in } else { 0.0 },
                    ground: 0.0,
                },
            });
        }
    }
}
