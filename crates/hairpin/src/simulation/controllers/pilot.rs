//! The controller of a run, if it is one of ours: no allocation, and it can be copied in mid-flight.

use super::anafi::Anafi;
use super::cascade::Cascade;
use super::crazyflie_goto::CrazyflieGoto;
use super::fixed_velocity::FixedVelocity;
use super::geometric::Geometric;
use super::kind::{ControllerKind, ControllerSettings};
use super::minimum_snap::MinimumSnap;
use super::px4_mission::Px4Mission;
use super::{stable_waypoint, unstable_waypoint};
use crate::robot::quadrotor::Quadrotor;
use crate::simulation::SimulationError;
use crate::simulation::command::{FlightCommand, FlightState};
use crate::simulation::controller::{Acceptance, Controller, Fault, Reference, Schedule};

/// See the file's first line.
#[derive(Debug, Clone)]
pub(crate) enum Pilot {
    /// Either of the two waypoint cascades.
    Waypoint(Cascade),
    /// See [`ControllerKind::FixedVelocity`].
    FixedVelocity(FixedVelocity),
    /// See [`ControllerKind::MinimumSnap`].
    MinimumSnap(MinimumSnap),
    /// See [`ControllerKind::Geometric`].
    Geometric(Geometric),
    /// See [`ControllerKind::Anafi`].
    Anafi(Anafi),
    /// See [`ControllerKind::Px4Mission`].
    Px4Mission(Px4Mission),
    /// See [`ControllerKind::CrazyflieGoto`].
    CrazyflieGoto(CrazyflieGoto),
}

impl Pilot {
    /// Builds the controller for a robot.
    ///
    /// # Errors
    /// A speed that is given and not positive, a bandwidth that is not.
    ///
    /// `bandwidth` scales the loops of each; settings of other controllers than the one that is named are not looked
    /// at.
    pub(crate) fn new(settings: &ControllerSettings, robot: &Quadrotor) -> Result<Self, SimulationError> {
        let bandwidth = positive("bandwidth", settings.bandwidth, "finite and > 0")?;
        let speed = |field, speed| positive(field, speed, "finite and > 0 m/s");
        Ok(match settings.kind {
            ControllerKind::UnstableWaypoint => {
                Pilot::Waypoint(unstable_waypoint::cascade(robot).with_bandwidth(bandwidth))
            }
            ControllerKind::StableWaypoint => {
                Pilot::Waypoint(stable_waypoint::cascade(robot).with_bandwidth(bandwidth))
            }
            ControllerKind::FixedVelocity => {
                let speed = speed("fixed_velocity", settings.fixed_velocity)?;
                Pilot::FixedVelocity(FixedVelocity::new(robot, speed, bandwidth))
            }
            ControllerKind::MinimumSnap => {
                Pilot::MinimumSnap(MinimumSnap::new(robot, settings.segment_times, bandwidth))
            }
            ControllerKind::Geometric => Pilot::Geometric(Geometric::new(robot, settings.segment_times, bandwidth)),
            ControllerKind::Anafi => Pilot::Anafi(Anafi::new(robot, bandwidth)),
            ControllerKind::Px4Mission => Pilot::Px4Mission(Px4Mission::new(robot, bandwidth)),
            ControllerKind::CrazyflieGoto => {
                let speed = settings.goto_speed.map(|given| speed("goto_speed", given)).transpose()?;
                Pilot::CrazyflieGoto(CrazyflieGoto::new(robot, speed, bandwidth))
            }
        })
    }

    fn controller(&self) -> &dyn Controller<Quadrotor> {
        match self {
            Pilot::Waypoint(controller) => controller,
            Pilot::FixedVelocity(controller) => controller,
            Pilot::MinimumSnap(controller) => controller,
            Pilot::Geometric(controller) => controller,
            Pilot::Anafi(controller) => controller,
            Pilot::Px4Mission(controller) => controller,
            Pilot::CrazyflieGoto(controller) => controller,
        }
    }
}

impl Controller<Quadrotor> for Pilot {
    fn period(&self) -> Option<f64> {
        self.controller().period()
    }

    fn reset(&mut self, reference: &Reference<Quadrotor>) -> Result<(), Fault> {
        match self {
            Pilot::Waypoint(controller) => controller.reset(reference),
            Pilot::FixedVelocity(controller) => controller.reset(reference),
            Pilot::MinimumSnap(controller) => controller.reset(reference),
            Pilot::Geometric(controller) => controller.reset(reference),
            Pilot::Anafi(controller) => controller.reset(reference),
            Pilot::Px4Mission(controller) => controller.reset(reference),
            Pilot::CrazyflieGoto(controller) => controller.reset(reference),
        }
    }

    fn control(&mut self, dt: f64, now: &FlightState, to: &Reference<Quadrotor>) -> Result<FlightCommand, Fault> {
        match self {
            Pilot::Waypoint(controller) => controller.control(dt, now, to),
            Pilot::FixedVelocity(controller) => controller.control(dt, now, to),
            Pilot::MinimumSnap(controller) => controller.control(dt, now, to),
            Pilot::Geometric(controller) => controller.control(dt, now, to),
            Pilot::Anafi(controller) => controller.control(dt, now, to),
            Pilot::Px4Mission(controller) => controller.control(dt, now, to),
            Pilot::CrazyflieGoto(controller) => controller.control(dt, now, to),
        }
    }

    fn schedule(&self) -> Option<Schedule> {
        self.controller().schedule()
    }

    fn acceptance(&self) -> Acceptance {
        self.controller().acceptance()
    }
}

/// NaN and infinities are refused.
fn positive(field: &'static str, value: f64, bound: &'static str) -> Result<f64, SimulationError> {
    if value.is_finite() && value > 0.0 {
        return Ok(value);
    }
    Err(SimulationError::new(field, value.to_string(), bound))
}

#[cfg(feature = "unit-tests")]
mod tests {
    use nalgebra::{Point3, Vector3};

    use super::*;
    use crate::simulation::tests::{KINDS, cage, flightgoggles};
    use crate::simulation::{Conditions, FlySettings, Gusts, OwnController, Sortie, fly, fly_with};

    /// Ours brought in by the door for strangers fly the same, to the bit: there is no second way.
    #[test]
    fn ours_as_a_strangers_fly_alike() {
        let (robot, world) = (flightgoggles(), cage());
        let waypoints = [[5.0, 5.0, 5.0], [12.0, 6.0, 7.0], [6.0, 14.0, 4.0]].map(Point3::from);
        let sortie = Sortie { robot: &robot, world: &world, waypoints: &waypoints, profile: None };
        let gusts = Some(Gusts { std: 1.0, correlation: 1.0 });
        let conditions = Conditions { wind: Vector3::x(), gusts, noise: true, ..Conditions::default() };
        for kind in KINDS {
            let settings = ControllerSettings { kind, ..ControllerSettings::default() };
            let own = OwnController::new("ours", move |robot| Pilot::new(&settings, robot).unwrap());
            let ours = fly(&sortie, &settings, &conditions, &FlySettings::default(), 3).unwrap();
            let theirs = fly_with(&sortie, &own, &conditions, &FlySettings::default(), 3).unwrap();
            assert_eq!(ours, theirs, "{kind:?}");
        }
    }
}
