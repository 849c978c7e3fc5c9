//! The roadmap of a graph: waypoint states, and the legs between them, judged when a search first asks.
//!
//! Nodes are (waypoint, velocity): rest at start and end, M velocities elsewhere; a leg takes the shortest time of a
//! ladder that is proven feasible. Sound for the model, complete for nothing.

use std::cell::{OnceCell, RefCell};
use std::sync::Arc;

use nalgebra::Point3;
use rand::RngExt;

use super::leg::{BoatEnd, BoatJudge};
use super::limits::BoatInfeasible;
use crate::feasibility::reach::{Leg, LegFeatures, Reach};
use crate::feasibility::steering::LegTiming;
use crate::math::random::{named_seed, stream};
use crate::math::rotation::angle_between;
use crate::trajectory::Profile;

/// A node: a state of a waypoint, and the waypoint before it, which the turn angle is seen from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct BoatNode {
    /// The waypoint before; equal to `waypoint` at the start.
    pub previous: u32,
    /// The current waypoint.
    pub waypoint: u32,
    /// Which of the waypoint's velocities; 0 at start and end, which have only rest.
    pub velocity: u32,
}

/// How a roadmap is drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BoatRoadmapSettings {
    /// Velocities per waypoint, M; 0 is taken as 1.
    pub velocities: usize,
    /// Leg times.
    pub timing: LegTiming,
    /// Seed of the velocities.
    pub seed: u64,
    /// Velocity of the water, m/s: what legs across it are told by.
    pub current: [f64; 2],
}

/// A judged leg: the state it leads to, and its rung.
#[derive(Debug, Clone, Copy)]
struct Judged {
    state: u32,
    rung: u32,
}

/// The legs of a [`BoatRoadmap`] that were judged so far; they serve every roadmap that is drawn alike.
#[derive(Debug)]
pub struct BoatLegs(Vec<Option<Arc<[Judged]>>>);

impl BoatLegs {
    /// Memory that they take, about.
    pub fn bytes(&self) -> usize {
        let legs: usize = self.0.iter().flatten().map(|legs| legs.len()).sum();
        self.0.len() * size_of::<Option<Arc<[Judged]>>>() + legs * size_of::<Judged>()
    }
}

/// The waypoint states of one graph and the legs between them. One graph is one task on one thread.
#[derive(Debug)]
pub struct BoatRoadmap<'a> {
    judge: &'a BoatJudge,
    points: Vec<Point3<f64>>,
    /// States of all waypoints, waypoint by waypoint.
    states: Vec<BoatEnd>,
    /// First state of every waypoint, and the number of states.
    first: Vec<u32>,
    rungs: Vec<f64>,
    current: [f64; 2],
    kept: RefCell<Vec<Option<Arc<[Judged]>>>>,
    /// Which states have a leg to the end.
    arrivals: OnceCell<Vec<bool>>,
}

impl<'a> BoatRoadmap<'a> {
    /// The roadmap over `points`: index 0 the start, the last the end, both at rest.
    ///
    /// Velocity k of a waypoint has a speed drawn from the k-th of M equal parts of [0, top speed] and points towards a
    /// waypoint drawn from the others.
    pub fn new(judge: &'a BoatJudge, points: &[Point3<f64>], settings: &BoatRoadmapSettings) -> Self {
        let many = settings.velocities.max(1);
        let (mut states, mut first) = (Vec::with_capacity(points.len() * many), Vec::with_capacity(points.len() + 1));
        for (w, point) in points.iter().enumerate() {
            first.push(states.len() as u32);
            if w == 0 || w + 1 == points.len() {
                states.push(judge.end(point, [0.0; 2]));
                continue;
            }
            let mut random = stream(named_seed(settings.seed, "boat velocities", w as u64));
            for k in 0..many {
                let speed = judge.top_speed() * (k as f64 + random.random_range(0.0..1.0)) / many as f64;
                let towards = (w + 1 + random.random_range(0..points.len() - 1)) % points.len();
                let way = points[towards] - point;
                let [x, y] = if way.norm() > 0.0 { [way.x / way.norm(), way.y / way.norm()] } else { [1.0, 0.0] };
                states.push(judge.end(point, [speed * x, speed * y]));
            }
        }
        first.push(states.len() as u32);
        Self {
            judge,
            points: points.to_vec(),
            rungs: settings.timing.rungs(),
            current: settings.current,
            kept: RefCell::new(vec![None; states.len()]),
            states,
            first,
            arrivals: OnceCell::new(),
        }
    }

