//! Flies a mission in our own simulator.

use nalgebra::{Point3, Vector3};

use super::FlightSetup;
use crate::simulation::{
    self, Airborne, Conditions, ControllerKind, ControllerSettings, DiscreteGust, FlySettings, Gusts, SimulationError,
    Sortie,
};
use crate::trajectory::{Flight, Profile};

/// What is to be flown.
#[derive(Debug, Clone, Copy)]
pub(in crate::campaign) struct Order<'a> {
    /// Both ends included, m.
    pub(in crate::campaign) waypoints: &'a [Point3<f64>],
    /// The planned motion through them.
    pub(in crate::campaign) profile: Option<&'a Profile>,
    /// A waypoint counts as reached inside this radius, m.
    pub(in crate::campaign) accept: f64,
    /// s.
    pub(in crate::campaign) time_limit: f64,
    /// The run's seed.
    pub(in crate::campaign) seed: u64,
}

/// Carries out `order`; `setup` is the run's own.
pub(in crate::campaign) fn fly(setup: &FlightSetup, order: &Order) -> Result<Flight, SimulationError> {
    let (sortie, conditions, settings) = (sortie(setup, order), conditions(setup), settings(setup, order));
    match setup.controller {
        Some(own) => simulation::fly_with(&sortie, own, &conditions, &settings, order.seed),
        None => simulation::fly(&sortie, &controller(setup), &conditions, &settings, order.seed),
    }
}

/// Ready to be flown leg by leg from the first waypoint of `order`; its controller must be one that [`goes_on`].
pub(in crate::campaign) fn at_start(setup: &FlightSetup, order: &Order) -> Result<Airborne, SimulationError> {
    let (sortie, settings) = (sortie(setup, order), settings(setup, order));
    Airborne::at_start(&sortie, &controller(setup), &conditions(setup), &settings, order.seed)
}

/// Whether the controller can be flown leg by leg: of a stranger nobody knows how far it looks ahead.
pub(in crate::campaign) fn goes_on(setup: &FlightSetup) -> bool {
    setup.controller.is_none() && !controller(setup).kind.plans_ahead()
}

fn sortie<'a>(setup: &FlightSetup<'a>, order: &Order<'a>) -> Sortie<'a> {
    Sortie { robot: setup.robot, world: setup.world, waypoints: order.waypoints, profile: order.profile }
}

fn controller(setup: &FlightSetup) -> ControllerSettings {
    let execute = &setup.scenario.execute;
    ControllerSettings {
        kind: execute.controller_in_force().unwrap_or(ControllerKind::StableWaypoint),
        fixed_velocity: execute.fixed_velocity_m_s,
        segment_times: execute.segment_times,
    }
}

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

fn settings(setup: &FlightSetup, order: &Order) -> FlySettings {
    let execute = &setup.scenario.execute;
    FlySettings {
        step: execute.step_s,
        accept: order.accept,
        time_limit: order.time_limit,
        walls: execute.walls,
        simd: setup.simd,
        ..FlySettings::default()
    }
}
