//! Step-wise reach: which waypoints of one graph lie in a fixed set around where the velocity alone would carry.
//!
//! ```text
//! next ∈ current + (current − previous) · carry/Δt + set        |next − current| ≤ v_max Δt        next ≠ current
//! ```

use nalgebra::{Point3, Vector3};

use super::features::{LANES, eight_features, features};
use super::graph::{Graph, WORD};
use super::{Leg, LegFeatures, Reach, StepNode};
use crate::math::simd::Simd;

/// A set of displacements for one step of fixed duration: the end is `x0 + v0·carry + d` with `d` in the set.
///
/// `bounding_box` must hold the set; [`StepSet::contains`] decides. Both in m, relative to where the entry velocity
/// alone would carry.
pub trait StepSet: Sync {
    /// Corners of a box around the set, m; infinite for a set without bounds. Waypoints well outside are not asked for.
    fn bounding_box(&self) -> (Vector3<f64>, Vector3<f64>);
    /// Whether the displacement `d` lies in the set.
    fn contains(&self, d: &Vector3<f64>) -> bool;
    /// Clears bit i of `bits` (64 a word) where [`Self::contains`] refuses `points[i]` − `from`.
    #[inline]
    fn select(&self, from: &Vector3<f64>, points: &[Vector3<f64>], bits: &mut [u64]) {
        for (word, points) in bits.iter_mut().zip(points.chunks(WORD)) {
            let mut asked = *word;
            while asked != 0 {
                let lane = asked.trailing_zeros();
                asked &= asked - 1;
                *word &= !(u64::from(!self.contains(&(points[lane as usize] - from))) << lane);
            }
        }
    }
    /// Seconds of the entry velocity that the step carries on: the step itself without drag, 0 for a set that does not
    /// ask for the velocity.
    fn carry(&self) -> f64;
}

/// What a step-wise search assumes beside the set.
///
/// Every leg takes `step`, so that a trajectory of L waypoints takes (L − 1) · `step`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StepSettings {
    /// Duration of every leg, s.
    pub step: f64,
    /// Whether a waypoint is passed at the average velocity of the leg before, (current − previous)/step; else at rest.
    pub average_velocity: bool,
    /// No leg is faster than this, m/s (leg ÷ step); +∞: no cap.
    pub max_speed: f64,
    /// Version of the kernels that look for waypoints and measure legs.
    pub simd: Simd,
}

impl Default for StepSettings {
    fn default() -> Self {
        Self { step: 1.0, average_velocity: true, max_speed: f64::INFINITY, simd: Simd::default() }
    }
}

/// Words of 64 waypoints that are asked for at once.
const CHUNK: usize = 8;

/// A [`StepSet`] bound to the waypoints of one graph.
///
/// One look is a box test over all waypoints in single precision (64 a word), then the set over those that are left.
#[derive(Debug, Clone)]
pub struct StepReach<'a, S> {
    set: &'a S,
    graph: Graph,
    settings: StepSettings,
    /// Share of (current − previous) by which the set is moved on from the current waypoint.
    drift: f64,
    min: Vector3<f64>,
    max: Vector3<f64>,
    longest: f64,
}

impl<'a, S: StepSet> StepReach<'a, S> {
    /// Binds `set` to `points` (index 0 the start, the last the end).
    ///
    /// The set's step must be that of the settings.
    pub fn new(set: &'a S, points: &[Point3<f64>], settings: StepSettings) -> Self {
        let (min, max) = set.bounding_box();
        let drift = if settings.average_velocity { set.carry() / settings.step } else { 0.0 };
        let longest = settings.max_speed * settings.step;
        Self { set, graph: Graph::new(points), settings, drift, min, max, longest }
    }

    /// Number of waypoints of the graph.
    pub fn len(&self) -> usize {
        self.graph.points().len()
    }

    /// Whether the graph has no waypoint.
    pub fn is_empty(&self) -> bool {
        self.graph.points().is_empty()
    }

    /// The settings it was built with.
    pub fn settings(&self) -> &StepSettings {
        &self.settings
    }

    /// Whether a leg of displacement `leg` (m) follows one of displacement `before` (0 at the start).
    ///
    /// leg − before · drift ∈ set and |leg| ≤ v_max Δt: the plain test that [`Self::successors`] answers for all at
    /// once.
    pub fn feasible(&self, before: &Vector3<f64>, leg: &Vector3<f64>) -> bool {
        leg.norm_squared() <= self.longest * self.longest && self.set.contains(&(leg - before * self.drift))
    }

