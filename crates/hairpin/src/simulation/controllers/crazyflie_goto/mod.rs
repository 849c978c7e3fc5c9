//! `crazyflie-goto`: a `go_to` of the Crazyflie's high-level commander for each waypoint, followed by its PID.
//!
//! The commander plans one polynomial of degree 7 a `go_to`, from the motion that is *planned* at that moment, not from
//! where the robot is, to rest at the waypoint, with the acceleration at its start and no jerk at either end:
//!
//! ```text
//! p(0), ṗ(0), p̈(0) as planned, p⃛(0) = 0;    p(T) the waypoint, ṗ(T) = p̈(T) = p⃛(T) = 0;    T = |p(T) − p(0)|/v
//! ```
//!
//! The next `go_to` is given once the waypoint is reached, inside the scenario's acceptance radius, so that it knows of
//! one waypoint at a time: where the plan still moves then, the next path begins with that velocity and swings out.
//! The mean speed v is `goto_speed_m_s`, by default a tenth of the robot's top speed: 0.5 m/s for the Crazyflie, which
//! is what `PositionHlCommander` of cflib 0.1.34 has by default. [`pid`] follows the polynomial's position.
//!
//! Source: `planner.c` and `pptraj.c` of crazyflie-firmware 2026.08 for what is planned from where, after Mellinger and
//! Kumar (ICRA 2011); the polynomial is this library's own, and none of the firmware's code is here. What differs: the
//! attitude and rate loops are the simulator's, and there is no estimator.

mod pid;

use nalgebra::Vector3;

use self::pid::Pid;
use crate::math::polynomial::septic;
use crate::robot::quadrotor::Quadrotor;
use crate::simulation::command::{FlightCommand, FlightState};
use crate::simulation::controller::{Controller, Fault, Reference};
use crate::trajectory::ProfileLeg;

/// Mean speed of a `go_to` over the robot's top speed, where none is given.
const SHARE_OF_TOP_SPEED: f64 = 0.1;
/// The firmware's largest velocity on each axis, 1 m/s and a tenth more.
const MAX_VELOCITY: f64 = 1.1;
/// Peak over mean speed of the polynomial from rest to rest, 35/16: who flies faster raises the limit to it.
const PEAK: f64 = 2.1875;
/// Shortest duration of a `go_to`, s: waypoints that coincide still take some.
const LEAST_DURATION: f64 = 0.2;

/// See the file's first line.
#[derive(Debug, Clone)]
pub(crate) struct CrazyflieGoto {
    /// Mean speed of a `go_to`, m/s.
    speed: f64,
    pid: Pid,
    plan: Option<Plan>,
}

/// A `go_to` on its way: which waypoint's, its polynomial, and the time on it.
#[derive(Debug, Clone)]
struct Plan {
    waypoint: usize,
    leg: ProfileLeg,
    tau: f64,
}

impl CrazyflieGoto {
    /// At a mean speed of `speed` m/s, or a tenth of the robot's top speed.
    pub(crate) fn new(robot: &Quadrotor, speed: Option<f64>, bandwidth: f64) -> Self {
        let speed = speed.unwrap_or(SHARE_OF_TOP_SPEED * robot.max_speed).min(robot.max_speed);
        let pid = Pid::new(robot.mass * robot.gravity, MAX_VELOCITY.max(PEAK * speed), bandwidth);
        Self { speed, pid, plan: None }
    }

    /// The plan to the waypoint that `to` asks for: the one there is, or a new `go_to` from what was planned.
    fn planned(&mut self, to: &Reference<Quadrotor>) -> &mut Plan {
        let waypoint = to.next.min(to.waypoints.len() - 1);
        let speed = self.speed;
        let at_rest = || Plan::at_rest(to.waypoints[0].coords);
        let plan = self.plan.get_or_insert_with(at_rest);
        if plan.waypoint != waypoint {
            *plan = plan.go_to(waypoint, to.target(), speed);
        }
        plan
    }
}

