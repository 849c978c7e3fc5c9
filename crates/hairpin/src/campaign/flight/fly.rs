//! Flies missions in our own simulator.

use nalgebra::{Point3, Vector3};

use super::FlightSetup;
use super::fit;
use super::idle;
use super::place::place;
use crate::campaign::Case;
use crate::campaign::kind::{Act, Fittable, LegByLeg, Order, PassedOver, Same, Say};
use crate::campaign::placement::Placement;
use crate::simulation::{
    self, Airborne, Conditions, ControllerKind, ControllerSettings, DiscreteGust, FlySettings, Gusts, SimulationError,
    Sortie, minimum_snap_curve,
};
use crate::trajectory::{Flight, Profile, Track};

/// A run may take so many times its plan before it is given up.
const SLOWNESS_OF_PLAN: f64 = 2.0;
/// And so many times its way at the speed of who flies.
const SLOWNESS_OF_WAY: f64 = 1.5;
/// The mean speed of who has none of his own, m/s, or this share of the robot's top speed: polynomials from rest to
/// rest have 16/35 of their greatest.
///
/// The smaller of both: 16/35 ≈ 0.46 of the greatest is the mean speed of a septic from rest to rest.
const MODERATE_M_S: f64 = 3.0;
const SHARE_OF_TOP_SPEED: f64 = 0.6;

impl Act for FlightSetup {
    fn run(&self, _: Same, case: &Case, order: &Order) -> Result<Flight, SimulationError> {
        let sortie = sortie(self, order, case.profile());
        let (conditions, settings) = (conditions(self), settings(self, order));
        match &self.controller {
            Some(own) => simulation::fly_with(&sortie, own, &conditions, &settings, order.seed),
            None => simulation::fly(&sortie, &controller(self), &conditions, &settings, order.seed),
        }
    }

    /// Of our controllers that have a pace of their own legs across the whole world at it; else so many times the plan,
    /// or the way at a moderate speed.
    ///
    /// ```text
    /// max(legs · own pace, 2 · planned, 1.5 · way/speed)      s
    /// ```
    ///
    /// Of a controller of the user's the first term is 0.
    fn slowest(&self, waypoints: &[Point3<f64>], length: usize, planned: f64) -> f64 {
        let pace = || length as f64 * controller(self).own_pace(&self.robot, self.world.size().norm());
        let own = if self.controller.is_some() { 0.0 } else { pace() };
        let way: f64 = waypoints.windows(2).map(|pair| (pair[1] - pair[0]).norm()).sum();
        let moderate = MODERATE_M_S.min(SHARE_OF_TOP_SPEED * self.robot.max_speed);
        let speed = self.room().and_then(|room| room.speed).unwrap_or(moderate);
        own.max(SLOWNESS_OF_PLAN * planned).max(SLOWNESS_OF_WAY * way / speed)
    }

    /// Of a stranger's controller nobody knows how far it looks ahead.
    ///
    /// `None` for controllers that plan over all waypoints: what they fly first depends on what comes last.
    fn leg_by_leg(&self) -> Option<&dyn LegByLeg> {
        (self.controller.is_none() && !controller(self).kind.plans_ahead()).then_some(self)
    }

    fn fittable(&self) -> Result<Fittable, String> {
        fit::fittable(self, &controller(self))
    }

    fn repeats(&self) -> Option<&'static str> {
        idle::repeats(self)
    }

    fn passed_over(&self) -> Vec<PassedOver> {
        idle::passed_over(self)
    }

    fn unfelt(&self, key: &str) -> Option<&'static str> {
        idle::unfelt(self, key)
    }

    /// `None` too where the scenario asks for no obstacles.
    fn place(&self, case: &Case, track: &Track) -> Option<Placement> {
        place(self, case, track, &self.scenario.generate.environment?.obstacles?)
    }
}

impl LegByLeg for FlightSetup {
    fn at_start(&self, order: &Order) -> Result<Airborne, SimulationError> {
        let (sortie, settings) = (sortie(self, order, None), settings(self, order));
        Airborne::at_start(&sortie, &controller(self), &conditions(self), &settings, order.seed)
    }

    fn fly_to(&self, airborne: &mut Airborne, waypoint: Point3<f64>) -> Result<(), SimulationError> {
        airborne.fly_to(&self.world, waypoint)
    }

    fn finish(&self, airborne: &mut Airborne) -> Result<(), SimulationError> {
        airborne.finish(&self.world)
    }
}

/// The profile is that of the case's witness, for controllers that follow one; leg by leg there is none.
///
/// Waypoints are the order's, m.
fn sortie<'a>(setup: &'a FlightSetup, order: &Order<'a>, profile: Option<&'a Profile>) -> Sortie<'a> {
    Sortie { robot: &setup.robot, world: &setup.world, waypoints: order.waypoints, profile }
}

/// `stable-waypoint` where the scenario names nothing.
fn controller(setup: &FlightSetup) -> ControllerSettings {
    let execute = &setup.scenario.execute;
    ControllerSettings {
        kind: execute.controller_in_force().unwrap_or(ControllerKind::StableWaypoint),
        fixed_velocity: execute.fixed_velocity_m_s,
        segment_times: execute.segment_times,
        goto_speed: execute.goto_speed_m_s,
        bandwidth: execute.bandwidth.unwrap_or(1.0),
    }
}

/// The curve that the controller of ours makes of the waypoints of `case`; `None` where it makes none, or another one
/// flies.
///
/// By the segment times of the scenario; its legs are those of the waypoints.
pub(super) fn own_curve(setup: &FlightSetup, case: &Case) -> Option<Profile> {
    let curve = || minimum_snap_curve(&setup.robot, setup.scenario.execute.segment_times, &case.waypoints);
    makes_own_curve(setup).then(curve)?
}

/// Whether it makes one of any.
pub(super) fn makes_own_curve(setup: &FlightSetup) -> bool {
    let ours = setup.scenario.execute.controller_in_force().filter(|_| setup.controller.is_none());
    ours == Some(ControllerKind::MinimumSnap)
}

/// Velocities in m/s in the cage's axes.
///
/// Gusts have a standard deviation (m/s) and a correlation time (s); the discrete gust begins at `start` and lasts
/// `duration` (s).
fn conditions(setup: &FlightSetup) -> Conditions {
    let world = &setup.scenario.world;
    Conditions {
        wind: Vector3::from(world.wind_m_s.unwrap_or_default()),
        gusts: world.gusts.map(|gusts| Gusts { std: gusts.std_m_s, correlation: gusts.correlation_s }),
        discrete_gust: world.discrete_gust.map(|gust| DiscreteGust {
            velocity: Vector3::from(gust.velocity_m_s),
            start: gust.start_s,
            duration: gust.duration_s,
        }),
        noise: setup.scenario.execute.noise,
    }
}

/// Step and walls are the scenario's; acceptance radius (m), time limit (s) and whether anything stands in the way are
/// the order's.
fn settings(setup: &FlightSetup, order: &Order) -> FlySettings {
    let execute = &setup.scenario.execute;
    FlySettings {
        step: execute.step_s,
        accept: order.accept,
        time_limit: order.time_limit,
        walls: execute.walls && order.obstacles,
        obstacles: order.obstacles,
        latency: execute.latency_s.unwrap_or(0.0),
        simd: setup.simd,
        ..FlySettings::default()
    }
}
