//! Step-wise reach: which waypoints of one graph lie in a fixed set around where the velocity alone would carry.

use nalgebra::{Point3, Vector3};

use super::graph::Graph;
use super::{Leg, LegFeatures, Reach, StepNode};

/// A set of displacements for one step of fixed duration: the end is `x0 + v0·carry + d` with `d` in the set.
pub trait StepSet: Sync {
    /// Corners of a box around the set, m; infinite for a set without bounds.
    fn bounding_box(&self) -> (Vector3<f64>, Vector3<f64>);
    /// Whether the displacement `d`, inside the box, lies in the set.
    fn contains(&self, d: &Vector3<f64>) -> bool;
    /// Seconds of the entry velocity that the step carries on: the step itself without drag, 0 for a set that does not
    /// ask for the velocity.
    fn carry(&self) -> f64;
}

/// What a step-wise search assumes beside the set.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StepSettings {
    /// Duration of every leg, s.
    pub step: f64,
    /// Whether a waypoint is passed at the average velocity of the leg before, (current − previous)/step; else at rest.
    pub average_velocity: bool,
    /// No leg is faster than this, m/s (leg ÷ step); +∞: no cap.
    pub max_speed: f64,
}

impl Default for StepSettings {
    fn default() -> Self {
        Self { step: 1.0, average_velocity: true, max_speed: f64::INFINITY }
    }
}

/// A [`StepSet`] bound to the waypoints of one graph.
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
    pub fn new(set: &'a S, points: &[Point3<f64>], settings: StepSettings) -> Self {
        let (min, max) = set.bounding_box();
        let drift = if settings.average_velocity { set.carry() / settings.step } else { 0.0 };
        let longest = settings.max_speed * settings.step;
        Self { set, graph: Graph::new(points), settings, drift, min, max, longest }
    }

    /// Number of waypoints of the graph.
    pub fn len(&self) -> usize {
        self.graph.len()
    }

    /// Whether the graph has no waypoint.
    pub fn is_empty(&self) -> bool {
        self.graph.len() == 0
    }

    /// The settings it was built with.
    pub fn settings(&self) -> &StepSettings {
        &self.settings
    }

    /// Whether a leg of displacement `leg` (m) follows one of displacement `before` (0 at the start).
    pub fn feasible(&self, before: &Vector3<f64>, leg: &Vector3<f64>) -> bool {
        let d = leg - before * self.drift;
        let inside = (0..3).all(|i| d[i] >= self.min[i] && d[i] <= self.max[i]);
        inside && leg.norm_squared() <= self.longest * self.longest && self.set.contains(&d)
    }

    /// Appends, in rising order, the waypoints that can follow `previous`, `current` (equal at the start).
    #[inline]
    pub fn successors(&self, previous: u32, current: u32, out: &mut Vec<u32>) {
        let here = self.graph.point(current);
        let from = here + (here - self.graph.point(previous)) * self.drift;
        let square = self.longest * self.longest;
        self.graph.inside(&(from + self.min), &(from + self.max), |candidate| {
            let there = self.graph.point(candidate);
            if candidate != current && self.set.contains(&(there - from)) && (there - here).norm_squared() <= square {
                out.push(candidate);
            }
        });
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

/// What scores see of the displacement `leg` (m) after `before` (0 at the start), both flown in `step` s.
#[inline]
pub(super) fn features(before: &Vector3<f64>, leg: &Vector3<f64>, step: f64) -> LegFeatures {
    let (length, length_before) = (leg.norm(), before.norm());
    let turn = if length_before > 0.0 && length > 0.0 { before.cross(leg).norm().atan2(before.dot(leg)) } else { 0.0 };
    LegFeatures { v_in: length_before / step, v_out: length / step, turn, length, climb: leg.z }
}

impl<S: StepSet> Reach<StepNode> for StepReach<'_, S> {
    fn legs(&self, from: &StepNode, candidates: &[Point3<f64>], out: &mut Vec<Leg<StepNode>>) {
        debug_assert_eq!(candidates.len(), self.graph.len(), "the reach set is bound to another graph");
        let here = self.graph.point(from.current);
        let ahead = here + (here - self.graph.point(from.previous)) * self.drift;
        let square = self.longest * self.longest;
        self.graph.inside(&(ahead + self.min), &(ahead + self.max), |candidate| {
            let there = self.graph.point(candidate);
            if candidate != from.current
                && self.set.contains(&(there - ahead))
                && (there - here).norm_squared() <= square
            {
                let to = StepNode { previous: from.current, current: candidate };
                let features = self.features(from, candidate);
                out.push(Leg { to, waypoint: candidate, duration: self.settings.step, features });
            }
        });
    }
}
