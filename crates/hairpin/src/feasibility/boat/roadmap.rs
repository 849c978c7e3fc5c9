//! The roadmap of a graph: waypoint states, and the legs between them, judged when a search first asks.
//!
//! Nodes are (waypoint, velocity): rest at start and end, M velocities elsewhere; a leg takes the shortest time of a
//! ladder that is proven feasible. Sound for the model, complete for nothing.

use nalgebra::{Point3, Vector3};
use rand::RngExt;

use super::leg::{BoatEnd, BoatJudge};
use super::limits::BoatInfeasible;
use crate::feasibility::reach::proven_legs::ProveLegs;
use crate::feasibility::reach::states::{States, Velocities};
use crate::feasibility::reach::wander::another;
use crate::feasibility::reach::{Leg, LegFeatures, Reach, WitnessLegs, WitnessNode};
use crate::feasibility::steering::LegTiming;
use crate::math::random::Stream;
use crate::trajectory::{Profile, ProfileLeg};

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

/// The waypoint states of one graph and the legs between them. One graph is one task on one thread.
///
/// As the roadmap of flights ([`crate::feasibility::reach::witness`]), in the plane.
#[derive(Debug)]
pub struct BoatRoadmap<'a> {
    states: States<'a, BoatJudge>,
    current: [f64; 2],
}

impl ProveLegs for BoatJudge {
    type End = BoatEnd;
    type Lanes = ();
    type Why = BoatInfeasible;

    fn leg(&self, from: &BoatEnd, to: &BoatEnd, duration: f64) -> Result<ProfileLeg, BoatInfeasible> {
        self.judge(from, to, duration)
    }

    fn lanes(_: &[BoatEnd]) {}

    fn fastest(&self) -> f64 {
        self.fastest()
    }

    fn top_speed(&self) -> f64 {
        self.top_speed()
    }

    fn speed(end: &BoatEnd) -> f64 {
        end.speed()
    }

    fn state(&self, place: &Point3<f64>, velocity: &Vector3<f64>) -> BoatEnd {
        self.end(place, [velocity.x, velocity.y])
    }

    fn passing(&self, place: &Point3<f64>, velocity: &Vector3<f64>) -> Option<BoatEnd> {
        self.between(place, [velocity.x, velocity.y])
    }

    /// Towards another waypoint.
    fn aimed(&self, points: &[Point3<f64>], w: usize, speed: f64, _longest: f64, random: &mut Stream) -> Vector3<f64> {
        let way = points[another(points, w, f64::INFINITY, random)] - points[w];
        way.try_normalize(1e-9).unwrap_or_else(Vector3::x) * speed
    }
}

impl<'a> BoatRoadmap<'a> {
    /// The roadmap over `points`: index 0 the start, the last the end, both at rest.
    ///
    /// Velocity k of a waypoint has a speed drawn from the k-th of M equal parts of [0, top speed] and points towards a
    /// waypoint drawn from the others.
    pub fn new(judge: &'a BoatJudge, points: &[Point3<f64>], settings: &BoatRoadmapSettings) -> Self {
        let velocities =
            Velocities { many: settings.velocities, seed: (settings.seed, "boat velocities"), timing: settings.timing };
        let at_rest = |point: &Point3<f64>| judge.end(point, [0.0; 2]);
        let moving = |w: usize, speed: f64, random: &mut Stream| {
            let towards = (w + 1 + random.random_range(0..points.len() - 1)) % points.len();
            let way = points[towards] - points[w];
            let [x, y] = if way.norm() > 0.0 { [way.x / way.norm(), way.y / way.norm()] } else { [1.0, 0.0] };
            judge.end(&points[w], [speed * x, speed * y])
        };
        Self { states: States::new(judge, points, &velocities, at_rest, moving), current: settings.current }
    }

    /// The same, with `legs` of one that was drawn alike.
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

    /// A necessary test for searches: false only if no `steps` legs lead from `node` to the end.
    pub fn may_arrive(&self, node: &WitnessNode, steps: usize) -> bool {
        self.states.may_arrive(node, steps, || {
            let points = self.states.points();
            let left = points[points.len() - 1] - points[node.waypoint as usize];
            left.norm() <= steps as f64 * self.states.longest() * self.states.judge().fastest()
        })
    }

    /// What every candidate for a leg from `from` is, a state of another waypoint each: its node, or why it is none;
    /// `None` where the straight line alone takes longer at the largest speed than the longest leg may.
    pub fn candidates(&self, from: &WitnessNode) -> Vec<Result<WitnessNode, Option<BoatInfeasible>>> {
        // What stands against the longest is told: shorter ones ask for more.
        self.states.candidates(from, |_, _, _| self.states.longest())
    }

    /// The trajectory over `nodes`, built once for what is returned.
    ///
    /// # Errors
    /// Why two successive nodes are no leg: the evidence of the longest leg time.
    pub fn profile(&self, nodes: &[WitnessNode]) -> Result<Profile, BoatInfeasible> {
        self.states.profile(nodes)
    }

    /// How much a leg of `features` along `way` is a fast corner, the more the farther it leads across the current.
    ///
    /// v_in/V · v_out/V · Λ₉₀(turn) · (1 + |sin ∠(c, way)|)/2, where V is the top speed.
    fn across(&self, features: &LegFeatures, way: &Vector3<f64>) -> f64 {
        let top = self.states.judge().top_speed();
        let [x, y] = self.current;
        let both = libm::hypot(x, y) * libm::hypot(way.x, way.y);
        let across = if both > 0.0 { (x * way.y - y * way.x).abs() / both } else { 0.0 };
        let corner = 1.0 - (features.turn / std::f64::consts::FRAC_PI_2 - 1.0).abs();
        features.v_in / top * (features.v_out / top) * corner * 0.5 * (1.0 + across)
    }
}

impl Reach<WitnessNode> for BoatRoadmap<'_> {
    fn legs(&self, from: &WitnessNode, candidates: &[Point3<f64>], out: &mut Vec<Leg<WitnessNode>>) {
        self.states.legs(from, candidates, |features, way| self.across(features, way), out);
    }
}
