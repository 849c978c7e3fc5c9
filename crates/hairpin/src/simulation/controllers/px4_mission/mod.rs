//! `px4-mission`: flies waypoints as PX4 flies a mission, with the defaults of PX4 v1.16.
//!
//! A set point moves along a path of bounded speed, acceleration and jerk ([`guidance`], `math::jerk_limit`), and a
//! cascade follows it ([`tracking`]): P on position, PID on velocity, then the attitude and rate loops and the mixer
//! that all controllers here fly on, where yaw gives way first. A waypoint is reached inside a cylinder, of the
//! scenario's acceptance radius and `NAV_MC_ALT_RAD` = 0.8 m up and down; then the next three are looked at, so that it
//! knows one waypoint more than the next.
//!
//! ```text
//! horizontal   5 m/s, 3 m/s²       climb   3 m/s, 4 m/s²       sink   1.5 m/s, 3 m/s²       jerk   4 m/s³ on each axis
//! time of the set point   · (1 − |p_s − p|/2 m) horizontally, where the robot is behind it
//! ```
//!
//! Written from PX4's documentation and parameter reference and the equations of its controllers; none of its code is
//! here. What differs: yaw stays 0, as of all controllers here, where PX4 turns towards the waypoint; there is no
//! estimator; attitude and rate loops have the simulator's bandwidths (7 and 21 rad/s, where `MC_ROLL_P` is 6.5);
//! take-off and landing are not flown; a top speed of the robot that is lower bounds all speeds; of a leg's slope the
//! way from above is taken as it is flown, where v1.16 takes the difference of distances from home.

mod guidance;
mod parameters;
mod tracking;

use nalgebra::Vector3;

use self::guidance::Guidance;
use self::tracking::Tracking;
use crate::math::jerk_limit::{AxisLimits, JerkLimited};
use crate::robot::quadrotor::Quadrotor;
use crate::simulation::command::{FlightCommand, FlightState, attitude_of, level_heading};
use crate::simulation::controller::{Acceptance, Controller, Fault, Reference};

/// Height above and below within which a waypoint counts as reached, m.
pub(super) const ACCEPTANCE_HEIGHT: f64 = parameters::NAV_MC_ALT_RAD;

/// Horizontal speed of missions, m/s.
pub(super) const CRUISE: f64 = parameters::MPC_XY_CRUISE;

/// See the file's first line.
#[derive(Debug, Clone)]
pub(crate) struct Px4Mission {
    mass: f64,
    /// m/s, of the robot.
    max_speed: f64,
    guidance: Guidance,
    tracking: Tracking,
    /// `None` before the first turn; then it starts at rest at the first waypoint.
    point: Option<JerkLimited>,
    /// Whether the set point was last asked to climb.
    ///
    /// It chooses the limits of the next turn, one turn late.
    climbs: bool,
}

impl Px4Mission {
    /// For a robot, which may be slower than the parameters.
    pub(crate) fn new(robot: &Quadrotor, bandwidth: f64) -> Self {
        Self {
            mass: robot.mass,
            max_speed: robot.max_speed,
            guidance: Guidance::new(),
            tracking: Tracking::new(robot, bandwidth),
            point: None,
            climbs: false,
        }
    }

    /// Horizontal and vertical limits of the set point.
    ///
    /// m/s, m/s² and m/s³: horizontally for x and y alike, vertically those of climb or sink.
    fn limits(&self) -> (AxisLimits, AxisLimits) {
        use self::parameters as px4;
        let bounded = |speed: f64, acceleration: f64| AxisLimits {
            speed: speed.min(self.max_speed),
            acceleration,
            jerk: px4::MPC_JERK_AUTO,
        };
        let vertical = if self.climbs {
            bounded(px4::MPC_Z_V_AUTO_UP, px4::MPC_ACC_UP_MAX)
        } else {
            bounded(px4::MPC_Z_V_AUTO_DN, px4::MPC_ACC_DOWN_MAX)
        };
        (bounded(px4::MPC_XY_CRUISE, px4::MPC_ACC_HOR), vertical)
    }

