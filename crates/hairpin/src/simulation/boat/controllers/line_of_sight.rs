//! `line-of-sight`: an autopilot that goes from waypoint to waypoint, and knows of one at a time.
//!
//! Integral line of sight (Børhaug, Pavlov, Pettersen, CDC 2008): with e the distance to port of the line from the last
//! waypoint to the next and Δ the lookahead,
//!
//! ```text
//! ψ_d = α − atan((e + σ y)/Δ)      ẏ = Δ e/((e + σ y)² + Δ²)
//! ```
//!
//! so that y comes to the angle of crab that a current asks for. Heading by a PD law on the moment, speed by PI on the
//! force ahead; the force to the sides takes off what a turn makes it drift through the water, as far as it goes. A
//! waypoint that was missed is gone back to.

use nalgebra::{Vector2, Vector3};

use super::super::command::{BoatCommand, BoatState};
use super::angle::wrap;
use crate::robot::boat::Boat;
use crate::simulation::controller::{Controller, Fault, Reference};

/// Lookahead Δ, in radii of the hull's disc, and the weight σ of the integral over Δ, 1/s. Fixed by the step responses
/// of the tests, as are the gains.
const LOOKAHEAD: f64 = 3.0;
const INTEGRAL: f64 = 0.02;
/// Of heading: 1/s² and 1/s.
const HEADING: [f64; 2] = [0.5, 1.2];
/// Of speed: 1/s and 1/s².
const SPEED: [f64; 2] = [0.6, 0.05];
/// Of drift, 1/s.
const DRIFT: f64 = 0.6;
/// Way to the last waypoint per speed from which on it slows down, s.
const APPROACH: f64 = 5.0;

/// See the file's first line.
#[derive(Debug, Clone)]
pub(in crate::simulation::boat) struct LineOfSight {
    boat: Boat,
    speed: f64,
    lookahead: f64,
    /// Number of the waypoint that it goes to, and where the line there begins.
    line: (usize, Vector2<f64>),
    /// y, m.
    integral: f64,
    /// Of the speed's error, m.
    behind: f64,
}

impl LineOfSight {
    pub(super) fn new(nominal: &Boat, speed: f64) -> Self {
        let lookahead = LOOKAHEAD * nominal.radius;
        Self {
            speed: speed.min(nominal.top_speed),
            boat: nominal.clone(),
            lookahead,
            line: (0, Vector2::zeros()),
            integral: 0.0,
            behind: 0.0,
        }
    }

    /// The heading to steer for the next `dt` s, rad, on the line from `from` to `to`.
    fn guide(&mut self, dt: f64, at: &Vector2<f64>, from: &Vector2<f64>, to: &Vector2<f64>) -> f64 {
        let along = to - from;
        let course = libm::atan2(along.y, along.x);
        let (sin, cos) = libm::sincos(course);
        let off = cos * (at.y - from.y) - sin * (at.x - from.x);
        let sigma = INTEGRAL * self.lookahead;
        let sum = off + sigma * self.integral;
        self.integral += dt * self.lookahead * off / (sum * sum + self.lookahead * self.lookahead);
        course - libm::atan(sum / self.lookahead)
    }

    /// The forces for heading and speed.
    fn steer(&mut self, dt: f64, now: &BoatState, heading: f64, speed: f64) -> BoatCommand {
        let off = wrap(heading - now.heading);
        let short = speed - now.velocity.x;
        let surge = self.boat.damping.resistance(speed)
            + self.boat.inertia.surge * (SPEED[0] * short + SPEED[1] * (self.behind + dt * short));
        let thrust = &self.boat.thrust;
        // What the propellers cannot give is not summed up.
        if (-thrust.astern..=thrust.ahead).contains(&surge) {
            self.behind += dt * short;
        }
        let nu = now.through_water;
        let water = self.boat.inertia.coriolis(&nu) + self.boat.damping.force(&Vector3::new(0.0, 0.0, nu.z));
        let sway = water.y - self.boat.inertia.sway * DRIFT * nu.y;
        let yaw = water.z + self.boat.inertia.yaw * (HEADING[0] * off - HEADING[1] * nu.z);
        BoatCommand { surge, sway, yaw }
    }
}

impl Controller<Boat> for LineOfSight {
    fn control(&mut self, dt: f64, now: &BoatState, to: &Reference<Boat>) -> Result<BoatCommand, Fault> {
        let plane = |v: Vector3<f64>| Vector2::new(v.x, v.y);
        let last = to.waypoints.len() - 1;
        let target = plane(to.target());
        if to.holds() {
            return Ok(self.steer(dt, now, now.heading, 0.0));
        }
        if self.line.0 != to.next {
            self.line = (to.next, plane(to.waypoints[to.next.min(last).saturating_sub(1)].coords));
        }
        // Who has gone past turns round for it.
        if (now.position - target).dot(&(target - self.line.1)) > 0.0 {
            self.line.1 = now.position;
        }
        let from = self.line.1;
        let heading = self.guide(dt, &now.position, &from, &target);
        let left = (target - now.position).norm();
        let speed = if to.next == last { self.speed.min(left / APPROACH + 0.1 * self.speed) } else { self.speed };
        Ok(self.steer(dt, now, heading, speed))
    }
}
