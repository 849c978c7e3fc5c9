//! One leg between two waypoint states, judged cheapest test first.

use nalgebra::Point3;
use wide::f64x4;

use super::demand::ForceMap;
use super::limits::{BoatInfeasible, BoatLimit, BoatLimits};
use super::proof::{ForceLimits, motion};
use super::space::FreeWaters;
use super::waters::BoatWaters;
use crate::math::polynomial::{derivatives, septic};
use crate::robot::boat::Boat;
use crate::trajectory::ProfileLeg;

/// A waypoint state: place, velocity over ground without acceleration or jerk, and the heading that goes with it,
/// without rate, acceleration or jerk.
///
/// Bow into its motion through the water, so that at a waypoint a force ahead is all it takes, and forces go on
/// continuously from leg to leg. At rest at either end of a trip any heading will do: that of the leg to the other
/// waypoint.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BoatEnd {
    /// m.
    pub place: [f64; 2],
    /// Over ground, m/s.
    pub velocity: [f64; 2],
    /// ψ, rad; `None` where it is the leg's.
    pub heading: Option<f64>,
}

impl BoatEnd {
    /// Speed over ground, m/s.
    pub fn speed(&self) -> f64 {
        libm::hypot(self.velocity[0], self.velocity[1])
    }
}

/// Slower is at rest, m/s: what a polynomial leaves of a velocity of 0.
const REST: f64 = 1e-9;

fn is_motion(velocity: [f64; 2]) -> bool {
    libm::hypot(velocity[0], velocity[1]) > REST
}

/// Judges legs of one boat in one stretch of water under one set of limits.
///
/// Sound for the boat in this current; not complete, as a leg has one shape for a time.
#[derive(Debug, Clone)]
pub struct BoatJudge {
    map: ForceMap,
    forces: ForceLimits,
    waters: FreeWaters,
    limits: BoatLimits,
    top_speed: f64,
}

impl BoatJudge {
    /// The judge for `boat` in `waters`. The radius of the hull's disc is kept to places to keep out of, the keep-in
    /// margin to edges.
    pub fn new(boat: &Boat, waters: &BoatWaters, limits: BoatLimits) -> Self {
        let map = ForceMap::new(boat, waters.current);
        let top_speed = boat.top_speed.min(limits.max_speed);
        let forces = ForceLimits::new(boat, &limits);
        Self { forces, waters: FreeWaters::new(waters, boat.radius), map, limits, top_speed }
    }

    /// The speed that waypoint velocities are drawn up to, m/s: the task's limit or the boat's top speed.
    pub fn top_speed(&self) -> f64 {
        self.top_speed
    }

    /// No leg is faster over ground than this on the mean, m/s.
    ///
    /// Forces could be brought up for a moment beyond the speed that they keep; this is what legs are looked for with.
    pub fn fastest(&self) -> f64 {
        self.map.fastest().min(self.limits.max_speed)
    }

    /// The state at `place`, where a trip begins or ends, with `velocity` over ground.
    pub fn end(&self, place: &Point3<f64>, velocity: [f64; 2]) -> BoatEnd {
        let heading = self.bow(velocity).filter(|_| is_motion(velocity));
        BoatEnd { place: [place.x, place.y], velocity, heading }
    }

    /// The state at `place`, between the ends of a trip, with `velocity` over ground: of the leg that leads there and
    /// of the one that goes on, so that at rest its bow points into the current.
    ///
    /// `None` at rest in still water, where the two legs would turn it to a heading each.
    pub fn between(&self, place: &Point3<f64>, velocity: [f64; 2]) -> Option<BoatEnd> {
        Some(BoatEnd { heading: Some(self.bow(velocity)?), ..self.end(place, velocity) })
    }

    /// The heading of the motion through the water, rad; drifting with the water it may as well point where it drifts.
    fn bow(&self, velocity: [f64; 2]) -> Option<f64> {
        let [x, y] = [self.map.through_water(velocity), velocity].into_iter().find(|motion| is_motion(*motion))?;
        Some(libm::atan2(y, x))
    }

    /// The one leg from `from` to `to` in `duration` (s, > 0), not judged: it turns the shorter way round.
    ///
    /// x, y and ψ by one polynomial of degree 7 each, from value and three derivatives at both ends.
    #[inline]
    pub fn connect(from: &BoatEnd, to: &BoatEnd, duration: f64) -> ProfileLeg {
        let ahead = libm::atan2(to.place[1] - from.place[1], to.place[0] - from.place[0]);
        let begins = from.heading.unwrap_or(ahead);
        let turn = libm::remainder(to.heading.unwrap_or(ahead) - begins, std::f64::consts::TAU);
        let axis = |i: usize| {
            septic(&[from.place[i], from.velocity[i], 0.0, 0.0], &[to.place[i], to.velocity[i], 0.0, 0.0], duration)
        };
        let heading = septic(&[begins, 0.0, 0.0, 0.0], &[begins + turn, 0.0, 0.0, 0.0], duration);
        ProfileLeg { duration, coefficients: [axis(0), axis(1), heading] }
    }

    /// The leg from `from` to `to` in `duration`, if every limit holds at every instant of it.
    ///
    /// # Errors
    /// The limit that fails, where, and by how much.
    ///
    /// Four instants first, then proof; a duration that is not finite and positive is refused as such.
    pub fn judge(&self, from: &BoatEnd, to: &BoatEnd, duration: f64) -> Result<ProfileLeg, BoatInfeasible> {
        if !(duration > 0.0 && duration.is_finite()) {
            return Err(BoatInfeasible::Violates { limit: BoatLimit::Duration, at: 0.0, margin: -duration.abs() });
        }
        let mean = libm::hypot(to.place[0] - from.place[0], to.place[1] - from.place[1]) / duration;
        if mean > self.fastest() {
            let margin = self.fastest() - mean;
            return Err(BoatInfeasible::Violates { limit: BoatLimit::Speed, at: 0.0, margin });
        }
        let leg = Self::connect(from, to, duration);
        self.instants_allowed(&leg)?;
        self.prove(&leg)?;
        Ok(leg)
    }

    /// Proves that every limit holds at every instant of `leg`.
    ///
    /// # Errors
    /// As [`Self::judge`].
    pub fn prove(&self, leg: &ProfileLeg) -> Result<(), BoatInfeasible> {
        self.waters.contains(leg)?;
        self.forces.prove(&self.map, leg)
    }

    /// Forces, speed and edges at four instants.
    #[inline]
    fn instants_allowed(&self, leg: &ProfileLeg) -> Result<(), BoatInfeasible> {
        const INSTANTS: [f64; 4] = [0.2, 0.4, 0.6, 0.8];
        let d = leg.coefficients.map(|c| derivatives(&c, f64x4::new(INSTANTS) * leg.duration));
        let demand = self.map.demand(&motion(|axis, order| d[axis][order]));
        if let Some((lane, limit, margin)) = self.forces.violation(&demand) {
            return Err(BoatInfeasible::Violates { limit, at: INSTANTS[lane] * leg.duration, margin });
        }
        let places = [0, 1].map(|axis| d[axis][0].to_array());
        (0..4).try_for_each(|k| self.waters.allows([places[0][k], places[1][k]], INSTANTS[k] * leg.duration))
    }
}