    /// The set point after `dt` s, on its way to where `to` says.
    ///
    /// The set point's own time goes by `stretch`, so that its limits hold in its time and are milder in the robot's.
    fn advance(&mut self, dt: f64, position: &Vector3<f64>, to: &Reference<Quadrotor>) -> JerkLimited {
        let mut point = self.point.unwrap_or_else(|| JerkLimited::at_rest(to.waypoints[0].coords));
        self.guidance.note(to, position);
        let (horizontal, vertical) = self.limits();
        let wanted = self.guidance.velocity(&point, &horizontal, &vertical);
        self.climbs = wanted.z > 0.0;
        point.follow(&wanted, &[horizontal, horizontal, vertical], dt * stretch(&point, position));
        self.point = Some(point);
        point
    }
}

impl Controller<Quadrotor> for Px4Mission {
    fn control(&mut self, dt: f64, now: &FlightState, to: &Reference<Quadrotor>) -> Result<FlightCommand, Fault> {
        let point = self.advance(dt, &now.position, to);
        let force = self.tracking.thrust(dt, now, &point);
        let attitude = attitude_of(&level_heading(&force));
        Ok(FlightCommand::Attitude { thrust: self.mass * force.norm(), attitude })
    }

    fn acceptance(&self) -> Acceptance {
        Acceptance::Cylinder { height: ACCEPTANCE_HEIGHT }
    }
}

/// Share of the time that passes for the set point: less, the farther the robot is behind it.
///
/// 1 − min(1, |p_s − p|/2 m) where (p_s − p)·v_s ≥ 0, from above; else 1. At 2 m and more the point stands still.
fn stretch(point: &JerkLimited, position: &Vector3<f64>) -> f64 {
    let behind = (point.position - position).xy();
    if behind.dot(&point.velocity.xy()) < 0.0 {
        return 1.0;
    }
    1.0 - (behind.norm() / parameters::MPC_XY_ERR_MAX).min(1.0)
}

#[cfg(feature = "unit-tests")]
mod tests {
    use nalgebra::Point3;

    use super::*;
    use crate::math::jerk_limit::{braking_speed, corner_speed};
    use crate::simulation::controller::Controller;
    use crate::simulation::tests::{cage, flightgoggles};
    use crate::simulation::{Conditions, ControllerKind, ControllerSettings, FlySettings, Sortie, fly};
    use crate::trajectory::Ended;

    /// The set points along a course whose robot is always where the set point is, 10 ms apart.
    fn set_points(waypoints: &[[f64; 3]], accept: f64) -> Vec<JerkLimited> {
        let waypoints: Vec<Point3<f64>> = waypoints.iter().copied().map(Point3::from).collect();
        let mut pilot = Px4Mission::new(&flightgoggles(), 1.0);
        let mut points = vec![JerkLimited::at_rest(waypoints[0].coords)];
        let (mut next, mut position) = (1, waypoints[0].coords);
        while next < waypoints.len() || points[points.len() - 1].velocity.norm() > 1e-3 {
            let to = Reference { waypoints: &waypoints, next, accept, plan: None };
            points.push(pilot.advance(0.01, &position, &to));
            position = points[points.len() - 1].position;
            let away = to.target() - position;
            if next < waypoints.len() && away.xy().norm() <= accept && away.z.abs() <= ACCEPTANCE_HEIGHT {
                next += 1;
            }
            assert!(points.len() < 20_000, "never comes to {next} of {waypoints:?}");
        }
        points
    }

    /// Turns, climbs and dives: no set point is faster, accelerates or jerks more than its axis may.
    #[test]
    fn the_profile_keeps_its_limits() {
        let course = [
            [5.0, 5.0, 5.0],
            [15.0, 6.0, 7.0],
            [6.0, 14.0, 4.0],
            [16.0, 15.0, 12.0],
            [16.5, 15.0, 12.0],
            [9.0, 4.0, 9.0],
            [9.0, 4.0, 16.0],
            [9.0, 12.0, 3.0],
            [20.0, 12.0, 3.0],
        ];
        let points = set_points(&course, 1.0);
        let (mut fastest, mut climb, mut sink): (f64, f64, f64) = (0.0, 0.0, 0.0);
        for pair in points.windows(2) {
            let jerk = (pair[1].acceleration - pair[0].acceleration) / 0.01;
            let a = pair[1].acceleration;
            assert!(jerk.amax() < 4.0 * (1.0 + 1e-6), "{jerk}");
            assert!(a.xy().amax() < 3.0 * (1.0 + 1e-9) && a.z < 4.0 * (1.0 + 1e-9) && a.z > -4.0, "{a}");
            fastest = fastest.max(pair[1].velocity.xy().norm());
            climb = climb.max(pair[1].velocity.z);
            sink = sink.min(pair[1].velocity.z);
        }
        // Between two directions the axes change alike, so that cruise speed is passed by little if at all.
        assert!(fastest > 3.0 && fastest < 5.0 * 1.02, "{fastest}");
        assert!(climb > 2.0 && climb < 3.0 + 1e-9 && sink < -1.4 && sink > -1.5 - 1e-9, "{climb} {sink}");
    }