    /// The same, with `legs` of one that was drawn alike.
    ///
    /// # Panics
    /// If it has another number of states.
    pub fn knowing(self, legs: BoatLegs) -> Self {
        assert_eq!(legs.0.len(), self.states.len(), "legs of another roadmap");
        Self { kept: RefCell::new(legs.0), ..self }
    }

    /// The legs that were judged.
    pub fn into_legs(self) -> BoatLegs {
        BoatLegs(self.kept.into_inner())
    }

    /// The node at rest at the start.
    pub fn start(&self) -> BoatNode {
        BoatNode { previous: 0, waypoint: 0, velocity: 0 }
    }

    /// A necessary test for searches: false only if no `steps` legs lead from `node` to the end.
    pub fn may_arrive(&self, node: &BoatNode, steps: usize) -> bool {
        match steps {
            0 => node.waypoint as usize + 1 == self.points.len(),
            1 => self.arrivals.get_or_init(|| self.find_arrivals())[self.state(node)],
            _ => {
                let longest = self.rungs.last().copied().unwrap_or(0.0);
                let left = self.points[self.points.len() - 1] - self.points[node.waypoint as usize];
                left.norm() <= steps as f64 * longest * self.judge.fastest()
            }
        }
    }

    /// What every candidate for a leg from `from` is, a state of another waypoint each: its node, or why it is none;
    /// `None` where the straight line alone takes longer at the largest speed than the longest leg may.
    pub fn candidates(&self, from: &BoatNode) -> Vec<Result<BoatNode, Option<BoatInfeasible>>> {
        let (left, own) = (self.state(from), from.waypoint as usize);
        let longest = self.rungs.last().copied().unwrap_or(0.0);
        let others = (0..self.points.len()).filter(|w| *w != own);
        let judged = others.flat_map(|w| (self.first[w]..self.first[w + 1]).map(move |state| (w, state)));
        let fate = |(w, state): (usize, u32)| {
            let fastest = self.least_time(own, w);
            if fastest > longest {
                return Err(None);
            }
            if self.shortest(left, state as usize, fastest).is_some() {
                let (waypoint, velocity) = (w as u32, state - self.first[w]);
                return Ok(BoatNode { previous: from.waypoint, waypoint, velocity });
            }
            // What stands against the longest is told: shorter ones ask for more.
            Err(self.judge.judge(&self.states[left], &self.states[state as usize], longest).err())
        };
        judged.map(fate).collect()
    }

    /// The trajectory over `nodes`, built once for what is returned.
    ///
    /// # Errors
    /// Why two successive nodes are no leg: the evidence of the longest leg time.
    pub fn profile(&self, nodes: &[BoatNode]) -> Result<Profile, BoatInfeasible> {
        let leg = |pair: &[BoatNode]| {
            let (from, to) = (self.state(&pair[0]), self.state(&pair[1]));
            let judged = |rung: &f64| self.judge.judge(&self.states[from], &self.states[to], *rung);
            let (last, shorter) = self.rungs.split_last().expect("a timing has at least one rung");
            shorter.iter().find_map(|rung| judged(rung).ok()).map_or_else(|| judged(last), Ok)
        };
        Ok(Profile { legs: nodes.windows(2).map(leg).collect::<Result<_, _>>()? })
    }

    fn state(&self, node: &BoatNode) -> usize {
        let state = self.first[node.waypoint as usize] + node.velocity;
        assert!(state < self.first[node.waypoint as usize + 1], "a node of another roadmap: {node:?}");
        state as usize
    }

