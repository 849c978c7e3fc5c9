//! `crazyflie-goto`: a `go_to` of the Crazyflie's high-level commander for each waypoint, followed by its PID.
//!
//! The commander plans one polynomial of degree 7 a `go_to`, from the motion that is *planned* at that moment, not from
//! where the robot is. Who waits until one is over before he sends the next plans from rest to rest, straight:
//!
//! ```text
//! p = p(0) + (p(T) − p(0)) (35 σ⁴ − 84 σ⁵ + 70 σ⁶ − 20 σ⁷),    σ = τ/T,    T = |p(T) − p(0)|/v
//! ```
//!
//! So does `PositionHlCommander` of cflib 0.1.34, which sleeps for T, and so is it done here: the next `go_to` is given
//! once the waypoint is reached, inside the scenario's acceptance radius, and the one before is over. Sent while
//! another is under way, a `go_to` begins with that one's velocity and acceleration, and the longer it takes the
//! farther it swings out: by 20 m for a hop of 0.3 m before a leg of 6 m. cflib warns of it ("unexpected routes"),
//! firmware issue 1111 is such a flight; it is a mistake of who calls the stack, not the stack's own.
//!
//! The mean speed v is `goto_speed_m_s`, by default a tenth of the robot's top speed: 0.5 m/s for the Crazyflie, which
//! is what `PositionHlCommander` has by default. [`pid`] follows the polynomial's position.
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

/// Of a `go_to`, m/s: `given`, or a tenth of the robot's top speed; never more than that.
pub(super) fn mean_speed(robot: &Quadrotor, given: Option<f64>) -> f64 {
    given.unwrap_or(SHARE_OF_TOP_SPEED * robot.max_speed).min(robot.max_speed)
}

impl CrazyflieGoto {
    /// At a mean speed of `speed` m/s, or a tenth of the robot's top speed.
    pub(crate) fn new(robot: &Quadrotor, speed: Option<f64>, bandwidth: f64) -> Self {
        let speed = mean_speed(robot, speed);
        let pid = Pid::new(robot.mass * robot.gravity, MAX_VELOCITY.max(PEAK * speed), bandwidth);
        Self { speed, pid, plan: None }
    }

    /// The `go_to` on its way; once it is over, the next one, if its waypoint was reached.
    fn planned(&mut self, to: &Reference<Quadrotor>) -> &mut Plan {
        let asked = to.next.min(to.waypoints.len() - 1);
        let speed = self.speed;
        let plan = self.plan.get_or_insert_with(|| Plan::at_rest(to.waypoints[0].coords));
        if plan.is_over() && plan.waypoint < asked {
            *plan = plan.go_to(to.waypoints[plan.waypoint + 1].coords, speed);
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

    fn position(&self) -> Vector3<f64> {
        self.leg.derivative(self.tau, 0)
    }

    fn is_over(&self) -> bool {
        self.tau >= self.leg.duration
    }

    /// On to the next waypoint, `target` (m), in the time that `speed` m/s takes straight.
    fn go_to(&self, target: Vector3<f64>, speed: f64) -> Self {
        let from = self.position();
        let duration = ((target - from).norm() / speed).max(LEAST_DURATION);
        let axis = |i: usize| septic(&[from[i], 0.0, 0.0, 0.0], &[target[i], 0.0, 0.0, 0.0], duration);
        let leg = ProfileLeg { duration, coefficients: [axis(0), axis(1), axis(2)] };
        Self { waypoint: self.waypoint + 1, leg, tau: 0.0 }
    }
}

impl Controller<Quadrotor> for CrazyflieGoto {
    fn control(&mut self, dt: f64, now: &FlightState, to: &Reference<Quadrotor>) -> Result<FlightCommand, Fault> {
        let plan = self.planned(to);
        let position = plan.position();
        plan.tau = (plan.tau + dt).min(plan.leg.duration);
        Ok(self.pid.follow(dt, now, &position))
    }
}

#[cfg(feature = "unit-tests")]
mod tests {
    use nalgebra::{Point3, UnitQuaternion};

    use super::*;

    fn start() -> Plan {
        Plan::at_rest(Vector3::new(1.0, 2.0, 3.0))
    }

    #[test]
    fn it_is_straight_and_peaks_at_35_sixteenths_of_its_mean_speed() {
        let target = Vector3::new(4.0, 6.0, 3.0);
        let mut plan = start().go_to(target, 0.5);
        assert!((plan.leg.duration - 10.0).abs() < 1e-12);
        let (way, from) = (target - Vector3::new(1.0, 2.0, 3.0), Vector3::new(1.0, 2.0, 3.0));
        let mut peak: f64 = 0.0;
        for i in 0..=1000 {
            plan.tau = 0.01 * i as f64;
            assert!((plan.position() - from).cross(&way).norm() < 1e-9);
            peak = peak.max(plan.leg.derivative(plan.tau, 1).norm());
        }
        assert!((peak - 35.0 / 16.0 * 0.5).abs() < 1e-6, "{peak}");
        assert!((plan.position() - target).norm() < 1e-9 && plan.leg.derivative(10.0, 1).norm() < 1e-9);
    }

    /// A hop before a long leg, reached while the plan still moves: a `go_to` from that motion would swing out by 20 m.
    #[test]
    fn the_next_one_is_given_once_the_one_before_is_over() {
        let waypoints = [[1.0, 1.0, 1.0], [1.3, 1.0, 1.0], [1.3, 7.0, 1.0]].map(Point3::from);
        let mut controller = CrazyflieGoto { speed: 0.5, pid: Pid::new(0.3, MAX_VELOCITY, 1.0), plan: None };
        let mut reached = 1;
        for turn in 0..1400 {
            let to = Reference { waypoints: &waypoints, next: reached, accept: 0.3, plan: None };
            let at = controller.planned(&to).position();
            assert!((at.x - 1.3).min(0.0) * (at.y - 1.0) == 0.0 && at.x < 1.3 + 1e-9, "{turn}: {at}");
            let now = FlightState {
                t: 0.01 * turn as f64,
                position: at,
                velocity: Vector3::zeros(),
                attitude: UnitQuaternion::identity(),
                rates: Vector3::zeros(),
            };
            controller.control(0.01, &now, &to).unwrap();
            reached = if turn < 30 { 1 } else { 2 };
        }
        assert!((controller.plan.unwrap().position() - waypoints[2].coords).norm() < 1e-9);
    }
}