    /// Appends, in rising order, the waypoints that can follow `previous`, `current` (equal at the start).
    #[inline]
    pub fn successors(&self, previous: u32, current: u32, out: &mut Vec<u32>) {
        self.each(previous, current, |next| out.push(next));
    }

    /// Calls `found` with the waypoints that can follow, in rising order.
    #[inline]
    fn each(&self, previous: u32, current: u32, mut found: impl FnMut(u32)) {
        let from = self.carried(previous, current);
        let (min, max) = (from + self.min, from + self.max);
        let points = self.graph.points();
        for first in (0..self.graph.words()).step_by(CHUNK) {
            let mut chunk = [0; CHUNK];
            let bits = &mut chunk[..(self.graph.words() - first).min(CHUNK)];
            self.graph.near_box(self.settings.simd, &min, &max, first, bits);
            self.set.select(&from, &points[first * WORD..], bits);
            for (number, mut bits) in (first..).zip(bits.iter().copied()) {
                while bits != 0 {
                    let next = (number * WORD) as u32 + bits.trailing_zeros();
                    bits &= bits - 1;
                    if self.is_move(current, next) {
                        found(next);
                    }
                }
            }
        }
    }

    /// Where the velocity of the leg from `previous` alone leads.
    #[inline]
    fn carried(&self, previous: u32, current: u32) -> Vector3<f64> {
        let here = self.graph.point(current);
        here + (here - self.graph.point(previous)) * self.drift
    }

    /// Whether there is a way from `current`, and no longer one than a leg may be.
    #[inline]
    fn is_move(&self, current: u32, next: u32) -> bool {
        let way = self.graph.point(next) - self.graph.point(current);
        next != current && way.norm_squared() <= self.longest * self.longest
    }

    /// What scores see of the leg from `node` to waypoint `to`.
    #[inline]
    pub fn features(&self, node: &StepNode, to: u32) -> LegFeatures {
        let here = self.graph.point(node.current);
        let before = here - self.graph.point(node.previous);
        let leg = self.graph.point(to) - here;
        features(&before, &leg, self.settings.step)
    }
}

/// Up to eight legs on their way to the vector unit.
struct Waiting {
    legs: [[f64; LANES]; 3],
    waypoints: [u32; LANES],
    count: usize,
}

impl<S: StepSet> Reach<StepNode> for StepReach<'_, S> {
    /// Members in the order of their numbers; features eight at a time in vector lanes, the same bits as one by one.
    fn legs(&self, from: &StepNode, candidates: &[Point3<f64>], out: &mut Vec<Leg<StepNode>>) {
        debug_assert_eq!(candidates.len(), self.graph.points().len(), "the reach set is bound to another graph");
        let here = self.graph.point(from.current);
        let before = here - self.graph.point(from.previous);
        let mut waiting = Waiting { legs: [[0.0; LANES]; 3], waypoints: [0; LANES], count: 0 };
        let mut flush = |waiting: &mut Waiting| {
            let features = eight_features(self.settings.simd, &before, &waiting.legs, self.settings.step);
            out.extend((0..waiting.count).map(|lane| {
                let waypoint = waiting.waypoints[lane];
                let to = StepNode { previous: from.current, current: waypoint };
                Leg { to, waypoint, duration: self.settings.step, features: features[lane] }
            }));
            waiting.count = 0;
        };
        self.each(from.previous, from.current, |next| {
            let leg = self.graph.point(next) - here;
            for axis in 0..3 {
                waiting.legs[axis][waiting.count] = leg[axis];
            }
            waiting.waypoints[waiting.count] = next;
            waiting.count += 1;
            if waiting.count == LANES {
                flush(&mut waiting);
            }
        });
        if waiting.count > 0 {
            flush(&mut waiting);
        }
    }

    /// The same looks, at one waypoint's word alone.
    fn leg(&self, from: &StepNode, to: &StepNode, candidates: &[Point3<f64>]) -> Option<Leg<StepNode>> {
        debug_assert_eq!(candidates.len(), self.graph.points().len(), "the reach set is bound to another graph");
        let (word, bit) = (to.current as usize / WORD, 1 << (to.current as usize % WORD));
        let place = self.carried(from.previous, from.current);
        let mut bits = [0];
        self.graph.near_box(self.settings.simd, &(place + self.min), &(place + self.max), word, &mut bits);
        bits[0] &= bit;
        self.set.select(&place, &self.graph.points()[word * WORD..], &mut bits);
        let is_leg = to.previous == from.current && bits == [bit] && self.is_move(from.current, to.current);
        let features = || self.features(from, to.current);
        is_leg.then(|| Leg { to: *to, waypoint: to.current, duration: self.settings.step, features: features() })
    }
}
