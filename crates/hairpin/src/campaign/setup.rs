//! From a scenario's numbers to the things they describe: a scenario is checked by building it.

use std::borrow::Cow;
use std::sync::Arc;

use serde_json::Value;

use super::arm::ArmSetup;
use super::attachments::{Attachments, Resolved};
use super::check::check_vary;
use super::drive::{DriveSetup, Driver};
use super::flight::{FlightSetup, Flyer};
use super::machine::{Look, Machine};
use super::scenario::{Mistake, Scenario};
use super::user_score::LegScorer;
use super::vary;
use super::{AnyController, Case, Environment};
use crate::math::simd::Simd;

/// A resolved scenario and what it describes. What draws leave as it is they share.
#[derive(Debug, Clone)]
pub struct Setup {
    /// Every key, the robot's table inline.
    pub scenario: Scenario,
    /// What its files hold.
    pub attachments: Arc<Attachments>,
    /// Version of the kernels that generate and execute.
    pub simd: Simd,
    machine: Machine,
    own_controller: Option<AnyController>,
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
    /// Builds robot and world of a resolved scenario, and looks at every key that has a bound, also at the ends of what
    /// `[vary]` may make of it.
    ///
    /// # Errors
    /// Every key whose value is out of bounds, in the order of the file.
    pub fn build(resolved: Resolved) -> Result<Self, Vec<Mistake>> {
        let Resolved { scenario, attachments } = resolved;
        let machine = Machine::of(&scenario, &attachments, None, Look::All)?;
        let attachments = attachments.into();
        Self { scenario, attachments, simd: Simd::default(), machine, own_controller: None }.checked()
    }

    /// The same, which tells the first mistake alone.
    ///
    /// # Errors
    /// The first key whose value is out of bounds.
    pub fn new(resolved: impl Into<Resolved>) -> Result<Self, Mistake> {
        Self::build(resolved.into()).map_err(first)
    }

    /// The setup of another scenario with the same files, which is looked at as [`Self::new`] does; kernels and
    /// controller stay these.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn changed(&self, scenario: Scenario) -> Result<Self, Mistake> {
        self.check(scenario).map_err(first)
    }

    /// The setup with the values of `draws` in place of the nominal ones.
    ///
    /// # Errors
    /// A key that the scenario has not, a value that is out of its key's bounds in combination with the others.
    pub fn drawn(&self, draws: &[(String, Value)]) -> Result<Self, Mistake> {
        self.of_draw(vary::apply(&self.scenario, draws)?)
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
        let machine = Machine::of(&scenario, &self.attachments, self.known(), Look::Built).map_err(first)?;
        Ok(self.with(scenario, machine))
    }

    /// This setup with what `case` has beside its waypoints in its world.
    ///
    /// # Errors
    /// An environment of a folder that was edited, with the key of `[world]` that it breaks.
    pub fn around(&self, case: &Case) -> Result<Cow<'_, Self>, Mistake> {
        match &case.environment {
            Some(environment) => self.of_draw(self.surrounded_by(environment)).map(Cow::Owned),
            None => Ok(Cow::Borrowed(self)),
        }
    }

    /// Whether an environment made elsewhere can be that of a case.
    ///
    /// # Errors
    /// What it has that acts on no robot of this kind, or the key that it breaks.
    pub fn check_environment(&self, environment: &Environment) -> Result<(), Mistake> {
        if let Some(foreign) = environment.foreign(self.scenario.head().surroundings) {
            return Err(foreign);
        }
        let around = self.surrounded_by(environment);
        let broken = |mistake: &Mistake| {
            mistake.key.starts_with("world.") || mistake.key.starts_with("execute.external_force_n")
        };
        match self.check(around.clone()) {
            Ok(_) => Ok(()),
            Err(mistakes) => match mistakes.into_iter().find(broken) {
                Some(mistake) => Err(mistake),
                None => self.of_draw(around).map(drop),
            },
        }
    }

    /// What draws share.
    fn known(&self) -> Option<(&Scenario, &Machine)> {
        Some((&self.scenario, &self.machine))
    }

    fn surrounded_by(&self, environment: &Environment) -> Scenario {
        let mut around = self.scenario.clone();
        around.surround(environment);
        around
    }

    fn with(&self, scenario: Scenario, machine: Machine) -> Self {
        let (attachments, own_controller) = (self.attachments.clone(), self.own_controller.clone());
        Self { scenario, attachments, simd: self.simd, machine, own_controller }
    }

    fn check(&self, scenario: Scenario) -> Result<Self, Vec<Mistake>> {
        let machine = Machine::of(&scenario, &self.attachments, self.known(), Look::All)?;
        self.with(scenario, machine).checked()
    }

    /// Itself, once `[vary]` was looked at.
    fn checked(self) -> Result<Self, Vec<Mistake>> {
        let built =
            |drawn: &Scenario| Machine::of(drawn, &self.attachments, self.known(), Look::All).err().unwrap_or_default();
        let mistakes = check_vary(&self.scenario, &built);
        if mistakes.is_empty() { Ok(self) } else { Err(mistakes) }
    }

    /// The setup by what its robot does.
    pub fn kind(&self) -> Kind<'_> {
        let Self { scenario, attachments, simd, machine, own_controller } = self;
        let simd = *simd;
        match (scenario, machine) {
            (Scenario::Flight(scenario), Machine::Flyer(Flyer { robot, world })) => {
                let controller = match own_controller {
                    Some(AnyController::Flight(controller)) => Some(controller),
                    _ => None,
                };
                Kind::Flight(FlightSetup { scenario, attachments, robot, world, controller, simd })
            }
            (Scenario::Drive(scenario), Machine::Driver(Driver { rover, planner, map, keep_out })) => {
                let controller = match own_controller {
                    Some(AnyController::Drive(controller)) => Some(controller),
                    _ => None,
                };
                Kind::Drive(DriveSetup { scenario, attachments, rover, planner, map, keep_out, controller, simd })
            }
            (Scenario::Arm(scenario), Machine::Arm(station)) => {
                Kind::Arm(ArmSetup { scenario, attachments, station, simd })
            }
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

    /// The score of the user's own, if that is what legs are scored by.
    pub fn user_score(&self) -> Option<&dyn LegScorer> {
        self.attachments.user_score(self.scenario.score()).map(|user| &*user.read)
    }

    /// The word of the controller that executes, the caller's or ours; `None` where a command does.
    pub fn controller(&self) -> Option<&str> {
        self.own_controller().map(AnyController::name).or(self.scenario.controller())
    }

    /// The robot's name.
    pub fn robot_name(&self) -> &str {
        self.machine.names().0
    }

    /// What must be said wherever the robot is named; empty if nothing.
    pub fn caveat(&self) -> &str {
        self.machine.names().1
    }

    /// Names of the robot's numbers that were derived, not given.
    pub fn estimated(&self) -> Vec<&str> {
        self.machine.estimated()
    }
}

/// The first of what was refused.
fn first(mistakes: Vec<Mistake>) -> Mistake {
    match mistakes.into_iter().next() {
        Some(mistake) => mistake,
        None => unreachable!("what is refused is refused for a reason"),
    }
}

#[cfg(test)]
mod tests;