    /// Straight on the whole way is flown without a halt; a turn is taken at no more than its speed; a reversal stops.
    #[test]
    fn the_speed_at_a_waypoint_is_that_of_its_angle() {
        let (start, corner) = ([0.0, 20.0, 10.0], [20.0, 20.0, 10.0]);
        for (turn, accept) in [(0.0f64, 1.0), (45.0, 1.0), (90.0, 1.0), (90.0, 2.0), (135.0, 2.0), (179.9, 1.0)] {
            let (s, c) = turn.to_radians().sin_cos();
            let end = [20.0 + 20.0 * c, 20.0 + 20.0 * s, 10.0];
            let points = set_points(&[start, corner, end], accept);
            // Speed where the waypoint is accepted, against the least of what corner, cruise and the way there allow.
            let accepted = points.iter().find(|p| (p.position - Vector3::from(corner)).xy().norm() <= accept);
            let speed = accepted.map_or(f64::NAN, |p| p.velocity.xy().norm());
            let passing = corner_speed(-c, 0.5 * 3.0, accept).min(5.0);
            let most = braking_speed(accept, passing, 3.0, 4.0).min(5.0);
            // The set point lags what it is asked for by the time that its jerk takes.
            assert!(speed < most + 0.6 && speed > 0.7 * most, "{turn}° at {accept} m: {speed} of {most} m/s");
        }
    }

    #[test]
    fn missions_are_flown_to_their_end_by_the_acceptance_cylinder() {
        let (robot, world) = (flightgoggles(), cage());
        // Each waypoint but the last is passed within 1 m from above, and 0.8 m in height: none is flown through.
        let waypoints = [[5.0, 5.0, 5.0], [15.0, 5.0, 8.0], [15.0, 15.0, 5.0], [5.0, 15.0, 9.0]].map(Point3::from);
        let sortie = Sortie { robot: &robot, world: &world, waypoints: &waypoints, profile: None };
        let settings = ControllerSettings { kind: ControllerKind::Px4Mission, ..Default::default() };
        let flight = fly(&sortie, &settings, &Conditions::default(), &FlySettings::default(), 1).unwrap();
        assert_eq!(flight.ended, Ended::Done, "{:?}", flight.reached);
        for (k, reached) in flight.reached.iter().enumerate().skip(1) {
            let first = reached.expect("done means all reached");
            let sample = flight.track.times().iter().position(|t| *t >= first - 1e-9).unwrap();
            let away = flight.track.position(sample) - waypoints[k];
            assert!(away.xy().norm() <= 1.0 && away.z.abs() <= 0.8, "waypoint {k}: {away}");
            let before = flight.track.position(sample - 2) - waypoints[k];
            assert!(before.xy().norm() > 1.0 || before.z.abs() > 0.8, "waypoint {k} is reached at once: {before}");
        }
    }

    #[test]
    fn a_set_point_waits_for_who_is_behind_and_not_for_who_is_ahead() {
        let point = JerkLimited { velocity: Vector3::x(), ..JerkLimited::at_rest(Vector3::zeros()) };
        for (x, share) in [(0.0, 1.0), (-0.5, 0.75), (-2.0, 0.0), (-9.0, 0.0), (1.5, 1.0)] {
            assert!((stretch(&point, &Vector3::new(x, 0.0, 7.0)) - share).abs() < 1e-12, "{x}");
        }
    }

    #[test]
    fn a_slower_robot_bounds_all_speeds() {
        let robot = Quadrotor { max_speed: 1.0, ..flightgoggles() };
        let (horizontal, vertical) = Px4Mission::new(&robot, 1.0).limits();
        assert_eq!((horizontal.speed, vertical.speed), (1.0, 1.0));
        assert!(Px4Mission::new(&robot, 1.0).period().is_none());
    }
}
