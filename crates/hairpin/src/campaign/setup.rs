//! From a scenario's numbers to the things they describe. Robots are chosen by the one `match` here.

use std::borrow::Cow;
use std::sync::Arc;

use super::arm::{self, ArmSetup, Station};
use super::drive::{self, DriveSetup};
use super::flight::{self, FlightSetup};
use super::scenario::{Mistake, Scenario};
use super::{AnyController, Case, Environment};
use crate::math::simd::Simd;
use crate::robot::quadrotor::Quadrotor;
use crate::robot::rover::Rover;
use crate::world::World;
use crate::world::terrain::{ElevationMap, KeepOuts};

/// A resolved scenario and what it describes.
#[derive(Debug, Clone)]
pub struct Setup {
    /// Every key, the robot's table inline.
    pub scenario: Scenario,
    /// Version of the kernels that generate and execute.
    pub simd: Simd,
    machine: Machine,
    own_controller: Option<AnyController>,
}

/// A robot in its world.
#[derive(Debug, Clone)]
enum Machine {
    Flyer { robot: Box<Quadrotor>, world: World },
    Driver { rover: Box<Rover>, planner: Box<Rover>, map: Arc<ElevationMap>, keep_out: Arc<KeepOuts> },
    Arm(Arc<Station>),
}

