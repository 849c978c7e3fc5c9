//! Legs between states of waypoints that something proves: their nodes, what proves them, and what is kept of them.

use std::sync::Arc;

use nalgebra::{Point3, Vector3};

use crate::feasibility::steering::firsts::Asked;
use crate::math::random::Stream;
use crate::trajectory::ProfileLeg;

/// A node: a state of a waypoint and the waypoint before it, which the turn angle is seen from. Legs do not depend on
/// `previous`, and are kept without it.
///
/// `Ord` is (previous, waypoint, velocity): ties of searches follow it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct WitnessNode {
    /// The waypoint before; equal to `waypoint` at the start.
    pub previous: u32,
    /// The current waypoint.
    pub waypoint: u32,
    /// Which of the waypoint's velocities; 0 at start and end, which have only rest.
    pub velocity: u32,
}

/// A judged leg: the state it leads to, and its rung.
#[derive(Debug, Clone, Copy)]
pub(in crate::feasibility) struct Judged {
    pub(in crate::feasibility) state: u32,
    pub(in crate::feasibility) rung: u32,
}

/// The legs of a roadmap that were judged so far; they serve every roadmap that is drawn alike.
///
/// One entry a state, `None` where nothing asked yet.
#[derive(Debug)]
pub struct WitnessLegs(pub(in crate::feasibility) Vec<Option<Arc<[Judged]>>>);

impl WitnessLegs {
    /// Memory that they take, about.
    pub fn bytes(&self) -> usize {
        let legs: usize = self.0.iter().flatten().map(|legs| legs.len()).sum();
        self.0.len() * size_of::<Option<Arc<[Judged]>>>() + legs * size_of::<Judged>()
    }
}

/// Proves legs between states of one robot.
///
/// Quadrotors and boats: what roadmaps, walks and mending ask of a robot.
pub(crate) trait ProveLegs {
    /// A state.
    type End;
    /// The states of a waypoint as they are looked at together.
    type Lanes: std::fmt::Debug;
    /// Why a leg is none.
    type Why;

    /// The leg from `from` to `to` in `duration` (s), if every limit holds at every instant of it.
    fn leg(&self, from: &Self::End, to: &Self::End, duration: f64) -> Result<ProfileLeg, Self::Why>;

    /// The states of a waypoint.
    fn lanes(states: &[Self::End]) -> Self::Lanes;

    /// Calls `found` with the number of each state of `to` that is `asked` for and to which there is a leg, and the
    /// number of the first of `durations` (s) in which there is one; in the order of `asked`. `lanes` are the states of
    /// every waypoint.
    fn firsts(
        &self,
        from: &Self::End,
        (to, lanes): (&[Self::End], &[Self::Lanes]),
        asked: &[Asked],
        durations: &[f64],
        mut found: impl FnMut(usize, usize),
    ) {
        let _ = lanes;
        for Asked { begin, states, first, .. } in asked {
            for state in states.clone().map(|state| begin + state) {
                let is_leg = |number: &usize| self.leg(from, &to[state], durations[*number]).is_ok();
                (*first..durations.len()).find(is_leg).into_iter().for_each(|number| found(state, number));
            }
        }
    }

    /// The same of legs that may be, which all legs are among; none is shorter.
    fn possible(
        &self,
        from: &Self::End,
        to: (&[Self::End], &[Self::Lanes]),
        asked: &[Asked],
        durations: &[f64],
        found: impl FnMut(usize, usize),
    ) {
        self.firsts(from, to, asked, durations, found);
    }

    /// No leg is faster than this on the mean, m/s.
    fn fastest(&self) -> f64;

    /// Waypoint velocities are drawn up to here, m/s.
    fn top_speed(&self) -> f64;

    /// Speed of a state, m/s.
    fn speed(end: &Self::End) -> f64;

    /// The state at `place` with `velocity`, m/s.
    fn state(&self, place: &Point3<f64>, velocity: &Vector3<f64>) -> Self::End;

    /// The same between two legs, which both have it at their end; `None` where there is none that both could have.
    fn passing(&self, place: &Point3<f64>, velocity: &Vector3<f64>) -> Option<Self::End> {
        Some(self.state(place, velocity))
    }

    /// A velocity of `speed` (m/s) at waypoint number `w` of `points`, in a direction drawn at random; a leg takes
    /// `longest` s at most.
    fn aimed(&self, points: &[Point3<f64>], w: usize, speed: f64, longest: f64, random: &mut Stream) -> Vector3<f64>;
}
