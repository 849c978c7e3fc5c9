//! Flies a mission in our own simulator.

use nalgebra::{Point3, Vector3};

use super::FlightSetup;
use crate::simulation::{
    self, Conditions, ControllerKind, ControllerSettings, DiscreteGust, FlySettings, Gusts, SimulationError, Sortie,
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
    let FlightSetup { scenario, robot, world, simd } = *setup;
    let execute = &scenario.execute;
    let sortie = Sortie { robot, world, waypoints: order.waypoints, profile: order.profile };
    let controller = ControllerSettings {
        kind: execute.controller_in_force().unwrap_or(ControllerKind::StableWaypoint),
        fixed_velocity: execute.fixed_velocity_m_s,
        segment_times: execute.segment_times,
    };
    let conditions = Conditions {
        wind: Vector3::from(scenario.world.wind_m_s.unwrap_or_default()),
        gusts: scenario.world.gusts.map(|gusts| Gusts { std: gusts.std_m_s, correlation: gusts.correlation_s }),
        discrete_gust: scenario.world.discrete_gust.map(|gust| DiscreteGust {
            velocity: Vector3::from(gust.velocity_m_s),
            start: gust.start_s,
            duration: gust.duration_s,
        }),
        noise: execute.noise,
    };
    let settings = FlySettings {
        step: execute.step_s,
        accept: order.accept,
        time_limit: order.time_limit,
        walls: execute.walls,
        simd,
        ..FlySettings::default()
    };
    simulation::fly(&sortie, &controller, &conditions, &settings, order.seed)
}