/// A setup, by what its robot does.
#[derive(Debug, Clone, Copy)]
pub enum Kind<'a> {
    /// It flies.
    Flight(FlightSetup<'a>),
    /// It drives.
    Drive(DriveSetup<'a>),
    /// It is an arm.
    Arm(ArmSetup<'a>),
}

impl Setup {
    /// Builds robot and world of a resolved scenario, and checks every key that has a bound.
    ///
    /// # Errors
    /// The first key whose value is out of bounds.
    pub fn new(scenario: Scenario) -> Result<Self, Mistake> {
        let scenario = scenario.with_ground();
        if let Some(mistake) = scenario.check().into_iter().next() {
            return Err(mistake);
        }
        Self::build(scenario, Simd::default())
    }

    /// The same at another version of the kernels.
    pub fn with_simd(self, simd: Simd) -> Self {
        Self { simd, ..self }
    }

    /// The same executed by a controller of the caller's own, wherever the scenario's would execute: runs, searches
    /// that execute, re-runs, candidates of a shrinking. What is told of the campaign names it.
    ///
    /// The scenario's own keys stay as they are. A folder keeps a scenario and no code, so one that is written of this
    /// names the controller in its report and verdict only, and is resumed and replayed by those who have the code.
    ///
    /// # Errors
    /// A controller of another kind of robot, or without a name; a scenario that has a command executed, or varies what
    /// only ours have.
    pub fn with_controller(self, controller: impl Into<AnyController>) -> Result<Self, Mistake> {
        let controller = controller.into();
        match controller.mistake(&self.scenario) {
            Some(mistake) => Err(mistake),
            None => Ok(Self { own_controller: Some(controller), ..self }),
        }
    }

    /// The controller of the caller's own.
    pub(super) fn own_controller(&self) -> Option<&AnyController> {
        self.own_controller.as_ref()
    }

    /// The setup of `scenario`, whose keys were checked before `[vary]` drew some of them; kernels and controller stay
    /// these.
    pub(super) fn of_draw(&self, scenario: Scenario) -> Result<Self, Mistake> {
        Ok(Self { own_controller: self.own_controller.clone(), ..Self::build(scenario, self.simd)? })
    }

    /// This setup with what `case` has beside its waypoints in its world.
    ///
    /// # Errors
    /// An environment of a folder that was edited, with the key of `[world]` that it breaks.
    pub fn around(&self, case: &Case) -> Result<Cow<'_, Self>, Mistake> {
        match &case.environment {
            Some(environment) => self.of_draw(environment.around(&self.scenario)).map(Cow::Owned),
            None => Ok(Cow::Borrowed(self)),
        }
    }

    /// Whether an environment made elsewhere can be that of a case.
    ///
    /// # Errors
    /// What it has that acts on no robot of this kind, or the key that it breaks.
    pub fn check_environment(&self, environment: &Environment) -> Result<(), Mistake> {
        match environment.mistake(&self.scenario) {
            Some(mistake) => Err(mistake),
            None => self.of_draw(environment.around(&self.scenario)).map(drop),
        }
    }

    fn build(scenario: Scenario, simd: Simd) -> Result<Self, Mistake> {
        let machine = match &scenario {
            Scenario::Flight(scenario) => Machine::Flyer {
                robot: Box::new(flight::robot_of(&scenario.robot)?),
                world: flight::world_of(&scenario.world)?,
            },
            Scenario::Drive(scenario) => {
                let mut rover = Box::new(drive::rover_of(&scenario.robot)?);
                rover.kinematics = scenario.generate.kinematics;
                let map = drive::map_of(&scenario.world.terrain, scenario.seed)?;
                let planner = Box::new(drive::planner_of(&rover));
                let keep_out = Arc::new(scenario.world.keep_outs()?);
                Machine::Driver { rover, planner, map, keep_out }
            }
            Scenario::Arm(scenario) => Machine::Arm(Arc::new(arm::station_of(scenario)?)),
        };
        Ok(Self { scenario, simd, machine, own_controller: None })
    }

    /// The setup by what its robot does.
    pub fn kind(&self) -> Kind<'_> {
        let simd = self.simd;
        match (&self.scenario, &self.machine) {
            (Scenario::Flight(scenario), Machine::Flyer { robot, world }) => {
                let controller = match &self.own_controller {
                    Some(AnyController::Flight(controller)) => Some(controller),
                    _ => None,
                };
                Kind::Flight(FlightSetup { scenario, robot, world, controller, simd })
            }
            (Scenario::Drive(scenario), Machine::Driver { rover, planner, map, keep_out }) => {
                let controller = match &self.own_controller {
                    Some(AnyController::Drive(controller)) => Some(controller),
                    _ => None,
                };
                Kind::Drive(DriveSetup { scenario, rover, planner, map, keep_out, controller, simd })
            }
            (Scenario::Arm(scenario), Machine::Arm(station)) => Kind::Arm(ArmSetup { scenario, station, simd }),
            _ => unreachable!("a setup's machine is built from its scenario"),
        }
    }

    /// The setup of flights.
    pub fn flight(&self) -> Option<FlightSetup<'_>> {
        match self.kind() {
            Kind::Flight(setup) => Some(setup),
            Kind::Drive(_) | Kind::Arm(_) => None,
        }
    }

    /// The setup of drives.
    pub fn drive(&self) -> Option<DriveSetup<'_>> {
        match self.kind() {
            Kind::Drive(setup) => Some(setup),
            Kind::Flight(_) | Kind::Arm(_) => None,
        }
    }

    /// The setup of an arm.
    pub fn arm(&self) -> Option<ArmSetup<'_>> {
        match self.kind() {
            Kind::Arm(setup) => Some(setup),
            Kind::Flight(_) | Kind::Drive(_) => None,
        }
    }

    /// The logs whose recordings are the runs, where nothing is executed.
    pub fn recordings(&self) -> Option<&str> {
        self.arm().and_then(|arm| arm.scenario.execute.logs.as_deref())
    }

    /// The robot's name.
    pub fn robot_name(&self) -> &str {
        match &self.machine {
            Machine::Flyer { robot, .. } => &robot.name,
            Machine::Driver { rover, .. } => &rover.name,
            Machine::Arm(station) => &station.arm.name,
        }
    }

    /// What must be said wherever the robot is named; empty if nothing.
    pub fn caveat(&self) -> &str {
        match &self.machine {
            Machine::Flyer { robot, .. } => &robot.caveat,
            Machine::Driver { rover, .. } => &rover.caveat,
            Machine::Arm(station) => &station.arm.caveat,
        }
    }

    /// Names of the robot's numbers that were derived, not given.
    pub fn estimated(&self) -> Vec<&str> {
        match &self.machine {
            Machine::Flyer { robot, .. } => robot.estimated.iter().map(String::as_str).collect(),
            Machine::Driver { rover, .. } => rover.estimated.clone(),
            Machine::Arm(station) => station.arm.estimated.clone(),
        }
    }
}
