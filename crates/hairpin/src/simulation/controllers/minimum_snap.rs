//! `minimum-snap`: a point moves along the minimum-snap polynomial, and the waypoint cascade follows the point.

use nalgebra::{Point3, Vector3};

use super::cascade::{Cascade, Gains};
use super::curve::{Curve, NOT_RESET, Pace, SegmentTimes};
use crate::robot::quadrotor::Quadrotor;
use crate::simulation::command::{FlightCommand, FlightState};
use crate::simulation::controller::{Controller, Fault, Reference, Schedule};
use crate::trajectory::Profile;

/// Fixed by `tests/library/step_responses.rs`.
///
/// 1/s on position and velocity, 1/s² on the integral; tilt in rad. What is not fed forward, an acceleration a, is
/// missed by a/(K_p K_v).
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
    /// `None` before the first reset.
    curve: Option<Curve>,
}

impl MinimumSnap {
    /// Along a curve with leg times by `rule`.
    pub(crate) fn new(robot: &Quadrotor, rule: SegmentTimes, bandwidth: f64) -> Self {
        let cascade = Cascade::new(robot, GAINS).with_bandwidth(bandwidth);
        Self { cascade, pace: Pace::new(robot, rule), curve: None }
    }
}

/// The curve that it leads `robot` along, from waypoint to waypoint; `None` where there is none through them.
///
/// From rest to rest, with leg times by the rule; velocities and accelerations at waypoints follow from the curve.
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

#[cfg(feature = "unit-tests")]
mod tests {
    use nalgebra::Point3;

    use super::*;
    use crate::simulation::tests::{cage, shipped};
    use crate::simulation::{Conditions, ControllerKind, ControllerSettings, FlySettings, Sortie, fly};
    use crate::trajectory::{Ended, Flight};

    /// Largest distance of a flight from the curve's point at its time, m.
    fn behind(flight: &Flight, curve: &Curve) -> f64 {
        let (mut point, mut clock, mut farthest) = (curve.clone(), 0.0, 0.0f64);
        for (i, t) in flight.track.times().iter().enumerate() {
            point.advance(t - clock);
            clock = *t;
            farthest = farthest.max((point.sample()[0] - flight.track.position(i).coords).norm());
        }
        farthest
    }

    /// What is not fed forward is missed by: the same curve, followed with its acceleration, is met. It is no matter of
    /// time, and of no robot: the run is over with the curve, 40 s and more before its limit.
    #[test]
    fn waypoints_are_missed_by_the_acceleration_that_is_not_fed_forward() {
        let waypoints =
            [[1.0, 1.0, 2.0], [5.0, 2.0, 4.0], [2.0, 5.0, 5.0], [6.0, 6.0, 3.0], [3.0, 2.0, 5.0], [7.0, 4.0, 4.0]]
                .map(Point3::from);
        let world = cage();
        for robot in shipped() {
            let curve = Curve::through(&waypoints, &Pace::new(&robot, SegmentTimes::SqrtLength)).unwrap();
            let (mut point, mut hardest) = (curve.clone(), 0.0f64);
            while !point.schedule().over {
                hardest = hardest.max(point.sample()[2].norm());
                point.advance(0.01);
            }
            let sortie = Sortie { robot: &robot, world: &world, waypoints: &waypoints, profile: None };
            let flown = |kind, accept| {
                let controller = ControllerSettings { kind, ..ControllerSettings::default() };
                let settings = FlySettings { accept, ..FlySettings::default() };
                fly(&sortie, &controller, &Conditions::default(), &settings, 1).unwrap()
            };
            // At a steady acceleration the velocity loop needs a/K_v, and the position loop e = a/(K_p K_v) for that.
            let expected = hardest / (GAINS.position.x * GAINS.velocity_p.x);
            let narrow = flown(ControllerKind::MinimumSnap, 0.15);
            let late = behind(&narrow, &curve);
            let told = format!("{}: {late} m where {expected} m are expected", robot.name);
            assert!(late > 0.4 * expected && late < 1.2 * expected, "{told}");
            assert!(narrow.ended == Ended::Time && narrow.reached.last().is_some_and(Option::is_some), "{told}");
            assert!(*narrow.track.times().last().unwrap() < 50.0, "{told}");
            assert_eq!(flown(ControllerKind::MinimumSnap, 1.5).ended, Ended::Done, "{told}");
            let tracked = flown(ControllerKind::Geometric, 0.3);
            assert!(tracked.ended == Ended::Done && behind(&tracked, &curve) < 0.2 * late, "{told}");
        }
    }
}