    /// Waypoint and velocity of a state.
    fn place(&self, state: u32) -> (u32, u32) {
        let waypoint = self.first.partition_point(|first| *first <= state) - 1;
        (waypoint as u32, state - self.first[waypoint])
    }

    /// The shortest feasible rung between two states, of those that are no shorter than `least`.
    fn shortest(&self, from: usize, to: usize, least: f64) -> Option<u32> {
        let begin = self.rungs.partition_point(|rung| *rung < least);
        (begin..self.rungs.len())
            .find(|rung| self.judge.judge(&self.states[from], &self.states[to], self.rungs[*rung]).is_ok())
            .map(|rung| rung as u32)
    }

    fn least_time(&self, from: usize, to: usize) -> f64 {
        (self.points[to] - self.points[from]).norm() / self.judge.fastest()
    }

    /// All legs out of a state, judged at the first question and kept.
    fn kept_legs(&self, from: usize) -> Arc<[Judged]> {
        if let Some(legs) = &self.kept.borrow()[from] {
            return Arc::clone(legs);
        }
        let own = self.place(from as u32).0 as usize;
        let longest = self.rungs.last().copied().unwrap_or(0.0);
        let mut legs = Vec::new();
        for w in (0..self.points.len()).filter(|w| *w != own) {
            let least = self.least_time(own, w);
            if least > longest {
                continue;
            }
            for state in self.first[w]..self.first[w + 1] {
                legs.extend(self.shortest(from, state as usize, least).map(|rung| Judged { state, rung }));
            }
        }
        let legs: Arc<[Judged]> = legs.into();
        self.kept.borrow_mut()[from] = Some(Arc::clone(&legs));
        legs
    }

    fn find_arrivals(&self) -> Vec<bool> {
        let (end, goal) = (self.states.len() - 1, self.points.len() - 1);
        let arrives = |state: usize| {
            let own = self.place(state as u32).0 as usize;
            state != end && self.shortest(state, end, self.least_time(own, goal)).is_some()
        };
        (0..self.states.len()).map(arrives).collect()
    }

    /// How much a leg of `features` along `way` is a fast corner, the more the farther it leads across the current.
    ///
    /// v_in/V · v_out/V · Λ₉₀(turn) · (1 + |sin ∠(c, way)|)/2, where V is the top speed.
    fn across(&self, features: &LegFeatures, way: [f64; 2]) -> f64 {
        let top = self.judge.top_speed();
        let [x, y] = self.current;
        let both = libm::hypot(x, y) * libm::hypot(way[0], way[1]);
        let across = if both > 0.0 { (x * way[1] - y * way[0]).abs() / both } else { 0.0 };
        let corner = 1.0 - (features.turn / std::f64::consts::FRAC_PI_2 - 1.0).abs();
        features.v_in / top * (features.v_out / top) * corner * 0.5 * (1.0 + across)
    }
}

impl Reach<BoatNode> for BoatRoadmap<'_> {
    fn legs(&self, from: &BoatNode, candidates: &[Point3<f64>], out: &mut Vec<Leg<BoatNode>>) {
        assert_eq!(candidates.len(), self.points.len(), "a roadmap serves the graph that it was drawn over");
        let here = self.points[from.waypoint as usize];
        let incoming = here - self.points[from.previous as usize];
        let left = self.state(from);
        for leg in self.kept_legs(left).iter() {
            let (waypoint, velocity) = self.place(leg.state);
            let outgoing = self.points[waypoint as usize] - here;
            let turn = if from.previous == from.waypoint { 0.0 } else { angle_between(&incoming, &outgoing) };
            let (v_in, v_out) = (self.states[left].speed(), self.states[leg.state as usize].speed());
            let features = LegFeatures { v_in, v_out, turn, length: outgoing.norm(), ..LegFeatures::default() };
            let ground = self.across(&features, [outgoing.x, outgoing.y]);
            out.push(Leg {
                to: BoatNode { previous: from.waypoint, waypoint, velocity },
                waypoint,
                duration: self.rungs[leg.rung as usize],
                features: LegFeatures { ground, ..features },
            });
        }
    }
}
