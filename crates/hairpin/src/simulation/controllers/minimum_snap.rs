//! `minimum-snap`: a point moves along the minimum-snap polynomial, and the waypoint cascade follows the point.

use nalgebra::{Point3, Vector3};

use super::cascade::{Cascade, Gains};
use super::curve::{Curve, NOT_RESET, Pace, SegmentTimes};
use crate::robot::quadrotor::Quadrotor;
use crate::simulation::command::{FlightCommand, FlightState};
use crate::simulation::controller::{Controller, Fault, Reference, Schedule};
use crate::trajectory::Profile;

/// Fixed by `tests/step_responses.rs`.
const GAINS: Gains = Gains {
    position: Vector3::new(1.0, 1.0, 1.0),
    velocity_p: Vector3::new(3.0, 3.0, 3.5),
    velocity_i: Vector3::new(0.0, 0.0, 0.3),
    velocity_d: Vector3::new(0.0, 0.0, 0.0),
    winds_up: false,
    max_speed: f64::INFINITY,
    max_tilt: 0.8,
};

/// The point waits while it is farther ahead than this, m (the paper's authors' set point advances inside 3 m).
const LEASH: f64 = 3.0;

/// See the file's first line. The point's velocity is fed forward to the velocity loop.
///
/// v* = K_p (p_r − p) + v_r while the point is within 3 m, K_p (p_r − p) alone where it waits: late robots stretch
/// time, they do not cut the curve.
#[derive(Debug, Clone)]
pub(crate) struct MinimumSnap {
    cascade: Cascade,
    pace: Pace,
    curve: Option<Curve>,
}

impl MinimumSnap {
    /// Along a curve with leg times by `rule`.
    pub(crate) fn new(robot: &Quadrotor, rule: SegmentTimes) -> Self {
        Self { cascade: Cascade::new(robot, GAINS), pace: Pace::new(robot, rule), curve: None }
    }
}

/// The curve that it leads `robot` along, from waypoint to waypoint; `None` where there is none through them.
pub fn minimum_snap_curve(robot: &Quadrotor, rule: SegmentTimes, waypoints: &[Point3<f64>]) -> Option<Profile> {
    Some(Curve::through(waypoints, &Pace::new(robot, rule)).ok()?.into_profile())
}

impl Controller<Quadrotor> for MinimumSnap {
    fn reset(&mut self, reference: &Reference<Quadrotor>) -> Result<(), Fault> {
        self.curve = Some(Curve::through(reference.waypoints, &self.pace)?);
        Ok(())
    }

    fn control(&mut self, dt: f64, now: &FlightState, _to: &Reference<Quadrotor>) -> Result<FlightCommand, Fault> {
        let curve = self.curve.as_mut().ok_or(NOT_RESET)?;
        let [position, velocity, ..] = curve.sample();
        let error = position - now.position;
        let waits = error.norm() >= LEASH;
        if !waits {
            curve.advance(dt);
        }
        let moving = if waits { Vector3::zeros() } else { velocity };
        let wanted = self.cascade.approach(&error) + moving;
        Ok(FlightCommand::Force(self.cascade.follow(dt, now, &wanted)))
    }

    fn schedule(&self) -> Option<Schedule> {
        self.curve.as_ref().map(Curve::schedule)
    }
}
