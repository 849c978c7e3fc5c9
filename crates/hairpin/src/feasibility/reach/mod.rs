//! Reach sets: which waypoints follow a node of the search, and what is known of the legs to them.
//!
//! | set | a waypoint follows if | sound | one look |
//! | --- | --- | --- | --- |
//! | [`none`] | it is another one | no | nothing |
//! | [`sphere`] | it is within top speed × step | no | a box test |
//! | [`hull`] | second difference in one polytope K | no: a filter | half-spaces in lanes |
//! | [`brute_force`] | the same, simulated for each cell of what is carried | no: a filter | a hull, remembered |
//! | [`body_hull`] | in the hull of its bin, turned by the heading | no: a filter | a polygon |
//! | [`witness`] | a polynomial leg is proven | yes, for the model | a leg judged once |
//! | [`drive`] | a boundary-value drive is solved on the map | yes, for the prediction | a leg solved once |
//!
//! To a search all are one trait, [`Reach`]. Step-wise sets are a [`StepSet`] bound to a graph's points by
//! [`StepReach`]; what forbids single legs (obstacles) is put around any of them by [`Filtered`], and
//! what ends them early by [`Until`].
//!
//! With a convex K and average velocities a trajectory w is feasible iff w_{k+1} − 2w_k + w_{k−1} ∈ K for all k:
//! feasibility is a second difference, states are pairs of waypoints, and exact search is a dynamic program over
//! triples (`search::exact`).

pub mod body_hull;
pub mod brute_force;
mod cloud;
mod convex_hull;
pub mod drive;
mod features;
pub mod filtered;
mod graph;
mod growing;
pub mod hull;
pub mod mend;
pub mod none;
pub mod planar_runs;
pub mod polytope;
pub(in crate::feasibility) mod proven_legs;
mod refusal;
pub mod sampling;
pub mod sphere;
pub(in crate::feasibility) mod states;
pub mod step;
#[cfg(feature = "unit-tests")]
mod tests;
mod until;
pub mod wander;
pub mod witness;

use nalgebra::Point3;

use crate::math::rotation::angle_between;

pub use body_hull::{BodyGrid, BodyHull, BodyNode, NoBodyHull};
pub use brute_force::{BruteForce, BruteForceSettings, CarriedNode};
pub use drive::{DriveNode, DriveRoadmap, DriveSettings, DriveSite};
pub use filtered::{Filtered, PairMask};
pub use hull::{Hull, HullSettings, NoHull};
pub use none::Everywhere;
pub use planar_runs::PlanarVehicle;
pub use polytope::{NoPolytope, Polytope};
pub use proven_legs::{WitnessLegs, WitnessNode};
pub use sphere::Sphere;
pub use step::{StepReach, StepSet, StepSettings};
pub use until::Until;
pub use witness::{Roadmap, RoadmapLeg, RoadmapSettings};

/// What a score sees of a leg, from its first waypoint. For step-wise sets speeds are leg ÷ step, for `witness`
/// those at the leg's ends. On a flyer's first leg `v_in` = 0 and `turn` = 0.
///
/// Features are what a learned model may depend on: whoever adds one changes what models mean.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct LegFeatures {
    /// Entry speed, m/s.
    pub v_in: f64,
    /// Exit speed, m/s.
    pub v_out: f64,
    /// Angle between the incoming and the outgoing leg, rad: 0 straight on, π back.
    pub turn: f64,
    /// Length of the leg, m.
    pub length: f64,
    /// Height gained, m.
    pub climb: f64,
    /// Sine of the elevation of the incoming leg; 0 on a flyer's first leg, and for drives.
    pub slope_in: f64,
    /// What the reach set knows of the leg's stress on the ground; 0 for flyers.
    pub ground: f64,
}

impl LegFeatures {
    /// The same, entered from `points[previous]` for a leg from `points[here]` to `points[next]`: `turn` and
    /// `slope_in`, which are 0 where `previous` is `here`.
    ///
    /// turn = ∠(here − previous, next − here), slope_in = climb/length of the way in.
    pub(crate) fn entered(self, points: &[Point3<f64>], [previous, here, next]: [u32; 3]) -> Self {
        let [before, at, to] = [previous, here, next].map(|point| points[point as usize]);
        let incoming = at - before;
        let length = incoming.norm();
        let turn = if previous == here { 0.0 } else { angle_between(&incoming, &(to - at)) };
        Self { turn, slope_in: if length > 0.0 { incoming.z / length } else { 0.0 }, ..self }
    }
}