impl Plan {
    /// At the first waypoint, before anything was asked.
    fn at_rest(position: Vector3<f64>) -> Self {
        let still = |p: f64| [p, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
        let coefficients = [still(position.x), still(position.y), still(position.z)];
        Self { waypoint: 0, leg: ProfileLeg { duration: LEAST_DURATION, coefficients }, tau: LEAST_DURATION }
    }

    /// Position, velocity and acceleration now; at the end it stands still.
    fn sample(&self) -> [Vector3<f64>; 3] {
        let mut sample = [0, 1, 2].map(|order| self.leg.derivative(self.tau, order));
        if self.tau >= self.leg.duration {
            sample[1..].fill(Vector3::zeros());
        }
        sample
    }

    /// On from here to `target` (m), in the time that `speed` m/s takes straight.
    fn go_to(&self, waypoint: usize, target: Vector3<f64>, speed: f64) -> Self {
        let [p, v, a] = self.sample();
        let duration = ((target - p).norm() / speed).max(LEAST_DURATION);
        let axis = |i: usize| septic(&[p[i], v[i], a[i], 0.0], &[target[i], 0.0, 0.0, 0.0], duration);
        Self { waypoint, leg: ProfileLeg { duration, coefficients: [axis(0), axis(1), axis(2)] }, tau: 0.0 }
    }
}

impl Controller<Quadrotor> for CrazyflieGoto {
    fn control(&mut self, dt: f64, now: &FlightState, to: &Reference<Quadrotor>) -> Result<FlightCommand, Fault> {
        let plan = self.planned(to);
        let [position, ..] = plan.sample();
        plan.tau = (plan.tau + dt).min(plan.leg.duration);
        Ok(self.pid.follow(dt, now, &position))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn start() -> Plan {
        Plan::at_rest(Vector3::new(1.0, 2.0, 3.0))
    }

    #[test]
    fn from_rest_it_is_straight_and_peaks_at_35_sixteenths_of_its_mean_speed() {
        let target = Vector3::new(4.0, 6.0, 3.0);
        let mut plan = start().go_to(1, target, 0.5);
        assert!((plan.leg.duration - 10.0).abs() < 1e-12);
        let (way, from) = (target - Vector3::new(1.0, 2.0, 3.0), Vector3::new(1.0, 2.0, 3.0));
        let mut peak: f64 = 0.0;
        for i in 0..=1000 {
            plan.tau = 0.01 * i as f64;
            let [p, v, _] = plan.sample();
            assert!((p - from).cross(&way).norm() < 1e-9);
            peak = peak.max(v.norm());
        }
        assert!((peak - 35.0 / 16.0 * 0.5).abs() < 1e-6, "{peak}");
        assert!((plan.sample()[0] - target).norm() < 1e-9 && plan.sample()[1].norm() == 0.0);
    }

    /// Asked in mid-flight, the next path takes over position, velocity and acceleration, and ends at rest.
    #[test]
    fn the_next_one_begins_with_the_planned_motion() {
        let mut first = start().go_to(1, Vector3::new(4.0, 2.0, 3.0), 1.0);
        first.tau = 1.9;
        let mut second = first.go_to(2, Vector3::new(4.0, 5.0, 3.0), 1.0);
        for (before, after) in first.sample().into_iter().zip(second.sample()) {
            assert!((before - after).norm() < 1e-9, "{before} {after}");
        }
        assert!(second.leg.derivative(0.0, 3).norm() < 1e-9);
        let end = second.leg.duration;
        for order in 1..=3 {
            assert!(second.leg.derivative(end, order).norm() < 1e-8, "order {order}");
        }
        // The corner is swung out of: the path goes on along x before it comes back.
        second.tau = 0.5;
        let farthest = (0..300).map(|i| second.leg.derivative(0.01 * i as f64, 0).x).fold(0.0, f64::max);
        assert!(farthest > first.sample()[0].x + 0.1, "{farthest}");
    }
}