/// What a node is entered from, of the nodes of one state.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Entry {
    /// Number of the state.
    pub state: usize,
    /// Index of the waypoint before.
    pub previous: u32,
}

/// A leg from a node to the node `to`, which stands at candidate number `waypoint`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Leg<N> {
    /// The node reached.
    pub to: N,
    /// Index of its waypoint among the candidates.
    pub waypoint: u32,
    /// Planned duration, s.
    pub duration: f64,
    /// What scores see.
    pub features: LegFeatures,
}

/// A reach set: appends to `out` every feasible leg from `from` to a candidate, in rising order of `waypoint`;
/// the current waypoint is never its own successor. `candidates` is the graph: index 0 the start, the last the end.
///
/// The same legs for the same node whenever asked, so that searches may forget and ask again.
pub trait Reach<N> {
    /// Appends the feasible legs from `from` to `out`.
    fn legs(&self, from: &N, candidates: &[Point3<f64>], out: &mut Vec<Leg<N>>);

    /// The same order and more: all feasible legs, and others that nothing cheap refuses. None of them is
    /// shorter than is told here.
    ///
    /// For who needs few of all legs: what [`Self::proven`] says of one of these is then asked of those few.
    fn possible(&self, from: &N, candidates: &[Point3<f64>], out: &mut Vec<Leg<N>>) {
        self.legs(from, candidates, out);
    }

    /// The duration of the leg from `from` to `to`, s, that [`Self::possible`] gave with `duration`; `None` where it is
    /// none.
    fn proven(&self, from: &N, to: &N, duration: f64) -> Option<f64> {
        let _ = (from, to);
        Some(duration)
    }

    /// The one leg of [`Self::legs`] that leads to `to`, for who needs no other; `None` where it is none.
    fn leg(&self, from: &N, to: &N, candidates: &[Point3<f64>]) -> Option<Leg<N>>
    where
        N: PartialEq,
    {
        let mut legs = Vec::new();
        self.legs(from, candidates, &mut legs);
        legs.into_iter().find(|leg| leg.to == *to)
    }

    /// Whether [`Self::possible`] gives the feasible legs alone: nothing is gained by proving them later.
    fn is_known_at_once(&self) -> bool {
        true
    }

    /// How `from` is entered, where all nodes of its state stand at one waypoint and have the same legs but for `turn`
    /// and `slope_in`, which follow from the waypoint before; `None` where legs are each node's own.
    ///
    /// Who asks for all nodes then asks for the legs of each state once.
    fn entry(&self, from: &N) -> Option<Entry> {
        let _ = from;
        None
    }
}

impl<N, R: Reach<N> + ?Sized> Reach<N> for &R {
    fn legs(&self, from: &N, candidates: &[Point3<f64>], out: &mut Vec<Leg<N>>) {
        (**self).legs(from, candidates, out);
    }

    fn possible(&self, from: &N, candidates: &[Point3<f64>], out: &mut Vec<Leg<N>>) {
        (**self).possible(from, candidates, out);
    }

    fn proven(&self, from: &N, to: &N, duration: f64) -> Option<f64> {
        (**self).proven(from, to, duration)
    }

    fn leg(&self, from: &N, to: &N, candidates: &[Point3<f64>]) -> Option<Leg<N>>
    where
        N: PartialEq,
    {
        (**self).leg(from, to, candidates)
    }

    fn is_known_at_once(&self) -> bool {
        (**self).is_known_at_once()
    }

    fn entry(&self, from: &N) -> Option<Entry> {
        (**self).entry(from)
    }
}

/// The node of step-wise reach sets: the last two waypoints, as indices into the graph. The start is (0, 0).
///
/// u32 indices into the graph's candidates. Velocity at `current` is (current − previous)/step or 0, as the set's
/// settings say.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct StepNode {
    /// The waypoint before; equal to `current` at the start.
    pub previous: u32,
    /// The current waypoint.
    pub current: u32,
}
